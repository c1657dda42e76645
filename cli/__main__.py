"""Run the command line with the bpy module: ``python -m eigenparts.cli segment FILE...``."""

import sys

from . import main

sys.exit(main(sys.argv[1:]))
