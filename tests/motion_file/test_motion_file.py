"""The job kind `motion`: what it leaves of a file, so that somebody can choose."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from made_motion import BONES, bvh

from engine.errors import InputError
from engine.motion.files.gltf_motion import read_gltf_motion
from engine.motion_file import KIND, MotionOptions
from engine.run import Run

STICK = """HIERARCHY
ROOT lower
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT upper
  {
    OFFSET 0 50 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 50 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
0 0 0 0 0 0 0 0 0
0 0 0 0 0 0 0 0 10
"""


def looked_at(path: Path, out: Path, **options: Any) -> tuple[dict[str, Any], dict[str, Any]]:
    """The documents that a check leaves of a file: `motion.json` and `report.json`."""
    with Run() as run:
        KIND.work({"motion": path}, MotionOptions(**options), out, run)
    motion, report = (json.loads((out / name).read_text()) for name in ("motion.json", "report.json"))
    return motion, report


def test_a_file_s_joints_and_whom_they_move_are_left_for_somebody_to_choose(tmp_path: Path) -> None:
    path = tmp_path / "arms.bvh"
    path.write_bytes(bvh(frames=20))
    told, report = looked_at(path, tmp_path)
    assert {joint["name"]: joint["parent"] for joint in told["joints"]} == {
        name: parent for name, (parent, _) in BONES.items()
    }
    assert told["mapping"]["LeftForeArm"] == "LeftForeArm" and told["mapping"]["LeftShoulder"] == "LeftCollar"
    assert (told["frames"], told["clips"], told["error"]) == (20, [], None)
    assert report["inputs"]["joints"] == len(BONES) and report["inputs"]["motion_joints"] == told["mapping"]
    mended, _ = looked_at(path, tmp_path, motion_joints={"LeftShoulder": None})
    assert "LeftShoulder" not in mended["mapping"]


def test_what_is_nobody_s_skeleton_is_told_of_and_no_failure(tmp_path: Path) -> None:
    """A stick of two joints."""
    path = tmp_path / "stick.bvh"
    path.write_text(STICK)
    told, report = looked_at(path, tmp_path)
    assert (told["error"]["code"], told["mapping"]) == ("motion_not_humanoid", {})
    assert [joint["name"] for joint in told["joints"]] == ["lower", "upper"]
    assert [warning["code"] for warning in report["warnings"]] == ["motion_not_humanoid"]


def test_one_of_several_animations_is_chosen(media: Callable[[str], Path], tmp_path: Path) -> None:
    """The job kind `motion` tells of all by their names, and looks at the one that is meant."""
    soldier = media("scans3d/body_soldier/soldier.glb")
    told = {}
    for clip in (None, "Run", "Walk"):
        with Run() as run:
            KIND.work({"motion": soldier}, MotionOptions(motion_clip=clip), tmp_path, run)
        told[clip] = json.loads((tmp_path / "motion.json").read_text())
        assert told[clip]["clips"] == ["Idle", "Run", "TPose", "Walk"]
    assert told[None]["frames"] == len(read_gltf_motion(soldier, "Idle").rotations)
    assert len({document["seconds"] for document in told.values()}) == 3
    with pytest.raises(InputError) as error, Run() as run:
        KIND.work({"motion": soldier}, MotionOptions(motion_clip="Swim"), tmp_path, run)
    assert (error.value.code, error.value.correctable) == ("motion_clip_unknown", KIND.correctable[1:])
