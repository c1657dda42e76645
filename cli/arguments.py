"""Arguments of the command line."""

import argparse
import shlex
from pathlib import Path
from typing import TypeAlias

from .. import compute
from ..operators.transfer.layer_choices import DEFAULT_LAYERS, LAYERS_OF_FILES
from .formats import FORMATS
from .processes.limits import CAN_LIMIT_MEMORY

EXIT_CODES = "Exit code: 0 if all went well, 1 if a file failed, 2 if the arguments are wrong."
LAYERS = tuple(kind.lower() for kind in LAYERS_OF_FILES)
# Seconds of the longest time limit: a week.
LONGEST = 604_800
# Gigabytes that no machine has.
LARGEST = 1_000_000
FILE_KINDS = f"Formats: {' '.join(FORMATS)}."


def parse(argv: list[str]) -> argparse.Namespace:
    """Return the options; ``.command`` is the name of the command."""
    about = "Divide meshes into meaningful parts."
    parser = argparse.ArgumentParser(prog="eigenparts", description=about, epilog=EXIT_CODES)
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for add in (_add_segment, _add_register, _add_transfer, _add_batch):
        add(commands)
    options = parser.parse_args(argv)
    if options.timeout and options.in_process:
        parser.error("--timeout ends processes, so it does not go with --in-process")
    if options.memory_limit and not CAN_LIMIT_MEMORY:
        parser.error("--memory-limit needs Linux: this system cannot limit the memory of a process")
    if options.points and options.command == "batch" and not options.source:
        parser.error("--points needs a --source, whose vertices it names")
    if options.command in ("register", "transfer") and options.source is None:
        options.source = options.files[0]
    return options


Commands: TypeAlias = "argparse._SubParsersAction[argparse.ArgumentParser]"


def _add_segment(commands: Commands) -> None:
    summary = "divide each mesh into parts"
    command = commands.add_parser("segment", help=summary, description=f"Divide each mesh of each file. {FILE_KINDS}")
    _add_files(command)
    _add_division(command)
    _add_execution(command)
    command.set_defaults(command="segment", source=None, reference=None, mirrored=False, points=None)


def _add_register(commands: Commands) -> None:
    summary = "divide each mesh into the parts of a reference"
    about = (
        f"Divide each mesh of each file into the parts of one of them: equal numbers are the same part. {FILE_KINDS}"
    )
    command = commands.add_parser("register", help=summary, description=about)
    _add_files(command)
    command.add_argument("--source", metavar="FILE", type=Path, help="file of the reference; otherwise the first file")
    _add_reference(command)
    _add_division(command)
    _add_execution(command)
    command.set_defaults(command="register")


def _add_transfer(commands: Commands) -> None:
    summary = "give each mesh what another has: weights, UV maps, shape keys"
    about = f"Transfer layers of one mesh to each mesh of each file; the results are .blend files. {FILE_KINDS}"
    command = commands.add_parser("transfer", help=summary, description=about)
    _add_files(command)
    command.add_argument("--source", metavar="FILE", type=Path, help="file to transfer from; otherwise the first file")
    _add_reference(command)
    _add_object(command)
    command.add_argument(
        "--layers",
        metavar="KINDS",
        type=_layers,
        default=[kind.lower() for kind in DEFAULT_LAYERS],
        help=f"what is transferred, with commas between: {', '.join(LAYERS)}; groups if not given",
    )
    command.add_argument(
        "--method",
        choices=("auto", "place", "shape"),
        default="auto",
        help="by place for clothes and the like, by shape for other poses; whichever fits if not given",
    )
    _add_execution(command)
    command.set_defaults(command="transfer")


def _add_batch(commands: Commands) -> None:
    summary = "do all files of folders, but for those that were finished before"
    about = f"Divide all files below folders, or register them if there is a --source. {FILE_KINDS}"
    command = commands.add_parser("batch", help=summary, description=about)
    command.add_argument("folders", metavar="FOLDER", nargs="+", type=Path)
    command.add_argument(
        "--glob",
        metavar="PATTERN",
        action="append",
        default=[],
        help="only files like this, such as '*.obj' or 'people/*'; may be given several times",
    )
    command.add_argument("--again", action="store_true", help="do the finished files, too")
    command.add_argument("--source", metavar="FILE", type=Path, help="file of a reference to register all files to")
    _add_reference(command)
    _add_division(command)
    _add_execution(command)
    command.set_defaults(command="batch")


def _add_files(command: argparse.ArgumentParser) -> None:
    command.add_argument("files", metavar="FILE", nargs="+", type=Path)


def _add_reference(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--reference", metavar="NAME", help="object of that file that is the reference; else the first"
    )
    command.add_argument("--mirrored", action="store_true", help="the files are mirror images of the reference")
    command.add_argument(
        "--points",
        metavar="JSON",
        type=Path,
        help='pairs of vertices that belong together, {"points": [[source, target], ...]}; the same for all files',
    )


def _add_object(command: argparse.ArgumentParser) -> None:
    command.add_argument("--object", metavar="NAME", help="only this object of each file")


def _add_division(command: argparse.ArgumentParser) -> None:
    _add_object(command)
    command.add_argument(
        "--field",
        metavar="F",
        default="diffusion",
        help="diffusion (default), the number of an eigenfunction, or the name of a float attribute",
    )
    command.add_argument(
        "--shells",
        choices=compute.SHELLS,
        default=compute.SHELLS[0],
        help="loose parts are analyzed with the largest where they prolong it (default), not at all, or each by itself",
    )
    command.add_argument(
        "--borders",
        choices=compute.BORDERS,
        default=compute.BORDERS[0],
        help="parts end at short lines of edges (default), or each face goes where its greater half lies",
    )
    choice = command.add_mutually_exclusive_group()
    choice.add_argument("--level", metavar="N", type=int, help="how many features to keep")
    choice.add_argument("--threshold", metavar="X", type=float, help="least height of a feature, as a fraction")
    choice.add_argument("--parts", metavar="N", type=int, dest="n_parts", help="how many parts, the body included")
    mode = command.add_mutually_exclusive_group()
    mode.add_argument(
        "--mode",
        choices=compute.READINGS,
        help="parts inside parts with joints (default) or without, or only what stands out at this level",
    )
    mode.add_argument(
        "--joints",
        dest="mode",
        action="store_const",
        const=compute.JOINTED,
        help="parts inside parts, and limbs cut where they narrow on both sides, such as at wrists (default)",
    )
    mode.add_argument("--no-joints", dest="mode", action="store_const", const=compute.NESTED, help="without joints")


def _add_execution(command: argparse.ArgumentParser) -> None:
    command.add_argument("--output", metavar="DIR", type=_folder, help="folder for results; otherwise beside each file")
    command.add_argument(
        "--overwrite",
        action="store_true",
        help="results may replace files that are not known as results of theirs",
    )
    report = command.add_mutually_exclusive_group()
    report.add_argument("--json", action="store_true", help="print the report as JSON")
    report.add_argument("--json-lines", action="store_true", help="print a report for each file as soon as it is done")
    processes = command.add_mutually_exclusive_group()
    processes.add_argument("--jobs", metavar="N", type=_positive, help="do the files in N processes")
    processes.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="do the files on a dask cluster, such as tcp://host:8786; whoever runs that scheduler can run any command "
        "as you, so name only one that you trust with your account",
    )
    processes.add_argument(
        "--in-process",
        action="store_true",
        help="do the files in this process: faster for small ones, but a file that crashes Blender ends all; otherwise "
        "those of a batch have a process each, and several that were named one that is started anew after a crash",
    )
    command.add_argument(
        "--timeout",
        metavar="SECONDS",
        type=_seconds,
        help="a file that takes longer has failed, and the others go on; otherwise an hour",
    )
    command.add_argument(
        "--memory-limit",
        metavar="GB",
        type=_gigabytes,
        help="a file that takes more memory has failed, and the others go on; otherwise what is free, shared among the "
        "processes (Linux only)",
    )
    # Of a process that goes on behind a file of the same call: the first number for parts that the reference has not.
    command.add_argument("--first-free", type=int, default=0, help=argparse.SUPPRESS)
    command.add_argument(
        "--worker-command",
        metavar="COMMAND",
        type=shlex.split,
        help="what starts this command line on the machines of the cluster; otherwise the same as here",
    )


def _folder(text: str) -> Path:
    path = Path(text)
    if not text or (path.exists() and not path.is_dir()):
        raise argparse.ArgumentTypeError(f"must be a folder, or the name of a new one; {text!r} is none")
    return path


def _layers(text: str) -> list[str]:
    kinds = sorted({kind.strip().lower() for kind in text.split(",")})
    if not set(kinds) <= set(LAYERS):
        raise argparse.ArgumentTypeError(f"must be some of {', '.join(LAYERS)}")
    return kinds


def _seconds(text: str) -> float:
    seconds = float(text)
    if not 0 < seconds <= LONGEST:
        raise argparse.ArgumentTypeError(f"must be more than 0 and at most {LONGEST}")
    return seconds


def _gigabytes(text: str) -> float:
    gigabytes = float(text)
    if not 0 < gigabytes < LARGEST:
        raise argparse.ArgumentTypeError(f"must be more than 0 and less than {LARGEST}")
    return gigabytes


def _positive(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError("must be at least 1")
    return number
