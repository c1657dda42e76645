"""The command line: ``blender --background --command eigenparts ...``, and the same as :func:`main`."""

import sys
from collections.abc import Sequence

import bpy

from ..operators.messages.user_errors import MISSING_SCIPY, is_engine_complete
from .processes.ending import let_python_end

_handles: list[object] = []


def main(argv: Sequence[str]) -> int:
    """Run one command and return its exit code: 0, 1 if a file failed, 2 if the arguments are wrong."""
    if is_module():
        let_python_end()
    if not is_engine_complete():
        sys.stderr.write(MISSING_SCIPY + "\n")
        return 1
    # The engine takes its time to load, and Blender starts often without this being called.
    from .arguments import parse
    from .run import run_command

    try:
        options = parse(list(argv))
    except SystemExit as exit_request:
        return int(exit_request.code or 0)
    return run_command(options, sys.stdout, sys.stderr)


def is_module() -> bool:
    """Whether Blender is a module of this Python, which gives it no command line of its own."""
    return not bpy.app.binary_path


def register() -> None:
    # As a module, Blender would never call the command, and end with a crash because it is still there.
    if is_module():
        let_python_end()
    else:
        _handles.append(bpy.utils.register_cli_command("eigenparts", main))


def unregister() -> None:
    while _handles:
        bpy.utils.unregister_cli_command(_handles.pop())
