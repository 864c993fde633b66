"""Films in which the person stays in the picture: from head to soles in every frame, and whole in the last.

A still picture has no more background than it shows, so the camera cannot go back before somebody who comes nearer.
They come, and go aside, as far as they are still seen whole. There they tread on the spot (`engine.motion.confine`).
Whoever needs more room than the picture has above them, because they straighten up or raise their arms, first steps
back.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from engine.character.rig.rigging import Character
from engine.geometry.camera import Camera
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion.clip import Clip
from engine.motion.confine import MovementRoom, confine_clip
from engine.motion.feet.sole import leg_length
from engine.motion.kinematics import pose_transforms

Array = NDArray[np.float64]

FRAME_MARGIN_SHARE = 0.03
"""What stays free along the picture's borders, as a share of its height: less where the person is pictured nearer to them."""
MAX_STEP_BACK_LEGS = 0.6
"""How far anybody steps back, at most, leg lengths: one step of each foot."""
MAX_RETREAT_METRES = 1.2
"""How far away from the viewer a motion may lead, metres: not into the wall of `engine.character.film.film`."""
STANDING_ROOM = MovementRoom(0.0, MAX_RETREAT_METRES, 0.0, 0.0)
MIN_APPROACH_METRES = 0.3
"""Metres by which a motion comes nearer that is on its way, and no sway."""
RETREAT_BISECTION_STEPS = 5
MAX_SAMPLED_FRAMES = 48
"""Of a film those that are looked at, evenly spread: between them nobody gets through the margin."""
SWUNG_ARM_JOINT_NAMES = ("Arm", "Hand")


@dataclass(frozen=True)
class _View:
    """What decides whether a character is in the picture.

    camera_at : the camera by the second; at second 0 it is where the picture was taken.
    outer : (V,) the outermost vertices of every bone.
    arms : (V,) which of them hands and arms carry.
    low, high : (2,) x and y of the box in which they must be, pixels of the camera.
    """

    mesh: SkinnedMesh
    camera_at: Callable[[float], Camera]
    outer: NDArray[np.intp]
    arms: NDArray[np.bool_]
    low: Array
    high: Array

    def posed(self, clip: Clip) -> Array:
        """(F, V, 3) the outermost vertices in the frames that are looked at."""
        frames = _looked_at(clip)
        moves = pose_transforms(self.mesh.skeleton, clip.rotations[frames], clip.root[frames])
        rest = (self.mesh.vertices[self.outer], self.mesh.bones[self.outer], self.mesh.weights[self.outer])
        return np.stack([skin(*rest, move) for move in moves]).astype(np.float64)

    def outside(self, clip: Clip) -> tuple[float, float]:
        """By how many pixels the clip leaves the box: head, trunk and legs in any frame, or anything in the last; and
        anything in any frame."""
        flat = np.stack(
            [
                self.camera_at(frame / clip.fps).project(points)
                for frame, points in zip(_looked_at(clip), self.posed(clip), strict=True)
            ]
        ).astype(np.float64)
        beyond = np.maximum(self.low - flat[..., :2], flat[..., :2] - self.high).max(2)
        beyond = np.where(flat[..., 2] > 0, beyond, np.inf)
        return float(max(beyond[:, ~self.arms].max(), beyond[-1].max())), float(beyond.max())

    def holds(self, clip: Clip, everything: bool) -> bool:
        """Whether the clip stays in the box: with or without hands and arms, which must be in it in the last frame."""
        return self.outside(clip)[everything] <= 0

    def room(self, clip: Clip) -> MovementRoom:
        """How far the clip may be moved as it is, before a camera at rest: nearer, and then to the sides."""
        x, y, z = np.moveaxis(self.posed(clip), 2, 0)
        camera = self.camera_at(0.0)
        eye, focal, centre = camera.eye, camera.focal, camera.centre
        away = eye[2] - z
        reach = np.where(y > eye[1], centre[1] - self.low[1], self.high[1] - centre[1])
        ahead = max(float((away - focal * np.abs(y - eye[1]) / np.maximum(reach, 1)).min()), 0.0)
        sides = [(bound - centre[0]) / focal * (away - ahead) - (x - eye[0]) for bound in (self.low[0], self.high[0])]
        return MovementRoom(
            ahead, MAX_RETREAT_METRES, max(float(sides[1].min()), 0.0), max(float(-sides[0].max()), 0.0)
        )


def kept_in_frame(character: Character, camera_at: Callable[[float], Camera], film: Callable[[float], Clip]) -> Clip:
    """The film within the picture of `camera_at(second)`; `film(back)` begins with a step back by so many metres.

    Everything is in the picture if that takes no more than a step back. Else raised hands may leave it, and if that is not
    enough, leaps become lower.
    """
    maker = _Maker(character, film)
    view = _view(character, camera_at, maker.first)
    for everything in (True, False):
        found = _framed(view, maker, everything)
        if found is not None:
            return found
    leap = 1 - _least(lambda less: view.holds(maker.made(maker.most, leap=1 - less), False))
    return maker.made(maker.most, leap=leap)


class _Maker:
    """Makes the film with a step back by some metres, at `most` by that, within a room beside and before it."""

    def __init__(self, character: Character, film: Callable[[float], Clip]):
        self._film, self._skeleton = cache(film), character.mesh.skeleton
        self.first = film(0.0)
        ahead = self.first.root[:, 2] - self.first.root[0, 2]
        self._comes = float(ahead.max()) > MIN_APPROACH_METRES
        self.most = MAX_STEP_BACK_LEGS * leg_length(self._skeleton)

    def made(self, back: float, room: MovementRoom = STANDING_ROOM, leap: float = 1.0) -> Clip:
        if back and self._comes:  # the steps that it takes anyway lead back
            return confine_clip(self._skeleton, self.first, replace(room, ahead=-back), leap)
        return confine_clip(self._skeleton, self._film(back) if back else self.first, room, leap)


def _framed(view: _View, maker: _Maker, everything: bool) -> Clip | None:
    """The film with the shortest step back, and then the widest room, in which the picture holds it; None if no step does."""
    back = 0.0
    if not view.holds(maker.made(0.0), everything):
        if not view.holds(maker.made(maker.most), everything):
            return None
        back = maker.most * _least(lambda share: view.holds(maker.made(maker.most * share), everything))
    widest = view.room(maker.made(back))
    less = _least(lambda less: view.holds(maker.made(back, _shared(widest, 1 - less)), everything))
    return maker.made(back, _shared(widest, 1 - less))


def _shared(room: MovementRoom, share: float) -> MovementRoom:
    return MovementRoom(share * room.ahead, room.behind, share * room.left, share * room.right)


def _least(fits: Callable[[float], bool]) -> float:
    """The least share in [0, 1] that fits, where all larger ones do; 1 is taken to."""
    if fits(0.0):
        return 0.0
    low, high = 0.0, 1.0
    for _ in range(RETREAT_BISECTION_STEPS):
        middle = (low + high) / 2
        low, high = (low, middle) if fits(middle) else (middle, high)
    return high


def _view(character: Character, camera_at: Callable[[float], Camera], film: Clip) -> _View:
    mesh, camera = character.mesh, camera_at(0.0)
    bone = mesh.bones[np.arange(len(mesh.bones)), mesh.weights.argmax(1)]
    outer = np.concatenate([_outermost(mesh.vertices, np.flatnonzero(bone == one)) for one in np.unique(bone)])
    arms = np.array([any(part in name for part in SWUNG_ARM_JOINT_NAMES) for name in mesh.skeleton.names])[bone[outer]]
    height, width = camera.size
    margin = FRAME_MARGIN_SHARE * height
    view = _View(mesh, camera_at, outer, arms, np.full(2, margin), np.array([width, height]) - 1 - margin)
    pictured = camera.project(view.posed(film)[0]).astype(np.float64)[:, :2]
    return replace(view, low=np.minimum(view.low, pictured.min(0)), high=np.maximum(view.high, pictured.max(0)))


def _looked_at(clip: Clip) -> NDArray[np.intp]:
    """The frames of a clip that are looked at, the last one among them."""
    count = len(clip.root)
    return np.unique(np.linspace(0, count - 1, min(count, MAX_SAMPLED_FRAMES)).round().astype(np.intp))


def _outermost(vertices: NDArray[np.float32], of: NDArray[np.intp]) -> NDArray[np.intp]:
    """Of some vertices the farthest in each of 26 directions."""
    directions = np.array([way for way in product((-1, 0, 1), repeat=3) if any(way)], np.float64)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return np.unique(of[np.argmax(vertices[of] @ directions.T, axis=0)])
