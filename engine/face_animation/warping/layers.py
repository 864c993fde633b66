"""The target in layers: the person, and the background behind."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.target_face import TargetFace
from engine.face_animation.warping.bystanders import own_share
from engine.imaging.alpha.matting import estimate_layers, reconcile_with_plate
from engine.imaging.filling.background_plate import background_plate
from engine.media.image import is_cut_out, over_grey
from engine.perception.landmarks import FACE_OVAL
from engine.perception.matting import MattingModel
from engine.perception.person import person_mask

BEYOND_SHARE = 0.2
"""Share of a picture's shorter side by which its layer goes on beyond its border."""
FRAME_SHARE = 0.012
"""Share of it that may be a frame."""

CAP_SHARE = 0.04
"""Share of its height within which the sides of a head that is cut at the top show how round it is."""


@dataclass(frozen=True)
class Layers:
    """The person as a layer over the background plate.

    person : (H, W, 4) uint8, colours without the background in them, and alpha. plate : (H, W, 3) uint8.
    transparent : the picture itself was cut out; formats that can stay so, others get a white plate.
    """

    person: NDArray[np.uint8]
    plate: NDArray[np.uint8]
    transparent: bool = False


def separate_layers(target: TargetFace, model: MattingModel | None = None, model_hash: str | None = None) -> Layers:
    """Cut the person out, and fill in the background behind (the paper's limit: bending backgrounds). Who else is in the
    picture is background.

    `model` is a matting network of the operator's, if there is one, and `model_hash` its SHA-256.
    """
    seed = np.zeros(target.rgb.shape[:2], np.float32)
    cv2.fillConvexPoly(seed, target.mesh[list(FACE_OVAL), :2].round().astype(np.int32), 1.0)
    alpha = person_mask(target.rgb, seed=seed, alpha=target.alpha, model=model, people=target.people)
    face, others = target.face_boxes()
    if len(others):
        alpha = alpha * own_share(target.rgb, alpha, face, others)
    if target.alpha is not None and is_cut_out(target.alpha):
        person = np.dstack([target.rgb, (target.alpha * 255 + 0.5).astype(np.uint8)])
        return Layers(person, np.full_like(target.rgb, 255), transparent=True)
    with ThreadPoolExecutor(1, thread_name_prefix="front") as beside:
        layers = beside.submit(estimate_layers, target.rgb, alpha)
        plate = background_plate(target.rgb, alpha)
    colours = reconcile_with_plate(target.rgb, alpha, layers.result()[0], plate)
    return Layers((np.dstack([colours, alpha * 255]) + np.float32(0.5)).astype(np.uint8), plate)


def beyond_border(layer: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], int]:
    """A layer (H, W, 4) carried on beyond the picture's border, for whoever is cut by it and moves; and by how many pixels, to
    each side.

    What is cut goes on as it is at the border, and closes roundly above it: its alpha is the border's, its colours are the picture's mirror image, as a
    texture. The outermost pixels of a picture are often a thin frame: what goes on is what lies inside of them.
    """
    shorter = min(layer.shape[:2])
    frame = max(1, round(FRAME_SHARE * shorter))
    margin = round(BEYOND_SHARE * shorter)
    inner = np.ascontiguousarray(layer[frame:-frame, frame:-frame])
    more = (frame + margin,) * 4
    out = cv2.copyMakeBorder(inner, *more, cv2.BORDER_REFLECT_101)
    out[..., 3] = cv2.copyMakeBorder(inner[..., 3], *more, cv2.BORDER_REPLICATE)
    above = out[: margin + frame]
    above[..., 3] = np.minimum(above[..., 3], _cap(inner[..., 3], *above.shape[:2]))
    out[margin:-margin, margin:-margin] = layer
    return np.asarray(out, np.uint8), margin


def _cap(alpha: NDArray[np.uint8], height: int, width: int) -> NDArray[np.uint8]:
    """(height, width) alpha above a layer's (H, W), in the middle of what is below: runs of what its first row covers are closed by
    the circle that their sides are parts of. Runs that reach an end of the row go on straight."""
    covered, columns = alpha[0] > 127, np.arange(alpha.shape[1])
    bare = np.flatnonzero(~covered)
    if not len(bare):
        return np.full((height, width), 255, np.uint8)
    lower = max(1, round(CAP_SHARE * len(alpha)))
    half, half_lower = covered.sum() / 2, (alpha[lower] > 127).sum() / 2
    centre = max((half_lower**2 - half**2) / lower + lower, lower) / 2  # rows below the first
    after = np.searchsorted(bare, columns)
    left = np.where(after > 0, columns - bare[np.maximum(after - 1, 0)], 2 * width)
    right = np.where(after < len(bare), bare[np.minimum(after, len(bare) - 1)] - columns, 2 * width)
    open_ended = (after == 0) | (after == len(bare))
    rises = np.where(open_ended, height, np.sqrt(centre**2 + left * right) - centre)
    rises = np.pad(np.where(covered, rises, 0), (width - len(covered)) // 2, mode="edge")
    return np.asarray(255 * np.clip(rises - np.arange(height, 0, -1)[:, None] + 0.5, 0, 1), np.uint8)


def single_layer(target: TargetFace) -> Layers:
    """The whole picture as one layer, which is enough to look at the face; what is transparent is grey."""
    rgb = over_grey(target.rgb, target.alpha)
    return Layers(np.dstack([rgb, np.full(rgb.shape[:2], 255, np.uint8)]), rgb)
