"""A face as it looks in a frame: its mesh, and a small picture of it, upright by the eyes."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import fit_similarity
from engine.imaging.warping.delaunay import delaunay
from engine.imaging.warping.mesh_warp import inverse_map
from engine.perception.face.landmarks import LIPS_INNER, eye_centres

CROP_SHAPE = (320, 288)
"""Height and width of the kept appearance of the face, pixels: about 20 kB a frame."""
CROP_EYES = ((96.0, 116.0), (192.0, 116.0))
"""Where the eyes' centres lie in a crop of the face."""
CROP_EYE_DISTANCE_PIXELS = CROP_EYES[1][0] - CROP_EYES[0][0]
EDGE_POINTS = np.array(
    [(x * (CROP_SHAPE[1] - 1), y * (CROP_SHAPE[0] - 1)) for x in (0, 0.5, 1) for y in (0, 0.5, 1) if x * y != 0.25],
    np.float32,
)
"""(8, 2) points of the crop that stay where they are when the face in it moves."""


@dataclass(frozen=True)
class FaceCrop:
    """`mesh` (478, 3) float32, pixels of the frame; `place` (2, 3) carries these to pixels of `crop`, uint8 (*CROP, 3)."""

    mesh: NDArray[np.float32]
    place: NDArray[np.float64]
    crop: NDArray[np.uint8]

    def in_crop(self) -> NDArray[np.float32]:
        """(478, 2) the mesh in the crop's pixels."""
        return np.asarray(self.mesh[:, :2] @ self.place[:, :2].T + self.place[:, 2], np.float32)


def crop_place(mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(2, 3): carries pixels of a picture with a face at `mesh` (478, 2 or 3) to pixels of the crop, upright by the eyes."""
    eyes = np.array(eye_centres(mesh[:, :2]))
    return fit_similarity(eyes, np.array(CROP_EYES)).matrix()


def crop_face(rgb: NDArray[np.uint8], mesh: NDArray[np.float32]) -> FaceCrop:
    """The face at `mesh` in a frame (H, W, 3)."""
    place = crop_place(mesh)
    crop = cv2.warpAffine(rgb, place, CROP_SHAPE[::-1], flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return FaceCrop(mesh, place, np.asarray(crop, np.uint8))


def interpolate_crops(one: FaceCrop, other: FaceCrop, share: float) -> FaceCrop:
    """The face on its way from one look to another, 0 is the one, 1 the other: both are warped to the mesh between them,
    and faded into each other. The inside of the mouth is of the one who opens it more."""
    mesh = (one.mesh + np.float32(share) * (other.mesh - one.mesh)).astype(np.float32)
    place = crop_place(mesh)
    lands = np.concatenate([mesh[:468, :2] @ place[:, :2].T + place[:, 2], EDGE_POINTS]).astype(np.float32)
    triangles = delaunay(lands)

    warped = []
    for look in (one, other):
        origin = inverse_map(lands, np.concatenate([look.in_crop()[:468], EDGE_POINTS]), triangles, CROP_SHAPE)
        there = cv2.remap(look.crop, origin[..., 0], origin[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        warped.append(there.astype(np.float32))
    mouth = np.zeros(CROP_SHAPE, np.float32)
    cv2.fillPoly(mouth, [lands[list(LIPS_INNER)].round().astype(np.int32)], 1.0)
    open_one, open_other = (1 - share) * _opening(one), share * _opening(other)
    inside = open_other / (open_one + open_other) if open_one + open_other > 0 else share
    shares = share + cv2.GaussianBlur(mouth, (0, 0), 1)[..., None] * (inside - share)
    crop = warped[0] + shares * (warped[1] - warped[0])
    return FaceCrop(mesh, place, (crop + 0.5).astype(np.uint8))


def _opening(look: FaceCrop) -> float:
    """How far the mouth is open, square pixels of the crop."""
    return float(cv2.contourArea(look.in_crop()[list(LIPS_INNER)]))
