"""Where eyes look: how far each iris of a driver goes toward the corner of its eye, and how far that is in the target's.

Both eyes of a person turn together. In pictures their irises rest at different places of their openings, as heads are turned, eyes
stand apart, or a hand drew them. The same way in eye widths then leads one iris to its corner and leaves the other in the
middle: they look apart. So a look is told as a share of the way from where an iris rests to the corner. Both eyes go the same share, and
come to their corners together.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.eyeball import EYE_OUTLINE_IRIS_CORNERS, Eyeball

MIN_CORNER_DISTANCE_IRIS_RADII = 0.85
"""Radii of the iris that are between its middle and a corner of the eye, at least."""
MIN_WAY_EYE_WIDTHS = 0.05
"""Eye widths from where an iris rests to where it may go, at least: irises that are large, or aside, still move."""
MIN_VERGENCE_SHARE = 0.3
"""Share of its way by which each iris has to go against the other's before eyes are taken to converge: a tracker errs by less."""
INWARD_SIGNS = np.array([1.0, -1.0])[:, None]
"""Of both eyes, right eye first: from the outer corner to the inner one, along the picture's right or against it."""


def gaze(
    meshes: NDArray[np.floating], neutral: NDArray[np.floating], openness: NDArray[np.floating]
) -> NDArray[np.float64]:
    """Where the eyes of N meshes (N, 478, 2 or 3) look, against a `neutral` one.

    Parameters
    ----------
    openness : (N, 2) in [0, 1], right eye first. Of an eye that shuts the tracker sees no iris: it counts less, and both look
        less far.

    Returns
    -------
    (N, 2, 2), right eye first. Along the eye from its outer to its inner corner, the share of the way from where the iris rests to where it
    comes to a corner, in [-1, 1]; across it, eye widths.
    """
    rest = iris_positions(neutral[None])[0]
    radii = iris_radii(neutral[None])[0]
    moved = iris_positions(meshes) - rest
    ways = np.array([ways_to_corners(*eye) for eye in zip(rest[:, 0], radii, strict=True)])
    shares = np.where(moved[..., 0] < 0, moved[..., 0] / ways[:, 0], moved[..., 0] / ways[:, 1])
    return conjugate(np.stack([np.clip(shares, -1, 1), moved[..., 1]], axis=-1), openness)


def conjugate(looks: NDArray[np.floating], openness: NDArray[np.floating]) -> NDArray[np.float64]:
    """Looks (N, 2, 2) of two eyes that move together, as `gaze` has them. Both go the mean of what each was seen to do, weighted by
    their `openness` (N, 2). Only what they differ by along the eyes beyond `MIN_VERGENCE_SHARE` remains: whoever crosses their
    eyes means it."""
    across_picture = looks * INWARD_SIGNS
    weights = (openness + 1e-6)[..., None]
    together = (weights * across_picture).sum(axis=1, keepdims=True) / weights.sum(axis=1, keepdims=True)
    apart = across_picture - together
    meant = np.sign(apart) * np.maximum(np.abs(apart) - MIN_VERGENCE_SHARE, 0) * (1.0, 0.0)
    shown = openness.max(axis=1)[:, None, None]
    return np.asarray(shown * (together + openness.min(axis=1)[:, None, None] * meant) * INWARD_SIGNS, float)


def iris_positions(meshes: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N, 2, 2) where each iris stands between the eye's corners, right eye first, from their middle, in eye widths along
    and across the line between them."""
    return np.stack([_position(meshes, side) for side in EYE_OUTLINE_IRIS_CORNERS], axis=1)


def iris_radii(meshes: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N, 2) radii of the irises, right eye first, in eye widths."""
    radii = []
    for _, iris, outer, inner in EYE_OUTLINE_IRIS_CORNERS:
        rim = np.linalg.norm(meshes[:, list(iris[1:]), :2] - meshes[:, [iris[0]], :2], axis=-1).mean(axis=-1)
        radii.append(rim / np.linalg.norm(meshes[:, inner, :2] - meshes[:, outer, :2], axis=-1))
    return np.stack(radii, axis=1)


def ways_to_corners(rest: float, radius: float) -> tuple[float, float]:
    """How far an iris of a `radius` that rests at `rest`, both in eye widths as in `iris_positions`, may go toward the outer and
    toward the inner corner, eye widths."""
    most = 0.5 - MIN_CORNER_DISTANCE_IRIS_RADII * radius
    return max(most + rest, MIN_WAY_EYE_WIDTHS), max(most - rest, MIN_WAY_EYE_WIDTHS)


def iris_shift(eye: Eyeball, look: NDArray[np.floating]) -> NDArray[np.float64]:
    """(2,) how far the iris of an eyeball goes for a `look` (2,) as `gaze` has it, in eye widths along and across the eye."""
    outward, inward = ways_to_corners(float(eye.centre[0]), eye.radius)
    share = float(np.clip(look[0], -1, 1))  # a strength above 1 leads no iris out of its eye
    return np.array([share * (outward if share < 0 else inward), look[1]], float)


def _position(meshes: NDArray[np.floating], side: tuple) -> NDArray[np.float64]:
    _, iris, outer, inner = side
    a, b = meshes[:, outer, :2], meshes[:, inner, :2]
    along = b - a
    width = np.linalg.norm(along, axis=1, keepdims=True)
    along = along / width
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    centre = meshes[:, iris[0], :2] - (a + b) / 2
    return np.stack([(centre * along).sum(1), (centre * across).sum(1)], axis=1) / width
