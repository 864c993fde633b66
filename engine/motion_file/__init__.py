"""A motion file looked at by itself: the job kind `motion`.

It finds what a character's job would: the skeleton, and which of its joints move which of a character's. So a motion
can be kept, shown, and mended by overrides before anybody is moved by it.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from pydantic import BaseModel, ConfigDict

from engine.kind import Given, Input, Kind, Needs
from engine.motion.options import MotionClip, MotionJoints
from engine.run import Run
from engine.run_report import write_report

STAGES = {"read": 4.0, "map_joints": 1.0}
"""The stages and their usual share of the time."""

MAX_NAMES_TOLD = 1000
"""Animations, and skeletons, of a file that are told of."""


class MotionOptions(BaseModel):
    """What a user may choose about a check."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    motion_joints: MotionJoints = {}
    motion_clip: MotionClip = None


def _work(inputs: Mapping[str, Given], options: BaseModel, out: Path, run: Run) -> None:
    """Leaves `motion.json` and `report.json` in `out`. A skeleton that is nobody's is told of, and no failure."""
    from engine.motion.beginning import length_warning  # the service reads KIND alone: it stays light
    from engine.motion.check import check_motion
    from engine.motion.files.reading import motion_clips, read_motion
    from engine.motion.retargeting.joint_map import lost_warning

    path = inputs["motion"]
    assert isinstance(path, Path) and isinstance(options, MotionOptions)
    run.plan(STAGES)
    with run.timed("read"):
        motion = read_motion(path, options.motion_clip)
    with run.timed("map_joints"):
        checked = check_motion(motion, options.motion_joints)
    if too_long := length_warning(motion):
        run.warn("motion_cut", too_long)
    error = None
    if checked.refused is not None:
        error = {"code": checked.refused.code, "detail": checked.refused.detail}
        run.warn(checked.refused.code, checked.refused.detail)
    elif lost := lost_warning(motion, checked.mapping):
        run.warn("motion_joints_unmapped", lost)
    figures = {"fps": round(checked.fps, 4), "frames": checked.frames, "seconds": round(checked.seconds, 3)}
    document = {
        **figures,
        "loops": checked.loops,
        "clips": list(motion_clips(path)[:MAX_NAMES_TOLD]),
        "skeletons": list(motion.skeletons[:MAX_NAMES_TOLD]),
        "joints": [
            {"name": name, "parent": parent} for name, parent in zip(checked.joints, checked.parents, strict=True)
        ],
        "mapping": dict(checked.mapping),
        "missing": list(checked.missing),
        "error": error,
    }
    (out / "motion.json").write_text(json.dumps(document, indent=2) + "\n")
    report = {**figures, "joints": len(checked.joints), "motion_joints": dict(checked.mapping)}
    if motion.skeletons:
        report |= {"skeleton": motion.skeletons[0], "skeletons": len(motion.skeletons)}
    write_report(out / "report.json", "motion", run, report, {})


def _prepare() -> None:
    from engine.motion import check  # noqa: F401 - importing them is the preparation
    from engine.motion.files import reading  # noqa: F401


KIND = Kind(
    name="motion",
    summary="A motion file is read: its skeleton, and which of its joints move a character's.",
    inputs=(Input("motion", "motion", "A BVH file, or a GLB with an animated skeleton.", corrects=True),),
    options=MotionOptions,
    work=_work,
    correctable=("motion_joints", "motion_clip"),
    prepare=_prepare,
    needs=Needs(seconds=180, memory_mb=3000, cores=1, short=True),
)
