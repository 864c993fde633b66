"""`galatea doctor`."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from shell.doctor import builds_the_page

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
    assert "AttributeError" not in found.stderr
    for wall in ("jobs see no files but their own", "jobs have no network", "jobs do not work as root"):
        assert wall in found.stdout


def test_the_model_that_tells_people_apart_is_named(tmp_path: Path) -> None:
    found = doctor(GALATEA_DATA_DIR=str(tmp_path))
    assert "ok       faces of personas are told apart by dlib_face_recognition_resnet_model_v1.dat" in found.stdout
    model = tmp_path / "own.onnx"
    model.write_bytes(b"no model")
    own = {"GALATEA_FACE_DESCRIPTOR_MODEL": str(model), "GALATEA_FACE_DESCRIPTOR_MODEL_LICENCE": "MIT"}
    found = doctor(GALATEA_DATA_DIR=str(tmp_path), GALATEA_FACE_DESCRIPTOR_MODEL_SHA256="0" * 64, **own)
    assert found.returncode == 1
    assert "missing  faces of personas: own.onnx has SHA-256" in found.stdout


def test_what_is_missing_is_named_with_a_remedy(tmp_path: Path) -> None:
    found = doctor(GALATEA_DATA_DIR="/proc/nothing/here", GALATEA_KINDS="no_such_module:KIND", GALATEA_WEB_DIR="/none")
    assert found.returncode == 1
    assert "No module named 'no_such_module'" in found.stdout
    assert "make setup" in found.stdout
    assert "needed things are missing" in found.stdout


@pytest.mark.parametrize(("version", "builds"), [
    ("v18.20.4", False), ("v20.18.3", False), ("v20.19.0", True), ("v20.20.2", True), ("v21.7.3", False),
    ("v22.11.0", False), ("v22.12.0", True), ("v23.1.0", True), ("v24.0.0", True),
])  # fmt: skip
def test_node_builds_the_page_as_its_package_says(version: str, builds: bool) -> None:
    assert json.loads((ROOT / "web" / "package.json").read_text())["engines"]["node"] == "^20.19.0 || >=22.12.0"
    assert builds_the_page(version) == builds


def test_a_node_that_cannot_build_it_is_named_where_there_is_no_page(tmp_path: Path) -> None:
    node = tmp_path / "node"
    node.write_text("#!/bin/sh\necho v20.18.3\n")
    node.chmod(0o755)
    found = doctor(GALATEA_DATA_DIR=str(tmp_path), GALATEA_WEB_DIR="/none", PATH=f"{tmp_path}:{os.environ['PATH']}")
    assert found.returncode == 0, found.stdout
    assert "warning  Node v20.18.3 cannot build the page" in found.stdout
    assert "install Node 20.19 or later, or 22.12 or later" in found.stdout
