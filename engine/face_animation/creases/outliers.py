"""Ratios that are no creases: shadows that shift and features that misalign (section 6, figure 5).

A significant ratio is an outlier if what it shows is there in the neutral frame too, a little elsewhere: a
moved shadow, not a new crease. This is decided once per connected component, in the most expressive frame.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numba
import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.geometry.registration.rigid import Similarity, fit_similarity
from engine.perception.face.landmarks import fiducials
from engine.perception.face_track.track import FaceTrack

SIGNIFICANT_RATIO = 1.1
"""Section 6: ratios above this or below its inverse are significant."""
SEARCH_RADIUS_PIXELS = 10
"""Section 6: half the side of the 20x20 region searched, pixels at the crop's eye distance."""
SEARCH_ROTATIONS_DEGREES = (-30.0, -15.0, 0.0, 15.0, 30.0)
"""Degrees; section 6 allows up to 30."""
OUTLIER_THRESHOLD_GREY_LEVELS = 5.0
"""Section 6: a component whose mean best difference is below this, in grey levels, is an outlier."""
OUTLIER_MARGIN_PIXELS = 20.0
"""Section 6: pixels closer than this to an outlier are set to one in every frame."""
OUTLIER_RAMP_PIXELS = 6.0
"""Pixels over which an outlier's ratios of one pass into the others, so that no edge appears."""


@dataclass(frozen=True)
class Outliers:
    """`distance` (H, W) to the nearest outlier in the reference frame's crop, pixels; `to_reference` the
    similarity from each frame's crop."""

    distance: NDArray[np.float32]
    to_reference: tuple[Similarity, ...]

    def keep(self, origin: NDArray[np.float32], frame: int) -> NDArray[np.float32]:
        """[0, 1] for each pixel of the neutral crop; `origin` is where it lies in the frame's crop."""
        carry = self.to_reference[frame]
        a, b = carry.linear.astype(np.float32), carry.shift.astype(np.float32)
        x = a[0, 0] * origin[..., 0] + a[0, 1] * origin[..., 1] + b[0]
        y = a[1, 0] * origin[..., 0] + a[1, 1] * origin[..., 1] + b[1]
        far = cv2.remap(self.distance, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=1e3)
        return np.clip((far - OUTLIER_MARGIN_PIXELS + OUTLIER_RAMP_PIXELS) / OUTLIER_RAMP_PIXELS, 0, 1)


def find_outliers(
    ratio: NDArray[np.float32], origin: NDArray[np.float32], track: FaceTrack, neutral: int, reference: int
) -> Outliers:
    """Judge the components of significant ratios in the reference frame.

    Parameters
    ----------
    ratio : the reference's, on the neutral crop. origin : (H, W, 2) its pixels' places in the reference crop.
    """
    significant = ((ratio > SIGNIFICANT_RATIO) | (ratio < 1 / SIGNIFICANT_RATIO)).astype(np.uint8)
    count, labels = cv2.connectedComponents(significant, connectivity=8)
    best = match_differences(track.crop(reference), track.crop(neutral), origin, significant)
    sizes = np.bincount(labels.ravel(), minlength=count)
    mean = np.bincount(labels.ravel(), best.ravel(), count) / np.maximum(sizes, 1)
    outlier = mean < OUTLIER_THRESHOLD_GREY_LEVELS
    outlier[0] = False
    chosen = outlier[labels]
    footprint = np.ones(ratio.shape, np.uint8)
    places = origin[chosen].round().astype(int)
    inside = ((places >= 0) & (places < ratio.shape[::-1])).all(axis=1)
    footprint[places[inside, 1], places[inside, 0]] = 0
    distance = cv2.distanceTransform(footprint, cv2.DIST_L2, 5) if inside.any() else np.full(ratio.shape, 1e3)
    points = fiducials(np.stack([track.in_crop(i) for i in (reference,)])).astype(float)[0]
    carry = tuple(fit_similarity(fiducials(track.in_crop(i)).astype(float), points) for i in range(len(track)))
    return Outliers(distance.astype(np.float32), carry)


def match_differences(
    frame: NDArray[np.uint8], neutral: NDArray[np.uint8], origin: NDArray[np.float32], where: NDArray[np.uint8]
) -> NDArray[np.float32]:
    """For each pixel of the neutral crop in `where`: how well the 3x3 patch at its place in `frame` is found in
    the neutral crop around it, as the least, over shifts and rotations, of the largest RGB difference."""
    offsets = []
    for degrees in SEARCH_ROTATIONS_DEGREES:
        c, s = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
        offsets.append([(c * x - s * y, s * x + c * y) for y in (-1, 0, 1) for x in (-1, 0, 1)])
    return _match(frame, neutral, origin, where, np.array(offsets, np.float32), SEARCH_RADIUS_PIXELS)


@njit(parallel=True, fastmath=True)
def _match(frame, neutral, origin, where, rotated, search):  # type: ignore[no-untyped-def]
    height, width = where.shape
    best = np.zeros((height, width), np.float32)
    for y in numba.prange(height):
        patch = np.empty((9, 3), np.float32)
        for x in range(width):
            if where[y, x] == 0:
                continue
            px, py = round(origin[y, x, 0]), round(origin[y, x, 1])
            if px < 1 or py < 1 or px >= width - 1 or py >= height - 1:
                best[y, x] = 255.0
                continue
            for k in range(9):
                for c in range(3):
                    patch[k, c] = frame[py + k // 3 - 1, px + k % 3 - 1, c]
            least = np.float32(255.0)
            for dy in range(-search, search):
                for dx in range(-search, search):
                    cx, cy = x + dx, y + dy
                    if cx < 2 or cy < 2 or cx >= width - 2 or cy >= height - 2:
                        continue
                    for r in range(rotated.shape[0]):
                        worst = np.float32(0.0)
                        for k in range(9):
                            qx, qy = round(cx + rotated[r, k, 0]), round(cy + rotated[r, k, 1])
                            for c in range(3):
                                worst = max(worst, abs(patch[k, c] - neutral[qy, qx, c]))
                            if worst >= least:
                                break
                        least = min(least, worst)
            best[y, x] = least
    return best
