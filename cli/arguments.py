"""What the command line understands."""

import argparse
from pathlib import Path

from . import segment
from .formats import FORMATS


def parse(argv: list[str]) -> argparse.Namespace:
    """Return the options; ``.run(options, out, err)`` carries the command out."""
    parser = argparse.ArgumentParser(prog="eigenparts", description="Divide meshes into meaningful parts.")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    _add_segment(commands)
    return parser.parse_args(argv)


def _add_segment(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    command = commands.add_parser(
        "segment",
        help="divide each mesh into parts",
        description=f"Divide each mesh of each file into parts. Formats: {' '.join(FORMATS)}.",
    )
    command.add_argument("files", metavar="FILE", nargs="+", type=Path)
    command.add_argument("--object", metavar="NAME", help="only this object of each file")
    command.add_argument(
        "--field",
        metavar="F",
        default="diffusion",
        help="diffusion (default), the number of an eigenfunction, or the name of a float attribute",
    )
    choice = command.add_mutually_exclusive_group()
    choice.add_argument("--level", metavar="N", type=int, help="how many features to keep")
    choice.add_argument("--threshold", metavar="X", type=float, help="least height of a feature, as a fraction")
    choice.add_argument("--parts", metavar="N", type=int, dest="n_parts", help="how many parts, the body included")
    command.add_argument(
        "--mode",
        choices=["nested", "features"],
        default="nested",
        help="parts inside parts (default), or only what stands out at this level",
    )
    command.add_argument("--output", metavar="DIR", type=Path, help="folder for results; otherwise beside each file")
    command.add_argument("--json", action="store_true", help="print the report as JSON")
    command.set_defaults(run=segment.run)
