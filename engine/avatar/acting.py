"""The avatar in action: its clips, and the film that shows one of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.avatar.turntable import backdrop, orbit_camera
from engine.geometry.camera import Camera
from engine.geometry.rigging.morph_target import MorphTarget, MorphTrack, morphed
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion.arms.arms_outside import arms_outside
from engine.motion.arms.solid_body import solid_body
from engine.motion.clip import Clip
from engine.motion.edit import in_place, loop_travel
from engine.motion.kinematics import pose_transforms
from engine.motion.library import CLIPS, built_in
from engine.motion.rotation import from_matrix
from engine.render.lighting.ground_shadow import GroundShadow
from engine.render.scene.character import Actor, film_cast, prepare_character

TRAVEL_METRES = 0.1
"""Metres: a loop that gets further than this in one round goes somewhere."""
FRAMED_FRAME_COUNT = 12
"""Frames of a clip by which the camera is placed so that all of them are in the picture."""
FILMED_CLIP_NAME = "filmed"
"""The clip that holds the pose in which the person was filmed."""
BUST_HEIGHT_METRES = 0.52
"""Metres from the crown down that are shown where a face acts."""


@dataclass(frozen=True)
class Scene:
    """A clip, and what the face does meanwhile; None where it does nothing."""

    clip: Clip
    expressions: MorphTrack | None = None


def standing_clip(mesh: SkinnedMesh, rotations: NDArray[np.floating], root: NDArray[np.floating], fps: float) -> Clip:
    """The pose in which the person was filmed, one frame. `rotations` (J, 3, 3): each joint's axes, in the world; `root` (3,)."""
    parents = mesh.skeleton.parents
    own = np.stack([rotations[p].T @ rotations[j] if p >= 0 else rotations[j] for j, p in enumerate(parents)])
    return Clip(FILMED_CLIP_NAME, fps, from_matrix(own)[None].astype(np.float32), np.asarray(root, np.float32)[None])


def built_in_clips(mesh: SkinnedMesh, fps: float) -> list[Clip]:
    """All built-in motions, the arms outside the body; those that would go somewhere in place."""
    body = solid_body(mesh)
    clips = [arms_outside(body, built_in(name, mesh.skeleton, fps)) for name in CLIPS]
    return [
        in_place(clip) if clip.loops and np.linalg.norm(loop_travel(clip)) > TRAVEL_METRES else clip for clip in clips
    ]


def film(
    mesh: SkinnedMesh, morphs: Sequence[MorphTarget], scene: Scene, size: tuple[int, int]
) -> Iterator[NDArray[np.uint8]]:
    """Frames (h, w, 3) of the avatar in a scene, before a plain wall; `size` (width, height). Where its face acts the camera is
    near, else it holds all of the motion."""
    names = [morph.name for morph in morphs]
    track = None if scene.expressions is None else scene.expressions.of(names)

    def rest_at(frame: int) -> NDArray[np.float32]:
        return mesh.vertices if track is None else morphed(mesh.vertices, morphs, track[frame])

    camera = bust_camera(mesh, scene.clip, size) if track is not None else wide_camera(mesh, scene.clip, size)
    background = backdrop(size)
    actor = Actor(prepare_character(mesh), scene.clip, rest_at=rest_at)
    return film_cast([actor], lambda second: camera, lambda camera: background, GroundShadow(0.35, 0.06))


def wide_camera(mesh: SkinnedMesh, clip: Clip, size: tuple[int, int]) -> Camera:
    """A camera before the avatar that holds it throughout the clip."""
    return orbit_camera(_reached(mesh, clip), size, 0.0)


def bust_camera(mesh: SkinnedMesh, clip: Clip, size: tuple[int, int]) -> Camera:
    """A camera before the avatar's face, which holds head and shoulders of the clip's first frame."""
    posed = _reached(mesh, replace(clip, rotations=clip.rotations[:1], root=clip.root[:1]))
    top = posed[:, 1].max()
    return orbit_camera(posed[posed[:, 1] > top - BUST_HEIGHT_METRES], size, 0.0)


def _reached(mesh: SkinnedMesh, clip: Clip) -> NDArray[np.float32]:
    """The vertices of some frames of a clip, evenly spread, together: (F V, 3)."""
    chosen = np.unique(np.linspace(0, len(clip.rotations) - 1, FRAMED_FRAME_COUNT).astype(int))
    transforms = pose_transforms(mesh.skeleton, clip.rotations[chosen], clip.root[chosen])
    return np.concatenate([skin(mesh.vertices, mesh.bones, mesh.weights, each) for each in transforms])
