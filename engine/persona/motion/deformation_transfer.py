"""A driver's deformation carried to the puppet, as large as the puppet's own face asks for.

Source: section 4, figure 3. A lid that closes moves by the height of its eye: where the puppet's eye is larger, the same movement would
leave it open. So each point's movement is measured by where it leads on the driver's face, and made as long as the way between the
corresponding two points of the puppet's face, along it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from scipy.spatial import cKDTree

from engine.imaging.total_variation import denoised
from engine.persona.texture.texture_frame import TextureFrame, with_rim

TV_WEIGHT, HUBER = 1.0, 0.05
"""Section 6."""
MIN_MOVEMENT = 0.02
"""Eye distances: by which movement of less nothing is told of how far one like it leads."""
MAX_FACTOR = 2.5
"""And its inverse: no face is so unlike another."""
MIN_TRUST = 1e-3
"""Of points that do not move, and so tell nothing: they take the factors of those about them, not these theirs."""
COARSENESS = 2
"""Pixels of the frame for one of the field in which factors are told."""


@dataclass(frozen=True)
class DeformationTransfer:
    """From the average face of a driver to that of a puppet.

    driver, puppet : their frames, of one size. shift : (H, W, 2) pixels from each of the driver's frame to what corresponds to it in the
    puppet's, beside what the meshes say of that; None for none.
    """

    driver: TextureFrame
    puppet: TextureFrame
    shift: NDArray[np.float32] | None = None

    def __call__(self, deformation: NDArray[np.floating]) -> NDArray[np.float64]:
        """(478, 3) by how much the puppet's vertices move where the driver's move by `deformation` (478, 3); both from the average
        face in front view, in eye distances."""
        moved = with_rim(np.asarray(deformation, np.float64) + self._driver_mesh) - with_rim(self._driver_mesh)
        factors = self.factors(self.driver.interpolated(moved)[::COARSENESS, ::COARSENESS])
        at = (self.driver.places[:478, :2] / COARSENESS).astype(np.float32)
        own = cv2.remap(factors, at[:, :1], at[:, 1:], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        return np.asarray(deformation * np.asarray(own), np.float64)

    def factors(self, moved: NDArray[np.floating]) -> NDArray[np.float32]:
        """(h, w) by how much longer each movement of `moved` (h, w, 3) is on the puppet, in eye distances; denoised."""
        tree, points, puppets = self._surfaces
        here = self._covered
        led = points + np.asarray(moved, np.float64)[here]
        nearest = tree.query(led)[1]
        step, own = points[nearest] - points, puppets[nearest] - puppets
        length = np.linalg.norm(step, axis=1)
        factor = (step * own).sum(axis=1) / np.maximum(length**2, 1e-12)
        told = (length > MIN_MOVEMENT) & (np.linalg.norm(moved[here], axis=1) > MIN_MOVEMENT)
        if not told.any():
            return np.ones(here.shape, np.float32)
        known = np.zeros(here.shape, np.bool_)
        known[here] = told
        field = np.ones(here.shape, np.float32)
        field[known] = np.clip(factor[told], 1 / MAX_FACTOR, MAX_FACTOR)
        rows, columns = distance_transform_edt(~known, return_distances=False, return_indices=True)
        return denoised(field[rows, columns], TV_WEIGHT, HUBER, np.maximum(known, MIN_TRUST))

    @cached_property
    def _driver_mesh(self) -> NDArray[np.float64]:
        return self.driver.places[:478] / self.driver.scale

    @cached_property
    def _covered(self) -> NDArray[np.bool_]:
        return self.driver.covered[::COARSENESS, ::COARSENESS]

    @cached_property
    def _surfaces(self) -> tuple[cKDTree, NDArray[np.float64], NDArray[np.float64]]:
        """The driver's points by their places, they, and the corresponding ones of the puppet, in eye distances (P, 3)."""
        step = np.s_[::COARSENESS, ::COARSENESS]
        points = self.driver.interpolated(self.driver.places)[step][self._covered] / self.driver.scale
        puppets = self.driver.interpolated(self.puppet.places)
        if self.shift is not None:
            puppets = self._by_shift(puppets)
        return (
            cKDTree(points),
            points.astype(np.float64),
            puppets[step][self._covered].astype(np.float64) / self.puppet.scale,
        )

    def _by_shift(self, puppets: NDArray[np.float32]) -> NDArray[np.float32]:
        assert self.shift is not None
        at = (puppets[..., :2] + self.shift).astype(np.float32)
        whole = self.puppet.interpolated(self.puppet.places)
        found = cv2.remap(whole, at[..., 0], at[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        return np.asarray(found, np.float32)
