"""What a user may choose about a persona."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

Side = Annotated[int, Field(ge=64, le=1920)]
FaceNumber = Annotated[int, Field(ge=0, le=10_000)]
FaceNumbers = Annotated[tuple[FaceNumber, ...], Field(max_length=10_000)]
Channel = Annotated[int, Field(ge=0, le=255)]
Year = Annotated[int, Field(ge=1826, le=2200)]
Seconds = Annotated[float, Field(ge=0, le=86_400)]


class PersonaOptions(BaseModel):
    """Options of the persona system; every one has a sound default."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    texture_width: Annotated[int, Field(ge=97, le=800)] | None = Field(
        None, description="Pixels of the face's texture. Default: as many as the photos are worth, 194 to 400."
    )
    keep: FaceNumbers = Field(
        (), description="Faces to use whatever speaks against them, by their numbers in `faces.json`."
    )
    leave_out: FaceNumbers = Field((), description="Faces not to use, by their numbers in `faces.json`.")
    example: FaceNumber | None = Field(
        None,
        description="A face of the person that is meant, where photos show several, by its number in `faces.json`.",
    )
    years: tuple[Year, Year] | None = Field(
        None, description="First and last year of the photos to use, of those that say when they were taken."
    )
    look: Annotated[int, Field(ge=0, le=3)] | None = Field(
        None,
        description="Which of the person's looks to use, where the photos show several, of decades say: its number in `faces.json`, 0 is"
        " the one that most show. Default: all of them.",
    )
    size: tuple[Side, Side] = Field(
        (600, 800),
        description="Width and height of the animation, in pixels; `side_by_side` has the driver beside it, as high as it.",
    )
    fps: Annotated[float, Field(ge=1, le=60)] | None = Field(
        None, description="Frames a second of the animation. Default: one frame for each frame of the driver."
    )
    trim: tuple[Seconds, Seconds] | None = Field(
        None, description="Start and end of the part of the driver to use, in seconds."
    )
    driver_face_index: Annotated[int, Field(ge=0, le=99)] = Field(
        0, description="Which face of the driver, counted from the largest in the first frame that shows any."
    )
    composite: Literal["auto", "none", "photo", "side_by_side"] = Field(
        "auto",
        description="What is seen: the puppet alone before a plain background or a picture (none), the person as they are in one of the photos (photo), or the"
        " puppet beside the driver (side_by_side). By itself (auto) a photo, where one shows half a head and no `background_picture` is given, else the puppet alone.",
    )
    photo: FaceNumber | None = Field(
        None,
        description="Whose photo acts, where one does: a face by its number in `faces.json`. Default: the best one.",
    )
    light: Literal["own", "average", "left", "right"] = Field(
        "own",
        description="The light on the face of the film or the still. own: the photo's; the puppet has the mean of all photos. average: that mean."
        " left, right: that of the photos that are lit most from this side of the picture.",
    )
    average_light: Annotated[tuple[FaceNumber, ...], Field(max_length=64)] = Field(
        (),
        description="Photos to leave in the light that all have in the mean, as `average_light_N.png`: faces by their numbers in `faces.json`.",
    )
    background: tuple[Channel, Channel, Channel] = Field(
        (58, 60, 64), description="Red, green and blue of the plain background, where no `background_picture` is given."
    )
    sound: bool = Field(False, description="Keep the driver's sound.")
