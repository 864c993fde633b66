"""What the check of a motion found: its skeleton, and which of its joints move which of a character's."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, Field

Name = Annotated[str, Field(max_length=200)]


class MotionJoint(BaseModel):
    """A joint of a motion's skeleton."""

    name: Name
    parent: Name | None
    """Null for a root."""


class MotionError(BaseModel):
    """What is wrong with a motion."""

    code: Name
    detail: Annotated[str, Field(max_length=5000)]


class Check(BaseModel):
    """What is in a motion, as the check wrote it down."""

    fps: Annotated[float, Field(ge=0, allow_inf_nan=False)]
    frames: Annotated[int, Field(ge=0)]
    seconds: Annotated[float, Field(ge=0, allow_inf_nan=False)]
    loops: bool | None = None
    clips: Annotated[list[Name], Field(max_length=1000)] = []
    joints: Annotated[list[MotionJoint], Field(max_length=1000)]
    mapping: Annotated[dict[Name, Name], Field(max_length=200)]
    missing: Annotated[list[Name], Field(max_length=200)]
    error: MotionError | None
