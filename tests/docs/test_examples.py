"""What the guides tell a reader to type does what they say: run as it stands, against a service that runs."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest
from made_motion import bvh
from missing import missing
from PIL import Image
from running import ROOT, Running

from engine.character.sample import sample_picture
from engine.media.image import write_image

ADDRESS = "http://127.0.0.1:8000"


@pytest.fixture(scope="module")
def shared_service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    served = "portrait,moments,character,motion"  # what the guides order
    data = tmp_path_factory.mktemp("data") / "data"
    service = Running(data, kinds="engine.kinds:KINDS", worker_kinds=served, wait_seconds=900)
    yield service
    service.stop()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a portrait, a person and a motion in it, as the guides suppose."""
    package = find_spec("matplotlib")
    assert package is not None and package.origin is not None
    portrait = Path(package.origin).parent / "mpl-data/sample_data/grace_hopper.jpg"
    with Image.open(portrait) as whole:  # a ninth of its pixels, for what is made of it several times
        whole.reduce(3).save(tmp_path / "portrait.jpg", quality=95)
    write_image(tmp_path / "person.jpg", sample_picture(300))
    (tmp_path / "swing.bvh").write_bytes(bvh())
    return tmp_path


def blocks(name: str, language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", (ROOT / "docs" / name).read_text(), re.MULTILINE | re.DOTALL)


@pytest.mark.timeout(1800)  # half a dozen jobs, one after the other
def test_the_rest_guide(running: Running, folder: Path) -> None:
    if shutil.which("jq") is None or shutil.which("curl") is None:
        message = "the guide's commands need curl and jq (make test installs them: scripts/setup.sh --for-tests)"
        missing(message)
    address = str(running.client.base_url).rstrip("/")
    script = "\n".join(["set -eu -o pipefail", *blocks("rest.md", "sh")]).replace(ADDRESS, address)
    script = script.replace("wait=60", "wait=900")  # machines that run tests are busy
    done = subprocess.run(["bash", "-c", script], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert json.loads((folder / "job.json").read_text())["status"] == "succeeded"
    assert (folder / "animation.mp4").read_bytes()[4:8] == b"ftyp"
    assert (folder / "result.zip").read_bytes()[:2] == b"PK"
    assert (folder / "character.glb").read_bytes()[:4] == b"glTF"
    assert "event: progress" in done.stdout and done.stdout.rstrip().endswith("missing_input")


def test_the_python_clients_first_example(running: Running, folder: Path) -> None:
    address = str(running.client.base_url).rstrip("/")
    program = blocks("python-client.md", "python")[0].replace(ADDRESS, address)
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "animate" in done.stdout and (folder / "out" / "animation.mp4").read_bytes()[4:8] == b"ftyp"
