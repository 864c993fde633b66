"""Whose pixels are whose where a picture shows several people: who does not act stays where they are.

Around each face a head and a trunk are laid, in proportion to it. What is clearly nearest to one of them is that person's;
what lies between goes to whoever is reached first without crossing an edge of the picture (a watershed: F. Meyer, "Color
image segmentation", 1992).
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.resample import resized, size_within

WORKING_SIZE_PIXELS = 640
"""Pixels of the longer side at which people are told apart."""
HEAD_HALF_AXES = (0.8, 1.0)
"""Half axes of a head, hair included, in widths and heights of its face; its middle is `HEAD_CENTRE_RISE_FACE_HEIGHTS` face heights above that of
the face."""
HEAD_CENTRE_RISE_FACE_HEIGHTS = 0.12
TRUNK_HALF_WIDTHS = ((0.45, 0.45), (1.3, 1.1), (1.7, 2.2), (1.8, 9.0))
"""Half widths of a trunk, in widths of the face, and how far below the face's middle, in its heights: neck, shoulders, arms."""
TRUNK_BEHIND_HEAD_FACE_HEIGHTS = 0.2
"""Face heights by which a trunk counts as further away than a head: heads of those who stand in front hide trunks."""
OWNER_MARGIN_FACE_HEIGHTS = 0.5
"""Face heights by which a place is nearer to one person than to all others, to be clearly that person's."""
MASK_BLUR_PIXELS = 0.7
"""Pixels over which one person's mask passes over into another's."""


def own_share(
    rgb: NDArray[np.uint8], people: NDArray[np.float32], face: NDArray[np.floating], others: NDArray[np.floating]
) -> NDArray[np.float32]:
    """(H, W) in [0, 1]: how far what is seen of `people` (H, W) in a picture (H, W, 3) belongs to the person with this
    `face` (4,), rather than to those with `others` (K, 4). Boxes are x, y, width, height in pixels."""
    size = size_within(rgb.shape, WORKING_SIZE_PIXELS)
    factor = size[0] / rgb.shape[1]
    faces = np.vstack([face, others]) * factor
    away = np.stack([_away(one, size) for one in faces])
    order = np.argsort(away, axis=0)
    nearest, second = (np.take_along_axis(away, order[k : k + 1], axis=0)[0] for k in (0, 1))
    nobody = resized(people, size) < 0.02
    markers = np.where(second - nearest > OWNER_MARGIN_FACE_HEIGHTS, order[0] + 2, 0).astype(np.int32)
    markers[nobody] = 1
    found = cv2.watershed(resized(np.ascontiguousarray(rgb), size), markers.copy())
    whose = np.where(found > 1, found - 2, order[0])  # borders, too, are somebody's
    own = resized((whose == 0).astype(np.float32), rgb.shape[1::-1])
    return np.asarray(cv2.GaussianBlur((own > 0.5).astype(np.float32), (0, 0), MASK_BLUR_PIXELS), np.float32)


def _away(face: NDArray[np.floating], size: tuple[int, int]) -> NDArray[np.float32]:
    """How far each pixel of a picture of this size (w, h) is from somebody with this face (4,), in heights of the face."""
    x, y, width, height = (float(value) for value in face)
    middle = np.array([x + width / 2, y + height / 2])
    head, trunk = (np.zeros(size[::-1], np.uint8) for _ in range(2))
    crown = middle - [0, HEAD_CENTRE_RISE_FACE_HEIGHTS * height]
    cv2.ellipse(head, (crown.tolist(), (2 * HEAD_HALF_AXES[0] * width, 2 * HEAD_HALF_AXES[1] * height), 0), (1,), -1)
    side = np.array(TRUNK_HALF_WIDTHS) * [width, height]
    outline = np.concatenate([middle + side, (middle + side * [-1, 1])[::-1]])
    cv2.fillPoly(trunk, [np.rint(outline).astype(np.int32)], (1,))
    far = [cv2.distanceTransform(1 - part, cv2.DIST_L2, 5) / height for part in (head, trunk)]
    return np.minimum(far[0], far[1] + TRUNK_BEHIND_HEAD_FACE_HEIGHTS)
