"""The part of the template that a shell is made of: skin and eyes, with what the rig does to them and the template's own chart."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.body import load_template
from engine.body.parts import BODY_PARTS, part_of_bone
from engine.character.fit.template_fit import load_human
from engine.geometry.mesh.surface import triangulate
from engine.geometry.rigging.skinning import MAX_VERTEX_INFLUENCES

EAR_RADIUS_METRES, EAR_DEPTH_METRES = 0.045, 0.025
"""Metres around the outermost point of an ear, and inwards from it, that are the ear's."""
MIN_SURE_HEAD_WEIGHT = 0.9
"""Share of the head in what moves a vertex that is surely of it."""


@dataclass(frozen=True)
class TemplateMesh:
    """The template's body and eyes, its vertices counted anew. What is in the mouth is left out, as nobody sees it.

    ids : (V,) int, which of the template's vertices each is.
    triangles : (T, 3) int32, counter-clockwise seen from outside. The surface is closed.
    corners : (S,) int, the vertex at each point of the chart: vertices along its seams come once for each side.
    uv : (S, 2) float32 in [0, 1], the points of the chart, (0, 0) at the texture's upper left corner.
    uv_triangles : (T, 3) int32, the same triangles by points of the chart.
    bones : (V, 4) int, the joints that move each vertex, strongest first.
    weights : (V, 4) float32, how much each of them does, summing to one.
    parts : (V, 6) float32, how much of what moves a vertex is of each of `engine.body.parts.BODY_PARTS`.
    hand, foot, head : (V,) float32, the same of hands, feet and the head.
    eye, ear : (V,) bool.
    names : the joints.
    """

    ids: NDArray[np.intp]
    triangles: NDArray[np.int32]
    corners: NDArray[np.intp]
    uv: NDArray[np.float32]
    uv_triangles: NDArray[np.int32]
    bones: NDArray[np.intp]
    weights: NDArray[np.float32]
    parts: NDArray[np.float32]
    hand: NDArray[np.float32]
    foot: NDArray[np.float32]
    head: NDArray[np.float32]
    eye: NDArray[np.bool_]
    ear: NDArray[np.bool_]
    names: tuple[str, ...]

    def share(self, *beginnings: str) -> NDArray[np.float32]:
        """(V,) how much of what moves a vertex are joints whose names begin so."""
        own = np.array([name.startswith(beginnings) for name in self.names])
        return np.asarray((self.weights * own[self.bones]).sum(1), np.float32)

    def renamed(self, vertices: NDArray[np.integer]) -> NDArray[np.intp]:
        """Vertices of the template by their numbers here; -1 for what is not here."""
        numbers = np.full(int(max(self.ids.max(), np.max(vertices, initial=0))) + 1, -1, np.intp)
        numbers[self.ids] = np.arange(len(self.ids))
        return numbers[vertices]

    def part(self, vertices: NDArray[np.bool_]) -> tuple[TemplateMesh, NDArray[np.intp]]:
        """What lies between some of its vertices (V,), with an open border, and which they are, (W,) indices. It has no chart."""
        which = np.flatnonzero(vertices)
        again = np.full(len(self.ids), -1, np.int32)
        again[which] = np.arange(len(which))
        names = ("ids", "bones", "weights", "parts", "hand", "foot", "head", "eye", "ear")
        return replace(
            self,
            triangles=again[self.triangles[vertices[self.triangles].all(1)]],
            corners=np.zeros(0, np.intp),
            uv=np.zeros((0, 2), np.float32),
            uv_triangles=np.zeros((0, 3), np.int32),
            **{name: getattr(self, name)[which] for name in names},
        ), which


@cache
def template_mesh() -> TemplateMesh:
    """The mesh, once for the process."""
    human, template = load_human(), load_template()
    faces = template.faces("body", "left_eye", "right_eye")
    ids, quads = np.unique(template.quads[faces], return_inverse=True)
    quads = quads.reshape(-1, 4)
    points, charted = np.unique(
        quads.astype(np.int64) * len(template.uv) + template.uv_quads[faces], return_inverse=True
    )
    rig = human.rig
    strongest = np.argsort(-rig.weights[ids], axis=1, kind="stable")[:, :MAX_VERTEX_INFLUENCES]
    bones = np.take_along_axis(rig.bones[ids].astype(np.intp), strongest, 1)
    weights = np.take_along_axis(rig.weights[ids].astype(np.float64), strongest, 1)
    weights /= weights.sum(1, keepdims=True)

    def share(of: NDArray[np.bool_]) -> NDArray[np.float32]:
        return np.asarray((weights * of[bones]).sum(1), np.float32)

    part = np.array([part_of_bone(name) for name in rig.names])
    head = share(np.array([name.startswith("Head") for name in rig.names]))
    return TemplateMesh(
        ids.astype(np.intp),
        triangulate(quads),
        (points // len(template.uv)).astype(np.intp),
        template.uv[points % len(template.uv)].astype(np.float32),
        triangulate(charted.reshape(-1, 4)),
        bones,
        weights.astype(np.float32),
        np.stack([share(part == k) for k in range(len(BODY_PARTS))], 1),
        share(np.array(["Hand" in name for name in rig.names])),
        share(np.array(["Foot" in name or "Toe" in name for name in rig.names])),
        head,
        np.isin(ids, np.unique(template.quads[template.faces("left_eye", "right_eye")])),
        _ears(human.space.mean[ids], head > MIN_SURE_HEAD_WEIGHT),
        tuple(rig.names),
    )


def _ears(places: NDArray[np.floating], head: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which vertices (V,) at rest, `places` (V, 3), are ears': what is around the points of the `head` (V,) that are furthest aside."""
    ears = np.zeros(len(places), np.bool_)
    for side in (1, -1):
        aside = side * places[:, 0]
        tip = np.flatnonzero(head)[np.argmax(aside[head])]
        near = np.linalg.norm(places - places[tip], axis=1) < EAR_RADIUS_METRES
        ears |= near & (aside > aside[tip] - EAR_DEPTH_METRES) & head
    return ears
