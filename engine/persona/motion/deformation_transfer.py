"""A driver's deformation carried to the puppet, as large as the puppet's own face asks for.

Source: section 4, figure 3. A lid that closes moves by the height of its eye: where the puppet's eye is larger, the same movement would
leave it open. So each point's movement is measured by where it leads on the driver's face, and made as long as the way between the
corresponding two points of the puppet's face, along it.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from engine.compiled import njit
from engine.imaging.total_variation import denoised
from engine.persona.motion.contact import corrected
from engine.persona.texture.texture_frame import TextureFrame, with_rim

TV_WEIGHT, HUBER_THRESHOLDS = 0.5, 0.1
"""Section 6's 1 and 0.05, of a field with twice as many pixels to a side: with 1 here, thin rims of lips and lids lose half of what
sets their factors apart, and do not meet."""
MIN_MOVEMENT_EYE_DISTANCES = 0.02
"""Eye distances: by which movement of less nothing is told of how far one like it leads."""
MAX_FACTOR = 2.5
"""How many times longer a movement may be on one face than on another, at most: none is so unlike another."""
MIN_TRUST = 1e-3
"""Trust in points that do not move, and so tell nothing: they take the factors of those about them."""
NEIGHBOURHOOD_PIXELS = 2
"""Pixels of the field of factors about a point among which a nearer one is sought."""
PIXELS_PER_FACTOR = 2
"""Pixels of the frame for one of the field in which factors are told."""


@dataclass(frozen=True)
class DeformationTransfer:
    """From the average face of a driver to that of a puppet.

    driver, puppet : their frames, of one size. What corresponds is what the same triangle of both meshes covers: the flow between averages in
    one another's light, which the paper has, was tried on heads of known correspondence, and lies farther off.
    """

    driver: TextureFrame
    puppet: TextureFrame

    def __call__(self, deformation: NDArray[np.floating]) -> NDArray[np.float64]:
        """(478, 3) by how much the puppet's vertices move where the driver's move by `deformation` (478, 3); both from the average
        face in front view, in eye distances."""
        moved = with_rim(np.asarray(deformation, np.float64) + self._driver_mesh) - with_rim(self._driver_mesh)
        factors = self.factors((self._interpolation @ moved).reshape(*self._covered.shape, 3))
        at = (self.driver.places[:478, :2] / PIXELS_PER_FACTOR).astype(np.float32)
        own = cv2.remap(factors, at[:, :1], at[:, 1:], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        longer = deformation * np.asarray(own)
        return corrected(longer, np.asarray(own), deformation, self._driver_mesh, self._puppet_mesh)

    def of_frames(
        self, deformations: NDArray[np.floating], tick: Callable[[float], None] = lambda fraction: None
    ) -> NDArray[np.float64]:
        """(F, 478, 3) the same of many frames (F, 478, 3), side by side."""
        out = np.empty(deformations.shape)
        self(np.zeros(self._driver_mesh.shape))  # what all frames share is made once
        with ThreadPoolExecutor(os.cpu_count() or 1, thread_name_prefix="transfer") as pool:
            for number, moved in enumerate(pool.map(self, deformations)):
                out[number] = moved
                tick((number + 1) / len(out))
        return out

    def factors(self, moved: NDArray[np.floating]) -> NDArray[np.float32]:
        """(h, w) by how much longer each movement of `moved` (h, w, 3) is on the puppet, in eye distances; denoised."""
        points, puppets = self._surfaces
        field, known = _told(np.ascontiguousarray(moved, np.float32), points, puppets, self._covered, self._pixels)
        if not known.any():
            return np.ones(known.shape, np.float32)
        rows, columns = distance_transform_edt(~known, return_distances=False, return_indices=True)
        return denoised(field[rows, columns], TV_WEIGHT, HUBER_THRESHOLDS, np.maximum(known, MIN_TRUST))

    @property
    def _pixels(self) -> float:
        """Of the coarse frame, for an eye distance."""
        return self.driver.scale / PIXELS_PER_FACTOR

    @cached_property
    def _driver_mesh(self) -> NDArray[np.float64]:
        return self.driver.places[:478] / self.driver.scale

    @cached_property
    def _puppet_mesh(self) -> NDArray[np.float64]:
        return self.puppet.places[:478] / self.puppet.scale

    @cached_property
    def _covered(self) -> NDArray[np.bool_]:
        return self.driver.covered[::PIXELS_PER_FACTOR, ::PIXELS_PER_FACTOR]

    @cached_property
    def _interpolation(self) -> sp.csr_array:
        """(h * w, V) which blends the vertices' values at each of the coarse frame's pixels."""
        step = np.s_[::PIXELS_PER_FACTOR, ::PIXELS_PER_FACTOR]
        triangle, weights = (layer[step].reshape(self._covered.size, -1) for layer in self.driver.raster[:2])
        columns = self.driver.triangles[triangle[:, 0]]  # of pixels that nothing covers any: their weights are zero
        starts = np.arange(len(weights) + 1) * 3
        shape = (len(weights), len(self.driver.places))
        return sp.csr_array((weights.ravel(), columns.ravel(), starts), shape)

    @cached_property
    def _surfaces(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """(h, w, 3) the driver's points, and the corresponding ones of the puppet, in eye distances."""
        step = np.s_[::PIXELS_PER_FACTOR, ::PIXELS_PER_FACTOR]
        puppets = self.driver.interpolated(self.puppet.places)
        points = self.driver.interpolated(self.driver.places)
        return (
            np.ascontiguousarray(points[step] / np.float32(self.driver.scale)),
            np.ascontiguousarray(puppets[step] / np.float32(self.puppet.scale)),
        )


@njit(nogil=True, error_model="numpy", boundscheck=False)
def _told(
    moved: np.ndarray, points: np.ndarray, puppets: np.ndarray, covered: np.ndarray, pixels: float
) -> tuple[np.ndarray, np.ndarray]:
    """(h, w) each point's factor, and where its movement tells one.

    Where a movement (h, w, 3) leads is the nearest of the driver's points: it is found by going downhill from where the movement
    leads within the frame, as far as neighbours are nearer.
    """
    height, width = covered.shape
    field, known = np.ones((height, width), np.float32), np.zeros((height, width), np.bool_)
    for y in range(height):
        for x in range(width):
            dx, dy, dz = moved[y, x, 0], moved[y, x, 1], moved[y, x, 2]
            if not covered[y, x] or dx * dx + dy * dy + dz * dz <= MIN_MOVEMENT_EYE_DISTANCES**2:
                continue
            px, py, pz = points[y, x, 0] + dx, points[y, x, 1] + dy, points[y, x, 2] + dz
            row = min(max(round(y + dy * pixels), 0), height - 1)
            column = min(max(round(x + dx * pixels), 0), width - 1)
            if not covered[row, column]:
                row, column = y, x
            best = _squared(points, row, column, px, py, pz)
            nearer = True
            while nearer:
                nearer = False
                middle_row, middle_column = row, column
                for r in range(
                    max(middle_row - NEIGHBOURHOOD_PIXELS, 0), min(middle_row + NEIGHBOURHOOD_PIXELS + 1, height)
                ):
                    for c in range(
                        max(middle_column - NEIGHBOURHOOD_PIXELS, 0),
                        min(middle_column + NEIGHBOURHOOD_PIXELS + 1, width),
                    ):
                        apart = _squared(points, r, c, px, py, pz)
                        if covered[r, c] and apart < best:
                            row, column, best, nearer = r, c, apart, True
            length, along = 0.0, 0.0
            for k in range(3):
                step = points[row, column, k] - points[y, x, k]
                length += step * step
                along += step * (puppets[row, column, k] - puppets[y, x, k])
            if length > MIN_MOVEMENT_EYE_DISTANCES**2:
                field[y, x] = min(max(along / length, 1 / MAX_FACTOR), MAX_FACTOR)
                known[y, x] = True
    return field, known


@njit(inline="always")
def _squared(points: np.ndarray, row: int, column: int, x: float, y: float, z: float) -> float:
    return (points[row, column, 0] - x) ** 2 + (points[row, column, 1] - y) ** 2 + (points[row, column, 2] - z) ** 2
