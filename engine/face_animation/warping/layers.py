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
from engine.imaging.picture_frame import inner_picture
from engine.imaging.window import Window
from engine.media.image import is_cut_out, over_grey
from engine.perception.face.landmarks import FACE_OVAL
from engine.perception.masks.matting_network import MattingModel
from engine.perception.masks.person import person_mask

LAYER_MARGIN_SHARE = 0.2
"""Share of a picture's shorter side by which its layer goes on beyond its border."""
FRAME_SHARE = 0.012
"""Share of a picture's shorter side that may be a frame."""

HEAD_TOP_SHARE = 0.04
"""Share of a head's height within which the sides of one that is cut at the top show how round it is."""

LACE_SHARE = 0.03
"""Half the share of a cut head's width up to which what a mask leaves out between hair and hair along the cut is hair,
too."""


@dataclass(frozen=True)
class Layers:
    """The person as a layer over the background plate.

    person : (H, W, 4) uint8, colours without the background in them, and alpha.
    plate : (H, W, 3) uint8.
    transparent : the picture itself was cut out; formats that can stay so, others get a white plate.
    inner : what of the picture lies within its margins or its frame, where it has some.
    """

    person: NDArray[np.uint8]
    plate: NDArray[np.uint8]
    transparent: bool = False
    inner: Window | None = None


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
    inner = inner_picture(target.rgb)
    rgb, alpha = np.ascontiguousarray(target.rgb[inner.pixels]), np.ascontiguousarray(alpha[inner.pixels])
    with ThreadPoolExecutor(1, thread_name_prefix="front") as beside:
        layers = beside.submit(estimate_layers, rgb, alpha)
        behind = background_plate(rgb, alpha)
    colours = reconcile_with_plate(rgb, alpha, layers.result()[0], behind)
    person, plate = np.dstack([target.rgb, np.zeros_like(target.rgb[..., 0])]), target.rgb.copy()
    person[inner.pixels] = np.dstack([colours, alpha * 255]) + np.float32(0.5)
    plate[inner.pixels] = behind
    return Layers(person, plate, inner=inner if inner.shape != target.rgb.shape[:2] else None)


def beyond_border(layer: NDArray[np.uint8], inner: Window | None = None) -> tuple[NDArray[np.uint8], int]:
    """A layer (H, W, 4) carried on beyond the picture's border, or that of its `inner` picture, for whoever is cut by it and moves; and by how
    many pixels, to each side of the layer.

    What is cut goes on as it is at the border, and closes roundly above it: its alpha is the border's, its colours are the picture's mirror image, as a
    texture. The outermost pixels of a picture are often a thin frame: what goes on is what lies inside of them.
    """
    shorter = min(layer.shape[:2])
    frame = max(1, round(FRAME_SHARE * shorter))
    margin = round(LAYER_MARGIN_SHARE * shorter)
    height, width = layer.shape[:2]
    shown = inner or Window(0, 0, width, height)
    source = Window(shown.left + frame, shown.top + frame, shown.right - frame, shown.bottom - frame)
    core = np.ascontiguousarray(layer[source.pixels])
    above = source.top + margin
    more = above, height - source.bottom + margin, source.left + margin, width - source.right + margin
    out = cv2.copyMakeBorder(core, *more, cv2.BORDER_REFLECT_101)
    out[..., 3] = cv2.copyMakeBorder(core[..., 3], *more, cv2.BORDER_REPLICATE)
    closed = core[..., 3].copy()
    between = np.ones((1, 2 * round(LACE_SHARE * core.shape[1]) + 1), np.uint8)
    closed[:1] = cv2.morphologyEx(closed[:1], cv2.MORPH_CLOSE, between)
    straight = np.pad(closed[0], more[2:], mode="edge")
    out[:above, :, 3] = np.minimum(straight, _cap(closed, above, *more[2:]))
    out[margin:-margin, margin:-margin][shown.pixels] = layer[shown.pixels]
    return np.asarray(out, np.uint8), margin


def _cap(alpha: NDArray[np.uint8], height: int, left: int, right: int) -> NDArray[np.uint8]:
    """(height, left + W + right) alpha above a layer's (H, W): runs of what its first row covers are closed by
    the circle that their sides are parts of. Runs that reach an end of the row go on straight."""
    covered, columns = alpha[0] > 127, np.arange(alpha.shape[1])
    bare = np.flatnonzero(~covered)
    if not len(bare):
        return np.full((height, left + len(covered) + right), 255, np.uint8)
    lower = max(1, round(HEAD_TOP_SHARE * len(alpha)))
    half, half_lower = covered.sum() / 2, (alpha[lower] > 127).sum() / 2
    centre = max((half_lower**2 - half**2) / lower + lower, lower) / 2  # rows below the first
    after = np.searchsorted(bare, columns)
    to_left = columns - bare[np.maximum(after - 1, 0)]
    to_right = bare[np.minimum(after, len(bare) - 1)] - columns
    open_ended = (after == 0) | (after == len(bare))
    rises = np.where(open_ended, height, np.sqrt(np.maximum(centre**2 + to_left * to_right, 0)) - centre)
    rises = np.pad(np.where(covered, rises, 0), (left, right), mode="edge")
    return np.asarray(255 * np.clip(rises - np.arange(height, 0, -1)[:, None] + 0.5, 0, 1), np.uint8)


def single_layer(target: TargetFace) -> Layers:
    """The whole picture as one layer, which is enough to look at the face; what is transparent is grey."""
    rgb = over_grey(target.rgb, target.alpha)
    return Layers(np.dstack([rgb, np.full(rgb.shape[:2], 255, np.uint8)]), rgb)
