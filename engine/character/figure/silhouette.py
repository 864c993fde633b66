"""The person cut out, and the grid of pixels on which the character is made."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.character.figure.doubts import doubt_mask
from engine.character.figure.figure import Figure
from engine.character.figure.gaps import gaps
from engine.character.figure.picture_space import PictureCamera
from engine.character.figure.strokes import read_mask, repaint_mask
from engine.character.options import MaskStroke
from engine.errors import InputError
from engine.imaging.masks.mask_distance import dilate_mask
from engine.imaging.masks.mask_pieces import bounding_box, largest_piece
from engine.imaging.resample import resized
from engine.media.limits import Limits
from engine.perception.masks.matting_network import MattingModel
from engine.perception.masks.person import DOUBTFUL_BELIEF, LIKELY_BELIEF, person_mask
from engine.perception.masks.salience import with_salience
from engine.perception.masks.segmentation import people_confidence
from engine.perception.pose.body import BODY_LANDMARKS

GRID_HEIGHT_PIXELS = 400
"""Pixels of the person's height on the grid."""
GRID_MARGIN_PIXELS = 24
"""Pixels of the grid around the person."""
MIN_PERSON_PIXELS = 400
"""Pixels of a person."""
MIN_TOLD_PIECE_SHARE = 0.02
"""Size from which another piece of the mask is told of, as a share of the person's."""
CROP_MARGIN_SHARE = 0.15
"""How much of the picture around a person is looked at where others are in it, as a share of the box."""
FOREARM_WIDTH_SHARE, SURE_HAND_WIDTH_SHARE, FINGER_WIDTH_SHARE, DRAWN_JOINT_CONFIDENCE = 0.02, 0.02, 0.006, 0.7
"""Widths of what is surely a forearm, a hand or a finger, as shares of the person's height, and the confidence from which a joint is seen."""
HAND_REACH_SHARE = 0.043
"""How far around what is surely a forearm, a hand or a finger the rest of it may be, as a share of the person's
height."""
MAX_HAND_DISTANCE_SHARE = 0.25
"""From the elbow to the fingertips, as a share of the person's height: so far from it may a hand be that is not seen closely."""
OPAQUE_ALPHA = 0.9
"""Alpha from which a pixel's colour is the person's own."""
BONE_WIDTH_SHARE = 0.03
"""Width of what is surely somebody along a bone whose joints are seen, as a share of their height."""
LIMB_WIDTH_SHARE = 0.03
"""Width of a limb that is known to be the person's, as a share of its skeleton's height."""


@dataclass(frozen=True)
class Silhouette:
    """alpha : (H, W) float32, the person's mask in the picture.
    soft : (h, w) the same on the grid.
    mask : (h, w) its largest piece.
    rgb : (h, w, 3) the picture on the grid.
    to_grid : (2, 3) from the picture's pixels to the grid's.
    """

    alpha: NDArray[np.float32]
    soft: NDArray[np.float32]
    mask: NDArray[np.bool_]
    rgb: NDArray[np.uint8]
    to_grid: NDArray[np.float64]

    def camera(self, picture: PictureCamera) -> PictureCamera:
        """The grid's camera, of the picture's."""
        x, y = (self.to_grid[:, :2] @ np.array(picture.camera.centre) + self.to_grid[:, 2]).tolist()
        focal = picture.camera.focal * float(self.to_grid[0, 0])
        height, width = self.mask.shape
        return replace(picture, camera=replace(picture.camera, focal=focal, centre=(x, y), size=(height, width)))


def cut_out(
    figure: Figure,
    mask: Path | None,
    strokes: tuple[MaskStroke, ...],
    limits: Limits,
    model: MattingModel | None,
    model_key: str | None,
    warn: Callable[[str, str], None],
) -> Silhouette:
    """Cut the person out. `mask` is a picture that takes the place of what is found, and `strokes` are painted over it;
    `model_key` says which model, for the stage's key.

    Raises
    ------
    InputError : `no_person` where no mask was found around the joints, and what `read_mask` may raise. Warns of
    `mask_in_pieces`, `mask_misses_joints`, `mask_too_large`.
    """
    height, width = figure.rgb.shape[:2]
    if mask is None:
        alpha = _found(figure, model)
    else:
        alpha = resized(read_mask(mask, [figure.original, (width, height)], limits), (width, height))
    alpha = repaint_mask(alpha, strokes, figure.scale)
    limbs = np.asarray(_limbs(figure) > 0)
    piece, rest = _own_piece(np.asarray(alpha > 0.5), limbs)
    if piece.sum() < MIN_PERSON_PIXELS:
        raise InputError(
            "no_person",
            "No person stands out in the picture: choose one in which somebody is clearly seen, or paint the mask by hand.",
            ("mask_strokes", "mask"),
        )
    if rest > MIN_TOLD_PIECE_SHARE * piece.sum():
        warn(
            "mask_in_pieces",
            "The mask is in pieces, and the person was made of the one that holds most of the joints: if another "
            f"({rest / piece.sum():.0%} of it in size) belongs to them, paint over what parts them.",
        )
    doubt_mask(figure, piece, limbs, warn)
    alpha = np.where(dilate_mask(piece, 4), alpha, 0).astype(np.float32)
    rows, columns = bounding_box(piece)
    scale = GRID_HEIGHT_PIXELS / (rows.stop - rows.start)
    matrix = np.array([[scale, 0, -columns.start * scale], [0, scale, -rows.start * scale]])
    matrix[:, 2] += (scale - 1) / 2 + GRID_MARGIN_PIXELS
    size = (
        round((columns.stop - columns.start) * scale) + 2 * GRID_MARGIN_PIXELS,
        GRID_HEIGHT_PIXELS + 2 * GRID_MARGIN_PIXELS,
    )
    flags = cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR
    soft = np.asarray(cv2.warpAffine(alpha, matrix, size, flags=flags), np.float32)
    rgb = cv2.warpAffine(figure.rgb, matrix, size, flags=flags, borderMode=cv2.BORDER_REPLICATE)
    return Silhouette(alpha, soft, largest_piece(soft > 0.5), np.asarray(rgb, np.uint8), matrix)


def _own_piece(mask: NDArray[np.bool_], limbs: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], int]:
    """The piece of a mask, joined by the sides of its pixels, that holds most of the limbs, the largest where none does; and
    the pixels of the largest of all others."""
    count, pieces, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=4)
    if count == 1:
        return mask, 0
    sizes, held = stats[1:, cv2.CC_STAT_AREA], np.bincount(pieces[limbs], minlength=count)[1:]
    own = int(np.argmax(held if held.any() else sizes))
    return np.asarray(pieces == own + 1), int(np.delete(sizes, own).max(initial=0))


def _found(figure: Figure, model: MattingModel | None) -> NDArray[np.float32]:
    """The mask that is found of itself, (H, W). Where others are in the picture, the networks look at this one alone."""
    part = _looked_at(figure)
    rgb = np.ascontiguousarray(figure.rgb[part])
    seed = seen_limbs(figure) if figure.spatial else _limbs(figure)
    known = model is not None or (figure.alpha is not None and (figure.alpha < 0.5).any())
    people = None
    if not known:
        corner = np.array([part[1].start, part[0].start], np.float32)
        people = with_salience(
            rgb, people_confidence(rgb, whole=True), seen_bones(figure)[part], _hands(figure) - corner
        )
    own = None if figure.alpha is None else figure.alpha[part]
    alpha = np.zeros(figure.rgb.shape[:2], np.float32)
    alpha[part] = person_mask(rgb, seed[part], own, model, figure.others[part], whole=True, people=people)
    if people is None:
        return alpha
    belief = np.zeros_like(alpha)
    belief[part] = resized(people, (rgb.shape[1], rgb.shape[0]))
    return np.asarray(alpha * (1 - gaps(figure.rgb, alpha, belief, figure.point)), np.float32)


def _looked_at(figure: Figure) -> tuple[slice, slice]:
    """The rows and columns that the networks look at: all, or where others are, those around this one."""
    height, width = figure.rgb.shape[:2]
    if len(figure.people) < 2 or not figure.spatial:
        return slice(0, height), slice(0, width)
    x, y, wide, high = figure.people[figure.index]
    return (
        slice(max(0, int(y - CROP_MARGIN_SHARE * high)), min(height, int(y + (1 + CROP_MARGIN_SHARE) * high) + 1)),
        slice(max(0, int(x - CROP_MARGIN_SHARE * wide)), min(width, int(x + (1 + CROP_MARGIN_SHARE) * wide) + 1)),
    )


def seen_limbs(figure: Figure) -> NDArray[np.float32]:
    """Where the person is (`LIKELY_BELIEF`) by the joints that are seen: along arms, and in hands. The network that cuts people
    out misses them, the one that finds their joints does not, and by colour a hand is not like the sleeve beside it."""
    seed, beyond = (np.zeros(figure.rgb.shape[:2], np.uint8) for _ in range(2))
    height = float(np.ptp(figure.points[figure.confidence > 0.3, 1], axis=0))

    def line(points: NDArray[np.floating], width: float, on: NDArray[np.uint8] = seed) -> None:
        cv2.polylines(on, [np.rint(points).astype(np.int32)], False, (1,), max(1, round(width * height)))

    for side, hand in zip(("Left", "Right"), figure.hands, strict=True):
        names = [f"{side}{joint}" for joint in ("Elbow", "Wrist", "Index", "Pinky")]
        elbow, wrist, *fingers = (figure.point(name) for name in names)
        sure = figure.confidence[[BODY_LANDMARKS.index(name) for name in names]]
        if min(sure[:2]) > DRAWN_JOINT_CONFIDENCE:
            line(np.stack([elbow, wrist]), FOREARM_WIDTH_SHARE)
            if hand is None:
                along = (wrist - elbow) / max(float(np.linalg.norm(wrist - elbow)), 1.0)
                line(np.stack([wrist, elbow + MAX_HAND_DISTANCE_SHARE * height * along]), FOREARM_WIDTH_SHARE, beyond)
        if hand is not None:
            cv2.fillConvexPoly(seed, np.rint(hand[[0, 1, 5, 9, 13, 17], :2]).astype(np.int32), (1,))
            for first in (1, 5, 9, 13, 17):
                line(hand[first : first + 4, :2], FINGER_WIDTH_SHARE)
        elif min(sure[1:]) > DRAWN_JOINT_CONFIDENCE:
            line(np.stack([wrist, np.mean(fingers, axis=0)]), SURE_HAND_WIDTH_SHARE)
    reach = max(1, round(HAND_REACH_SHARE * height))
    near = cv2.dilate(np.maximum(seed, beyond), np.ones((2 * reach + 1, 2 * reach + 1), np.uint8))
    for side in ("Left", "Right"):
        names = [f"{side}Shoulder", f"{side}Elbow"]
        if min(figure.confidence[[BODY_LANDMARKS.index(name) for name in names]]) > DRAWN_JOINT_CONFIDENCE:
            line(np.stack([figure.point(name) for name in names]), FOREARM_WIDTH_SHARE)
    return np.asarray(np.maximum(LIKELY_BELIEF * seed, DOUBTFUL_BELIEF * near), np.float32)


def seen_bones(figure: Figure) -> NDArray[np.bool_]:
    """Where somebody is by their joints alone (H, W): along arms, legs and feet of which both ends are seen, and in the trunk."""
    drawn = np.zeros(figure.rgb.shape[:2], np.uint8)
    width = max(1, round(BONE_WIDTH_SHARE * float(np.ptp(figure.points[figure.confidence > 0.3, 1], axis=0))))
    for side in ("Left", "Right"):
        for chain in (("Shoulder", "Elbow", "Wrist"), ("Hip", "Knee", "Ankle", "FootIndex"), ("Ankle", "Heel")):
            for ends in pairwise(f"{side}{joint}" for joint in chain):
                if min(figure.confidence[BODY_LANDMARKS.index(name)] for name in ends) > DRAWN_JOINT_CONFIDENCE:
                    line = np.rint(np.stack([figure.point(name) for name in ends])).astype(np.int32)
                    cv2.polylines(drawn, [line], False, (1,), width)
    trunk = ("LeftShoulder", "RightShoulder", "RightHip", "LeftHip")
    if min(figure.confidence[BODY_LANDMARKS.index(name)] for name in trunk) > DRAWN_JOINT_CONFIDENCE:
        cv2.fillPoly(drawn, [np.rint(np.stack([figure.point(name) for name in trunk])).astype(np.int32)], (1,))
    return drawn > 0


def _hands(figure: Figure) -> NDArray[np.float32]:
    """Points (K, 2) of hands and wrists that are seen."""
    seen = [
        np.concatenate([hand[:, :2] for hand in figure.hands if hand is not None] or [np.zeros((0, 2), np.float32)])
    ]
    for name in (f"{side}{mark}" for side in ("Left", "Right") for mark in ("Wrist", "Index", "Pinky")):
        if figure.confidence[BODY_LANDMARKS.index(name)] > DRAWN_JOINT_CONFIDENCE:
            seen.append(figure.point(name)[None])
    return np.concatenate(seen).astype(np.float32)


def _limbs(figure: Figure) -> NDArray[np.float32]:
    """Where the person must be if the skeleton was placed by hand: along its limbs and in its trunk."""
    seed = np.zeros(figure.rgb.shape[:2], np.uint8)
    place = {name: np.rint(figure.point(name)).astype(int) for name in BODY_LANDMARKS}
    width = max(1, round(LIMB_WIDTH_SHARE * float(np.ptp(figure.points[figure.confidence > 0, 1]))))
    for side in ("Left", "Right"):
        for chain in (("Shoulder", "Elbow", "Wrist"), ("Shoulder", "Hip", "Knee", "Ankle")):
            line = np.stack([place[f"{side}{joint}"] for joint in chain])
            cv2.polylines(seed, [line], False, (1,), width)
    trunk = ("LeftShoulder", "RightShoulder", "RightHip", "LeftHip")
    cv2.fillPoly(seed, [np.stack([place[name] for name in trunk])], (1,))
    return seed.astype(np.float32)
