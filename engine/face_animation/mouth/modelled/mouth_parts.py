"""The modelled parts of a mouth: rows of teeth, a tongue, and the bag behind the lips, which is tied to them.

Teeth are the actor's crowns (`engine.performances.modelling.teeth`), the tongue is the template's; the bag is made of rings that begin at the inner lips,
so that whatever these do nothing shows through.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.body.face.face_points import PICTURE_TO_TEMPLATE
from engine.body.subdivision import Subdivision, catmull_clark
from engine.body.template import Template, load_template
from engine.face_animation.mouth.modelled.resting_mouth import RestingMouth
from engine.geometry.mesh.surface import triangulate
from engine.perception.face.landmarks import LIPS_INNER
from engine.performances.modelling.teeth import LOWER_CROWNS, UPPER_CROWNS, Arch, build_dentition

EYE_DISTANCE_METRES = 0.063
"""Metres between the middles of the eyes: people's mean."""
CROWN_DETAIL_SHARE, CROWN_UNEVENNESS_SHARE = 0.4, 0.35
"""Of the crowns' meshes; and of what sets single crowns off their row: on faces of some eighty pixels their edges would become steps."""
OVERBITE_EYE_DISTANCES, OVERJET_EYE_DISTANCES = 0.03, 0.05
"""Eye distances by which lower teeth end above the upper ones' edges, and lie behind them, where the jaw is closed."""
TONGUE_SIZE_SHARES = (1.0, 0.5, 0.45)
"""Of the template's tongue, along x, y and z from its tip: so that it lies within the row of teeth, and its root within a face without a neck."""
TONGUE_ARCH_EYE_DISTANCES, TONGUE_DOME_EYE_DISTANCES = 0.08, 0.2
"""Eye distances by which a tongue's back is higher in the middle of its length than at its ends, and its middle than its sides, as at rest: the template's is flat,
and seen from the front a block with a straight border."""
TONGUE_JAW_SHARE = 0.8
"""Of the jaw's angle, by which the tongue lies lower where it opens: its back is lifted off the floor of the mouth."""
TONGUE_SECTIONS = 8
"""Of the tongue, in which its width is told."""
UPPER_GUM_EYE_DISTANCES, LOWER_GUM_EYE_DISTANCES = 0.34, 0.2
"""Eye distances from the crowns' edges up to which there is gum."""
UPPER_ROW_DEPTH_EYE_DISTANCES, LOWER_ROW_DEPTH_EYE_DISTANCES = 0.5, 0.25
"""Eye distances from their front up to which there are teeth: the face has no more room, and of lower molars, which lie in the dark beside the tongue, specks would
be seen."""
BAG_RINGS = (
    (0.0, 0.0, 0.0, 1.0),
    (0.04, 0.1, 0.1, 1.03),
    (0.15, 0.25, 0.25, 1.15),
    (0.25, 0.12, 0.28, 1.1),
    (0.55, -0.35, 0.3, 0.5),
)
"""Of the bag: eye distances behind the lips, by which its roof is higher and its floor deeper than their opening, and its share of their width. Behind the teeth the
roof comes down as a palate does, so that this is seen above a tongue, and the throat, which is dark, just above its back: a wall there is one flat dark band."""
BAG_BOTTOM_EYE_DISTANCES = 0.05
"""Eye distances behind the last ring at which the bag ends."""
CROWN_SHADE_FACTORS = (0.9, 1.1)
"""Of single crowns, the darkest and the lightest."""
BACKING_DEPTH_METRES, BACKING_HEIGHT_SHARES, BACKING_LIGHT_SHARE = 0.0022, (-0.2, 0.93), 0.45
"""The wall that closes the gaps between crowns: metres behind the front of the arch, the shares of the crowns' heights
from and up to which it is there, and its share of their light. Without it the dark of the throat stands between teeth
as lines; as light as they it makes one bar of the row."""
BACKING_COLUMNS = 48


@dataclass(frozen=True)
class MouthPart:
    """A surface in the mouth, the jaw closed: of a head from the front, in eye distances, y down and z away.

    vertices : (V, 3) float64.
    triangles : (T, 3) int32, counter-clockwise from outside.
    uv : (V, 2) float32 on the part's ramp of colours (`engine.face_animation.mouth.modelled.mouth_colours`).
    light : (V,) float32, what is left of the light where others stand before it.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    uv: NDArray[np.float32]
    light: NDArray[np.float32]


def modelled_teeth(at: RestingMouth, upper: bool) -> MouthPart:
    """A row of teeth, its gum, and the wall behind them: u from the gum to the crowns' edges, v the crowns' own shades."""
    arch = Arch(gum=0.0, front=0.0, up=-1 if upper else 1)
    row = build_dentition(arch, CROWN_DETAIL_SHARE, seed=3 if upper else 4, unevenness=CROWN_UNEVENNESS_SHARE)
    wall, wall_triangles = _backing(arch)
    places = _in_eye_distances(np.concatenate([row.vertices, wall]))
    enamel = np.concatenate([row.enamel, np.full(len(wall), 0.5)])
    light = np.concatenate([np.ones(len(row.vertices)), np.full(len(wall), BACKING_LIGHT_SHARE)]).astype(np.float32)
    crowns = enamel[: len(row.vertices)] > 0.5
    heights = places[: len(crowns)][crowns, 1]
    edge, front = heights.max() if upper else heights.min(), places[:, 2].min()
    shift = (
        (at.middle, at.edge, at.depth)
        if upper
        else (at.middle, at.edge - OVERBITE_EYE_DISTANCES, at.depth + OVERJET_EYE_DISTANCES)
    )
    shade = (np.concatenate([row.shade, np.ones(len(wall))]) - CROWN_SHADE_FACTORS[0]) / (
        CROWN_SHADE_FACTORS[1] - CROWN_SHADE_FACTORS[0]
    )
    uv = np.column_stack([(enamel + 1) / 2, shade]).clip(0, 1).astype(np.float32)
    away = np.abs(places - (0, edge, front))
    triangles = np.concatenate([row.triangles, wall_triangles + len(row.vertices)])
    kept = (
        (away[:, 1] < (UPPER_GUM_EYE_DISTANCES if upper else LOWER_GUM_EYE_DISTANCES))
        & (away[:, 2] < (UPPER_ROW_DEPTH_EYE_DISTANCES if upper else LOWER_ROW_DEPTH_EYE_DISTANCES))
    )[triangles].all(axis=1)
    known, triangles = np.unique(triangles[kept], return_inverse=True)
    placed = places[known] - (0, edge, front) + shift
    return MouthPart(placed, triangles.reshape(-1, 3).astype(np.int32), uv[known], light[known])


def _backing(arch: Arch) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Vertices (V, 3), metres, and triangles of the wall behind the crowns of an arch."""
    widths, tall = np.array(UPPER_CROWNS if arch.up < 0 else LOWER_CROWNS).T / 1000
    ends = 0.985 * np.cumsum(widths)
    length = np.linspace(-ends[-1], ends[-1], BACKING_COLUMNS)
    place, outward = arch.place(length)
    ground = place - BACKING_DEPTH_METRES * outward / np.linalg.norm(outward, axis=1, keepdims=True)
    crown = np.interp(np.abs(length), ends - widths / 2, tall)
    rows = [
        np.column_stack([ground[:, 0], arch.gum + arch.up * share * crown, ground[:, 1]])
        for share in BACKING_HEIGHT_SHARES
    ]
    first = np.arange(BACKING_COLUMNS - 1)
    below, after = first + BACKING_COLUMNS, first + 1
    pairs = [(first, below, after), (after, below, below + 1)]
    triangles = np.concatenate([np.stack(three if arch.up < 0 else three[::-1], axis=1) for three in pairs])
    return np.concatenate(rows), triangles.astype(np.int32)


def tongue(at: RestingMouth) -> MouthPart:
    """The tongue, as it lies behind the lower teeth: u from its tip to its root, v from its middle to its sides."""
    template = load_template()
    known, finer = _tongue(template)
    lower = _in_eye_distances(template.vertices[template.vertices_of("lower_teeth")])
    places = finer.points @ (_in_eye_distances(template.vertices[known]) - (0, lower[:, 1].min(), lower[:, 2].min()))
    tip = np.array([0, places[:, 1].min(), places[:, 2].min()])
    places = tip + (places - tip) * TONGUE_SIZE_SHARES
    depth = (places[:, 2] - places[:, 2].min()) / np.ptp(places[:, 2])
    aside = np.abs(places[:, 0]) / _half_width(places[:, 0], depth)
    places[:, 1] -= TONGUE_ARCH_EYE_DISTANCES * np.sin(np.pi * depth)
    places[:, 1] += TONGUE_DOME_EYE_DISTANCES * np.minimum(aside, 1) ** 2
    shift = np.array([at.middle, at.edge - OVERBITE_EYE_DISTANCES, at.depth + OVERJET_EYE_DISTANCES])
    uv = np.column_stack([depth, aside]).astype(np.float32)
    return MouthPart(places + shift, triangulate(finer.quads), uv, np.ones(len(uv), np.float32))


def _half_width(across: NDArray[np.floating], depth: NDArray[np.floating]) -> NDArray[np.float64]:
    """(V,) how wide to one side a tongue is at the `depth` (V,) in [0, 1] of each of its vertices, which lie `across` (V,) of its middle."""
    section = np.minimum((depth * TONGUE_SECTIONS).astype(int), TONGUE_SECTIONS - 1)
    widest = np.full(TONGUE_SECTIONS, 1e-6)
    np.maximum.at(widest, section, np.abs(across))
    return np.asarray(np.interp(depth, (np.arange(TONGUE_SECTIONS) + 0.5) / TONGUE_SECTIONS, widest), np.float64)


def tongue_put_out() -> NDArray[np.float64]:
    """(V, 3) by how much ARKit's `tongueOut` moves the vertices of the tongue, eye distances."""
    template = load_template()
    known, finer = _tongue(template)
    return np.asarray(finer.points @ _in_eye_distances(template.face_units.displacement({"tongueOut": 1.0})[known]))


def _tongue(template: Template) -> tuple[NDArray[np.integer], Subdivision]:
    """The template's vertices that are the tongue's, and how they become finer ones."""
    quads = template.quads[slice(*template.parts["tongue"])]
    known, index = np.unique(quads, return_inverse=True)
    return known, catmull_clark(index.reshape(quads.shape), len(known))


def mouth_bag(lips: NDArray[np.floating], deeper: float = 1.0, width: float = 0.0) -> NDArray[np.float64]:
    """(V, 3) the vertices of the bag behind inner `lips` (20, 3), in the order of `LIPS_INNER`: rings, and its end; so many times `deeper`
    than a face without a neck has room for. Behind lips that are narrower than `width`, rounded as they are, it is as wide as that: the tongue is,
    too."""
    lips = np.asarray(lips, np.float64)
    middle = lips.mean(axis=0)
    wider = max(1.0, width / max(float(np.ptp(lips[:, 0])), 1e-6))
    up = _up(len(lips))
    rings = []
    for depth, higher, lower, share in BAG_RINGS:
        ring = middle + (lips - middle) * (share * (wider if depth > 0 else 1), 1, 1)
        ring[:, 1] += np.where(up < 0, higher, lower) * up
        ring[:, 2] += deeper * depth
        rings.append(ring)
    end = rings[-1].mean(axis=0) + np.array([0, 0, deeper * BAG_BOTTOM_EYE_DISTANCES])
    return np.concatenate([*rings, end[None]])


def bag_surface() -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """(T, 3) the bag's triangles, seen from within, and (V, 2) its places on its ramp: u from the lips to the throat, v from its roof
    to its floor."""
    count = len(LIPS_INNER)
    index = np.arange(len(BAG_RINGS) * count).reshape(len(BAG_RINGS), count)
    after = np.roll(index, -1, axis=1)
    walls = [
        np.stack([index[:-1], index[1:], after[1:]], axis=-1).reshape(-1, 3),
        np.stack([index[:-1], after[1:], after[:-1]], axis=-1).reshape(-1, 3),
    ]
    end = np.stack([index[-1], np.full(count, index.size), after[-1]], axis=-1)
    depth = np.append(
        np.repeat([ring[0] for ring in BAG_RINGS], count), BAG_RINGS[-1][0] + BAG_BOTTOM_EYE_DISTANCES
    ) / (BAG_RINGS[-1][0] + BAG_BOTTOM_EYE_DISTANCES)
    floor = np.append(np.tile((1 + _up(count)) / 2, len(BAG_RINGS)), 0.5)
    return np.concatenate([*walls, end]).astype(np.int32), np.column_stack([depth, floor]).astype(np.float32)


def _up(count: int) -> NDArray[np.float64]:
    """(count,) along a ring of the bag, in the order of `LIPS_INNER`: from corner over the upper lip, -1, to corner, and back, y down."""
    return np.asarray(-np.sin(2 * np.pi * np.arange(count) / count), np.float64)


def _in_eye_distances(places: NDArray[np.floating]) -> NDArray[np.float64]:
    return np.asarray(places, np.float64) @ PICTURE_TO_TEMPLATE / EYE_DISTANCE_METRES
