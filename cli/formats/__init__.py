"""Files of every format: looked at, read with what had to be mended, and written with what they hold of the parts."""

from .format_table import FORMATS, load, name_of_divided, name_of_transferred, save
from .open_file import OpenFile

__all__ = ["FORMATS", "OpenFile", "load", "name_of_divided", "name_of_transferred", "save"]
