"""The sides of head and body: where the back's colours begin, and how they are laid over the surface.

Seen from the front, a head or a trunk shows its sides in a pixel or two, stretched over a third of it. So the back's
colours begin there, within the outline. From there to the middle of the back they are laid at the pace of the surface,
as if it were round: an inch of painted hair or cloth is an inch wherever it is seen from.
"""

from __future__ import annotations

from dataclasses import fields, replace

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from engine.character.surface.front_and_back import ClosedMesh
from engine.imaging.masks.mask_distance import dilate_mask

MIN_ROUND_HALF_WIDTH_PIXELS = 4.0
"""Pixels from the outline to the middle from which something is round."""
DISTANCE_SMOOTHING_PIXELS = 1.5
"""Pixels by which distances from the outline are smoothed: their gradients lead inward."""
DESCENT_STEP_PIXELS, MAX_DESCENT_STEPS = 0.5, 120
"""How the way inward is followed, pixels."""
MIN_INWARD_SLOPE = 0.4
"""How fast the distance must grow on the way, or it is at the middle."""
BACK_BLEND_PIXELS = 10.0
"""Pixels over which the back's colours come to lie as they are on the rest of the body, if there is any; they begin to at half as many
within."""


def with_round_sides(
    mesh: ClosedMesh,
    where: NDArray[np.bool_],
    face: NDArray[np.bool_],
    body_layer: int,
    upright: NDArray[np.bool_] | None = None,
) -> ClosedMesh:
    """The mesh whose outermost triangles of the front take the back's colours where they are `where` (h, w) the body is round, and whose
    back takes them at the pace of the surface. Where the `face` (h, w) comes to the outline, as a turned one's does, its cheek
    goes on. What is `upright` (h, w), trunk and legs, keeps its height: a belt or a hem goes round level."""
    body = mesh.layer == body_layer
    met = mesh.pixels(np.flatnonzero(body), where.shape).astype(np.uint8)
    whole = cv2.morphologyEx(met, cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8)) > 0  # its border lies between pixels
    near = dilate_mask(where, 2)  # a border lies between pixels
    rest = (whole & ~near).astype(np.uint8)
    on_it = body & near[_pixels(mesh, where.shape)]
    triangles = mesh.triangles
    outermost = mesh.front[triangles].all(1) & (mesh.rim & on_it)[triangles].any(1) & on_it[triangles].all(1)
    outermost &= ~face[_pixels(mesh, where.shape)][triangles].any(1)
    if not outermost.any():
        return mesh
    joined, copied = _with_copies(mesh, outermost)
    within, without = (cv2.distanceTransform(one.astype(np.uint8), cv2.DIST_L2, 5) for one in (whole, ~whole))
    depth = np.where(whole, within - 0.5, 0.5 - without)
    share = np.clip(np.asarray(cv2.distanceTransform(1 - rest, cv2.DIST_L2, 5)) / BACK_BLEND_PIXELS - 0.5, 0, 1)
    y, x = _pixels(joined, where.shape)
    back = (joined.layer == body_layer) & ~joined.front & near[y, x]
    moved = np.flatnonzero(back & (joined.rim | ~copied))  # and not the seam
    start = joined.vertices[moved, :2]
    places = joined.places.copy()
    laid = _at_the_surfaces_pace(start, depth.astype(np.float32), seam_depth=1.0)
    way = share[y[moved], x[moved], None] * (laid - start)
    if upright is not None:
        level = cv2.blur(upright.astype(np.float32), (round(BACK_BLEND_PIXELS), round(BACK_BLEND_PIXELS)))
        way[:, 1] *= 1 - level[y[moved], x[moved]]
    places[moved] = start + way
    return replace(joined, places=places)


def _pixels(mesh: ClosedMesh, shape: tuple[int, ...]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Row and column of the pixel of the grid in which each vertex is, (V,) each."""
    x, y = np.clip(np.rint(mesh.vertices[:, :2]), 0, [shape[1] - 1, shape[0] - 1]).astype(np.intp).T
    return y, x


def _with_copies(mesh: ClosedMesh, chosen: NDArray[np.bool_]) -> tuple[ClosedMesh, NDArray[np.bool_]]:
    """The mesh with the `chosen` triangles (T,) coloured as the back is: their corners are there once more, for them; and
    which vertices these are (V,)."""
    corners = np.unique(mesh.triangles[chosen])
    again = np.arange(len(mesh.vertices))
    again[corners] = len(mesh.vertices) + np.arange(len(corners))
    triangles = mesh.triangles.copy()
    triangles[chosen] = again[triangles[chosen]]
    more = {
        name: np.concatenate([getattr(mesh, name), getattr(mesh, name)[corners]])
        for name in (field.name for field in fields(mesh) if field.name not in ("triangles", "front"))
    }
    front = np.concatenate([mesh.front, np.zeros(len(corners), np.bool_)])
    used, renumbered = np.unique(triangles, return_inverse=True)
    kept = {name: values[used] for name, values in (more | {"front": front}).items()}
    joined = replace(mesh, triangles=renumbered.reshape(triangles.shape).astype(np.int32), **kept)
    return joined, np.asarray(used >= len(mesh.vertices))


def _at_the_surfaces_pace(
    start: NDArray[np.float64], depth: NDArray[np.float32], seam_depth: float
) -> NDArray[np.float64]:
    """Places (N, 2) for points (N, 2) of the back, further inward: a picture's outermost pixels would be stretched
    most. The way leads from the seam on the front, `seam_depth` within the outline, over the outline to the middle.
    Each share of it on the picture is the same share on the surface. `depth` (h, w): distances from the outline."""
    soft = np.asarray(cv2.GaussianBlur(depth, (0, 0), DISTANCE_SMOOTHING_PIXELS), np.float32)
    slope = [
        np.asarray(cv2.Sobel(soft, cv2.CV_32F, *axis, ksize=3, scale=1 / 8), np.float32) for axis in ((1, 0), (0, 1))
    ]
    way, reached = [start], [_sampled(soft, start)]
    going = np.arange(len(start))
    for _ in range(MAX_DESCENT_STEPS):
        here = way[-1][going]
        towards = np.stack([_sampled(one, here) for one in slope], 1)
        towards /= np.maximum(np.linalg.norm(towards, axis=1, keepdims=True), 1e-6)
        ahead = here + DESCENT_STEP_PIXELS * towards
        there = _sampled(soft, ahead)
        further = there - reached[-1][going] > MIN_INWARD_SLOPE * DESCENT_STEP_PIXELS
        going = going[further]
        if not len(going):
            break
        way.append(way[-1].copy())
        reached.append(reached[-1].copy())
        way[-1][going], reached[-1][going] = ahead[further], there[further]
    places, depths = np.stack(way), np.stack(reached)
    first, thick = depths[0], np.maximum(depths[-1], 1e-6)
    behind = np.arccos(np.clip(1 - np.maximum(first, 0) / thick, -1, 1))
    before = np.arccos(np.clip(1 - seam_depth / thick, -1, 1))
    wanted = seam_depth + (before + behind) / (before + np.pi / 2) * (thick - seam_depth)
    after = np.argmax(depths >= np.minimum(wanted, depths[-1])[None], axis=0)
    at = np.maximum(after - 1, 0)
    number = np.arange(len(start))
    low, high = depths[at, number], depths[after, number]
    share = np.clip((wanted - low) / np.maximum(high - low, 1e-6), 0, 1)[:, None]
    laid = places[at, number] + share * (places[after, number] - places[at, number])
    return np.where((thick > MIN_ROUND_HALF_WIDTH_PIXELS)[:, None], laid, start)


def _sampled(image: NDArray[np.float32], at: NDArray[np.float64]) -> NDArray[np.float64]:
    """An image (h, w) between its pixels at places (N, 2)."""
    return np.asarray(map_coordinates(image, at[:, ::-1].T, np.float64, order=1, mode="nearest"))
