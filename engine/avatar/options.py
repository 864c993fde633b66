"""What a user may choose about an avatar."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from engine.motion.options import JointName, MotionClip, MotionJoints

Side = Annotated[int, Field(ge=64, le=4096)]
Frames = Annotated[int, Field(ge=12, le=150)]
FrameIndex = Annotated[int, Field(ge=0, le=1_000_000)]
LeftOut = Annotated[tuple[FrameIndex, ...], Field(max_length=150)]
Coordinate = Annotated[float, Field(ge=-16384, le=16384)]
Motion = Literal["idle", "walk", "run", "jump", "sit", "wave", "dance", "bow"]
MAX_TEMPLATE_TRIANGLES = 27_676
"""Of the template's visible parts: an avatar has no more."""
MAX_ATTACHED_TRIANGLES = 6_000
"""Of what stands off the body, at most."""

CAPTURE_OPTIONS = (
    *("height_m", "body_frames", "head_frames", "more_frames", "body_lens", "head_lens"),
    *("body_frames_left_out", "head_frames_left_out", "landmarks"),
)
"""What is about clips of a person: an avatar that is there already cannot have it."""


class KnownLens(BaseModel):
    """A camera's lens that somebody has calibrated, in pixels of the upright clip: Brown's model, as OpenCV has it."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    focal: Annotated[float, Field(gt=0, le=100_000)] = Field(description="Focal length.")
    centre: tuple[Coordinate, Coordinate] | None = Field(
        None, description="The principal point (x, y); without it the middle of the frame."
    )
    k1: Annotated[float, Field(ge=-1, le=1)] = Field(0.0, description="Radial distortion, of the square of the radius.")
    k2: Annotated[float, Field(ge=-1, le=1)] = Field(0.0, description="Radial distortion, of its fourth power.")


class PlacedLandmark(BaseModel):
    """Where a landmark of the body is in one frame of its clip."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    frame: FrameIndex = Field(description="Which frame of the clip; one of those in the report's `inputs`.")
    place: tuple[Coordinate, Coordinate] = Field(description="Pixel (x, y) of the upright frame.")


Placed = Annotated[tuple[PlacedLandmark, ...], Field(min_length=2, max_length=150)]


class AvatarOptions(BaseModel):
    """Options of the avatar system; every one has a sound default."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    height_m: Annotated[float, Field(ge=0.8, le=2.4)] | None = Field(
        None,
        examples=[1.75],
        description="How tall the person is, metres. Without it the size is guessed from how people are built, and the report says so.",
    )
    body_frames: Frames = Field(75, description="Frames that are taken from the clip of the body.")
    head_frames: Frames = Field(50, description="Frames that are taken from the clip of the head.")
    more_frames: Frames = Field(25, description="Frames that are taken from each further clip.")
    texture_size: Literal[1024, 2048, 4096, 8192] = Field(
        4096, description="Width and height of the texture in pixels."
    )
    triangles: Annotated[int, Field(ge=2000, le=MAX_TEMPLATE_TRIANGLES + MAX_ATTACHED_TRIANGLES)] = Field(
        MAX_TEMPLATE_TRIANGLES + MAX_ATTACHED_TRIANGLES, description="Most triangles of the avatar."
    )
    levels: Annotated[int, Field(ge=0, le=3)] = Field(
        0, description="Further levels of detail, each with a quarter of the triangles, in the same GLB (MSFT_lod)."
    )
    compression: Literal["none", "meshopt"] = Field(
        "none",
        description="Whether geometry and animations of the GLB are compressed (EXT_meshopt_compression): half as large, for programs"
        " that read it.",
    )
    vrm: bool = Field(False, description="Write the avatar as VRM 1.0, too.")
    vrm_author: Annotated[str, Field(min_length=1, max_length=200)] = Field(
        "Galatea", description="Whose the avatar is, as its VRM file says: nobody else may use it without asking."
    )
    body_lens: KnownLens | None = Field(
        None,
        examples=[{"focal": 1580.5, "centre": [539.5, 959.5], "k1": 0.012}],
        description="The lens of the body's clip, where it is known; otherwise it is found.",
    )
    head_lens: KnownLens | None = Field(None, description="The same of the head's clip.")
    body_frames_left_out: LeftOut = Field(
        (),
        description="Frames of the body's clip, by their numbers in the report's `inputs`, of which nothing is made.",
    )
    head_frames_left_out: LeftOut = Field((), description="The same of the head's clip.")
    landmarks: dict[JointName, Placed] = Field(
        {},
        max_length=33,
        examples=[{"LeftElbow": [{"frame": 120, "place": [402, 611]}, {"frame": 480, "place": [231, 598]}]}],
        description="Landmarks of the body (MediaPipe's names, such as `LeftElbow`) where they are not found well, in two"
        " frames or more that show them from different sides. The person's own left and right.",
    )
    motion: Motion = Field("idle", description="The clip that the video shows, where no file is given.")
    motion_joints: MotionJoints = {}
    motion_clip: MotionClip = None
    size: tuple[Side, Side] = Field(
        (720, 1280), examples=[(720, 1280)], description="Width and height of the videos in pixels."
    )
    fps: Annotated[float, Field(ge=1, le=60)] = Field(30.0, description="Frames a second of clips and videos.")
    seconds: Annotated[float, Field(ge=1, le=30)] = Field(
        4.0, description="Length of the animation: a longer motion is cut, and of a shorter one the last pose is held."
    )
