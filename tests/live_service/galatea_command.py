"""`galatea ARGUMENTS` in the tests' own process: what a short command says and does, without a start of Python for each."""

from __future__ import annotations

from pathlib import Path

from click.testing import CliRunner, Result

from shell.main import main


def galatea(data_dir: Path, *arguments: str) -> Result:
    """What the command said (`stdout`, `stderr`) and ended with (`exit_code`), of a service that keeps its data there."""
    return CliRunner().invoke(main, arguments, env={"GALATEA_DATA_DIR": str(data_dir)})
