"""The teeth that one photograph shows, as they lie on the face seen from the front."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from engine.face_animation.mouth.lip_contours import (
    LOWER_INNER_LIP,
    UPPER_INNER_LIP,
    soft_polygon,
)
from engine.face_animation.mouth.modelled.resting_mouth import BEHIND_LIPS_EYE_DISTANCES
from engine.face_animation.mouth.modelled.skull import skull_camera
from engine.face_animation.mouth.pictured.pictured_face import PicturedFace
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.imaging.resample import resized
from engine.perception.expression.features import frontalise
from engine.perception.face.landmarks import LIPS_INNER, LIPS_OUTER, eye_distance

ARCH_CURVATURE_PER_EYE_DISTANCE = 1.2
"""Eye distances by which teeth lie further back, for the square of one to the side."""
LIP_SHADOW_EYE_DISTANCES = 0.02
"""Eye distances below the upper lip from which on teeth are taken: above are the lip and its edge."""
STRIP_MARGIN_EYE_DISTANCES = 0.1
"""Eye distances around the lips that are kept."""
STRIP_SOFTNESS_EYE_DISTANCES = 0.018
"""Eye distances over which the teeth pass into the dark."""
ROW_SAMPLES = 200
MIN_CROWN_HEIGHT = 0.07
"""By how much crowns stand out (`TeethStrip.crowns`) that are seen."""
CROWN_ROW_SHARE = 0.55
"""Of the way from the lip to where teeth end, at which crowns are told apart."""
CROWN_WIDTH_EYE_DISTANCES, CROWN_SMOOTHING_WIDTHS = 0.125, 1.0
"""Eye distances that a front tooth is wide, and such widths over which light is told that is no crown's."""
MAX_SHARPENING_SHARE = 0.6
"""Of what is finer than a pixel, where the photograph is enlarged twice or more: its own pixels have blurred it."""
TEETH_PERCENTILE, USUAL_PERCENTILE = 90, 60
TEETH_EDGE_ROWS = 20
"""Rows from lip to lip at which it is looked for where teeth end."""
TEETH_EDGE_LIGHT_SHARE = 0.6
"""Of the lightest row's light, above which a row is of teeth."""
TEETH_EDGE_RANGE = (0.5, 1.0)


@dataclass(frozen=True)
class TeethStrip:
    """Of a face seen from the front, in its eye distances; places are (..., 2), x to the right and y down.

    layer : (h, w, 4) float32, the photograph's mouth, and in [0, 1] what of it is within the inner lips.
    upper : (11, 2) the upper inner lip, from corner to corner.
    lower : (11, 2) the lower one.
    depth : of the teeth in the middle.
    edge : the share of the way from lip to lip where teeth end.
    matrix : (2, 3) from the face into the photograph, with `shift`.
    shift : (2,) pixels of the photograph.
    corner : (2,) pixels of the photograph at which the layer begins.
    scale : of its pixels in the layer.
    """

    layer: NDArray[np.float32]
    upper: NDArray[np.float64]
    lower: NDArray[np.float64]
    depth: float
    edge: float
    matrix: NDArray[np.float64]
    shift: NDArray[np.float64]
    corner: NDArray[np.float64]
    scale: float

    @property
    def middle(self) -> float:
        """Where along x the teeth's middle is."""
        return float((self.upper[0, 0] + self.upper[-1, 0]) / 2)

    @property
    def width(self) -> float:
        """From corner to corner of the mouth."""
        return float(np.linalg.norm(self.upper[-1] - self.upper[0]))

    def lip(self, x: NDArray[np.floating]) -> NDArray[np.float64]:
        """(...) the height at which the upper lip ends."""
        return np.interp(x, self.upper[:, 0], self.upper[:, 1])

    def ends(self, x: NDArray[np.floating]) -> NDArray[np.float64]:
        """(...) the height at which the upper teeth end."""
        top = self.lip(x)
        return np.asarray(top + self.edge * (np.interp(x, self.lower[:, 0], self.lower[:, 1]) - top))

    def sampled(self, x: NDArray[np.floating], y: NDArray[np.floating]) -> NDArray[np.float32]:
        """(..., 4) colours and shares of teeth at places (h, w), whose height is held below the upper lip."""
        held = np.maximum(y, self.lip(x) + LIP_SHADOW_EYE_DISTANCES)
        depth = self.depth + ARCH_CURVATURE_PER_EYE_DISTANCE * (x - self.middle) ** 2
        photo = np.stack([x, held], axis=-1) @ self.matrix[:, :2].T + depth[..., None] * self.matrix[:, 2] + self.shift
        at = ((photo - self.corner + 0.5) * self.scale - 0.5).astype(np.float32)
        found = cv2.remap(self.layer, at[..., 0], at[..., 1], cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
        layer = np.clip(np.asarray(found, np.float32), 0, (255, 255, 255, 1))
        layer[..., 3] *= np.clip((self.ends(x) - held) / STRIP_SOFTNESS_EYE_DISTANCES + 1, 0, 1)
        return layer

    def brightest(self, gain: NDArray[np.floating]) -> float:
        """The luminance of the lightest teeth, each channel times its `gain` (3,)."""
        light = (self.layer[..., :3] * gain)[self.layer[..., 3] > 0.5] @ LUMINANCE_WEIGHTS
        return max(float(np.percentile(light, TEETH_PERCENTILE)), 1.0) if len(light) else 255.0

    @property
    def has_crowns(self) -> bool:
        """Whether single ones are seen, and not a mere white band."""
        return self.crowns() >= MIN_CROWN_HEIGHT

    def crowns(self) -> float:
        """By how much single crowns stand out along the row: the standard deviation of light, of what is finer than two of them, as a share of
        the light."""
        x = np.linspace(self.upper[1, 0], self.upper[-2, 0], ROW_SAMPLES)
        y = self.lip(x) + CROWN_ROW_SHARE * (self.ends(x) - self.lip(x))
        light = self.sampled(x[None], y[None])[0, :, :3] @ LUMINANCE_WEIGHTS
        smooth = uniform_filter1d(
            light, round(CROWN_SMOOTHING_WIDTHS * ROW_SAMPLES * CROWN_WIDTH_EYE_DISTANCES / np.ptp(x)), mode="nearest"
        )
        return float((light - smooth).std() / max(float(light.mean()), 1.0))

    def usual(self) -> NDArray[np.float64]:
        """(3,) the colour of teeth that are well lit, as the photograph has them."""
        colours = self.layer[self.layer[..., 3] > 0.5][:, :3]
        light = colours @ LUMINANCE_WEIGHTS
        lit = colours[light >= np.percentile(light, USUAL_PERCENTILE)] if len(light) else np.full((1, 3), 200.0)
        return np.asarray(lit.mean(axis=0), np.float64)


def teeth_strip(photo: PicturedFace, wanted: float) -> TeethStrip:
    """That of a photograph, shrunk where its face is larger than one of an eye distance of `wanted` pixels asks for."""
    front = frontalise(photo.mesh[None])[0]
    unit = float(eye_distance(photo.mesh[:, :2]))
    mouth = photo.mesh[list(LIPS_OUTER), :2]
    low = np.floor(mouth.min(axis=0) - STRIP_MARGIN_EYE_DISTANCES * unit).astype(int).clip(0)
    high = np.ceil(mouth.max(axis=0) + STRIP_MARGIN_EYE_DISTANCES * unit).astype(int)
    part = photo.cut(low, np.minimum(high, photo.rgb.shape[1::-1]))
    scale = min(wanted / unit, 1.0)
    size = max(round(part.rgb.shape[1] * scale), 8), max(round(part.rgb.shape[0] * scale), 8)
    scale = size[0] / part.rgb.shape[1]
    small = resized(part.rgb, size).astype(np.float32)
    sharpness = MAX_SHARPENING_SHARE * float(np.clip(wanted / unit - 1, 0, 1))
    sharp = np.clip(small + sharpness * (small - cv2.GaussianBlur(small, (0, 0), 1.0)), 0, 255)
    lips = ((part.mesh[list(LIPS_INNER), :2] + 0.5) * scale - 0.5).astype(np.float32)
    softness = max(0.5, STRIP_SOFTNESS_EYE_DISTANCES * unit * scale)
    mask = cv2.GaussianBlur(soft_polygon(lips, size[::-1]), (0, 0), softness)
    return TeethStrip(
        np.dstack([without_violet(sharp), np.asarray(mask)]).astype(np.float32),
        front[list(UPPER_INNER_LIP), :2],
        front[list(LOWER_INNER_LIP), :2],
        float(front[list(UPPER_INNER_LIP[4:7]), 2].mean()) + BEHIND_LIPS_EYE_DISTANCES,
        _edge(part),
        *skull_camera(front, photo.mesh),
        low.astype(np.float64),
        scale,
    )


def without_violet(colours: NDArray[np.floating]) -> NDArray[np.float32]:
    """Colours (..., 3) as light as they are, none of them bluer than it is green. Teeth, gums and tongues are not, but
    a lens leaves violet seams between them."""
    found = np.asarray(colours, np.float32).copy()
    weights = LUMINANCE_WEIGHTS.astype(np.float32)
    light = found @ weights
    found[..., 2] = np.minimum(found[..., 2], found[..., 1])
    return np.asarray(found * (light / np.maximum(found @ weights, 1e-3))[..., None], np.float32)


def _edge(photo: PicturedFace) -> float:
    """The share of the way from lip to lip where the upper teeth end, in the middle of the mouth."""
    upper, lower = (photo.mesh[list(lip[3:8]), :2] for lip in (UPPER_INNER_LIP, LOWER_INNER_LIP))
    down = (np.arange(TEETH_EDGE_ROWS) + 0.5)[:, None, None] / TEETH_EDGE_ROWS
    at = np.asarray(upper + down * (lower - upper), np.float32)
    light = np.asarray(cv2.remap(photo.rgb, at[..., 0], at[..., 1], cv2.INTER_LINEAR), np.float32) @ LUMINANCE_WEIGHTS
    rows = light.mean(axis=1)
    lightest = int(rows.argmax())
    below = np.flatnonzero(rows[lightest:] < TEETH_EDGE_LIGHT_SHARE * rows[lightest])
    return float(np.clip((lightest + below[0]) / TEETH_EDGE_ROWS if len(below) else 1.0, *TEETH_EDGE_RANGE))
