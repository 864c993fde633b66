"""`galatea doctor`."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent


def doctor(**settings: str) -> subprocess.CompletedProcess[str]:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GALATEA_")}
    command = [sys.executable, "-m", "shell.main", "doctor"]
    return subprocess.run(command, env=environment | settings, cwd=ROOT, capture_output=True, text=True)


def test_a_whole_installation_is_whole(tmp_path: Path) -> None:
    found = doctor(GALATEA_DATA_DIR=str(tmp_path))
    assert found.returncode == 0, found.stdout
    assert "mediapipe 0.10.21" in found.stdout and "embedded Redis 6" in found.stdout
    assert "Everything that is needed is there." in found.stdout
    for wall in ("jobs see no files but their own", "jobs have no network", "jobs do not work as root"):
        assert wall in found.stdout


def test_what_is_missing_is_named_with_a_remedy(tmp_path: Path) -> None:
    found = doctor(GALATEA_DATA_DIR="/proc/nothing/here", GALATEA_KINDS="no_such_module:KIND", GALATEA_WEB_DIR="/none")
    assert found.returncode == 1
    assert "No module named 'no_such_module'" in found.stdout
    assert "make setup" in found.stdout
    assert "needed things are missing" in found.stdout
