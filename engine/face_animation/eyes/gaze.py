"""Where eyes look: how far the irises of a driver go, and how far those of the target do.

Both eyes of a person turn together, and people's irises are alike large, in whichever eye and however the face is turned. So a look is one
way for both, told in radii of the iris: small irises do not make it longer. In pictures irises rest at different places of their openings, as
heads are turned, eyes stand apart, or a hand drew them. The same way would then lead one to its corner and leave the other in the middle. So the
target's both go the same share of their ways to the corners, which is as far in their mean as the driver's look is, and come there together.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.eyeball import EYE_OUTLINE_IRIS_CORNERS, Eyeball

MIN_CORNER_DISTANCE_IRIS_RADII = 1.1
"""Radii of the iris that are between its middle and a corner of the eye, at least: two people who glance aside as far as they can have 1.05 to 1.2."""
CARUNCLE_EYE_WIDTHS = 0.08
"""Eye widths at the inner corner that the caruncle takes. The iris of an eye that turns inwards ends before it: laid into the corner itself it goes up to twice as
far as the other, which turns outwards."""
MIN_WAY_EYE_WIDTHS = 0.05
"""Eye widths from where an iris rests to where it may go, at least: irises that are large, or aside, still move."""
MIN_VERGENCE_IRIS_RADII = 0.45
"""Radii of the iris by which each has to go against the other before eyes are taken to converge: a tracker errs by less."""
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
    (N, 2, 2), right eye first: along the eye from its outer to its inner corner, and across it, radii of the iris from where it rests.
    """
    moved = iris_positions(meshes) - iris_positions(neutral[None])
    radii = iris_radii(neutral[None])[0]
    widths = np.array([np.linalg.norm(neutral[b, :2] - neutral[a, :2]) for *_, a, b in EYE_OUTLINE_IRIS_CORNERS])
    return conjugate(moved * (widths / (radii * widths).mean())[:, None], openness)


def conjugate(looks: NDArray[np.floating], openness: NDArray[np.floating]) -> NDArray[np.float64]:
    """Looks (N, 2, 2) of two eyes that move together, as `gaze` has them. Both go the mean of what each was seen to do, weighted by
    their `openness` (N, 2). Only what they differ by along the eyes beyond `MIN_VERGENCE_IRIS_RADII` remains: whoever crosses their
    eyes means it."""
    across_picture = looks * INWARD_SIGNS
    weights = (openness + 1e-6)[..., None]
    together = (weights * across_picture).sum(axis=1, keepdims=True) / weights.sum(axis=1, keepdims=True)
    apart = across_picture - together
    meant = np.sign(apart) * np.maximum(np.abs(apart) - MIN_VERGENCE_IRIS_RADII, 0) * (1.0, 0.0)
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


def iris_shifts(
    eyes: tuple[Eyeball | None, Eyeball | None], looks: NDArray[np.floating]
) -> list[NDArray[np.float64] | None]:
    """How far the irises of both `eyes`, right one first, go for `looks` (2, 2) as `gaze` has them: (2,) each, in eye widths along
    and across the eye."""
    shifts: list[NDArray[np.float64] | None] = [None, None]
    seen = [(side, eye) for side, eye in enumerate(eyes) if eye is not None]
    if not seen:
        return shifts
    radius = float(np.mean([eye.radius * eye.width for _, eye in seen]))
    ways = [_way(eye, looks[side, 0]) for side, eye in seen]
    mean_way = float(np.mean([way * eye.width for way, (_, eye) in zip(ways, seen, strict=True)])) / radius
    for way, (side, eye) in zip(ways, seen, strict=True):
        share = float(np.clip(looks[side, 0] / mean_way, -1, 1))  # however strongly, no iris leaves its eye
        shifts[side] = np.array([share * way, looks[side, 1] * radius / eye.width])
    return shifts


def _way(eye: Eyeball, inward: float) -> float:
    """Eye widths from where the iris of an eye rests to where it may go toward its inner corner, or where `inward` is below 0, its outer one."""
    rest = np.copysign(1.0, inward) * eye.centre[0]
    end = 0.5 - CARUNCLE_EYE_WIDTHS if inward > 0 else 0.5
    return float(max(end - MIN_CORNER_DISTANCE_IRIS_RADII * eye.radius - rest, MIN_WAY_EYE_WIDTHS))


def _position(meshes: NDArray[np.floating], side: tuple) -> NDArray[np.float64]:
    _, iris, outer, inner = side
    a, b = meshes[:, outer, :2], meshes[:, inner, :2]
    along = b - a
    width = np.linalg.norm(along, axis=1, keepdims=True)
    along = along / width
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    centre = meshes[:, iris[0], :2] - (a + b) / 2
    return np.stack([(centre * along).sum(1), (centre * across).sum(1)], axis=1) / width
