"""The folds that a smile leaves in the target's picture, eased where it does not smile any more.

A picture that smiles wears folds from the nose down past the corners of its mouth. The warp moves them, and draws them out to wedges and scars where
the mouth narrows; on a face they go with the smile. They are dark lines on skin with light ridges beside them: a closing of the picture and an opening
after it have neither. Such skin, with no more grain than the cheeks have, takes their place as far as the mouth is narrower than the picture's. Lines as thin
as grain go with it, else they stay as hooks at the corners.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.creases.carried_change import add_carried
from engine.face_animation.creases.fine_details import NOSE_VERTICES
from engine.face_animation.smoothstep import smoothstep
from engine.perception.face.landmarks import (
    CHIN_VERTEX,
    FACE_OVAL,
    LEFT_EYE_CORNER_VERTICES,
    LIPS_OUTER,
    MOUTH_CORNER_VERTICES,
    NOSE_BASE_VERTEX,
    RIGHT_EYE_CORNER_VERTICES,
    eye_distance,
)

FOLDS_EYE_DISTANCE_PIXELS = 120.0
"""Eye distance, pixels, of the copy in which folds are looked for, at most."""
FOLD_HALF_WIDTH_EYE_DISTANCES = 0.22
"""Half the width of the widest fold."""
SMOOTH_SKIN_SIGMA_EYE_DISTANCES = 0.08
"""Sigma of the smooth skin that takes folds' place."""
GRAIN_SIGMA_EYE_DISTANCES = 0.02
"""Sigma below which structure is the skin's grain."""
CHEEK_GRAIN_SHARE, MAX_GRAIN_RATIO = 0.8, 1.5
"""The share of the cheeks' pixels whose grain is the measure, and how many times as strong it may be beside the mouth: stronger is a line."""
LIP_START_EYE_DISTANCES, LIP_END_EYE_DISTANCES, NOSE_START_EYE_DISTANCES = (0.0, 0.03), (0.7, 1.1), (-0.35, -0.1)
"""Eye distances from the lips from which folds are eased, and up to which; and from where on, down from the nose's base."""
MIDLINE_START_EYE_DISTANCES = (0.12, 0.3)
"""Eye distances to either side of the face's middle from which folds are eased: the groove below a nose, a chin and what grows there are none."""
FOLDS_CONTOUR_EYE_DISTANCES = 0.25
"""Eye distances from the face's contour to where they are eased fully."""
NARROW_MOUTH_SHARES = (0.04, 0.16)
"""Shares by which the mouth is narrower than the picture's from which on folds fade, and at which they are gone."""
MOUSTACHE_LIGHT_RATIOS = (0.45, 0.55)
"""Of the cheeks' light: an upper lip darker than the first wears a moustache, whose ends are no folds; one lighter than the second does not."""
PHILTRUM_VERTICES, LIT_CHEEK_VERTICES = (
    (97, 326, 269, 0, 39),
    ((50, 101, 118, 117, 111, 116, 123), (280, 330, 347, 346, 340, 345, 352)),
)
OUTER_EYE_CORNER_VERTICES = (RIGHT_EYE_CORNER_VERTICES[0], LEFT_EYE_CORNER_VERTICES[0])


class OwnFolds:
    """The folds around the mouth of a picture (H, W, 3) with its face at `mesh` (478, 2 or 3): what skin without them is lighter or darker by."""

    def __init__(self, rgb: NDArray[np.uint8], mesh: NDArray[np.floating]):
        unit = float(eye_distance(mesh[:, :2]))
        low, high = np.floor(mesh[:, :2].min(axis=0)).astype(int), np.ceil(mesh[:, :2].max(axis=0)).astype(int) + 1
        (left, top), (right, bottom) = np.maximum(low, 0), np.minimum(high, rgb.shape[1::-1])
        shrink = min(1.0, FOLDS_EYE_DISTANCE_PIXELS / unit)
        patch = cv2.resize(rgb[top:bottom, left:right], None, fx=shrink, fy=shrink, interpolation=cv2.INTER_AREA)
        points = (mesh[:, :2] - (left, top) + 0.5) * shrink - 0.5
        self._corner, self._shrink = (float(left), float(top)), float(shrink)
        self._width = mouth_width(mesh)
        self._change = _folds(np.asarray(patch, np.uint8), points.astype(np.float32), unit * shrink)

    def within(self, low: NDArray[np.integer], high: NDArray[np.integer]) -> NDArray[np.float32]:
        """(h, w, 3) what the picture is lighter by without folds, grey levels, from the pixel `low` (x, y) up to `high`, which is the first beyond it."""
        x, y = (
            ((np.arange(low[k], high[k]) + 0.5 - self._corner[k]) * self._shrink - 0.5).astype(np.float32)
            for k in range(2)
        )
        at = np.meshgrid(x, y)
        return np.asarray(cv2.remap(self._change, *at, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT), np.float32)

    def share(self, face: NDArray[np.floating]) -> float:
        """How far a face (478, 2 or 3) has left the smile of its picture, [0, 1]."""
        return float(smoothstep(1 - mouth_width(face) / self._width, *NARROW_MOUTH_SHARES))

    def ease(
        self, frame: NDArray[np.uint8], origin: NDArray[np.float32], scale: float, face: NDArray[np.floating]
    ) -> None:
        """Even out the folds of a `frame` (H, W, 3), in place, with its face at (478, 2); `origin` (H, W, 2) is its inverse map, in pixels of the
        picture enlarged by `scale`."""
        share = self.share(face)
        if share < 1e-3:
            return
        height, width = frame.shape[:2]
        left, top = np.clip(np.floor(face[:, :2].min(axis=0)).astype(int), 0, (width, height)).tolist()
        right, bottom = np.clip(np.ceil(face[:, :2].max(axis=0)).astype(int) + 1, 0, (width, height)).tolist()
        there = (slice(top, bottom), slice(left, right))
        place = np.float32(1 / scale), *(np.float32(at) for at in self._corner), np.float32(self._shrink)
        add_carried(frame[there], self._change, np.float32(share), origin[there], *place)


def wears_no_moustache(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> float:
    """[0, 1] whether the upper lip of a face at `mesh` (478, 2 or 3) of a picture (H, W, 3) is skin, by its light."""
    light = cv2.GaussianBlur(rgb, (0, 0), GRAIN_SIGMA_EYE_DISTANCES * float(eye_distance(mesh[:, :2])))
    return float(
        smoothstep(_upper_lip_light(light.mean(axis=2), mesh[:, :2].astype(np.float32)), *MOUSTACHE_LIGHT_RATIOS)
    )


def mouth_width(face: NDArray[np.floating]) -> float:
    """Of a face (478, 2 or 3), in widths between the eyes' outer corners: turns aside shorten both."""
    mouth, eyes = (
        float(np.linalg.norm(face[a, :2] - face[b, :2])) for a, b in (MOUTH_CORNER_VERTICES, OUTER_EYE_CORNER_VERTICES)
    )
    return mouth / max(eyes, 1e-6)


def _folds(rgb: NDArray[np.uint8], points: NDArray[np.float32], unit: float) -> NDArray[np.float32]:
    """(h, w, 3) grey levels by which skin around the mouth is lighter without its folds, or darker; eye distance `unit` pixels."""
    lips = np.zeros(rgb.shape[:2], np.uint8)
    cv2.fillPoly(lips, [points[list(LIPS_OUTER)].round().astype(np.int32)], 1)
    picture = rgb.astype(np.float32)
    even = cv2.GaussianBlur(picture, (0, 0), GRAIN_SIGMA_EYE_DISTANCES * unit)
    radius = max(1, round(FOLD_HALF_WIDTH_EYE_DISTANCES * unit))
    disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1, 2 * radius + 1))
    red = cv2.dilate(lips, np.ones((3, 3), np.uint8))[..., None] > 0  # no light for the skin beside them, and no shade
    closed = cv2.morphologyEx(np.where(red, np.float32(0), even), cv2.MORPH_CLOSE, disk)
    opened = cv2.morphologyEx(np.where(red, np.float32(255), closed), cv2.MORPH_OPEN, disk)
    soft = SMOOTH_SKIN_SIGMA_EYE_DISTANCES * unit
    skin = (
        cv2.GaussianBlur(np.where(red, np.float32(0), opened), (0, 0), soft)
        / np.maximum(cv2.GaussianBlur(1 - red[..., 0].astype(np.float32), (0, 0), soft), 1e-3)[..., None]
    )
    limit = _cheek_grain(np.abs(picture - even), points)
    change = skin + np.clip(picture - even, -limit, limit) - picture
    share = smoothstep(_upper_lip_light(even.mean(axis=2), points), *MOUSTACHE_LIGHT_RATIOS)
    return np.asarray(share * _around_mouth(lips, points, unit)[..., None] * change, np.float32)


def _cheek_grain(grain: NDArray[np.float32], points: NDArray[np.float32]) -> float:
    """Grey levels that the `grain` (h, w, 3) of skin has at most, as the cheeks show."""
    inside = np.zeros(grain.shape[:2], np.uint8)
    for cheek in LIT_CHEEK_VERTICES:
        cv2.fillPoly(inside, [points[list(cheek)].round().astype(np.int32)], 1)
    return MAX_GRAIN_RATIO * float(np.quantile(grain[inside > 0], CHEEK_GRAIN_SHARE)) if inside.any() else 0.0


def _upper_lip_light(light: NDArray[np.floating], points: NDArray[np.float32]) -> float:
    """Of a picture's light (h, w): the median of the skin below the nose in that of the lighter cheek."""

    def median(corners: tuple[int, ...]) -> float:
        inside = np.zeros(light.shape, np.uint8)
        cv2.fillPoly(inside, [points[list(corners)].round().astype(np.int32)], 1)
        return float(np.median(light[inside > 0])) if inside.any() else 0.0

    return median(PHILTRUM_VERTICES) / max(*(median(cheek) for cheek in LIT_CHEEK_VERTICES), 1.0)


def _around_mouth(lips: NDArray[np.uint8], points: NDArray[np.float32], unit: float) -> NDArray[np.float64]:
    """(h, w) [0, 1] the skin around the mouth, without lips and nose."""
    away = cv2.distanceTransform(1 - lips, cv2.DIST_L2, 5) / unit
    down = (np.arange(lips.shape[0])[:, None] - points[NOSE_BASE_VERTEX, 1]) / unit
    nose = np.zeros(lips.shape, np.float32)
    hull = cv2.convexHull(points[list(NOSE_VERTICES)].round().astype(np.int32))
    cv2.fillConvexPoly(nose, hull, 1.0)
    grown = cv2.dilate(nose, np.ones((2 * round(0.05 * unit) + 1,) * 2, np.uint8))
    oval = np.zeros(lips.shape, np.uint8)
    cv2.fillPoly(oval, [points[list(FACE_OVAL)].round().astype(np.int32)], 1)
    inside = np.clip(cv2.distanceTransform(oval, cv2.DIST_L2, 5) / (FOLDS_CONTOUR_EYE_DISTANCES * unit), 0, 1)
    near = (
        smoothstep(away, *LIP_START_EYE_DISTANCES)
        * (1 - smoothstep(away, *LIP_END_EYE_DISTANCES))
        * smoothstep(down, *NOSE_START_EYE_DISTANCES)
    )
    near = near * smoothstep(_beside_middle(lips.shape, points) / unit, *MIDLINE_START_EYE_DISTANCES)
    return np.asarray(near * inside * (1 - cv2.GaussianBlur(grown, (0, 0), 0.05 * unit)), float)


def _beside_middle(shape: tuple[int, ...], points: NDArray[np.float32]) -> NDArray[np.float32]:
    """(h, w) pixels to either side of the line from the nose's base to the chin."""
    base, along = points[NOSE_BASE_VERTEX], points[CHIN_VERTEX] - points[NOSE_BASE_VERTEX]
    y, x = np.indices(shape, np.float32)
    across = (x - base[0]) * along[1] - (y - base[1]) * along[0]
    return np.asarray(np.abs(across) / max(float(np.linalg.norm(along)), 1e-6), np.float32)
