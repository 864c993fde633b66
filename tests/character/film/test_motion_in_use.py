"""What is used of a motion's file, and what is said of what is not."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from engine.character.film.motions import motion_in_use
from engine.errors import InputError
from engine.run import Run

TURN = """HIERARCHY
ROOT Hips
{{
  OFFSET 0 0 0
  CHANNELS 3 Zrotation Xrotation Yrotation
  End Site
  {{
    OFFSET 0 1 0
  }}
}}
MOTION
Frames: {frames}
Frame Time: 0.5
"""


@pytest.fixture
def run() -> Iterator[Run]:
    with Run() as run:
        yield run


def turning(folder: Path, frames: int) -> Path:
    """A file of two frames a second."""
    path = folder / "turn.bvh"
    path.write_text(TURN.format(frames=frames) + "0 0 0\n" * frames)
    return path


def test_a_minute_is_used_whole(run: Run, tmp_path: Path) -> None:
    motion = motion_in_use(turning(tmp_path, 121), None, {}, run.warn)
    assert motion is not None and len(motion.rotations) == 121
    assert run.notices == []


def test_of_more_the_first_minute_is_used_and_both_lengths_are_told(run: Run, tmp_path: Path) -> None:
    motion = motion_in_use(turning(tmp_path, 2401), None, {}, run.warn)
    assert motion is not None and len(motion.rotations) == 121
    (notice,) = run.notices
    assert notice.code == "motion_cut"
    assert "1200.0 s" in notice.message and "first 60" in notice.message


@pytest.mark.parametrize(
    ("clip", "joints", "named"),
    [
        ("Walk", {}, ["motion_clip"]),
        (None, {"Hips": "pelvis"}, ["motion_joints"]),
        ("Walk", {"Hips": None}, ["motion_joints", "motion_clip"]),
        (None, {}, []),
    ],
)
def test_without_a_file_its_options_are_not_passed_over_in_silence(
    run: Run, clip: str | None, joints: dict[str, str | None], named: list[str]
) -> None:
    """And are no reason to refuse: a revision that takes a built-in motion in a file's place has them from its parent."""
    assert motion_in_use(None, clip, joints, run.warn) is None
    assert [notice.code for notice in run.notices] == ["motion_options_unused"] * bool(named)
    for name in ("motion_joints", "motion_clip"):
        assert any(name in notice.message for notice in run.notices) is (name in named)


def test_what_cannot_be_read_is_mended_by_another_motion(run: Run, tmp_path: Path) -> None:
    path = turning(tmp_path, 3)
    path.write_text(path.read_text().replace("0 0 0\n", "0,5 0 0\n"))
    with pytest.raises(InputError) as error:
        motion_in_use(path, None, {}, run.warn)
    assert (error.value.code, error.value.correctable) == ("motion_unreadable", ("motion",))
    with pytest.raises(InputError) as error:
        motion_in_use(path, "Walk", {}, run.warn)
    assert (error.value.code, error.value.correctable) == ("motion_clip_unknown", ("motion_clip",))
