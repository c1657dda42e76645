"""Labels for the faces and the table of parts. Imports all else of segmentation."""
