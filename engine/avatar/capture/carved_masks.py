"""Gaps in a person's masks, told by the other frames: between coat tails, fingers, arm and trunk.

A network that cuts somebody out lets the room in where a gap is narrow, now in one frame and now in another. What lies behind the gap is
outside the silhouette from most other sides: what no line of sight meets within the hull of all masks is not the person.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.camera import Camera
from engine.geometry.multiview.visual_hull import depth_range, visual_hull
from engine.imaging.masks.mask_distance import dilate_mask

VOXEL_SIZE_METRES = 0.008
"""Metres from voxel to voxel of the hull."""
KEPT_PIXELS = 1
"""About what the hull shows, which a mask may have beyond it: arms drift, and voxels are coarser than pixels."""

MAX_CARVED_SHARE = 0.1
"""Share of a mask: what takes more of it away is a camera or a hull that is wrong, no gap."""


def within_hull(masks: Sequence[NDArray[np.bool_]], cameras: Sequence[Camera], top: float) -> list[NDArray[np.bool_]]:
    """Masks without what the other views know to be outside.

    Parameters
    ----------
    masks : (h, w) each, of its camera's size.
    cameras : locked to the person, y up, metres.
    top : metres. What is seen above is left as it is: brims of hats and hair, which most masks lose, would be outvoted.

    Where the masks share nothing they are returned as they are, and so is one of which a tenth would be lost.
    """
    straight = [replace(camera, distortion=()) for camera in cameras]
    flat = [_seen_by(mask, one, other) for mask, one, other in zip(masks, cameras, straight, strict=True)]
    try:
        hull = visual_hull(flat, straight, VOXEL_SIZE_METRES)
    except ValueError:
        return list(masks)
    out = []
    for mask, camera, without, own in zip(masks, cameras, straight, flat, strict=True):
        met = depth_range(hull, without, own)[..., 0] > 0
        kept = dilate_mask(_seen_by(met, without, camera), KEPT_PIXELS) | _above(camera, top)
        lost = np.count_nonzero(mask & ~kept) > MAX_CARVED_SHARE * np.count_nonzero(mask)
        out.append(mask if lost else mask & kept)
    return out


def _seen_by(mask: NDArray[np.bool_], camera: Camera, other: Camera) -> NDArray[np.bool_]:
    """A camera's mask as another sees it that differs by its lens's distortion alone; False beyond the border."""
    if camera.distortion == other.distortion:
        return mask
    y, x = np.indices(mask.shape, np.float64)
    lies = camera.project(other.unproject(np.stack([x, y], axis=-1), 1.0))
    found = cv2.remap(mask.astype(np.uint8), lies[..., 0], lies[..., 1], cv2.INTER_NEAREST)
    return np.asarray(found > 0)


def _above(camera: Camera, top: float) -> NDArray[np.bool_]:
    """(h, w) the rows of a picture above where the person's axis is `top` metres high."""
    at = camera.project(np.array([[0.0, top, 0.0]]), np.float64)[0]
    rows = np.arange(camera.size[0])[:, None] < (at[1] if at[2] > 0 else 0)
    return np.broadcast_to(rows, camera.size)
