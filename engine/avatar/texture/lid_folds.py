"""Skin of the lids that lies in their folds while eyes are open, and comes out of them when they shut."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.registration.eyes.eyeballs import sphere
from engine.geometry.camera import Camera
from engine.render.rasterisation.visibility import depth_buffer, seen_points, view_cosines

LID_FOLD_EYE_WIDTHS = 0.25
"""Widths of an eye from the rims of its lids within which skin may lie in a fold."""
CAMERA_DISTANCE_METRES, PICTURE_WIDTH_PIXELS, PICTURE_WIDTH_METRES = 0.5, 480, 0.06
"""Metres from the eye to the camera that looks at it, and the pixels and the metres at the eye that its picture is wide."""
MIN_LID_VIEW_COSINE = 0.35
"""Cosine to the way to the eye's camera. Skin that is seen more from the side is in the shade of lids and lashes, as
what is in the fold is."""
CLOSING_ROUNDS = 2
"""Rounds in which triangles of the upper lid that share two corners with what lies in the fold are counted with it:
what shows of them at rest is narrower than lashes."""
LID_VISIBILITY_TOLERANCE_METRES = 5e-4
"""Metres behind the surface at which a triangle's middle is seen."""


def in_lid_fold(
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    rim: NDArray[np.integer],
    eyeball: NDArray[np.integer],
) -> NDArray[np.bool_]:
    """(T,) which of the triangles (T, 3) of a skin meet the `rim` of an eye's lids, or are near it and not seen from before the
    `eyeball`.

    Both are numbers of `vertices` (V, 3), metres. Frames from below or aside do see some of them, at grazing angles, and show
    lashes, shadow and eyeball there; what shut lids show is skin. At the rim itself pixels are of lid and eyeball both.
    """
    middle = sphere(vertices[eyeball])[0]
    loop = vertices[rim]
    ahead = loop.mean(0) - middle
    half = (PICTURE_WIDTH_PIXELS - 1) / 2
    lens = Camera(
        (0.0, 0.0, 0.0),
        PICTURE_WIDTH_PIXELS * CAMERA_DISTANCE_METRES / PICTURE_WIDTH_METRES,
        (half, half),
        (PICTURE_WIDTH_PIXELS, PICTURE_WIDTH_PIXELS),
    )
    camera = lens.aimed(middle + CAMERA_DISTANCE_METRES * ahead / np.linalg.norm(ahead), middle)
    corners = np.asarray(triangles)
    middles = vertices[corners].mean(1)
    reach = LID_FOLD_EYE_WIDTHS * float(np.ptp(loop, axis=0).max())
    near = np.flatnonzero(np.isfinite(cKDTree(loop).query(middles, distance_upper_bound=reach)[0]))
    a, b, c = (vertices[corners[near, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    seen = seen_points(
        depth_buffer(camera, vertices, corners), camera.project(middles[near]), LID_VISIBILITY_TOLERANCE_METRES
    )
    seen &= view_cosines(camera, middles[near], normals) > MIN_LID_VIEW_COSINE
    upper = _above_corners(camera.project(middles[near]), camera.project(loop))
    hidden = ~seen
    for _ in range(CLOSING_ROUNDS):
        touched = np.zeros(len(vertices), np.bool_)
        touched[corners[near[hidden]]] = True
        hidden |= upper & (touched[corners[near]].sum(1) >= 2)
    out = np.zeros(len(corners), np.bool_)
    out[near[hidden]] = True
    return out | np.isin(corners, rim).any(1)


def _above_corners(pixels: NDArray[np.float32], rim: NDArray[np.float32]) -> NDArray[np.bool_]:
    """(N,) which of the places (N, 3) in a picture are above the line between both ends of a rim (R, 3)."""
    first, last = rim[np.argmin(rim[:, 0])], rim[np.argmax(rim[:, 0])]
    return np.asarray(pixels[:, 1] < np.interp(pixels[:, 0], [first[0], last[0]], [first[1], last[1]]))
