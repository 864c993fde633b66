"""Points that silhouettes alone tell of: along a rim of the person's outline the line of sight touches the surface.

Where it does is known as well as the line lies within the visual hull; since it runs along the surface there, even half of
that is hardly an error across it. Source: R. Cipolla, P. Giblin, Visual Motion of Curves and Surfaces, Cambridge University
Press 2000, chapter 2 (contour generators and their normals).
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.avatar.capture.captured_view import CapturedView
from engine.geometry.multiview.visual_hull import VisualHull, depth_range
from engine.geometry.point_clouds.point_cloud import PointCloud

MAX_CHORD_METRES = 0.25
"""Metres within the hull up to which the middle is taken for where the line of sight touches the person."""
NORMAL_BLUR_PIXELS = 1.5
"""Pixels of the Gaussian by which the outline is smoothed before it tells normals."""
PICTURE_BORDER_PIXELS = 2
"""Pixels at a picture's borders where an outline is that of the picture."""


def rim_points(view: CapturedView, hull: VisualHull) -> PointCloud:
    """The points where lines of sight along a view's outline touch the person, with normals out of it. The view's camera has
    no distortion."""
    figure = view.figure.astype(np.uint8)
    rim = view.figure & (cv2.erode(figure, np.ones((3, 3), np.uint8)) == 0)
    inner = np.zeros_like(rim)
    inner[PICTURE_BORDER_PIXELS:-PICTURE_BORDER_PIXELS, PICTURE_BORDER_PIXELS:-PICTURE_BORDER_PIXELS] = True
    reach = depth_range(hull, view.camera, rim & inner)
    y, x = np.nonzero((reach[..., 0] > 0) & (reach[..., 1] - reach[..., 0] < MAX_CHORD_METRES))
    pixels = np.stack([x, y], axis=-1).astype(np.float64)
    points = view.camera.unproject(pixels, reach[y, x].mean(axis=-1))
    normals = _outward(figure, view, pixels, x, y)
    return PointCloud(points.astype(np.float32), normals.astype(np.float32), view.image[y, x])


def _outward(
    figure: NDArray[np.uint8], view: CapturedView, pixels: NDArray[np.float64], x: NDArray[np.intp], y: NDArray[np.intp]
) -> NDArray[np.float64]:
    """(N, 3) unit normals of the surface at an outline's pixels: across the outline and across the line of sight."""
    blurred = cv2.GaussianBlur(figure.astype(np.float32), (0, 0), NORMAL_BLUR_PIXELS)
    right, down = -cv2.Sobel(blurred, cv2.CV_32F, 1, 0)[y, x], -cv2.Sobel(blurred, cv2.CV_32F, 0, 1)[y, x]
    axes = np.array(view.camera.axes)
    out = right[:, None] * axes[0] - down[:, None] * axes[1]
    sight = view.camera.rays(pixels)
    out = out - sight * ((out * sight).sum(axis=1) / (sight * sight).sum(axis=1))[:, None]
    return np.asarray(out / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-12))
