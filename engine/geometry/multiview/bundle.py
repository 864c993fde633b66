"""Bundles: cameras, points of space, and the pixels at which the ones see the others.

A camera is a rotation R and a translation t in vision's axes (x right, y down, z into the picture), and one of a few
lenses: a focal length in pixels with two radial coefficients of distortion, its principal point known. A point p is
seen at f (1 + k1 r2 + k2 r2^2) (x, y) / z + centre. There (x, y, z) = R p + t and r2 = (x^2 + y^2) / z^2 (Brown's
model, as `engine.geometry.camera.Camera` and OpenCV have it).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.geometry.camera import Camera
from engine.geometry.registration.rigid import Similarity

MIN_POINT_DEPTH = 1e-9
"""Distance along the view axis from which on a point is before the camera."""


@dataclass(frozen=True)
class Bundle:
    """C cameras, their L lenses and P points, in one unit of length.

    rotations : (C, 3, 3) float64, from the world to each camera.
    translations : (C, 3) float64, likewise.
    lenses : (L, 3) float64, focal length in pixels, k1, k2.
    centres : (L, 2) float64, principal points, pixels.
    lens_of : (C,) int, which of the lenses each camera has.
    points : (P, 3) float64.
    """

    rotations: NDArray[np.float64]
    translations: NDArray[np.float64]
    lenses: NDArray[np.float64]
    centres: NDArray[np.float64]
    lens_of: NDArray[np.intp]
    points: NDArray[np.float64]

    @property
    def eyes(self) -> NDArray[np.float64]:
        """(C, 3) where the cameras stand."""
        return np.asarray(-np.einsum("cji,cj->ci", self.rotations, self.translations))

    def camera(self, index: int, size: tuple[int, int]) -> Camera:
        """One of the cameras, of a picture of a `size` (height, width)."""
        lens = int(self.lens_of[index])
        focal, k1, k2 = self.lenses[lens].tolist()
        x, y = self.centres[lens].tolist()
        intrinsics = np.array([[focal, 0, x], [0, focal, y], [0, 0, 1]])
        return Camera.of_matrices(intrinsics, self.rotations[index], self.translations[index], size, (k1, k2, 0.0, 0.0))

    def moved(self, change: Similarity) -> Bundle:
        """This bundle in another frame: every point p and every eye becomes `change(p)`; pictures stay alike."""
        rotations = self.rotations @ change.rotation.T
        translations = -np.einsum("cij,cj->ci", rotations, change(self.eyes))
        return replace(self, rotations=rotations, translations=translations, points=change(self.points))


@dataclass(frozen=True)
class Observations:
    """Which camera sees which point where: `camera` (O,), `point` (O,) indices, `pixels` (O, 2)."""

    camera: NDArray[np.intp]
    point: NDArray[np.intp]
    pixels: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.camera)

    def __getitem__(self, chosen: NDArray[np.integer] | NDArray[np.bool_]) -> Observations:
        """Those that an index array or a mask (O,) chooses."""
        return Observations(self.camera[chosen], self.point[chosen], self.pixels[chosen])


def reprojection_errors(bundle: Bundle, seen: Observations) -> NDArray[np.float64]:
    """(O,) how far, in pixels, each point is seen from where its camera would see it; infinite behind the camera."""
    lens = bundle.lens_of[seen.camera]
    found = np.empty(len(seen))
    _errors(
        *(bundle.rotations, bundle.translations, bundle.lenses[lens], bundle.points),
        *(seen.camera, seen.point, seen.pixels - bundle.centres[lens], found),
    )
    return found


def undistorted(
    pixels: NDArray[np.floating], lens: NDArray[np.floating], centre: NDArray[np.floating]
) -> NDArray[np.float64]:
    """Pixels (N, 2) of a lens (focal, k1, k2) on the plane at distance 1, without distortion: (N, 2). NaN for what is so
    far outside that the lens shows nothing there."""
    focal, k1, k2 = (float(value) for value in lens)
    camera = Camera((0, 0, 0), focal, (float(centre[0]), float(centre[1])), (1, 1), distortion=(k1, k2, 0.0, 0.0))
    return np.asarray(camera.rays(np.asarray(pixels, np.float64))[:, :2] * [1.0, -1.0])


@njit(nogil=True, error_model="numpy")
def _errors(
    rotations: np.ndarray,
    translations: np.ndarray,
    lenses: np.ndarray,
    points: np.ndarray,
    cameras: np.ndarray,
    indices: np.ndarray,
    offsets: np.ndarray,
    found: np.ndarray,
) -> None:
    for o in range(len(cameras)):
        turn, at = rotations[cameras[o]], points[indices[o]]
        shift = translations[cameras[o]]
        z = turn[2, 0] * at[0] + turn[2, 1] * at[1] + turn[2, 2] * at[2] + shift[2]
        if z <= MIN_POINT_DEPTH:
            found[o] = np.inf
            continue
        x = (turn[0, 0] * at[0] + turn[0, 1] * at[1] + turn[0, 2] * at[2] + shift[0]) / z
        y = (turn[1, 0] * at[0] + turn[1, 1] * at[1] + turn[1, 2] * at[2] + shift[1]) / z
        focal, k1, k2 = lenses[o]
        square = x * x + y * y
        stretch = focal * (1 + square * (k1 + square * k2))
        found[o] = np.hypot(stretch * x - offsets[o, 0], stretch * y - offsets[o, 1])
