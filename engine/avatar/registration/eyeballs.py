"""Eyeballs between the lids as these were fitted, and the lids' rims on the eyeballs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.registration.skin import EYE_PARTS, Skin
from engine.avatar.registration.smooth_field import smooth_field
from engine.body.template import Template
from engine.geometry.registration.rigid import Similarity, fit_similarity

SURROUNDINGS = 0.03
"""Metres about the eyeball's middle within which visible skin says about where it is."""
SURROUNDINGS_SHARE = 0.2
"""What that counts beside the rims' distances from the middle."""
GAUSS_NEWTON_STEPS = 8
"""Of Gauss and Newton's method, for the middle."""
LID_GAP = 0.0004
"""Metres that lids stay before the eyeball."""


def placed_eyeball(
    template: Template,
    skin: Skin,
    part: str,
    before: NDArray[np.float64],
    fitted: NDArray[np.float64],
    head: Similarity,
) -> NDArray[np.float64]:
    """The vertices (E, 3) of an eyeball `part` for the `fitted` skin (S, 3), from the whole template `before` (V, 3) the fit.

    It is as large as the `head` has become and looks where that looks, straight ahead; its middle is where the rims of the
    lids are as far away as they were.
    """
    eyeball, own = before[template.vertices_of(part)], before[skin.vertices]
    middle, _ = sphere(eyeball)
    shown = np.flatnonzero(~skin.regions["inner"] & skin.regions["head"])
    near = shown[np.linalg.norm(own[shown] - middle, axis=1) < SURROUNDINGS]
    about = fit_similarity(own[near], fitted[near])(middle)
    rim = skin.regions[f"{part}_rim"]
    reach = head.scale * np.linalg.norm(own[rim] - middle, axis=1)
    at = about.copy()
    for _ in range(GAUSS_NEWTON_STEPS):
        away = at - fitted[rim]
        distance = np.linalg.norm(away, axis=1)
        slopes = away / distance[:, None]
        matrix = slopes.T @ slopes / len(slopes) + SURROUNDINGS_SHARE * np.eye(3)
        right = slopes.T @ (distance - reach) / len(slopes) + SURROUNDINGS_SHARE * (at - about)
        at = at - np.linalg.solve(matrix, right)
    return np.asarray(at + head.offsets(eyeball - middle))


def lids_on_eyes(
    template: Template, skin: Skin, before: NDArray[np.float64], vertices: NDArray[np.float64], head: Similarity
) -> NDArray[np.float64]:
    """The skin (S, 3) of the whole template `vertices` (V, 3) with the lids' rims as far before the eyeballs as they were `before`
    (V, 3), as large as the `head` has become, and nothing of the lids within an eyeball.

    Lids between their rims and the skin about them keep the folds that they had before, but for a smooth displacement: the fit
    crumples them where an eye is opened wider, and between them points are of the eye.
    """
    fitted = vertices[skin.vertices].copy()
    own = before[skin.vertices]
    lids = skin.regions["lids"] & ~skin.regions["inner"]
    free = lids.copy()
    for part in EYE_PARTS:
        rim = np.flatnonzero(skin.regions[f"{part}_rim"])
        was = np.linalg.norm(own[rim] - sphere(before[template.vertices_of(part)])[0], axis=1)
        middle = sphere(vertices[template.vertices_of(part)])[0]
        away = fitted[rim] - middle
        fitted[rim] = middle + away * (head.scale * was / np.linalg.norm(away, axis=1))[:, None]
        free[rim] = False
    fitted[lids] = (head(own) + smooth_field(skin.triangles, free, fitted - head(own)))[lids]
    for part in EYE_PARTS:
        fitted[lids] = before_eyeball(vertices[template.vertices_of(part)], fitted[lids])
    return fitted


def before_eyeball(
    eyeball: NDArray[np.float64], points: NDArray[np.float64], gap: float = LID_GAP
) -> NDArray[np.float64]:
    """The points (N, 3), those inside of an eyeball (E, 3), or nearer than `gap`, moved out to so far before it."""
    middle, radius = sphere(eyeball)
    away = points - middle
    distance = np.linalg.norm(away, axis=1)
    surface = _reach(eyeball - middle, away / np.maximum(distance, 1e-12)[:, None], radius) + gap
    return np.asarray(middle + away * np.maximum(surface / np.maximum(distance, 1e-12), 1)[:, None])


def sphere(points: NDArray[np.floating]) -> tuple[NDArray[np.float64], float]:
    """The middle (3,) and the radius of the sphere on which points (N, 3) lie best, by linear least squares."""
    rows = np.column_stack([2 * points, np.ones(len(points))])
    solved = np.linalg.lstsq(rows, (points**2).sum(1), rcond=None)[0]
    middle = solved[:3]
    return np.asarray(middle), float(np.sqrt(solved[3] + middle @ middle))


def _reach(eyeball: NDArray[np.float64], directions: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    """(N,) metres from the eyeball's middle to its surface along unit `directions` (N, 3): of the nearest vertex, the cornea's
    bulge included, and the sphere's at least."""
    length = np.linalg.norm(eyeball, axis=1)
    near = cKDTree(eyeball / length[:, None]).query(directions)[1]
    return np.maximum(length[near], radius)
