"""The depth of a person's average face: its low frequencies from the mesh, its high ones from shading.

Shading alone loses the nose from the side, since it tells slopes and not how far things are; the mesh, led to where photographs have it
(`parallax`), has no more than its vertices tell.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.filling.nearest import nearest_values
from engine.perception.face.landmarks import LEFT_BROW, LEFT_EYE, LIPS_OUTER, RIGHT_BROW, RIGHT_EYE
from engine.persona.shape.photometric_stereo import photometric_stereo
from engine.persona.shape.screened_poisson import screened_poisson
from engine.persona.texture.appearance_subspace import REFERENCE_WIDTH_PIXELS, Appearance
from engine.persona.texture.texture_frame import TextureFrame

LOW_SIGMA = 8.0
"""Pixels of a frame 194 wide: slopes as wide as this are the mesh's, finer ones shading's."""
DEPTH_SCREENING_WEIGHT = 3e-3
"""Weight of the mesh's depth in a frame 194 wide, beside slopes."""
RIM_SIGMA = 4.0
"""Pixels over which shading comes in: from the face's rim, from eyes and from lips."""
FEATURE_MARGIN_PIXELS = 4
"""Pixels about eyes, brows and lips in which shading is none: they have colours of their own."""
MIN_NORMAL_Z = 0.25
"""Of a normal's part towards the viewer: slopes steeper than one in four are not believed."""
FEATURE_OUTLINES = (LIPS_OUTER, RIGHT_EYE, LEFT_EYE, RIGHT_BROW, LEFT_BROW)


def average_depth(frame: TextureFrame, seen: Appearance) -> NDArray[np.float64]:
    """(H, W) depth in pixels, away from the viewer; beside face and rim it goes on as it ends there."""
    unit = frame.size[1] / REFERENCE_WIDTH_PIXELS
    mesh = _mesh_depth(frame, unit)
    skin = _skin(frame, unit)
    shape = photometric_stereo(seen, frame.interpolated(frame.normals), frame.face, skin)
    shaded = _slopes(shape.normals)
    own = np.stack([np.gradient(mesh, axis=1), np.gradient(mesh, axis=0)], -1)
    share = cv2.GaussianBlur(cv2.erode(skin.astype(np.float32), _disk(2 * RIM_SIGMA * unit)), (0, 0), RIM_SIGMA * unit)
    off = np.where(skin[..., None], shaded - own, 0)
    finer = off - _low(off, skin, LOW_SIGMA * unit)  # shading's in place of the mesh's
    return screened_poisson(own + finer * np.asarray(share)[..., None], mesh, DEPTH_SCREENING_WEIGHT / unit**2)


def _mesh_depth(frame: TextureFrame, unit: float) -> NDArray[np.float64]:
    """Smoothed, so that triangles leave no facets."""
    depth = frame.interpolated(frame.places[:, 2:])[..., 0].astype(np.float64)
    covered = frame.covered.astype(np.float64)
    weight = cv2.GaussianBlur(covered, (0, 0), 2 * unit)
    smooth = np.asarray(cv2.GaussianBlur(depth * covered, (0, 0), 2 * unit)) / np.maximum(np.asarray(weight), 1e-6)
    return np.asarray(nearest_values(smooth, frame.covered), np.float64)


def _skin(frame: TextureFrame, unit: float) -> NDArray[np.bool_]:
    features = np.zeros(frame.size, np.uint8)
    for contour in FEATURE_OUTLINES:
        hull = cv2.convexHull(np.rint(frame.places[list(contour), :2]).astype(np.int32))
        cv2.fillConvexPoly(features, hull, 1)
    return frame.face & (np.asarray(cv2.dilate(features, _disk(FEATURE_MARGIN_PIXELS * unit))) == 0)


def _slopes(normals: NDArray[np.float64]) -> NDArray[np.float64]:
    toward = np.minimum(normals[..., 2:], -MIN_NORMAL_Z)
    return -normals[..., :2] / toward


def _low(slopes: NDArray[np.float64], skin: NDArray[np.bool_], sigma: float) -> NDArray[np.float64]:
    """The slopes' means about each pixel, of skin alone."""
    weight = skin.astype(np.float64)
    total = np.asarray(cv2.GaussianBlur(slopes * weight[..., None], (0, 0), sigma))
    return total / np.maximum(np.asarray(cv2.GaussianBlur(weight, (0, 0), sigma)), 1e-6)[..., None]


def _disk(radius: float) -> NDArray[np.uint8]:
    side = 2 * max(round(radius), 1) + 1
    return np.asarray(cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side)), np.uint8)
