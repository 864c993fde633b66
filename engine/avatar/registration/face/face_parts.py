"""Teeth, tongue and lashes of the fitted face: what is in the mouth by the lips and the face about it, the rest by the nearest skin."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.registration.template_skin.skin import Skin
from engine.body.template import Template
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import triangulate
from engine.geometry.mesh.winding_number import winding_numbers
from engine.geometry.registration.rigid import Similarity, fit_similarity
from engine.render.rasterisation.rasteriser import depth_map

MOUTH_PARTS = ("upper_teeth", "lower_teeth", "tongue")
"""What lies in the mouth, and is placed as one: teeth meet as they do in the template."""
MOUTH_SURROUNDINGS_METRES = 0.045
"""Metres of the template about the middle of the teeth within which visible skin says how large they are, and how deep they lie."""
LIPS_MEETING_FACE_POINTS = (62, 66)
"""Face landmarks: the middle of the lips' inner edges."""
INCISOR_DEPTH_METRES = 0.02
"""Metres of the template behind the foremost of the teeth within which they are incisors."""
SHOWN_INCISORS_METRES = 0.004
"""Metres by which the edge of the upper incisors lies below where the lips meet: what shows of them as lips part."""
TEETH_DEPTH_METRES = 0.002
"""Metres that teeth lie behind the visible skin at rest, at least."""
EXPRESSION_DEPTH_METRES = 0.0005
"""Metres that teeth, seen from the front, lie behind what any face unit of the mouth makes of that skin, at least."""
FRONT_PIXEL_METRES = 0.0005
"""Metres between the places at which teeth and skin are compared from the front."""
MOUTH_UNITS = (
    *("jawForward", "jawLeft", "jawRight", "mouthFunnel", "mouthLeft", "mouthPucker", "mouthRight", "mouthRollLower"),
    *("mouthRollUpper", "mouthShrugLower", "mouthShrugUpper"),
)
SIDED_MOUTH_UNITS = (
    *("cheekSquint", "mouthDimple", "mouthFrown", "mouthLowerDown", "mouthPress", "mouthSmile", "mouthStretch"),
    "mouthUpperUp",
)
"""Face units that press skin against teeth; of the latter both sides do."""
TONGUE_HEIGHT_SHARE = 0.45
"""Of the template's tongue's, which fills a mouth that opens."""
TONGUE_TIP_METRES = 0.012
"""Metres of the template behind the foremost of the tongue within which it is its tip, and of the lower teeth within which they meet
it."""
TONGUE_BELOW_INCISORS_METRES = 0.003
"""Metres by which the tip of a tongue that lies in the jaw is below the edge of the lower incisors."""
SETBACK_STEP_METRES, MAX_SETBACK_METRES = 0.0005, 0.03
"""Metres by which teeth are set back at a time, and at most."""
FOLLOWED_SKIN_VERTICES = 4
"""Vertices of the skin whose motion, weighted by nearness, a vertex of no such part follows."""


def place_parts(
    template: Template, skin: Skin, model: NDArray[np.floating], fitted: NDArray[np.floating]
) -> NDArray[np.float64]:
    """All the template's vertices (V, 3) for the `fitted` skin (S, 3), from `model` (V, 3), the whole template before the fit.

    Skin is as it was fitted. What is in the mouth is the template's own, as the face is turned and the skin about it is
    large. Its upper incisors are behind the lips, `SHOWN_INCISORS_METRES` below the upper one. What is left (eyeballs,
    lashes, cages of cloth, joints' cubes) goes with the nearest skin.
    """
    before, after = np.asarray(model, np.float64), np.asarray(fitted, np.float64)
    out = _carried_by_skin(before, before[skin.vertices], after)
    inside = np.concatenate([template.vertices_of(part) for part in MOUTH_PARTS])
    own = template.vertices.astype(np.float64)
    head = head_change(skin, own[skin.vertices], after)
    placed = _in_mouth(template, skin, own, after, head)
    back = _back_in_expressions(template, skin, after, placed, head)
    mouth = placed(own) - back * head.rotation[:, 2]
    tongue = template.vertices_of("tongue")
    mouth[tongue] = _lying_tongue(template, mouth, head.rotation[:, 1])
    out[inside] = _behind_lips(skin, after, mouth[inside], head)
    out[skin.vertices] = after
    return out


def _lying_tongue(template: Template, mouth: NDArray[np.float64], up: NDArray[np.float64]) -> NDArray[np.float64]:
    """The tongue's vertices, flat behind the lower incisors, of a `mouth` (V, 3) whose upwards is `up` (3,)."""
    tongue, teeth = template.vertices_of("tongue"), template.vertices_of("lower_teeth")
    own = mouth[tongue]
    flat = own + (TONGUE_HEIGHT_SHARE - 1) * ((own - own.mean(0)) @ up)[:, None] * up
    ahead = [template.vertices[part, 2] for part in (tongue, teeth)]
    tip, incisors = (depth > depth.max() - TONGUE_TIP_METRES for depth in ahead)
    edge = (mouth[teeth[incisors]] @ up).max() - TONGUE_BELOW_INCISORS_METRES
    return np.asarray(flat + (edge - (flat[tip] @ up).max()) * up)


def head_change(skin: Skin, before: NDArray[np.float64], after: NDArray[np.float64]) -> Similarity:
    """What the head's visible skin as a whole went through from `before` (S, 3) to `after` (S, 3)."""
    shown = ~skin.regions["inner"] & skin.regions["face"]
    return fit_similarity(before[shown], after[shown])


def _in_mouth(
    template: Template, skin: Skin, own: NDArray[np.float64], after: NDArray[np.float64], head: Similarity
) -> Similarity:
    """From the template's vertices, `own` (V, 3), to the mouth of the skin `after` (S, 3), whose face went through `head`."""
    teeth = own[np.concatenate([template.vertices_of(part) for part in ("upper_teeth", "lower_teeth")])]
    upper = own[template.vertices_of("upper_teeth")]
    shown = ~skin.regions["inner"] & skin.regions["head"]
    near = shown & (np.linalg.norm(own[skin.vertices] - teeth.mean(0), axis=1) < MOUTH_SURROUNDINGS_METRES)
    around = fit_similarity(own[skin.vertices[near]], after[near])
    linear = around.scale * head.rotation
    incisors = upper[upper[:, 2] > upper[:, 2].max() - INCISOR_DEPTH_METRES]
    edge = np.array([teeth[:, 0].mean(), incisors[:, 1].min(), incisors[:, 2].max()])
    lip = after[skin.face_points[list(LIPS_MEETING_FACE_POINTS)]].mean(0)
    _, up, ahead = head.rotation.T
    goal = lip - SHOWN_INCISORS_METRES * up
    depth = (around(edge) - goal) @ ahead
    return Similarity(linear, goal + depth * ahead - linear @ edge)


def _back_in_expressions(
    template: Template, skin: Skin, fitted: NDArray[np.float64], placed: Similarity, head: Similarity
) -> float:
    """Metres by which what is `placed` in the mouth of the skin (S, 3) has to be set back. Then, seen from the front,
    none of it comes through what any of `_mouth_poses` makes of the face; it may be seen between lips.

    Skin and teeth move as the template's do, as large as the `head`."""
    parts = triangulate(template.quads[template.faces(*MOUTH_PARTS)]).astype(np.int32)
    hull = skin.triangles[skin.visible & skin.regions["face"][skin.triangles].all(1)]
    inside = placed(template.vertices.astype(np.float64))
    axes = head.rotation.T / FRONT_PIXEL_METRES  # to aside, up and ahead, in pixels
    rest = inside[parts].reshape(-1, 3) @ axes.T
    corner = np.floor(rest.min(0))
    height, width = np.ceil(rest.max(0) - corner).astype(int)[1::-1] + 1
    back = 0.0
    for moved in _mouth_poses(template):
        depths = []
        for vertices, triangles in (
            (fitted + head.offsets(moved[skin.vertices]), hull),
            (inside + placed.offsets(moved), parts),
        ):
            seen = (vertices @ axes.T - corner) * [1, 1, -1]
            depths.append(depth_map(seen.astype(np.float32), triangles, (height, width)))
        both = np.isfinite(depths[0]) & np.isfinite(depths[1])
        through = float((depths[0][both] - depths[1][both]).max(initial=-np.inf))
        back = max(back, through * FRONT_PIXEL_METRES + EXPRESSION_DEPTH_METRES)
    return back


def _mouth_poses(template: Template) -> Iterator[NDArray[np.float32]]:
    """Displacements (V, 3) of the template's vertices by each unit of the mouth, alone and with the jaw half open."""
    half_open = template.face_units.displacement({"jawOpen": 0.5})
    alone: list[Mapping[str, float]] = [{unit: 1.0} for unit in MOUTH_UNITS]
    for weights in alone + [{f"{unit}Left": 1.0, f"{unit}Right": 1.0} for unit in SIDED_MOUTH_UNITS]:
        moved = template.face_units.displacement(weights)
        yield moved
        yield moved + half_open


def _behind_lips(
    skin: Skin, fitted: NDArray[np.float64], points: NDArray[np.float64], head: Similarity
) -> NDArray[np.float64]:
    """The points (N, 3) set back into the head, all alike, until all are `TEETH_DEPTH_METRES` behind the visible skin."""
    hull = skin.triangles[skin.visible]
    backwards = -head.rotation[:, 2]
    for back in np.arange(0, MAX_SETBACK_METRES, SETBACK_STEP_METRES):
        placed = points + back * backwards
        inside = winding_numbers(placed, fitted, hull) > 0.5
        if inside.all() and closest_points(placed, fitted, hull).distance.min() > TEETH_DEPTH_METRES:
            break
    return np.asarray(placed)


def _carried_by_skin(
    before: NDArray[np.float64], skin_before: NDArray[np.float64], skin_after: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Each vertex (V, 3) moved as the nearest vertices of the skin."""
    distance, near = cKDTree(skin_before).query(before, k=FOLLOWED_SKIN_VERTICES)
    weights = 1 / np.maximum(distance, 1e-6)
    weights /= weights.sum(1, keepdims=True)
    moved = (skin_after - skin_before)[near]
    return np.asarray(before + np.einsum("vk,vkc->vc", weights, moved))
