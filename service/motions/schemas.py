"""Motions as the API shows them."""

from __future__ import annotations

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

from engine.motion.catalogue import BuiltInMotion
from service.libraries.inspections import Inspection, InspectionStatus
from service.motions.checks import Check, MotionError, MotionJoint
from service.tables.files import File
from service.tables.kept import Kept


class MotionOut(BaseModel):
    """A motion that a character's job can name."""

    name: str
    source: Literal["built-in", "own"]
    title: str | None = None
    seconds: float | None = None
    loops: bool | None = None
    """Whether the last frame leads into the first, so that it is played on and on; null where that is not known."""
    url: str | None = None
    """Where the file is; built-in motions have none: they are made for each character."""
    size: int | None = None
    content_type: str | None = None
    created_at: datetime | None = None
    fps: float | None = None
    """Frames a second of the file."""
    frames: int | None = None
    clips: list[str] = []
    """The animations in a GLB, by their names: the option `motion_clip` of a job says which is played."""
    joints: list[MotionJoint] = []
    """The skeleton in the file."""
    mapping: dict[str, str] = {}
    """Which of its joints moves which of a character's: `{"LeftArm": "LeftShoulder"}`, a character's first. The option
    `motion_joints` of a job says otherwise where this is wrong."""
    missing: list[str] = []
    """Joints of a character that must have one in the file, and for which none was found."""
    error: MotionError | None = None
    """What is wrong with it. Where joints are missing, the option `motion_joints` mends it; otherwise, another file."""
    check_status: InspectionStatus = "none"
    """How far the check of the file is; `none`: there was no check."""
    check_job: str | None = None
    """The job that checks."""

    @classmethod
    def built_in(cls, motion: BuiltInMotion) -> MotionOut:
        return cls(name=motion.name, source="built-in", title=motion.title, seconds=motion.seconds, loops=motion.loops)

    @classmethod
    def own(cls, motion: Kept, file: File, inspection: Inspection[Check]) -> MotionOut:
        error = MotionError.model_validate(inspection.error) if inspection.error is not None else None
        return cls(
            name=motion.name,
            source="own",
            url=f"/v1/motions/{motion.name}/file",
            size=file.size,
            content_type=file.content_type,
            created_at=motion.created_at,
            check_status=inspection.status,
            check_job=motion.inspection_job if inspection.status != "none" else None,
            **(dict(inspection.document) if inspection.document is not None else {"error": error}),
        )


class MotionList(BaseModel):
    """All motions: the built-in ones first."""

    items: list[MotionOut]
