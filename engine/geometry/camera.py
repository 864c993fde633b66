"""The camera: where points of space are seen in a picture, and what a pixel looks at.

One pinhole with the distortion of its lens, for all who draw, fit or reconstruct. By itself it looks along -z, as a
photographer stands before a sitter who faces +z, with y up, as the world has it. Vision's way to say the same, with x right,
y down and z into the picture, is there as well: `intrinsics` K, `rotation` R and `translation` t, so that a point p is
seen at K (R p + t).

Source of the distortion: D. C. Brown, Decentering distortion of lenses, Photogrammetric Engineering 32, 1966, with the
coefficients in OpenCV's order.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from engine.compiled import njit
from engine.geometry.registration.rigid import Similarity

Axes = tuple[tuple[float, ...], ...]

IDENTITY_ROTATION: Axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
RENDER_TO_VISION_AXES = np.diag([1.0, -1.0, -1.0])
"""From x right, y up, z backwards to x right, y down, z forwards, and back."""
DISTORTION_COEFFICIENTS = 5
"""Of a lens: k1, k2, p1, p2, k3."""
MAX_UNDISTORTION_STEPS = 50
"""Steps in which distortion is undone, at most."""
CONVERGED_STEP_LENGTH = 1e-12
"""Length of a step, on the plane at distance 1, at which distortion is undone."""


@dataclass(frozen=True)
class Camera:
    """A camera.

    eye : (3,) metres.
    focal : pixels, along a row of the picture.
    centre : (x, y) the principal point in pixels.
    size : (height, width) of the picture.
    axes : three unit vectors of the world: the camera's right, its up, and backwards, away from what it looks at.
    distortion : none, or Brown's coefficients of a lens (k1, k2, p1, p2) or (k1, k2, p1, p2, k3), as OpenCV has them.
    aspect : focal length down a column by that along a row; 1 where pixels are square.
    """

    eye: tuple[float, float, float]
    focal: float
    centre: tuple[float, float]
    size: tuple[int, int]
    axes: Axes = IDENTITY_ROTATION
    distortion: tuple[float, ...] = ()
    aspect: float = 1.0

    def __post_init__(self) -> None:
        if len(self.distortion) not in (0, DISTORTION_COEFFICIENTS - 1, DISTORTION_COEFFICIENTS):
            raise ValueError(f"a lens has no, 4 or 5 coefficients of distortion, not {len(self.distortion)}")

    @staticmethod
    def of_matrices(
        intrinsics: NDArray[np.floating],
        rotation: NDArray[np.floating],
        translation: NDArray[np.floating],
        size: tuple[int, int],
        distortion: tuple[float, ...] = (),
    ) -> Camera:
        """The camera that sees p at K (R p + t): K (3, 3), R (3, 3) and t (3,) as OpenCV and COLMAP give them.

        Raises ValueError where K has skew: rows and columns of a picture's pixels are square to each other.
        """
        if abs(intrinsics[0, 1]) > 1e-9 * abs(intrinsics[0, 0]):
            raise ValueError("a camera whose pixels are skew is not supported")
        x, y, z = (-np.asarray(rotation, np.float64).T @ translation).tolist()
        axes: Axes = tuple(map(tuple, (RENDER_TO_VISION_AXES @ rotation).tolist()))
        focal, centre = float(intrinsics[0, 0]), (float(intrinsics[0, 2]), float(intrinsics[1, 2]))
        return Camera((x, y, z), focal, centre, size, axes, distortion, float(intrinsics[1, 1]) / focal)

    @property
    def intrinsics(self) -> NDArray[np.float64]:
        """K (3, 3): from x right, y down, z forwards to homogeneous pixels, the lens's distortion left aside."""
        (x, y), down = self.centre, self.focal * self.aspect
        return np.array([[self.focal, 0.0, x], [0.0, down, y], [0.0, 0.0, 1.0]])

    @property
    def rotation(self) -> NDArray[np.float64]:
        """R (3, 3): from the world's axes to x right, y down, z forwards."""
        return np.asarray(RENDER_TO_VISION_AXES @ np.array(self.axes))

    @property
    def translation(self) -> NDArray[np.float64]:
        """t (3,): the world's origin as the camera has it, x right, y down, z forwards, metres."""
        return np.asarray(-self.rotation @ np.array(self.eye))

    @property
    def projection(self) -> NDArray[np.float64]:
        """K [R | t] (3, 4): from homogeneous points of the world to homogeneous pixels, the lens's distortion left aside."""
        return np.asarray(self.intrinsics @ np.hstack([self.rotation, self.translation[:, None]]))

    @overload
    def project(self, points: NDArray[np.floating]) -> NDArray[np.float32]: ...

    @overload
    def project(
        self, points: NDArray[np.floating], dtype: type[np.float64], nearest: float = ...
    ) -> NDArray[np.float64]: ...

    def project(
        self, points: NDArray[np.floating], dtype: type = np.float32, nearest: float = -np.inf
    ) -> NDArray[np.floating]:
        """Where points (..., 3) in metres are seen, (..., 3): x and y in pixels and the distance along the view axis.

        In float32, as rasterisers take them, or float64, as whoever searches by small steps needs them. Points behind the
        eye have a distance <= 0 and no meaningful pixel; the rasteriser leaves them out. Those not as far away as `nearest`
        (metres) come to lie where they would be seen at that distance, so that a search may lead through the camera. What is
        so far aside that the polynomial of the lens would fold it back into the picture goes on outwards.
        """
        rows = np.ascontiguousarray(points, np.float64).reshape(-1, 3)
        found = np.empty((len(rows), 3))
        lens = np.array([self.focal, self.focal * self.aspect, *self.centre, nearest, _fold(self.distortion)])
        _project(rows, np.array(self.eye), np.array(self.axes), lens, self._coefficients(), found)
        return found.reshape(np.shape(points)).astype(dtype, copy=False)

    def depth(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """(...,) metres along the view axis to points (..., 3); not above zero behind the eye."""
        return np.asarray((np.array(self.eye) - np.asarray(points, np.float64)) @ np.array(self.axes[2]))

    def unproject(self, pixels: NDArray[np.floating], depth: ArrayLike) -> NDArray[np.float64]:
        """The inverse of `project`: (..., 3) the points that are seen at pixels (..., 2), so many metres (...,) along the
        view axis. NaN for pixels so far outside that the lens shows nothing there."""
        away = np.asarray(depth, np.float64)
        x, y = self._offsets(pixels)
        at = np.stack([x * away / self.focal, -y * away / (self.focal * self.aspect), -(away + np.zeros_like(x))], -1)
        return np.asarray(at @ np.array(self.axes) + np.array(self.eye))

    def rays(self, pixels: NDArray[np.floating]) -> NDArray[np.float64]:
        """(N, 2) pixels to (N, 3) the directions in which they look, in the world, one metre along the view axis."""
        x, y = self._offsets(pixels)
        return np.stack([x / self.focal, -y / (self.focal * self.aspect), -np.ones_like(x)], -1) @ np.array(self.axes)

    def scaled(self, factor: float) -> Camera:
        """The camera of the same picture, resized by `factor`, with pixel centres at whole numbers in both."""
        x, y = ((c + 0.5) * factor - 0.5 for c in self.centre)
        size = round(self.size[0] * factor), round(self.size[1] * factor)
        return replace(self, focal=self.focal * factor, centre=(x, y), size=size)

    def cropped(self, left: int, top: int, size: tuple[int, int]) -> Camera:
        """The camera of a part of the picture that begins at pixel (left, top); `size` (height, width)."""
        return replace(self, centre=(self.centre[0] - left, self.centre[1] - top), size=size)

    def moved(self, motion: Similarity) -> Camera:
        """The camera carried along with its world by a rigid motion or a similarity: it sees the moved points where it
        saw them before."""
        x, y, z = motion(np.array(self.eye)).tolist()
        axes = (np.array(self.axes) @ motion.rotation.T).tolist()
        return replace(self, eye=(x, y, z), axes=tuple(map(tuple, axes)))

    def aimed(self, eye: ArrayLike, target: ArrayLike) -> Camera:
        """A camera with this lens, level, at `eye` and looking at `target` (3,). The target may not be right above the
        eye."""
        back = np.asarray(eye, np.float64) - np.asarray(target, np.float64)
        back = back / np.linalg.norm(back)
        right = np.cross([0.0, 1.0, 0.0], back)
        right = right / np.linalg.norm(right)
        axes = np.stack([right, np.cross(back, right), back]).tolist()
        x, y, z = np.asarray(eye, np.float64).tolist()
        return replace(self, eye=(x, y, z), axes=tuple(map(tuple, axes)))

    def _coefficients(self) -> NDArray[np.float64]:
        """Of the lens, all five or none."""
        return np.array(
            [*self.distortion, *[0.0] * (DISTORTION_COEFFICIENTS - len(self.distortion))] if self.distortion else []
        )

    def _offsets(self, pixels: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """x and y (...,) in pixels from the principal point, as they would be without distortion."""
        away = np.asarray(pixels, np.float64) - self.centre
        if self.distortion:
            focal = np.array([self.focal, self.focal * self.aspect])
            away = _undistort((away / focal).reshape(-1, 2), self._coefficients()).reshape(away.shape) * focal
        return away[..., 0], away[..., 1]


@lru_cache(maxsize=1024)
def _fold(distortion: tuple[float, ...]) -> float:
    """Squared distance from the axis, on the plane at distance 1, from which on a lens would bring places back inwards."""
    if not distortion:
        return np.inf
    k1, k2, _, _, k3 = [*distortion, *[0.0] * (DISTORTION_COEFFICIENTS - len(distortion))]
    roots = np.roots([7 * k3, 5 * k2, 3 * k1, 1.0])  # of the slope of the distorted distance
    turning = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0)]
    return float(turning.min()) if len(turning) else np.inf


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _project(
    points: np.ndarray, eye: np.ndarray, axes: np.ndarray, lens: np.ndarray, coefficients: np.ndarray, found: np.ndarray
) -> None:
    across, down, x, y, nearest, fold = lens
    for v in range(len(points)):
        a, b, c = points[v, 0] - eye[0], points[v, 1] - eye[1], points[v, 2] - eye[2]
        distance = -(a * axes[2, 0] + b * axes[2, 1] + c * axes[2, 2])
        right = a * axes[0, 0] + b * axes[0, 1] + c * axes[0, 2]
        up = a * axes[1, 0] + b * axes[1, 1] + c * axes[1, 2]
        away = max(distance, nearest)
        if len(coefficients):
            aside = (right * right + up * up) / (away * away)
            shrunk = np.sqrt(fold / aside) if aside > fold else 1.0
            px, py = _distorted(shrunk * right / away, -shrunk * up / away, coefficients)
            found[v, 0] = across * px / shrunk + x
            found[v, 1] = down * py / shrunk + y
        else:
            found[v, 0] = across * right / away + x
            found[v, 1] = -down * up / away + y
        found[v, 2] = distance


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _distorted(x: float, y: float, coefficients: np.ndarray) -> tuple[float, float]:
    """Where the lens has what is seen at (x, y) on the plane at distance 1."""
    k1, k2, p1, p2, k3 = coefficients
    r = x * x + y * y
    radial = 1 + r * (k1 + r * (k2 + r * k3))
    return x * radial + 2 * p1 * x * y + p2 * (r + 2 * x * x), y * radial + p1 * (r + 2 * y * y) + 2 * p2 * x * y


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _undistort(places: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    """The inverse of `_distorted` for (N, 2), by Newton's method; NaN where it leads nowhere."""
    k1, k2, p1, p2, k3 = coefficients
    found = np.full_like(places, np.nan)
    for n in range(len(places)):
        x, y = places[n]
        for _ in range(MAX_UNDISTORTION_STEPS):
            at_x, at_y = _distorted(x, y, coefficients)
            r = x * x + y * y
            radial = 1 + r * (k1 + r * (k2 + r * k3))
            slope = 2 * (k1 + r * (2 * k2 + r * 3 * k3))  # of the radial factor, by x, is x times this
            xx = radial + x * x * slope + 2 * p1 * y + 6 * p2 * x
            xy = x * y * slope + 2 * p1 * x + 2 * p2 * y
            yy = radial + y * y * slope + 6 * p1 * y + 2 * p2 * x
            determinant = xx * yy - xy * xy
            off_x, off_y = places[n, 0] - at_x, places[n, 1] - at_y
            step_x, step_y = (yy * off_x - xy * off_y) / determinant, (xx * off_y - xy * off_x) / determinant
            x, y = x + step_x, y + step_y
            if abs(step_x) + abs(step_y) < CONVERGED_STEP_LENGTH:
                if radial > 0 and determinant > 0:  # else it is a solution beyond where the lens folds back
                    found[n, 0], found[n, 1] = x, y
                break
    return found
