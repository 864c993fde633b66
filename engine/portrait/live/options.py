"""What a user may choose about a portrait that follows a camera."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

from engine.face_animation.acting_options import ACTING_PARTS, Part
from engine.portrait.options import Coordinate, Face, Landmarks, PortraitOptions, named_parts

MAX_LIVE_SIDE_PIXELS = 768
"""Pixels of a live picture's longest side, at most."""


class LiveOptions(BaseModel):
    """Options of a live portrait, a choice of those of `PortraitOptions`; every one has a sound default."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    longest_side: Annotated[int, Field(ge=64, le=MAX_LIVE_SIDE_PIXELS)] = Field(
        512, description="Pixels of the live picture's longest side, into which the target is fitted."
    )
    crop: Literal["none", "face", "bust"] | tuple[Coordinate, Coordinate, Coordinate, Coordinate] = Field(
        "bust", description="Part of the target to show, as of a portrait job."
    )
    face_index: Face = Field(0, description="Which face of the target, counted from the largest.")
    landmarks: Landmarks | None = Field(None, description="Placed landmarks of the target, as of a portrait job.")
    strength: Annotated[float, Field(ge=0, le=2)] = Field(
        1.0, description="How strongly the motion is carried over; 1 is as the camera sees it."
    )
    follow: Annotated[tuple[Part, ...], Field(fail_fast=True, max_length=20), BeforeValidator(named_parts)] = Field(
        ACTING_PARTS, description='Which parts follow the camera; `["all"]` stands for every one.'
    )
    head_3d: bool = Field(
        True, description="Turn the head by a 3D proxy; false keeps to the paper's warp in the plane."
    )

    def portrait(self) -> PortraitOptions:
        """These options as those of a portrait job."""
        given = self.model_dump(exclude={"longest_side"})
        return PortraitOptions.model_validate({**given, "size": (self.longest_side, self.longest_side)})
