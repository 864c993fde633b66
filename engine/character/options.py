"""What a user may choose about a character."""

from __future__ import annotations

from typing import Annotated, Literal, Self, get_args

from pydantic import BaseModel, ConfigDict, Field, model_validator

from engine.motion.options import JointName, MotionClip, MotionJoints
from engine.render.scene.camera_moves import Move

Side = Annotated[int, Field(ge=64, le=4096)]
Coordinate = Annotated[float, Field(ge=-16384, le=16384)]
Extent = Annotated[float, Field(gt=0, le=16384)]
Angle = Annotated[float, Field(ge=-180, le=180)]
Motion = Literal["idle", "walk", "run", "jump", "sit", "wave", "dance", "bow"]
BUILT_IN_MOTIONS: tuple[Motion, ...] = get_args(Motion)
Part = Literal["head", "torso", "left_arm", "right_arm", "left_leg", "right_leg"]
BodyPart = Literal["head", "torso", "left_arm", "right_arm", "left_leg", "right_leg", "arms", "legs"]


Place = tuple[Coordinate, Coordinate]
Radius = Annotated[float, Field(gt=0, le=2048)]
Path = Annotated[tuple[Place, ...], Field(fail_fast=True, min_length=1, max_length=5000)]
MAX_STROKE_POINTS = 50_000
"""Of all strokes together: drawing takes about 0.3 ms for each where the brush is as large as the picture."""


class MaskStroke(BaseModel):
    """A stroke of a round brush over the mask, in pixels of the picture."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    path: Path = Field(description="The points that the brush passes.")
    radius: Radius
    person: bool = Field(description="Whether it paints the person, or what is not the person.")


class LabelStroke(BaseModel):
    """A stroke of a round brush over the label map, in pixels of the picture."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    path: Path = Field(description="The points that the brush passes.")
    radius: Radius
    part: Part = Field(description="What it paints; the person's own left and right.")


class CharacterOptions(BaseModel):
    """Options of the character system; every one has a sound default."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    motion: Motion = Field("walk", description="The clip into which the person steps, where no file is given.")
    motion_joints: MotionJoints = {}
    motion_clip: MotionClip = None
    keep: Annotated[tuple[BodyPart, ...], Field(fail_fast=True, max_length=20)] = Field(
        (), description="Parts of the body that stay as pictured."
    )
    seconds: Annotated[float, Field(ge=1, le=30)] = Field(
        4.0, description="Length of the video: a longer motion is cut, and of a shorter one the last pose is held."
    )
    size: tuple[Side, Side] | None = Field(
        None,
        examples=[(300, 300)],
        description="Width and height of the video in pixels; the picture is fitted into it. Default: the picture's own size, the longest side at most 1280.",
    )
    fps: Annotated[float, Field(ge=1, le=60)] = Field(30.0, description="Frames a second of clips and video.")
    format: Literal["mp4", "webm", "webp", "gif", "png"] = Field(
        "mp4",
        description="Container of the animation; png is a zip of numbered pictures. A gif has 256 colours and, without `size`, 640 pixels on the longest side.",
    )
    camera: Move = Field("fixed", description="What the video's camera does.")
    triangles: Annotated[int, Field(ge=2000, le=200_000)] = Field(
        60_000, description="Most triangles of the character."
    )
    levels: Annotated[int, Field(ge=0, le=3)] = Field(
        0, description="Further levels of detail, each with a quarter of the triangles: character-lod1.glb and so on."
    )
    vrm: bool = Field(False, description="Write the character as VRM 1.0, too.")
    vrm_author: Annotated[str, Field(min_length=1, max_length=200)] = Field(
        "Galatea", description="Whose the character is, as its VRM file says: nobody else may use it without asking."
    )
    lit: bool = Field(
        False, description="Draw the character under lamps, too: lit.png. Takes OpenGL, which not every machine has."
    )
    partial: bool = Field(
        False, description="Accept a person who is cut off or hidden below the chest, and animate what is there."
    )
    pose: dict[JointName, tuple[Angle, Angle, Angle]] = Field(
        {},
        max_length=100,
        description="Joints turned on from the pictured pose, by their names in the character's skeleton: degrees about x, y and z of the T-pose. The person starts from there, and posed.png shows it.",
    )
    joints: dict[JointName, Place] = Field(
        {},
        max_length=100,
        description="Joints placed by hand, by their names in skeleton.json: [x, y] in pixels of the picture.",
    )
    person_box: tuple[Coordinate, Coordinate, Extent, Extent] | None = Field(
        None,
        examples=[(120, 40, 200, 560)],
        description="x, y, width and height in pixels of the picture: the person is looked for in there, whatever person_index says.",
    )
    person_index: Annotated[int, Field(ge=0, le=99)] | Literal["all"] | None = Field(
        None,
        description="Which of the people in the picture, the largest first (the report lists them), or “all”: each becomes a character, and all walk out together. Default: the largest, unless there is a crowd.",
    )
    mask_strokes: Annotated[tuple[MaskStroke, ...], Field(fail_fast=True, max_length=500)] = Field(
        (), description="Strokes over the mask, in their order."
    )
    label_strokes: Annotated[tuple[LabelStroke, ...], Field(fail_fast=True, max_length=500)] = Field(
        (), description="Strokes over the label map, in their order."
    )
    back_texture: Literal["see_through", "mirror", "inpaint"] = Field(
        "see_through",
        description="The back: plain cloth as the sides of the trunk have it at each height, without what only fronts have (ties, prints, pockets, collars); a mirrored copy of the front; or filled by what the sides of each part of the body show.",
    )

    surface: Literal["auto", "hybrid", "relief", "shell"] = Field(
        "auto",
        description="What the character is made of. relief: the picture cut into parts that are given their depth, the paper's way. shell: the human template displaced to the outline, whole from every side and where parts touch. hybrid: trunk and hanging cloth of the relief, arms and legs of the shell, and its head where hair keeps to it. auto: the hybrid; where an arm is raised and no leg passes before the other, the relief with such a head.",
    )

    @model_validator(mode="after")
    def _strokes_that_can_be_drawn(self) -> Self:
        strokes: tuple[MaskStroke | LabelStroke, ...] = (*self.mask_strokes, *self.label_strokes)
        if sum(len(stroke.path) for stroke in strokes) > MAX_STROKE_POINTS:
            raise ValueError(
                f"the strokes have more than {MAX_STROKE_POINTS} points together: leave out those that lie close"
            )
        return self

    @model_validator(mode="after")
    def _one_to_correct(self) -> Self:
        if self.person_index == "all" and (self.joints or self.person_box or self.mask_strokes or self.label_strokes):
            raise ValueError("corrections are of one person: say which by person_index")
        return self
