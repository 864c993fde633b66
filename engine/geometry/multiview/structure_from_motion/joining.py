"""Two reconstructions with points in common, in one frame: the similarity for which all their cameras see these points where
they see them.

Points that a reconstruction sees from a small range of directions are known well across it and badly along it, so that a
similarity fitted to places is pulled, and shrinks. Here what was measured decides, pixels, and the common points move along:
bundle adjustment of seven parameters and the points, with the cameras of each reconstruction held as they stand to one
another (B. Triggs, P. McLauchlan, R. Hartley, A. Fitzgibbon, Bundle adjustment - a modern synthesis, 2000, sections 4.3 and
6.1).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.geometry.multiview.bundle import MIN_POINT_DEPTH, Bundle, Observations
from engine.geometry.multiview.bundle_adjustment import Freedom, adjust
from engine.geometry.multiview.structure_from_motion.mapping import Reconstruction
from engine.geometry.registration.rigid import Similarity

OBSERVATION_SIGMA_PIXELS = 1.5
"""Pixels by which a right observation is off at most, of pictures 1000 pixels long."""
MIN_OBSERVATION_SIGMA_PIXELS = 1.0
"""Pixels by which one of small pictures is off, in which features are not found more finely."""
FIRST_ROUND_MEDIANS = 2.0
"""Median errors up to which the first round believes an observation."""
ROUND_SHARPENING_FACTOR = 0.7
"""By what each round believes less than the one before."""
LAST_ROUNDS = 5
"""Last rounds of Gauss and Newton, which believe `OBSERVATION_SIGMA_PIXELS`."""
BEHIND_CAMERA_PIXELS = 1e9
"""Pixels by which what is behind a camera is off: it does not count."""
ROBUST_LOSS_PIXELS = (6.0, 1.0)
"""Pixels of the robust loss with which two films are adjusted together, one after the other: places in common are far
off first."""
MAX_ADJUSTMENT_STEPS, STEPS_AND_TOLERANCE = 15, 1e-4
"""Steps of each, and the relative decrease at which it ends before."""
JOINING_DAMPING_SHARE = 1e-9
"""Share of the diagonal of each system of equations that is added to it."""


@dataclass(frozen=True)
class Joined:
    """The `change` from the second reconstruction's frame to the first one's; which of the M pairs (M,) bool `agreed` on it, that
    is, are seen within that in the median by each side's cameras."""

    change: Similarity
    agreed: NDArray[np.bool_]


@dataclass(frozen=True)
class _Side:
    """What one reconstruction sees of M common points: `pair` (O,), `camera` (O,), and `pixels` (O, 2) from the principal point."""

    bundle: Bundle
    pair: NDArray[np.intp]
    camera: NDArray[np.intp]
    pixels: NDArray[np.float64]


def join_by_pixels(
    first: Reconstruction, second: Reconstruction, pairs: NDArray[np.integer], start: Similarity, length: float
) -> Joined:
    """The similarity from the second reconstruction to the first.

    Parameters
    ----------
    pairs : (M, 2) tracks of the first and of the second that are one point each; wrong ones do not matter while they are fewer.
    start : about right.
    length : the longer side of the pictures, pixels.
    """
    sides = _side(first, pairs[:, 0]), _side(second, pairs[:, 1])
    back = start.inverse()
    points = first.bundle.points[pairs[:, 0]].astype(np.float64)
    least = max(OBSERVATION_SIGMA_PIXELS * length / 1000, MIN_OBSERVATION_SIGMA_PIXELS)
    sigma = FIRST_ROUND_MEDIANS * float(np.median(np.linalg.norm(_seen(sides[1], back(points))[0], axis=1)))
    while sigma > least:
        back, points = _step(sides, back, points, sigma)
        sigma *= ROUND_SHARPENING_FACTOR
    for _ in range(LAST_ROUNDS):
        back, points = _step(sides, back, points, least)
    agreed = np.ones(len(pairs), np.bool_)
    for side, places in zip(sides, (points, back(points)), strict=True):
        off = np.linalg.norm(_seen(side, places)[0], axis=1)
        within = np.bincount(side.pair, off < least, len(pairs))
        agreed &= within > np.bincount(side.pair, minlength=len(pairs)) / 2
    return Joined(back.inverse(), agreed)


def adjust_together(
    first: Reconstruction, second: Reconstruction, shared: NDArray[np.integer], change: Similarity
) -> tuple[Reconstruction, Reconstruction]:
    """Both reconstructions in the first one's frame, with all their cameras, points and lenses adjusted as one bundle: what either
    knows badly, its lens above all, it learns of the other.

    Parameters
    ----------
    shared : (M, 2) tracks of the first and of the second that are one point each; of several with the same track one counts.
    change : from the second reconstruction's frame to the first's, about.
    """
    shared = shared[np.unique(shared[:, 0], return_index=True)[1]]
    shared = shared[np.unique(shared[:, 1], return_index=True)[1]]
    here, there = first.bundle, second.bundle.moved(change)
    at = len(here.points) + np.arange(len(there.points))
    at[shared[:, 1]] = shared[:, 0]
    both = Bundle(
        np.concatenate([here.rotations, there.rotations]),
        np.concatenate([here.translations, there.translations]),
        np.concatenate([here.lenses, there.lenses]),
        np.concatenate([here.centres, there.centres]),
        np.concatenate([here.lens_of, there.lens_of + len(here.lenses)]),
        np.concatenate([here.points, there.points]),
    )
    one, other = first.seen[first.agreed], second.seen[second.agreed]
    seen = Observations(
        np.concatenate([one.camera, other.camera + len(here.rotations)]),
        np.concatenate([one.point, at[other.point]]),
        np.concatenate([one.pixels, other.pixels]),
    )
    free = Freedom(np.concatenate([first.registered, second.registered]), (True, True, True))
    for loss in ROBUST_LOSS_PIXELS:
        both = adjust(both, seen, free, loss, MAX_ADJUSTMENT_STEPS, STEPS_AND_TOLERANCE).bundle
    count = len(here.rotations)
    parts = []
    for found, cameras, lenses, points in (
        (first, slice(None, count), slice(None, len(here.lenses)), slice(None, len(here.points))),
        (second, slice(count, None), slice(len(here.lenses), None), at),
    ):
        bundle = Bundle(
            both.rotations[cameras],
            both.translations[cameras],
            both.lenses[lenses],
            both.centres[lenses],
            found.bundle.lens_of,
            both.points[points],
        )
        parts.append(replace(found, bundle=bundle))
    return parts[0], parts[1]


def _side(found: Reconstruction, tracks: NDArray[np.integer]) -> _Side:
    """The observations of these tracks, in accord with the reconstruction."""
    kept = np.flatnonzero(found.agreed & found.registered[found.seen.camera])
    kept = kept[np.argsort(found.seen.point[kept], kind="stable")]
    track = found.seen.point[kept]
    begins, ends = np.searchsorted(track, tracks), np.searchsorted(track, tracks, side="right")
    pair = np.repeat(np.arange(len(tracks)), ends - begins)
    within = np.arange(len(pair)) - np.repeat(np.cumsum(ends - begins) - (ends - begins), ends - begins)
    chosen = kept[begins[pair] + within]
    camera = found.seen.camera[chosen]
    centres = found.bundle.centres[found.bundle.lens_of[camera]]
    return _Side(found.bundle, pair, camera, found.seen.pixels[chosen] - centres)


def _step(
    sides: tuple[_Side, _Side], back: Similarity, points: NDArray[np.float64], sigma: float
) -> tuple[Similarity, NDArray[np.float64]]:
    """One step of Gauss and Newton for the similarity `back` from the first frame to the second, and the points (M, 3)."""
    count = len(points)
    curvature, gradient = np.zeros((count, 3, 3)), np.zeros((count, 3))
    mixed = np.zeros((count, 3, 7))
    whole, slope = np.zeros((7, 7)), np.zeros(7)
    near = back(points)
    middle = near.mean(0)
    for side, places, turned in ((sides[0], points, np.eye(3)), (sides[1], near, back.linear)):
        off, by_place = _seen(side, places)
        weights = 1 / (1 + (off**2).sum(1) / sigma**2) ** 2
        by_point = by_place @ turned
        np.add.at(curvature, side.pair, np.einsum("o,oai,oaj->oij", weights, by_point, by_point))
        np.add.at(gradient, side.pair, np.einsum("o,oai,oa->oi", weights, by_point, off))
        if side is sides[1]:
            by_change = by_place @ _moves(places[side.pair] - middle)
            np.add.at(mixed, side.pair, np.einsum("o,oai,oaj->oij", weights, by_point, by_change))
            whole += np.einsum("o,oai,oaj->ij", weights, by_change, by_change)
            slope += np.einsum("o,oai,oa->i", weights, by_change, off)
    curvature += JOINING_DAMPING_SHARE * np.trace(curvature, axis1=1, axis2=2)[:, None, None] * np.eye(
        3
    ) + 1e-300 * np.eye(3)
    solved = np.linalg.solve(curvature, np.concatenate([mixed, gradient[:, :, None]], axis=2))
    reduced = whole - np.einsum("mik,mil->kl", mixed, solved[:, :, :7])
    right = slope - np.einsum("mik,mi->k", mixed, solved[:, :, 7])
    change = -np.linalg.solve(reduced + JOINING_DAMPING_SHARE * np.trace(whole) * np.eye(7), right)
    moved = points - solved[:, :, 7] - solved[:, :, :7] @ change
    turn = np.exp(change[6]) * Rotation.from_rotvec(change[:3]).as_matrix()
    return Similarity(turn @ back.linear, turn @ (back.shift - middle) + middle + change[3:6]), moved


def _moves(away: NDArray[np.float64]) -> NDArray[np.float64]:
    """(O, 3, 7) how places (O, 3), from the middle, move as the frame is turned, shifted and grown."""
    turned = np.cross(np.eye(3)[None], away[:, None]).transpose(0, 2, 1)
    shifted = np.broadcast_to(np.eye(3), (len(away), 3, 3))
    return np.concatenate([turned, shifted, away[:, :, None]], axis=2)


def _seen(side: _Side, places: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How far (O, 2) pixels the points at `places` (M, 3) are seen from where they were, and how that changes with the places
    (O, 2, 3); what is behind a camera is `BEHIND_CAMERA_PIXELS` off, and does not change."""
    bundle = side.bundle
    rotations = bundle.rotations[side.camera]
    at = np.einsum("oij,oj->oi", rotations, places[side.pair]) + bundle.translations[side.camera]
    before = at[:, 2] > MIN_POINT_DEPTH
    deep = np.where(before, at[:, 2], 1.0)[:, None]
    flat = at[:, :2] / deep
    focal, k1, k2 = bundle.lenses[bundle.lens_of[side.camera]].T
    square = (flat**2).sum(1)
    stretch = focal * (1 + square * (k1 + square * k2))
    off = stretch[:, None] * flat - side.pixels
    growth = focal * (2 * k1 + 4 * k2 * square)
    by_flat = stretch[:, None, None] * np.eye(2) + growth[:, None, None] * flat[:, :, None] * flat[:, None, :]
    by_eye = np.concatenate([by_flat, -(by_flat @ flat[:, :, None])], axis=2) / deep[:, :, None]
    off[~before], by_eye[~before] = BEHIND_CAMERA_PIXELS, 0.0
    return off, by_eye @ rotations
