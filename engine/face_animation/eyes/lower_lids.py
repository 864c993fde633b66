"""Lower lids where the picture has them.

A mesh knows the eyes of people. Drawn ones may reach further down, and what is left of them below the mesh's lid would
show under every shut one. So the eye is cut out by its colours, and where both reach further, the lids follow.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.eyes.eyeball import EYE_OUTLINE_IRIS_CORNERS
from engine.imaging.masks.colour_segmentation import grab_cut

EYE_PIXELS = 48
"""Pixels of an eye's width at which it is cut out."""
COLOUR_MARGIN_EYE_WIDTHS = 0.2
"""Eye widths around the mesh's opening in which colours decide."""
MIN_REACH_BELOW = 0.03
"""Eye widths by which a drawn eye reaches below the mesh's lid, along all of it but its ends, at least: less is the mesh's
own error or a lash."""
MAX_REACH_BELOW = 0.16
"""Eye widths by which a drawn eye reaches below the mesh's lid, at most: more is a shadow."""
SKIN_FALLOFF_EYE_WIDTHS = 0.4
"""Eye widths over which the skin below follows its lid."""


def fit_lower_lids(rgb: NDArray[np.uint8], mesh: NDArray[np.float32]) -> NDArray[np.float32]:
    """`mesh` (478, 3), pixels of the picture (H, W, 3), with the lower lids where both eyes end."""
    fitted = mesh.copy()
    for contour, _, _, _ in EYE_OUTLINE_IRIS_CORNERS:
        eye = _Eye(mesh, contour)
        reach = eye.reach_below(rgb)
        if reach[1:6].min() < MIN_REACH_BELOW or reach.max() > MAX_REACH_BELOW:
            return mesh
        eye.lower(fitted, reach)
    return fitted


class _Eye:
    """An eye of a mesh: its `contour` from one corner over the upper lid to the other and back."""

    def __init__(self, mesh: NDArray[np.float32], contour: tuple[int, ...]):
        self.upper = list(contour[:9])
        self.opening = mesh[list(contour), :2].astype(float)
        across = self.opening[8] - self.opening[0]
        self.width = max(float(np.linalg.norm(across)), 1.0)
        right = across / self.width * np.sign(across[0])
        self.axes = np.array([right, (-right[1], right[0])])

    def reach_below(self, rgb: NDArray[np.uint8]) -> NDArray[np.float64]:
        """(7,) eye widths by which the eye in the picture reaches below the points of the lower lid."""
        turn = self.axes * EYE_PIXELS / self.width
        middle = (self.opening[0] + self.opening[8]) / 2
        place = np.column_stack([turn, np.array([EYE_PIXELS, 0.75 * EYE_PIXELS]) - turn @ middle])
        size = 2 * EYE_PIXELS, 3 * EYE_PIXELS // 2
        patch = cv2.warpAffine(rgb, place, size, flags=cv2.INTER_AREA, borderMode=cv2.BORDER_REPLICATE)
        points = self.opening @ turn.T + place[:, 2]
        opening = np.zeros(size[::-1], np.uint8)
        cv2.fillPoly(opening, [points.round().astype(np.int32)], 1)
        disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * round(COLOUR_MARGIN_EYE_WIDTHS * EYE_PIXELS) + 1,) * 2)
        inner, skin = cv2.erode(opening, np.ones((3, 3))) > 0, cv2.dilate(opening, disk) == 0
        if not inner.any():
            return np.zeros(7)
        smooth = np.asarray(cv2.GaussianBlur(patch, (0, 0), 1), np.uint8)
        eye = grab_cut(smooth, inner, skin, probable=np.zeros_like(inner), rounds=2)
        eye = np.pad(eye, ((0, 1), (0, 0)))
        columns, rows = points[9:].round().astype(int).T
        ends = [row + int(eye[row:, column].argmin()) for column, row in zip(columns, rows, strict=True)]
        reach = (np.array(ends) - points[9:, 1]) / EYE_PIXELS
        return np.convolve(np.pad(reach, 1, "edge"), (0.25, 0.5, 0.25), "valid")

    def lower(self, mesh: NDArray[np.float32], reach: NDArray[np.float64]) -> None:
        """Move the lower lid's points down by `reach` (7,) eye widths, in place, and the skin below with them."""
        lid, down = self.opening[9:], self.axes[1]
        away = mesh[:, None, :2] - lid
        nearest = np.linalg.norm(away, axis=2).argmin(axis=1)
        away = away[np.arange(len(mesh)), nearest]
        share = np.clip(1 - np.linalg.norm(away, axis=1) / (SKIN_FALLOFF_EYE_WIDTHS * self.width), 0, 1)
        share[(away @ down < -1e-3 * self.width) | (np.arange(len(mesh)) >= 468)] = 0
        share[self.upper] = 0
        mesh[:, :2] += ((share * reach[nearest] * self.width)[:, None] * down).astype(np.float32)
