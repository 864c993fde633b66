"""The options of the calls, for a type checker. `python -m scripts.option_types` draws them from the engine's models."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, TypedDict


class PortraitOptions(TypedDict, total=False):
    """Options of the portrait system."""

    size: tuple[int, int] | None
    fps: float | None
    format: Literal["mp4", "webm", "webp", "gif", "png"]
    neutral_frame: int | None
    face_index: int
    driver_face_index: int
    strength: float
    follow: Sequence[Literal["eyes", "mouth", "brows", "head"]]
    head_3d: bool
    crop: Literal["none", "face", "bust"] | tuple[float, float, float, float]
    trim: tuple[float, float] | None
    loop: bool
    sound: bool
    landmarks: Sequence[tuple[float, float]] | None
    reactive: bool | Sequence[str]


class CharacterOptions(TypedDict, total=False):
    """Options of the character system."""

    motion_joints: Mapping[str, str | None]
    motion_clip: str | None
    keep: Sequence[Literal["head", "torso", "left_arm", "right_arm", "left_leg", "right_leg", "arms", "legs"]]
    seconds: float
    size: tuple[int, int] | None
    fps: float
    format: Literal["mp4", "webm", "webp", "gif", "png"]
    camera: Literal["fixed", "orbit", "parallax"]
    triangles: int
    levels: int
    vrm: bool
    vrm_author: str
    lit: bool
    partial: bool
    pose: Mapping[str, tuple[float, float, float]]
    joints: Mapping[str, tuple[float, float]]
    person_box: tuple[float, float, float, float] | None
    person_index: int | Literal["all"] | None
    mask_strokes: Sequence[Mapping[str, Any]]
    label_strokes: Sequence[Mapping[str, Any]]
    back_texture: Literal["see_through", "mirror", "inpaint"]
    surface: Literal["auto", "hybrid", "relief", "shell"]


class AvatarOptions(TypedDict, total=False):
    """Options of the avatar system."""

    height_m: float | None
    body_frames: int
    head_frames: int
    more_frames: int
    texture_size: Literal["1024", "2048", "4096", "8192"]
    triangles: int
    levels: int
    compression: Literal["none", "meshopt"]
    vrm: bool
    vrm_author: str
    body_lens: Mapping[str, Any] | None
    head_lens: Mapping[str, Any] | None
    body_frames_left_out: Sequence[int]
    head_frames_left_out: Sequence[int]
    landmarks: Mapping[str, Sequence[Mapping[str, Any]]]
    motion_joints: Mapping[str, str | None]
    motion_clip: str | None
    size: tuple[int, int]
    fps: float
    seconds: float


class PersonaOptions(TypedDict, total=False):
    """Options of the persona system."""

    texture_width: int | None
    keep: Sequence[int]
    leave_out: Sequence[int]
    example: int | None
    years: tuple[int, int] | None
    look: int | None
    size: tuple[int, int]
    fps: float | None
    trim: tuple[float, float] | None
    driver_face_index: int
    composite: Literal["auto", "none", "photo", "side_by_side"]
    photo: int | None
    light: Literal["own", "average", "left", "right"]
    average_light: Sequence[int]
    background: tuple[int, int, int]
    sound: bool
