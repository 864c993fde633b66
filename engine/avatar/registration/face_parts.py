"""Eyes, teeth, tongue and lashes of the fitted face: placed by how the skin about them was deformed, lids laid on eyes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.registration.skin import Skin
from engine.body.template import Template
from engine.geometry.registration.rigid import fit_similarity

SURROUNDINGS = {
    "left_eye": 0.03,
    "right_eye": 0.03,
    "upper_teeth": 0.045,
    "lower_teeth": 0.045,
    "tongue": 0.045,
}
"""Parts that are placed by a similarity, and the metres about their middle within which visible skin says where."""
FOLLOWS = {"tongue": "lower_teeth"}
"""A part that goes where another goes."""
LID_GAP = 0.0004
"""Metres that lids stay before the eyeball."""
SKIN_FOLLOWERS = 4
"""Vertices of the skin whose motion, weighted by nearness, a vertex of no such part follows."""


def place_parts(
    template: Template, skin: Skin, model: NDArray[np.floating], fitted: NDArray[np.floating]
) -> NDArray[np.float64]:
    """All the template's vertices (V, 3) for the `fitted` skin (S, 3), from `model` (V, 3), the whole template before the fit.

    Skin is as it was fitted, rigid parts by a similarity (scale, turn, shift) of the skin about them, and what is left
    (lashes, cages of cloth, joints' cubes) goes with the nearest skin.
    """
    before = np.asarray(model, np.float64)
    own = before[skin.vertices]
    shown = np.flatnonzero(~skin.regions["inner"] & skin.regions["head"])
    out = _carried_by_skin(before, own, np.asarray(fitted, np.float64))
    for part, reach in SURROUNDINGS.items():
        vertices = template.vertices_of(part)
        middle = before[template.vertices_of(FOLLOWS.get(part, part))].mean(0)
        near = shown[np.linalg.norm(own[shown] - middle, axis=1) < reach]
        out[vertices] = fit_similarity(own[near], np.asarray(fitted, np.float64)[near])(before[vertices])
    out[skin.vertices] = fitted
    return out


def lids_on_eyes(template: Template, skin: Skin, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    """The skin (S, 3) of the whole template `vertices` (V, 3), with what of the lids is inside of an eyeball moved out to just
    before it."""
    fitted = vertices[skin.vertices].copy()
    lids = np.flatnonzero(skin.regions["lids"] & ~skin.regions["inner"])
    for part in ("left_eye", "right_eye"):
        eyeball = vertices[template.vertices_of(part)]
        middle, radius = sphere(eyeball)
        near = lids[np.linalg.norm(fitted[lids] - middle, axis=1) < 2 * radius]
        away = fitted[near] - middle
        distance = np.linalg.norm(away, axis=1)
        cornea = _reach(eyeball - middle, away / distance[:, None], radius) + LID_GAP
        inside = distance < cornea
        fitted[near[inside]] = middle + away[inside] * (cornea / distance)[inside, None]
    return fitted


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


def _carried_by_skin(
    before: NDArray[np.float64], skin_before: NDArray[np.float64], skin_after: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Each vertex (V, 3) moved as the nearest vertices of the skin."""
    distance, near = cKDTree(skin_before).query(before, k=SKIN_FOLLOWERS)
    weights = 1 / np.maximum(distance, 1e-6)
    weights /= weights.sum(1, keepdims=True)
    moved = (skin_after - skin_before)[near]
    return np.asarray(before + np.einsum("vk,vkc->vc", weights, moved))
