"""Run the command line with the bpy module: ``python -m eigenparts.cli segment FILE...``."""

import sys

from . import main
from .processes.ending import end_process

end_process(main(sys.argv[1:]))
