"""Files of every format: read into Blender with what had to be mended, and written with what they hold of the parts."""

from .format_table import FORMATS, OpenFile, load, name_of_divided, name_of_transferred, save

__all__ = ["FORMATS", "OpenFile", "load", "name_of_divided", "name_of_transferred", "save"]
