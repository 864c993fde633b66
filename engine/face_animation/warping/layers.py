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


def single_layer(target: TargetFace) -> Layers:
    """The whole picture as one layer, which is enough to look at the face; what is transparent is grey."""
    rgb = over_grey(target.rgb, target.alpha)
    return Layers(np.dstack([rgb, np.full(rgb.shape[:2], 255, np.uint8)]), rgb)
