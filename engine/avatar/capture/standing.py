"""Whether the person stays in one place while the camera goes around them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from engine.avatar.capture.person_frame import upward
from engine.avatar.capture.scene_cameras import ClipScene
from engine.errors import InputError
from engine.geometry.multiview.bundle import undistorted

MIN_PERSON_AREA_SHARE = 0.003
"""Share of a frame that shows somebody."""
MAX_OFFSET_CAMERA_DISTANCES = 0.1
"""Distances of the cameras by which the person may be seen beside their place: 20 cm at two metres."""
MAX_EMPTY_FRAMES_SHARE = 0.25
"""Share of the frames that may see nobody at the person's place."""
PLACE_REWEIGHTING_ROUNDS = 20
"""Rounds of least squares for the place that most frames agree on."""


def refuse_walking(scene: ClipScene, masks: Sequence[NDArray[np.bool_]]) -> None:
    """Look whether the person is always seen in one place.

    Parameters
    ----------
    masks : (h, w) bool of each frame, of any size: where the person is.

    Raises `InputError`: `person_walks`.
    """
    if share_astray(scene, masks) > MAX_EMPTY_FRAMES_SHARE:
        raise InputError(
            "person_walks",
            "The person does not stay where they are: let them stand still, and walk around them with the camera.",
        )


def share_astray(scene: ClipScene, masks: Sequence[NDArray[np.bool_]]) -> float:
    """Of the frames with a camera, the share that sees nobody in the place where most see the person, from above."""
    found = scene.reconstruction
    bundle, registered = found.bundle, np.flatnonzero(found.registered)
    up = upward(bundle, found.registered)
    level = np.linalg.svd(up[None])[2][1:]
    shown = [c for c in registered.tolist() if masks[c].mean() > MIN_PERSON_AREA_SHARE]
    if len(shown) < 2:
        return 1.0
    sight = np.array([_sight(scene, c, masks[c]) for c in shown]) @ level.T
    sight /= np.linalg.norm(sight, axis=1, keepdims=True)
    across = np.stack([-sight[:, 1], sight[:, 0]], axis=1)
    eyes = bundle.eyes[shown] @ level.T
    place = _nearest_to_lines(eyes, across)
    aside = np.abs(((place - eyes) * across).sum(1)) / np.median(np.linalg.norm(place - eyes, axis=1))
    before = ((place - eyes) * sight).sum(1) > 0
    return 1 - float((before & (aside < MAX_OFFSET_CAMERA_DISTANCES)).sum()) / len(registered)


def _sight(scene: ClipScene, frame: int, mask: NDArray[np.bool_]) -> NDArray[np.float64]:
    """(3,) the direction in which a frame sees the middle of its mask."""
    bundle = scene.reconstruction.bundle
    middle = np.median(np.argwhere(mask), axis=0)[::-1]
    pixel = (middle + 0.5) * scene.size[0] / mask.shape[0] - 0.5
    lens = int(bundle.lens_of[frame])
    ray = np.append(undistorted(pixel[None], bundle.lenses[lens], bundle.centres[lens])[0], 1.0)
    return np.asarray(ray @ bundle.rotations[frame])


def _nearest_to_lines(eyes: NDArray[np.float64], across: NDArray[np.float64]) -> NDArray[np.float64]:
    """The point of the plane (2,) nearest to most of the lines through `eyes` (N, 2), square to `across` (N, 2)."""
    weights = np.ones(len(eyes))
    offsets = (eyes * across).sum(1)
    place = np.zeros(2)
    for _ in range(PLACE_REWEIGHTING_ROUNDS):
        system = np.einsum("n,ni,nj->ij", weights, across, across) + 1e-12 * np.eye(2)
        place = np.linalg.solve(system, (weights * offsets) @ across)
        off = np.abs(across @ place - offsets)
        weights = 1 / (1 + (off / max(float(np.median(off)), 1e-12)) ** 2) ** 2
    return place
