"""The tracked face mesh on the template's face, and what ARKit's face units do to all of its vertices.

The canonical face mesh is laid on the template and bent so that its lids and lips lie where the template's are, as
these are seen from before. Lids end where eyeballs begin, and lips part where an open jaw parts the skin. What each
vertex then lies on, moves it. `engine.body.face.face_mesh_points` has fewer vertices, those that tell most of what a
tracked face does.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RBFInterpolator
from scipy.ndimage import distance_transform_edt, minimum_filter

from engine.body.body_space import BodySpace, load_body_space
from engine.body.face.face_capture import CAPTURED_UNITS
from engine.body.face.face_points import PICTURE_TO_TEMPLATE, lay_canonical_face
from engine.body.template import Template, load_template
from engine.geometry.mesh.surface import triangulate
from engine.geometry.registration.rigid import fit_similarity
from engine.perception.face.head_pose import canonical_face, mirror_vertices
from engine.perception.face.landmarks import (
    EYE_CORNER_VERTICES,
    FACE_OVAL,
    LEFT_EYE,
    LIPS_INNER,
    LIPS_OUTER,
    RIGHT_EYE,
    RIGID_VERTICES,
    eye_distance,
)
from engine.render.rasterisation.rasteriser import Raster, rasterise

PIXELS_PER_METRE = 5000.0
"""Of the picture in which the template is looked at."""
VIEW_MARGIN_METRES = 0.01
"""Metres about the laid face that it shows."""
MOUTH_REACH_METRES = 0.012
"""Metres above and below the laid mouth within which the template's is sought."""
LIP_STEP_METRES = 0.003
"""Metres by which an open jaw moves one lip farther than the other: where it is less, nothing parts."""
PARTED_SKIN_PIXELS = 4.0
"""Pixels from where lids or lips part to the skin that is looked up."""
CREVICE_WINDOW_PIXELS, CREVICE_DEPTH_METRES = 15, 0.015
"""Pixels about a place and metres that it is deeper than the highest there: between closed lips the throat is seen."""
UPPER_LIP_RINGS = (
    LIPS_INNER[1:10],
    (183, 42, 41, 38, 12, 268, 271, 272, 407),
    (184, 74, 73, 72, 11, 302, 303, 304, 408),
    LIPS_OUTER[1:10],
)
"""Vertices between the lips' contours, from the inner one to the outer, but for the mouth's corners."""
LOWER_LIP_RINGS = (
    LIPS_INNER[11:],
    (325, 319, 403, 316, 15, 86, 179, 89, 96),
    (307, 320, 404, 315, 16, 85, 180, 90, 77),
    LIPS_OUTER[11:],
)
EYE_OUTLINE_VERTICES = {"Left": LEFT_EYE, "Right": RIGHT_EYE}
EYEBALL_PARTS = ("left_eye", "right_eye")


@dataclass(frozen=True)
class MeshUnits:
    """The template's mean face as the tracker would have it, and its face units.

    rest : (478, 3) float64, from the front, in eye distances, in the axes of pictures (y down, z away).
    names : U of `CAPTURED_UNITS`.
    moved : (U, 478, 3) float64, what each does at its full.
    """

    rest: NDArray[np.float64]
    names: tuple[str, ...]
    moved: NDArray[np.float64]


@cache
def load_mesh_units() -> MeshUnits:
    """Those of the template that comes with the program, made once."""
    return mesh_units(load_template(), load_body_space())


def mesh_units(template: Template, space: BodySpace) -> MeshUnits:
    """The units at all vertices; those of the irises move as the skin about them, lids but no eyes."""
    laid = lay_canonical_face(template, space)[1]
    view = _front_view(template, space.mean.astype(np.float64), laid)
    bent = _on_their_side(view, _bent(view, view.pixels(laid)[:, :2]), 1.0)
    at = np.clip(
        np.rint(_on_their_side(view, bent + _lids_aside(bent), PARTED_SKIN_PIXELS)),
        0,
        np.array(view.shown.shape[::-1]) - 1,
    ).astype(int)
    rows, columns = view.nearest_skin[:, at[:, 1], at[:, 0]]
    corners, weights = view.triangles[view.shown[rows, columns]], view.raster.barycentrics[rows, columns]
    depth = -view.raster.depth[rows, columns] / PIXELS_PER_METRE
    rest = np.column_stack([view.metres(bent), depth])
    units = template.face_units.dense(CAPTURED_UNITS).astype(np.float64)
    moved = np.einsum("uvkc,vk->uvc", units[:, corners], weights)
    return _as_tracked(rest @ PICTURE_TO_TEMPLATE, moved @ PICTURE_TO_TEMPLATE)


@dataclass(frozen=True)
class _FrontView:
    """The template's face from before.

    raster : which of its triangles covers each pixel.
    triangles : (T, 3).
    low : (2,) x and y of the top-left pixel, metres.
    jaw : (H, W) how far an open jaw moves what is seen.
    eyes : (H, W) bool, where eyeballs are.
    """

    raster: Raster
    triangles: NDArray[np.int32]
    low: NDArray[np.float64]
    jaw: NDArray[np.float64]
    eyes: NDArray[np.bool_]

    @property
    def shown(self) -> NDArray[np.int32]:
        return self.raster.triangle

    @property
    def nearest_skin(self) -> NDArray[np.intp]:
        """(2, H, W) rows and columns of the nearest pixel that shows skin."""
        depth = np.where(self.shown < 0, np.inf, self.raster.depth)
        within = depth > minimum_filter(depth, CREVICE_WINDOW_PIXELS) + CREVICE_DEPTH_METRES * PIXELS_PER_METRE
        none = (self.shown < 0) | self.eyes | within
        return np.asarray(distance_transform_edt(none, return_distances=False, return_indices=True), np.intp)

    def seam(self, place: NDArray[np.float64]) -> float | None:
        """The row near `place` (x, y) where lips part; None where none do."""
        reach = int(MOUTH_REACH_METRES * PIXELS_PER_METRE)
        x, y = np.rint(place).astype(int)
        steps = np.diff(self.jaw[y - reach : y + reach, x])
        return float(y - reach + steps.argmax() + 0.5) if steps.max() > LIP_STEP_METRES else None

    def pixels(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """Points (N, 3), metres, as the rasteriser takes them."""
        across, up = (points[:, :2] - self.low).T * PIXELS_PER_METRE
        return np.column_stack([across, -up, -points[:, 2] * PIXELS_PER_METRE])

    def metres(self, pixels: NDArray[np.floating]) -> NDArray[np.float64]:
        """x and y (N, 2) of pixels (N, 2)."""
        return np.asarray(pixels * (1, -1) / PIXELS_PER_METRE + self.low, np.float64)


def _front_view(template: Template, mean: NDArray[np.float64], laid: NDArray[np.float64]) -> _FrontView:
    spans = [slice(*template.parts[part]) for part in ("body", *EYEBALL_PARTS)]
    triangles = triangulate(np.concatenate([template.quads[span] for span in spans]))
    eyeballs = np.concatenate([template.vertices_of(part) for part in EYEBALL_PARTS])
    low = np.array([laid[:, 0].min() - VIEW_MARGIN_METRES, laid[:, 1].max() + VIEW_MARGIN_METRES])
    size = (np.ptp(laid[:, [1, 0]], axis=0) + 2 * VIEW_MARGIN_METRES) * PIXELS_PER_METRE
    blank = np.zeros((0, 0))
    view = _FrontView(Raster(*[blank] * 3), triangles, low, blank, blank.astype(np.bool_))  # type: ignore[arg-type]
    raster = rasterise(view.pixels(mean), triangles, (int(size[0]), int(size[1])), cull=True)
    corners = triangles[raster.triangle]
    travel = np.linalg.norm(template.face_units.displacement({"jawOpen": 1.0}), axis=1)
    jaw = np.where(raster.triangle >= 0, (travel[corners] * raster.barycentrics).sum(axis=-1), 0)
    return _FrontView(raster, triangles, low, jaw, np.isin(corners[..., 0], eyeballs) & (raster.triangle >= 0))


def _bent(view: _FrontView, laid: NDArray[np.float64]) -> NDArray[np.float64]:
    """(478, 2) pixels of the mesh's vertices, by a thin-plate spline: what is rigid stays, lids and lips go to the template's."""
    known = [*dict.fromkeys([*RIGID_VERTICES, *FACE_OVAL])]
    goals = {vertex: laid[vertex] for vertex in known}
    for vertex in LIPS_INNER:
        row = view.seam(laid[vertex])
        if row is not None:
            goals[vertex] = np.array([laid[vertex, 0], row])
    for contour in EYE_OUTLINE_VERTICES.values():
        goals |= _lids(view, laid, contour)
    vertices = list(goals)
    goal = np.array([goals[vertex] for vertex in vertices])
    bend = RBFInterpolator(laid[vertices], goal - laid[vertices], kernel="thin_plate_spline")
    out = laid + bend(laid)
    out[vertices] = goal
    return np.asarray(out)


def _lids(view: _FrontView, laid: NDArray[np.float64], contour: tuple[int, ...]) -> dict[int, NDArray[np.float64]]:
    """Where the vertices of an eye's contour go: its outer corner and its lids to the eyeball's rim. The inner corner, where the
    template has skin, stays."""
    middle = laid[list(contour)].mean(axis=0)
    columns = np.flatnonzero(view.eyes.any(axis=0))
    own = columns[np.abs(columns - middle[0]) < np.ptp(laid[list(contour), 0])]
    first, last = own.min(), own.max()
    outer = first if laid[contour[0], 0] < middle[0] else last
    goals = {contour[0]: np.array([outer, np.flatnonzero(view.eyes[:, outer]).mean()]), contour[8]: laid[contour[8]]}
    inner = laid[contour[8]]
    for place, vertex in enumerate(contour):
        if place in (0, 8):
            continue
        share = (laid[vertex, 0] - inner[0]) / (laid[contour[0], 0] - inner[0])
        x = inner[0] + share * (outer - inner[0])
        if first < x < last:
            rows = np.flatnonzero(view.eyes[:, int(np.rint(x))])
            goals[vertex] = np.array([x, rows.min() - 0.5 if place < 8 else rows.max() + 0.5])
    return goals


def _lids_aside(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """(478, 2) from lids onto the skin beside the opening: up from upper ones, down from lower ones."""
    out = np.zeros_like(places)
    for contour in EYE_OUTLINE_VERTICES.values():
        out[list(contour[1:8]), 1] = -PARTED_SKIN_PIXELS
        out[list(contour[9:]), 1] = PARTED_SKIN_PIXELS
    return out


def _on_their_side(view: _FrontView, places: NDArray[np.float64], apart: float) -> NDArray[np.float64]:
    """(478, 2) `places` whose upper lip is above where lips part, and whose lower lip is below it: the innermost vertices by `apart`
    pixels at least, each further ring by a pixel more."""
    out = places.copy()
    for rings, sign in ((UPPER_LIP_RINGS, -1), (LOWER_LIP_RINGS, 1)):
        for number, ring in enumerate(rings):
            for vertex in ring:
                row = view.seam(places[vertex])
                if row is not None:
                    least = row + sign * (apart + number)
                    out[vertex, 1] = sign * max(sign * out[vertex, 1], sign * least)
    return out


def _as_tracked(rest: NDArray[np.float64], moved: NDArray[np.float64]) -> MeshUnits:
    """Turned to the front, as `engine.perception.expression.features.frontalise` does it, the eye distance 1."""
    chosen = list(RIGID_VERTICES)
    linear = fit_similarity(rest[chosen], canonical_face()[chosen].astype(np.float64)).linear
    front = rest @ linear.T
    scale = 1 / float(eye_distance(front))
    front = (front - front[list(EYE_CORNER_VERTICES)].mean(axis=0)) * scale
    found = _symmetric(MeshUnits(front, CAPTURED_UNITS, moved @ linear.T * scale))
    for side, contour in EYE_OUTLINE_VERTICES.items():
        blink = CAPTURED_UNITS.index(f"eyeBlink{side}")
        found.moved[blink] = lids_met(found.rest, found.moved[blink], contour)
    return found


def lids_met(rest: NDArray[np.floating], moved: NDArray[np.floating], contour: tuple[int, ...]) -> NDArray[np.float64]:
    """(478, 3) a blink of the eye in `contour` that ends where lids meet: the template's upper lid slides over the lower one, a tracked
    one does not. `rest` and `moved` (478, 3): the face, and by how much the blink moves it."""
    upper, lower = np.array(contour[1:8]), np.array(contour[:8:-1])
    gap, closing = (rest[lower] - rest[upper])[:, 1], (moved[upper] - moved[lower])[:, 1]
    out = np.asarray(moved * np.median(gap / np.maximum(closing, 1e-6)), np.float64)
    out[upper] = rest[lower] + out[lower] - rest[upper]
    return out


def _symmetric(found: MeshUnits) -> MeshUnits:
    """The mean of both sides: the template has no other one, pixels have."""
    mirror, across = mirror_vertices().astype(int), np.array([-1.0, 1.0, 1.0])
    swap = {"Left": "Right", "Right": "Left"}
    other = [
        found.names.index(
            next((f"{name.removesuffix(side)}{swap[side]}" for side in swap if name.endswith(side)), name)
        )
        for name in found.names
    ]
    rest = (found.rest + found.rest[mirror] * across) / 2
    return MeshUnits(rest, found.names, (found.moved + found.moved[other][:, mirror] * across) / 2)
