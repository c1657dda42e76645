"""Reports of files, for people and programs, and as they are kept with results."""
