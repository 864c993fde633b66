"""Modules of our own as programs: they find what this process finds, and nothing that lies in the current folder.

`python -m` looks for modules in the current folder first. Whoever starts a service in a folder that holds an
`engine.py`, a `json.py` or a stranger's checkout does not mean that.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path

import engine


def module_command(module: str, *arguments: str) -> list[str]:
    """The command that runs a module; it wants `module_environment`."""
    return [sys.executable, "-P", "-m", module, *arguments]


def module_environment(environment: Mapping[str, str] = os.environ) -> dict[str, str]:
    """The environment in which a module finds what this process finds."""
    return {**environment, "PYTHONPATH": os.pathsep.join(module_path()), "PYTHONSAFEPATH": "1"}


def module_path() -> list[str]:
    """Where this process looks for modules, without the current folder: Python puts it there for `-m`, `-c` and an empty
    part of PYTHONPATH. It stays where PYTHONPATH names it, and where it is the program's own."""
    here, program = Path.cwd(), Path(engine.__file__).parent.parent
    named = [Path(part).absolute() for part in os.environ.get("PYTHONPATH", "").split(os.pathsep) if part]
    folders = [Path(folder).absolute() for folder in sys.path if folder]
    return [str(folder) for folder in folders if folder != here or folder in (program, *named)]


def leave_out_current_folder() -> None:
    """Let this process, and all that it starts, look for modules nowhere else from now on."""
    sys.path[:] = module_path()
    os.environ["PYTHONSAFEPATH"] = "1"
