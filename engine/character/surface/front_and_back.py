"""Front and back of each part made into one closed mesh (the paper's sections 4.1.3 and 4.2.3).

Each part is a sheet of pixels: two triangles for each block of four, the front and the back sheet joined along their
border. Parts are not sewn to one another: they overlap where a limb begins (`engine.character.parts.regions`), and what overlaps
moves alike.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from engine.character.surface.part_surface import Surface
from engine.character.surface.rim import joining_strip, smoothed_border, to_the_edge
from engine.character.surface.solid_limb import SolidLimb, places_on_the_picture
from engine.geometry.mesh.adjacency import open_edges
from engine.geometry.rigging.skinning import MAX_VERTEX_INFLUENCES
from engine.render.rasterisation.rasteriser import rasterise

MIN_HALF_DEPTH_PIXELS, MIN_BORDER_HALF_DEPTH_PIXELS = 0.5, 0.3
"""Pixels between the middle and each side, at least, inside a part; and at its border."""
LIMB_OFFSET_PIXELS = 0.2
"""Pixels by which a limb lies before the body where both have the same depth: about the joint they overlap."""
CUT_GAP_PIXELS = 0.02
"""Pixels of depth between the two sides of a cut, which are otherwise in one place."""


@dataclass(frozen=True)
class Layer:
    """One part: its pixels `mask` (H, W) and both its sides.

    cut : (H, W) int8, if it is cut: where a 1 lies beside a 2 the part is not joined (one leg and the other).
    solid : what the part is made of in place of a sheet.
    limb : which that is, an index of `BODY_PARTS`; -1 for the body.
    hem : (H, W) where more than 0, border is a hem. Front and back end there as far apart as they are, and inside they
        are joined so many pixels further up.
    """

    mask: NDArray[np.bool_]
    front: Surface
    back: Surface
    cut: NDArray[np.int8] | None = None
    hem: NDArray[np.float32] | None = None
    solid: SolidLimb | None = None
    limb: int = -1


@dataclass(frozen=True)
class ClosedMesh:
    """A mesh in picture space.

    vertices : (V, 3) float64, x, y, z.
    triangles : (T, 3) int32, counter-clockwise seen from outside for one who looks at the picture.
    front : (V,) of the front sheet; vertices on a border are there twice, where it meets the front's colours and the back's.
    rim : (V,) on such a border, where it is no hem.
    layer : (V,) the part.
    limb : (V,) which limb that is, -1 for the body.
    bones, weights : (V, 4) the strongest influences, strongest first, summing to one.
    places : (V, 2) x and y of the pixel whose colour a vertex takes, where that is not its own; else NaN.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    front: NDArray[np.bool_]
    rim: NDArray[np.bool_]
    layer: NDArray[np.intp]
    limb: NDArray[np.int8]
    bones: NDArray[np.uint8]
    weights: NDArray[np.float32]
    places: NDArray[np.float64]

    def pixels(self, vertices: NDArray[np.intp], shape: Sequence[int]) -> NDArray[np.bool_]:
        """The pixels (h, w) of the grid in which some of the vertices are, by index."""
        x, y = np.clip(np.rint(self.vertices[vertices, :2]), 0, [shape[1] - 1, shape[0] - 1]).astype(int).T
        covered = np.zeros((shape[0], shape[1]), np.bool_)
        covered[y, x] = True
        return covered

    def seen_layer(self, size: tuple[int, int]) -> NDArray[np.intp]:
        """The part that is nearest to the viewer at each pixel of the grid `size` (height, width), -1 beside all."""
        raster = rasterise(self.vertices * [1, 1, -1], self.triangles, size)
        layer = self.layer[self.triangles[:, 0]]
        return np.where(raster.triangle >= 0, layer[raster.triangle], -1)


def stitch_front_and_back(
    layers: Sequence[Layer], soft: NDArray[np.float32], limbs: Mapping[int, NDArray[np.float32]] = MappingProxyType({})
) -> ClosedMesh:
    """Join front and back of each part into a mesh without open borders.

    `soft` (H, W) [0, 1] is the person's mask: where a border lies along its edge, it is moved to where the mask is 0.5,
    between the pixels. `limbs`: the same of each limb alone, by its index, for its own border.
    """
    places, owners, sources, triangles = _sheet(layers)
    count = len(places)
    rim = open_edges(triangles)
    border = np.zeros(count, np.bool_)
    border[rim.ravel()] = True
    ys, xs = places.T
    z = [np.zeros(count), np.zeros(count)]
    weights = [np.zeros((count, layers[0].front.weights.shape[-1]), np.float32) for _ in range(2)]
    for k, layer in enumerate(layers):
        if layer.solid is not None:
            continue
        own = owners == k
        for side, surface in enumerate((layer.front, layer.back)):
            z[side][own] = surface.depth[ys[own], xs[own]]
            weights[side][own] = surface.weights[sources[own, 0], sources[own, 1]]
    shared = (weights[0] + weights[1]) / 2
    for one in weights:
        one[border] = shared[border]
    middle = (z[0] + z[1]) / 2 + LIMB_OFFSET_PIXELS * owners + CUT_GAP_PIXELS * (sources != places).any(1)
    up = np.zeros(count)
    for k, layer in enumerate(layers):
        if layer.hem is not None:
            up[owners == k] = layer.hem[ys, xs][owners == k]
    hem = np.zeros(count, np.bool_)
    hem[rim[(up[rim] > 0).all(1)].ravel()] = True
    half = np.maximum((z[0] - z[1]) / 2, MIN_HALF_DEPTH_PIXELS)
    half[border & ~hem] = MIN_BORDER_HALF_DEPTH_PIXELS
    points = smoothed_border(np.stack([xs, ys, middle], 1).astype(np.float64), rim)
    for k, layer in enumerate(layers):
        if (own := border & (owners == k)).any():
            points[own, :2] = to_the_edge(points[own, :2], np.minimum(soft, limbs.get(layer.limb, soft)))
    deep = np.outer(half, [0, 0, 1])
    edge = np.unique(rim)  # once more, for the strip between the sheets, which is coloured as the front is
    inside = np.flatnonzero(hem)
    again, within = np.full((2, count), -1)
    again[edge] = 2 * count + np.arange(len(edge))
    within[inside] = 2 * count + len(edge) + np.arange(len(inside))
    strip = joining_strip(rim, again, within)
    of = np.concatenate([np.arange(count), np.arange(count), edge, inside])
    further_up = points[inside] - np.outer(up[inside], [0, 1, 0])
    bones, kept = strongest(np.concatenate([*weights, weights[1][edge], weights[1][inside]]))
    mesh = ClosedMesh(
        vertices=np.concatenate([points + deep, points - deep, (points - deep)[edge], further_up]),
        triangles=np.concatenate([triangles, triangles[:, ::-1] + count, strip]).astype(np.int32),
        front=np.repeat([True, False, True], [count, count, len(edge) + len(inside)]),
        rim=(border & ~hem)[of] & (np.arange(len(of)) < 2 * count + len(edge)),
        layer=owners[of],
        limb=np.array([layer.limb for layer in layers], np.int8)[owners[of]],
        bones=bones,
        weights=kept,
        places=np.full((len(of), 2), np.nan),
    )
    return _with_solids(mesh, layers)


def _with_solids(mesh: ClosedMesh, layers: Sequence[Layer]) -> ClosedMesh:
    """The mesh together with the parts that are no sheets."""
    solid = [(k, layer.solid) for k, layer in enumerate(layers) if layer.solid is not None]
    meshes = [mesh]
    for (k, limb), places in zip(solid, places_on_the_picture([limb for _, limb in solid]), strict=True):
        count = len(limb.vertices)
        bones, weights = strongest(limb.weights)
        neither = np.zeros(count, np.bool_)
        which = np.full(count, layers[k].limb, np.int8)
        vertices = limb.vertices + np.array([0, 0, LIMB_OFFSET_PIXELS * k])
        meshes.append(
            ClosedMesh(vertices, limb.triangles, ~neither, neither, np.full(count, k), which, bones, weights, places)
        )
    before = np.cumsum([0, *(len(one.vertices) for one in meshes)])
    joined = {field.name: np.concatenate([getattr(one, field.name) for one in meshes]) for field in fields(ClosedMesh)}
    joined["triangles"] = np.concatenate(
        [one.triangles + start for one, start in zip(meshes, before[:-1], strict=True)]
    ).astype(np.int32)
    return ClosedMesh(**joined)


def strongest(weights: NDArray[np.float32]) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """The strongest influences of weights (V, J): joints and weights, (V, 4) each, strongest first, summing to one."""
    chosen = np.argsort(-weights, 1, kind="stable")[:, :MAX_VERTEX_INFLUENCES]
    kept = np.take_along_axis(weights, chosen, 1)
    kept = kept / np.maximum(kept.sum(1, keepdims=True), 1e-9)
    return np.where(kept > 0, chosen, 0).astype(np.uint8), kept.astype(np.float32)


def _sheet(
    layers: Sequence[Layer],
) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """The front sheets of all parts: rows and columns (N, 2), parts (N,), the pixels (N, 2) that say what moves each,
    triangles (T, 3)."""
    places, owners, sources, triangles = [], [], [], []
    count = 0
    for k, layer in enumerate(layers):
        if layer.solid is not None:
            continue
        at = np.argwhere(layer.mask)
        number = np.full(layer.mask.shape, -1, np.intp)
        number[layer.mask] = np.arange(len(at))
        blocks = _blocks(number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:])
        whole, from_where, parted = (at, at, blocks) if layer.cut is None else _parted(at, layer.cut, blocks)
        places.append(whole)
        sources.append(from_where)
        owners.append(np.full(len(whole), k))
        triangles.append(parted + count)
        count += len(whole)
    found = _without_pinches(np.concatenate(triangles), count)
    used, renumbered = np.unique(found, return_inverse=True)
    kept = [np.concatenate(one)[used] for one in (places, owners, sources)]
    return kept[0], kept[1], kept[2], renumbered.reshape(found.shape)


def _parted(
    at: NDArray[np.intp], cut: NDArray[np.int8], triangles: NDArray[np.intp]
) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """A sheet of pixels (n, 2) cut where side 1 meets side 2. A triangle of both goes with side 1. For that it gets
    corners of its own in the same places, moved as the nearest pixel of that side is."""
    side = cut[at[:, 0], at[:, 1]]
    corners = side[triangles]
    both = (corners == 1).any(1) & (corners == 2).any(1)
    if not both.any():
        return at, at, triangles
    doubled = np.unique(triangles[both][corners[both] == 2])
    _, (rows, columns) = distance_transform_edt(cut != 1, return_indices=True)
    again = np.arange(len(at))
    again[doubled] = len(at) + np.arange(len(doubled))
    parted = triangles.copy()
    parted[both] = again[triangles[both]]
    y, x = at[doubled].T
    copies = np.stack([rows[y, x], columns[y, x]], 1)
    return np.concatenate([at, at[doubled]]), np.concatenate([at, copies]), parted


def _without_pinches(triangles: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    """Triangles without those around vertices where the sheet is joined by nothing but that vertex."""
    while True:
        passes = np.bincount(open_edges(triangles).ravel(), minlength=count)
        pinched = passes > 2
        if not pinched.any():
            return triangles
        triangles = triangles[~pinched[triangles].any(1)]


def _blocks(a: NDArray[np.intp], b: NDArray[np.intp], c: NDArray[np.intp], d: NDArray[np.intp]) -> NDArray[np.intp]:
    """Triangles of blocks with corners a b over c d; -1 is no corner. y points down: a, c, b turn counter-clockwise."""
    there = [corner >= 0 for corner in (a, b, c, d)]
    full = there[0] & there[1] & there[2] & there[3]
    found = [np.stack([a[full], c[full], b[full]], 1), np.stack([b[full], c[full], d[full]], 1)]
    corners = (a, b, c, d)
    for missing, (i, j, k) in ((0, (1, 2, 3)), (1, (0, 2, 3)), (2, (0, 3, 1)), (3, (0, 2, 1))):
        three = there[i] & there[j] & there[k] & ~there[missing]
        found.append(np.stack([corners[n][three] for n in (i, j, k)], 1))
    return np.concatenate(found)
