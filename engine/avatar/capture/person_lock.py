"""Cameras locked to the person: sway during the film goes into the cameras, and the person stands still.

What is seen of the person moves with them, not with the room, and by several millimetres: clouds from cameras solved on the
room are twice as far off as those from cameras solved on the person alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.avatar.capture.scene_cameras import ClipScene, with_reconstruction
from engine.geometry.multiview.bundle_adjustment import PosePrior
from engine.geometry.multiview.structure_from_motion.mapping import Reconstruction
from engine.geometry.multiview.structure_from_motion.refinement import refine
from engine.geometry.registration.rigid import fit_robustly

PERSON_RADIUS_CAMERA_DISTANCES = 0.6
"""Radius of what a person fills, in distances of the cameras from the middle of their view."""
SWAY_TURN_RADIANS = 0.002
"""Radians that a person who holds still turns in the mean."""
SWAY_CAMERA_DISTANCES = 0.0025
"""How far a person who holds still sways in the mean, in distances of the camera: 5 mm at two metres."""
FEATURE_NOISE_PIXELS = 0.4
"""Pixels by which features of cloth and skin are off in the mean."""
MIN_TRACK_INSIDE_SHARE = 0.6
"""Share of a track's observations that must lie on the person's masks."""


@dataclass(frozen=True)
class Focus:
    """What the cameras go around: the `middle` (3,), and the median `distance` of the cameras from it."""

    middle: NDArray[np.float64]
    distance: float


@dataclass(frozen=True)
class PersonLock:
    """The `scene` with cameras locked to the person; `locked` (C,) bool, which are; the others are the room's. `person` (T,)
    bool: the tracks that are the person's."""

    scene: ClipScene
    locked: NDArray[np.bool_]
    person: NDArray[np.bool_]


def focus_of(found: Reconstruction) -> Focus:
    """The point nearest to all cameras' axes; cameras far from the others' distance hardly count."""
    eyes, axes = found.bundle.eyes[found.registered], found.bundle.rotations[found.registered, 2]
    across = np.eye(3) - axes[:, :, None] * axes[:, None]
    weights = np.ones(len(eyes))
    middle = np.zeros(3)
    for _ in range(10):
        system = np.einsum("c,cij->ij", weights, across) + 1e-12 * np.eye(3)
        middle = np.linalg.solve(system, np.einsum("c,cij,cj->i", weights, across, eyes))
        off = np.linalg.norm(np.einsum("cij,cj->ci", across, middle - eyes), axis=1)
        weights = 1 / (1 + (off / max(float(np.median(off)), 1e-12)) ** 2)
    return Focus(middle, float(np.median(np.linalg.norm(eyes - middle, axis=1))))


def person_tracks(scene: ClipScene, masks: Sequence[NDArray[np.bool_]] | None) -> NDArray[np.bool_]:
    """(T,) the tracks that are the person's: found inside of the orbit, or nowhere, and mostly on the masks.

    Parameters
    ----------
    masks : (h, w) bool each, of any size: where the person is in each frame. None where that is not known: then what the
        cameras go around is the person, and tracks that were found nowhere are left out.
    """
    found = scene.reconstruction
    focus = focus_of(found)
    points = found.bundle.points
    with np.errstate(invalid="ignore"):
        inside = np.linalg.norm(points - focus.middle, axis=1) < PERSON_RADIUS_CAMERA_DISTANCES * focus.distance
    if masks is None:
        return inside
    on = np.zeros(len(found.seen))
    for c, mask in enumerate(masks):
        mine = np.flatnonzero(found.seen.camera == c)
        scale = np.array([mask.shape[1] / scene.size[1], mask.shape[0] / scene.size[0]])
        at = np.rint((found.seen.pixels[mine] + 0.5) * scale - 0.5).astype(int)
        at = np.clip(at, 0, [mask.shape[1] - 1, mask.shape[0] - 1])
        on[mine] = mask[at[:, 1], at[:, 0]]
    counts = np.bincount(found.seen.point, minlength=len(points))
    share = np.bincount(found.seen.point, on, len(points)) / np.maximum(counts, 1)
    return (inside | ~np.isfinite(points[:, 0])) & (share >= MIN_TRACK_INSIDE_SHARE)


def lock_to_person(scene: ClipScene, person: NDArray[np.bool_]) -> PersonLock:
    """The cameras solved on the person's tracks (T,) alone, in the frame and the scale of the scene's.

    Where a camera sees too little of the person it stays where the room has it.
    """
    found = scene.reconstruction
    distance = focus_of(found).distance
    prior = PosePrior(
        *(found.bundle.rotations, found.bundle.translations),
        *(SWAY_TURN_RADIANS / FEATURE_NOISE_PIXELS, SWAY_CAMERA_DISTANCES * distance / FEATURE_NOISE_PIXELS),
    )
    refined = refine(found, person, scene.length, prior)
    solved, moved = refined.reconstruction, refined.moved
    if moved.sum() >= 3:  # the frame was free: bring it back
        before, after = found.bundle.eyes[moved], solved.bundle.eyes[moved]
        spread = float(np.median(np.linalg.norm(before - before.mean(axis=0), axis=1)))
        change = fit_robustly(after, before, 0.02 * spread).transform
        back = solved.bundle.moved(change)
        rotations = np.where(moved[:, None, None], back.rotations, found.bundle.rotations)
        translations = np.where(moved[:, None], back.translations, found.bundle.translations)
        solved = replace(solved, bundle=replace(back, rotations=rotations, translations=translations))
    return PersonLock(with_reconstruction(scene, solved), moved, person)
