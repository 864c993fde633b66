"""Cameras that were found on a whole scene, solved again on a part of it: on what moved as one among all that stood still.

The part's own motion goes into the cameras. They stand where they stood, about, so nothing is searched anew: its points are
triangulated loosely, and what is let in grows stricter as cameras settle.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.geometry.multiview.bundle import Bundle, reprojection_errors, undistorted
from engine.geometry.multiview.bundle_adjustment import Freedom, PosePrior, adjust
from engine.geometry.multiview.structure_from_motion.mapping import MIN_RAY_ANGLE_RADIANS, Reconstruction
from engine.geometry.multiview.structure_from_motion.triangulation import triangulate

MAX_ROUND_ERRORS_PIXELS = (8.0, 5.0, 3.0, 3.0)
"""Pixels that an observation may be off in each round, of pictures 1000 pixels long."""
MIN_VISIBLE_POINTS = 25
"""Points of the part by which a camera is solved; with fewer it stays where it was."""


@dataclass(frozen=True)
class Refinement:
    """The `reconstruction` of the part alone; `moved` (C,) bool: the cameras that were solved on it. The others are those of
    the scene."""

    reconstruction: Reconstruction
    moved: NDArray[np.bool_]


def refine(
    found: Reconstruction,
    part: NDArray[np.bool_],
    length: float,
    prior: PosePrior | None = None,
    min_seen: int = MIN_VISIBLE_POINTS,
) -> Refinement:
    """The cameras of `found`, solved on some of its tracks alone, by the lenses that they have.

    Parameters
    ----------
    part : (T,) bool, the tracks of what moved as one; some may be wrong.
    length : the pictures' longer side, pixels.
    prior : how far the part may have moved.
    min_seen : points that a camera must see of the part.
    """
    bundle, agreed = found.bundle, np.zeros(len(found.seen), np.bool_)
    moved = np.zeros(len(found.registered), np.bool_)
    candidates = np.flatnonzero(part[found.seen.point] & found.registered[found.seen.camera])
    if not len(candidates):
        return Refinement(replace(found, agreed=agreed), moved)
    for max_error in MAX_ROUND_ERRORS_PIXELS:
        bundle, agreed = _with_points(found, bundle, candidates, max_error * length / 1000)
        counts = np.bincount(found.seen.camera[agreed], minlength=len(moved))
        moved = found.registered & (counts >= min_seen)
        if not moved.any():
            return Refinement(replace(found, agreed=agreed), moved)
        bundle = adjust(bundle, found.seen[agreed], Freedom(moved, prior=prior), most_steps=10, converged=1e-4).bundle
    kept = np.flatnonzero(agreed)
    agreed[kept] = reprojection_errors(bundle, found.seen[kept]) <= MAX_ROUND_ERRORS_PIXELS[-1] * length / 1000
    return Refinement(replace(found, bundle=bundle, agreed=agreed), moved)


def _with_points(
    found: Reconstruction, bundle: Bundle, candidates: NDArray[np.intp], max_error: float
) -> tuple[Bundle, NDArray[np.bool_]]:
    """The bundle with the points that the candidates' tracks have by its cameras, and which observations (O,) agree."""
    track = found.seen.point[candidates]
    starts = np.flatnonzero(np.r_[True, np.diff(track) > 0, True]).astype(np.intp)
    flat = undistorted(found.seen.pixels[candidates], bundle.lenses[0], bundle.centres[0])
    solved = triangulate(
        *((bundle.rotations, bundle.translations), found.seen.camera[candidates], np.nan_to_num(flat, nan=1e6)),
        *(starts, max_error / float(bundle.lenses[0, 0]), MIN_RAY_ANGLE_RADIANS),
    )
    points = np.full_like(bundle.points, np.nan)
    points[track[starts[:-1]]] = solved.points
    agreed = np.zeros(len(found.seen), np.bool_)
    agreed[candidates] = solved.agreed
    return replace(bundle, points=points), agreed
