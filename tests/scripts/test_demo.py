"""How the demo reads an event stream (HTML standard, section 9.2.6)."""

from __future__ import annotations

import runpy
from pathlib import Path

DEMO = runpy.run_path(str(Path(__file__).parents[2] / "scripts" / "demo.py"), run_name="demo")


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
