"""The demo from end to end, and how it reads an event stream (HTML standard, section 9.2.6)."""

from __future__ import annotations

import os
import re
import runpy
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from engine.media.video import probe_video, read_video
from engine.perception.face.faces import find_faces
from engine.perception.face.landmarks import mouth_opening

ROOT = Path(__file__).parents[2]
SCRIPT = ROOT / "scripts" / "demo.py"
DEMO = runpy.run_path(str(SCRIPT), run_name="demo")


def test_reads_the_messages_of_an_event_stream() -> None:
    lines = [
        ": a comment keeps the line open",
        "id: 7",
        "event: progress",
        'data: {"fraction":',
        "data:  0.5}",
        "",
        "",
        "data:no space",
        "",
        "data: cut off before its blank line",
    ]
    assert list(DEMO["messages"](iter(lines))) == [
        {"id": "7", "event": "progress", "data": '{"fraction":\n 0.5}'},
        {"data": "no space"},
    ]


def test_knows_files_from_names(tmp_path: Path) -> None:
    video = tmp_path / "smile.mp4"
    video.touch()
    assert DEMO["is_file"](str(video))
    assert not DEMO["is_file"]("happy")


def test_the_sample_portrait_is_there() -> None:
    assert DEMO["sample_portrait"]().is_file()


# in a new checkout the engine is compiled first, on what the other tests leave of the machine
@pytest.mark.timeout(1200)
def test_once_it_leaves_a_video_and_no_service(tmp_path: Path) -> None:
    """What `make demo ONCE=1` runs: Grace Hopper laughs, and the service has ended."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("GALATEA_")}
    command = [sys.executable, str(SCRIPT), "--once", "--folder", str(tmp_path)]
    done = subprocess.run(command, env=kept | {"PYTHONPATH": str(ROOT)}, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    page = re.search(r"Follow it at (http://127\.0\.0\.1:\d+)/#/jobs/", done.stdout)
    assert page and f"Video  {tmp_path / 'grace_hopper-happy.mp4'}" in done.stdout
    with pytest.raises(httpx.ConnectError):
        httpx.get(page[1], trust_env=False)
    video = tmp_path / "grace_hopper-happy.mp4"
    assert (probe_video(video).width, probe_video(video).height) == (512, 600)
    opening = [float(mouth_opening(find_faces(frame.rgb)[0])) for frame in read_video(video, fps=2)]
    assert opening[0] < 0.08 and max(opening) > 0.1
