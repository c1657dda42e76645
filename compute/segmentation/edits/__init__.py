"""Corrections by hand, and how they are found again after another analysis. Imports all of segmentation but parts."""
