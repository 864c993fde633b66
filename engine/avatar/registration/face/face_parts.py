"""Teeth, tongue and lashes of the fitted face: placed by how the skin about them was deformed, teeth behind the lips."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.registration.template_skin.skin import Skin
from engine.body.template import Template
from engine.geometry.closest_points import closest_points
from engine.geometry.registration.rigid import Similarity, fit_similarity
from engine.geometry.winding_number import winding_numbers

MOUTH_PARTS = ("upper_teeth", "lower_teeth", "tongue")
"""What lies in the mouth, and is placed as one: teeth meet as they did."""
MOUTH_SURROUNDINGS = 0.045
"""Metres about the middle of the teeth within which visible skin says where they are."""
TEETH_DEPTH = 0.002
"""Metres that teeth lie behind the visible skin, at least."""
BACK_STEP, MAX_BACK = 0.0005, 0.03
"""Metres by which they are set back at a time, and at most."""
SKIN_FOLLOWERS = 4
"""Vertices of the skin whose motion, weighted by nearness, a vertex of no such part follows."""


def place_parts(
    template: Template, skin: Skin, model: NDArray[np.floating], fitted: NDArray[np.floating]
) -> NDArray[np.float64]:
    """All the template's vertices (V, 3) for the `fitted` skin (S, 3), from `model` (V, 3), the whole template before the fit.

    Skin is as it was fitted, what is in the mouth lies by a similarity (scale, turn, shift) of the skin about it, behind the
    lips, and what is left (eyeballs, lashes, cages of cloth, joints' cubes) goes with the nearest skin.
    """
    before, after = np.asarray(model, np.float64), np.asarray(fitted, np.float64)
    head = head_change(skin, before[skin.vertices], after)
    out = _carried_by_skin(before, before[skin.vertices], after)
    inside = np.concatenate([template.vertices_of(part) for part in MOUTH_PARTS])
    out[inside] = _behind_lips(skin, after, _in_mouth(template, skin, before, after)(before[inside]), head)
    out[skin.vertices] = after
    return out


def head_change(skin: Skin, before: NDArray[np.float64], after: NDArray[np.float64]) -> Similarity:
    """What the head's visible skin as a whole went through from `before` (S, 3) to `after` (S, 3)."""
    shown = ~skin.regions["inner"] & skin.regions["face"]
    return fit_similarity(before[shown], after[shown])


def _in_mouth(template: Template, skin: Skin, before: NDArray[np.float64], after: NDArray[np.float64]) -> Similarity:
    """What the skin about the teeth went through."""
    own = before[skin.vertices]
    teeth = np.concatenate([template.vertices_of(part) for part in ("upper_teeth", "lower_teeth")])
    shown = ~skin.regions["inner"] & skin.regions["head"]
    near = shown & (np.linalg.norm(own - before[teeth].mean(0), axis=1) < MOUTH_SURROUNDINGS)
    return fit_similarity(own[near], after[near])


def _behind_lips(
    skin: Skin, fitted: NDArray[np.float64], points: NDArray[np.float64], head: Similarity
) -> NDArray[np.float64]:
    """The points (N, 3) set back into the head, all alike, until all are `TEETH_DEPTH` behind the visible skin."""
    hull = skin.triangles[skin.visible]
    backwards = -head.rotation[:, 2]
    for back in np.arange(0, MAX_BACK, BACK_STEP):
        placed = points + back * backwards
        inside = winding_numbers(placed, fitted, hull) > 0.5
        if inside.all() and closest_points(placed, fitted, hull).distance.min() > TEETH_DEPTH:
            break
    return np.asarray(placed)


def _carried_by_skin(
    before: NDArray[np.float64], skin_before: NDArray[np.float64], skin_after: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Each vertex (V, 3) moved as the nearest vertices of the skin."""
    distance, near = cKDTree(skin_before).query(before, k=SKIN_FOLLOWERS)
    weights = 1 / np.maximum(distance, 1e-6)
    weights /= weights.sum(1, keepdims=True)
    moved = (skin_after - skin_before)[near]
    return np.asarray(before + np.einsum("vk,vkc->vc", weights, moved))
