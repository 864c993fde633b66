"""What a user may choose about an animated portrait."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, field_validator, model_validator

from engine.face_animation.acting_options import ACTING_PARTS, ActingOptions, Part
from engine.performances import names

Side = Annotated[int, Field(ge=64, le=4096)]
Coordinate = Annotated[float, Field(ge=-16384, le=16384)]
Seconds = Annotated[float, Field(ge=0, le=86_400)]
Face = Annotated[int, Field(ge=0, le=99)]
Landmarks = Annotated[tuple[tuple[Coordinate, Coordinate], ...], Field(fail_fast=True, min_length=68, max_length=68)]
States = Annotated[tuple[Annotated[str, Field(max_length=100)], ...], Field(fail_fast=True, max_length=100)]


def named_parts(follow: object) -> object:
    """The parts, where they are not named one by one."""
    return ACTING_PARTS if follow in ("all", ["all"], ("all",)) else follow


class PortraitOptions(BaseModel):
    """Options of the portrait system; every one has a sound default."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    size: tuple[Side, Side] | None = Field(
        None,
        examples=[(300, 300)],
        description="Width and height of the result in pixels; the target is fitted into it. Default: the target's own size, the longest side at most 1920.",
    )
    fps: Annotated[float, Field(ge=1, le=60)] | None = Field(
        None, description="Frames a second of the result. Default: one frame for each frame of the driver."
    )
    format: Literal["mp4", "webm", "webp", "gif", "png"] = Field(
        "mp4",
        description="Container of the animation; png is a zip of numbered pictures. A gif has 256 colours and, without `size`, 640 pixels on the longest side.",
    )
    neutral_frame: Annotated[int, Field(ge=0, le=10_000_000)] | None = Field(
        None,
        description="Frame on which the driver shows the target's expression, counted from 0 among those that are used: of the `trim`, at the `fps`. Default: found automatically.",
    )
    face_index: Face = Field(
        0,
        description="Which face of the target, counted from the largest; with a crop by numbers, of those in the crop.",
    )
    driver_face_index: Face = Field(
        0,
        description="Which face of the driver, counted from the largest in the first frame that shows any. Not for `auto`, which compares the largest ones.",
    )
    strength: Annotated[float, Field(ge=0, le=2)] = Field(
        1.0, description="How strongly the motion is carried over; 1 is as the driver does it."
    )
    follow: Annotated[tuple[Part, ...], Field(fail_fast=True, max_length=20), BeforeValidator(named_parts)] = Field(
        ACTING_PARTS, description='Which parts follow the driver; `["all"]` stands for every one.'
    )
    head_3d: bool = Field(
        True, description="Turn the head by a 3D proxy; false keeps to the paper's warp in the plane."
    )
    crop: Literal["none", "face", "bust"] | tuple[Coordinate, Coordinate, Coordinate, Coordinate] = Field(
        "none",
        examples=["bust", (10, 20, 300, 400)],
        description="Part of the target to animate: around the face, head and shoulders, or [x, y, width, height] in pixels. Faces are looked for within such a crop, however small they are in the whole.",
    )
    trim: tuple[Seconds, Seconds] | None = Field(
        None,
        examples=[(0.5, 2.0)],
        description="Start and end of the part of the driver to use, in seconds; the end comes after the start.",
    )
    loop: bool = Field(
        False, description="Ease the end back into the beginning, so that the result repeats without a jump."
    )
    sound: bool = Field(False, description="Keep the driver's sound.")
    landmarks: Landmarks | None = Field(
        None,
        description="Placed landmarks of the target, 68 points [x, y] in pixels of the picture, where no face is detected or detection is off. They say whose face it is: `face_index` does not count beside them.",
    )

    reactive: bool | States = Field(
        False,
        description="Make a reactive profile, which plays emotions on demand: true, or the built-in performances that are to be its states. A driver is not needed then; one that is given becomes a state of its own.",
    )

    @field_validator("reactive")
    @classmethod
    def _known_states(cls, reactive: bool | tuple[str, ...]) -> bool | tuple[str, ...]:
        known = names()
        if isinstance(reactive, tuple) and (unknown := [name for name in reactive if name not in known]):
            raise ValueError(f"there is no performance {unknown[0][:80]}: choose of {', '.join(known)}")
        if reactive == ():
            raise ValueError("the list of states is empty: name some, or say true")
        return reactive

    @field_validator("trim")
    @classmethod
    def _ends_after_its_start(cls, trim: tuple[float, float] | None) -> tuple[float, float] | None:
        if trim is not None and trim[1] <= trim[0]:
            raise ValueError(f"the part ends at {trim[1]:g} s, which is not after its start at {trim[0]:g} s")
        return trim

    @model_validator(mode="after")
    def _reactive_is_mp4(self) -> Self:
        if self.reactive and self.format != "mp4":
            raise ValueError("a reactive profile is made of MP4 clips: leave the format out")
        return self

    @property
    def animation(self) -> str:
        """The name of the animation's file."""
        return "animation." + {"png": "zip"}.get(self.format, self.format)

    def framing(self) -> PortraitOptions:
        """Only what decides on the target's face and size, so that other choices leave its analysis as it is."""
        kept = {name: getattr(self, name) for name in ("size", "crop", "face_index", "landmarks")}
        kept |= {"format": "gif"} if self.format == "gif" else {}  # which is smaller
        return PortraitOptions.model_validate({**kept, "reactive": bool(self.reactive)})

    def acting(self) -> ActingOptions:
        """Only what decides on how the target moves, so that other choices leave what a second look found as it is."""
        return ActingOptions(self.strength, self.follow, self.head_3d)
