"""Modules of our own as programs: they find what this process finds, and nothing that lies in the current folder."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from worker.programs.interpreter import module_command, module_environment, module_path


def found(module: str, folder: Path) -> str:
    """Where a module lies that a program started in a folder imports."""
    (folder / "tells.py").write_text("raise SystemExit('a stranger was started')")
    program = "import importlib, json, sys; print(json.dumps(importlib.import_module(sys.argv[1]).__file__))"
    (library := folder / "library").mkdir()
    (library / "telling.py").write_text(program)
    environment = module_environment()
    environment["PYTHONPATH"] += f":{library}"
    command = module_command("telling", module)
    told = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=True, timeout=60)
    return str(json.loads(told.stdout))


@pytest.mark.parametrize("module", ["engine", "string"])
def test_what_lies_in_the_current_folder_under_our_names_is_not_taken(tmp_path: Path, module: str) -> None:
    (tmp_path / f"{module}.py").write_text("raise SystemExit('a stranger was started')")
    assert Path(found(module, tmp_path)).parent != tmp_path


def test_the_current_folder_is_looked_into_where_pythonpath_names_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delenv("PYTHONPATH", raising=False)
    assert str(tmp_path) not in module_path()
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    assert module_path()[0] == str(tmp_path)
