"""The persona's skin on a drawn frame of the photograph that acts.

The photograph keeps its own skin and light. What is added is by how much the person's texture for the frame's expression differs from that
for the photograph's own: its creases. And where the photograph is small, the detail that is too fine for its pixels.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.face_animation.mouth.lip_contours import box_around
from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.imaging.warping.mesh_warp import inverse_map
from engine.perception.face.face_tessellation import face_triangles, opening_triangles
from engine.perception.face.landmarks import FACE_OVAL, MESH_SIZE, eye_distance
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.composite.regions import retouched_skin
from engine.persona.light.low_frequencies import low_frequencies
from engine.persona.persona import Persona
from engine.persona.texture.appearance_subspace import REFERENCE_WIDTH_PIXELS
from engine.persona.texture.texture_frame import TextureFrame, sampled

MAX_CREASE_GREY_LEVELS = 45.0
"""Grey levels by which creases may change the skin."""
DETAIL_SIGMAS_PIXELS = (1.2, 6.0)
"""Pixels of a frame 194 wide: what is finer than the one and coarser than the other, contrast is not told by."""
CONTRAST_RANGE = (0.8, 1.5)
"""Of the photograph over the persona, whose means have less of it."""
PIXEL_SIGMA = 0.6
"""Of a photograph's pixel, by which what is between pixels is smooth."""
MIN_DETAIL_SIGMA_PIXELS = 0.5
"""Pixels of the frame: detail that is finer is none."""
BELIEF_RANGE = (0.3, 0.8)
"""Of a photograph's pixels, between which they begin to be skin, and are."""
BELIEF_SIGMA = 2.0
"""Pixels of a frame 194 wide."""


@dataclass(frozen=True)
class Retouching:
    """Of one photograph, in the persona's `frame` (H, W).

    base : (H, W, 3) uint8, the persona's texture for the photograph's own expression.
    skin : (H, W) in [0, 1], where the photograph shows skin.
    contrast : of its detail over the persona's.
    unresolved : sigma, in pixels of the frame, of what its own pixels cannot show; zero where it shows all.
    grey : it is black and white.
    """

    frame: TextureFrame
    base: NDArray[np.uint8]
    skin: NDArray[np.float32]
    contrast: float
    unresolved: float
    grey: bool

    def __call__(
        self,
        picture: NDArray[np.uint8],
        face: NDArray[np.float32],
        depth: NDArray[np.float32],
        texture: NDArray[np.uint8],
    ) -> None:
        """Retouch a `picture` (h, w, 3) in place, whose face is at `face` (478, 2), pixels, `depth` (478,) away, and whose expression's
        `texture` is (H, W, 3)."""
        box = box_around(face[list(FACE_OVAL)].astype(np.float32), picture.shape[:2])
        if box is None:
            return
        x0, y0, x1, y1 = box
        source = self.frame.places[:MESH_SIZE, :2].astype(np.float32)
        moved = (face[:, :2] - (x0, y0)).astype(np.float32)
        at = inverse_map(moved, source, _triangles(), (y1 - y0, x1 - x0), depth)
        layer = cv2.remap(self.layer(texture), at[..., 0], at[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)
        _add(picture[y0:y1, x0:x1], np.asarray(layer, np.float32))

    def layer(self, texture: NDArray[np.uint8]) -> NDArray[np.float32]:
        """(H, W, 3) what is added in the persona's frame, for the `texture` of an expression."""
        now = texture.astype(np.float32)
        apart = now - self.base
        apart -= low_frequencies(apart, self.skin, self.frame.scale)
        added = np.clip(np.float32(self.contrast) * apart, -MAX_CREASE_GREY_LEVELS, MAX_CREASE_GREY_LEVELS)
        if self.unresolved > 0:
            added += np.float32(self.contrast) * (now - cv2.GaussianBlur(now, (0, 0), self.unresolved))
        added *= self.skin[..., None]
        if self.grey:
            added[:] = (added @ LUMINANCE_WEIGHTS)[..., None]
        return added


def retouching_of(persona: Persona, photo: FacePhoto, base: NDArray[np.uint8], grey: bool) -> Retouching:
    """That of a photograph of the persona's, which for the photograph's expression has the texture `base` (H, W, 3)."""
    frame = persona.frame
    unit = frame.size[1] / REFERENCE_WIDTH_PIXELS
    belief = cv2.GaussianBlur(persona.belief[photo.number].astype(np.float32) / 255, (0, 0), BELIEF_SIGMA * unit)
    believed = np.clip((belief - BELIEF_RANGE[0]) / (BELIEF_RANGE[1] - BELIEF_RANGE[0]), 0, 1)
    skin = (retouched_skin(frame) * believed).astype(np.float32)
    own = sampled(photo.rgb, frame.lookup(photo.mesh))
    contrasts = [_contrast(one @ LUMINANCE_WEIGHTS, skin > 0.9, unit) for one in (own, base.astype(np.float32))]
    contrast = float(np.clip(contrasts[0] / max(contrasts[1], 1e-3), *CONTRAST_RANGE))
    pixel = frame.scale / float(eye_distance(photo.mesh[:, :2]))
    sigma = PIXEL_SIGMA * float(np.sqrt(max(pixel**2 - 1, 0)))
    return Retouching(frame, base, skin, contrast, sigma if sigma > MIN_DETAIL_SIGMA_PIXELS else 0.0, grey)


def _contrast(grey: NDArray[np.float32], where: NDArray[np.bool_], unit: float) -> float:
    fine, coarse = (cv2.GaussianBlur(grey, (0, 0), sigma * unit) for sigma in DETAIL_SIGMAS_PIXELS)
    return float((fine - coarse)[where].std()) if where.any() else 1.0


@cache
def _triangles() -> NDArray[np.int32]:
    return np.concatenate([face_triangles(), opening_triangles()])


@njit(fastmath=True, nogil=True)
def _add(picture, layer):  # type: ignore[no-untyped-def]
    """A layer (h, w, 3) on a picture (h, w, 3) uint8, in place."""
    height, width = picture.shape[:2]
    for y in range(height):
        for x in range(width):
            for k in range(3):
                value = np.float32(picture[y, x, k]) + layer[y, x, k] + np.float32(0.5)
                picture[y, x, k] = np.uint8(min(max(value, np.float32(0)), np.float32(255)))
