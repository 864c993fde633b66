"""What lies in the folder in which somebody starts the program is never run, whatever it is called."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from running import HERE, Running

GALATEA = Path(sys.executable).with_name("galatea")
OURS = ("engine", "service", "worker", "shell", "galatea_client", "galatea")
OTHERS = ("json", "redis", "celery", "celeryconfig", "alembic", "uvicorn", "sitecustomize", "usercustomize", "secrets")
PACKAGES = ("numpy", "scipy", "mediapipe", "logging")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder in which every module leaves a mark when it is run, and then fails."""
    folder = tmp_path / "evil"
    for name in (*OURS, *OTHERS):
        _trap(folder / f"{name}.py")
    for name in PACKAGES:
        _trap(folder / name / "__init__.py")
    return folder


def _trap(path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    mark = path.with_name("ran")
    path.write_text(f"open({str(mark)!r}, 'w').close()\nraise SystemExit('this is the wrong ' + __file__)\n")


def _ran(folder: Path) -> list[Path]:
    return list(folder.rglob("ran"))


def test_a_service_works_in_a_folder_of_modules_with_its_names(
    tmp_path: Path, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "compiled"))  # so that the worker rehearses, too
    running = Running(tmp_path / "data", cwd=folder, command=[str(GALATEA)])
    try:
        job = running.submit(b"\x89PNG\r\n\x1a\n" + bytes(100))
        assert running.until(job["id"], "succeeded", "failed")["status"] == "succeeded"
        assert _ran(folder) == []
    finally:
        running.stop()


def test_the_doctor_looks_elsewhere(tmp_path: Path, folder: Path) -> None:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GALATEA_")}
    environment |= {"GALATEA_DATA_DIR": str(tmp_path / "data")}
    done = subprocess.run([str(GALATEA), "doctor"], cwd=folder, env=environment, capture_output=True, text=True)
    assert "jobs have no network" in done.stdout, done.stdout + done.stderr
    assert _ran(folder) == []


def test_what_pythonpath_names_is_found(tmp_path: Path) -> None:
    """A job kind of an operator's own may lie in the current folder, where that is named."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GALATEA_")}
    environment |= {"GALATEA_KINDS": "tiny_kind:KIND", "GALATEA_DATA_DIR": str(tmp_path)}
    for named, code in ((str(HERE), 0), (".", 0), (os.pathsep, 1)):  # an empty part is the current folder to Python
        done = subprocess.run(
            [str(GALATEA), "tiny", "--help"],
            cwd=HERE,
            env=environment | {"PYTHONPATH": named},
            capture_output=True,
            text=True,
        )
        assert ("Measures a picture." in done.stdout) == (code == 0), done.stdout
        assert (done.returncode == 0) == (code == 0), done.stderr
