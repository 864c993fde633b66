"""Normals of a face that many photographs show, each in a light that nobody knows.

Source: section 4, "3D Average Model Estimation", which follows I. Kemelmacher-Shlizerman, S. M. Seitz, Face
reconstruction in the wild, ICCV 2011: of Lambertian faces under distant lights (first-order harmonics) all photographs
are mixtures of four pictures, albedo and albedo times normal. Which four is told by a template of another face.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.persona.texture.appearance_subspace import SUBSPACE_RANK, Appearance

ALBEDO_ALTERNATIONS = 3
"""Rounds in which the albedo that the template is multiplied with comes from the estimate before."""


@dataclass(frozen=True)
class PhotometricShape:
    """normals : (H, W, 3) float64 of unit length: x right, y down, z away from the viewer.
    albedo : (H, W) float64, in grey levels.

    Both are zero outside the area.
    """

    normals: NDArray[np.float64]
    albedo: NDArray[np.float64]


def photometric_stereo(
    seen: Appearance, template: NDArray[np.floating], area: NDArray[np.bool_], trusted: NDArray[np.bool_]
) -> PhotometricShape:
    """The normals of photographs as their subspace has them, over `area` (H, W).

    template : (H, W, 3) normals of a face that is alike.
    trusted : (H, W) bool, where it is skin. There the template tells which mixtures are normals (the rest of the
        generalised bas-relief ambiguity among them).
    """
    rows = seen.projected[:, area]
    _, vectors = np.linalg.eigh((rows @ rows.T).astype(np.float64))
    basis = vectors[:, -SUBSPACE_RANK:].T @ rows.astype(np.float64)
    basis /= np.linalg.norm(basis, axis=1, keepdims=True)
    inside = trusted[area]
    known = np.concatenate([np.ones((1, int(area.sum()))), np.asarray(template, np.float64)[area].T])
    albedo = rows.mean(axis=0).astype(np.float64)
    mixed = known
    for _ in range(ALBEDO_ALTERNATIONS):
        wanted = (albedo * known)[:, inside]
        mixed = wanted @ np.linalg.pinv(basis[:, inside]) @ basis
        albedo = np.linalg.norm(mixed[1:], axis=0)
    normals = np.zeros((*area.shape, 3))
    normals[area] = (mixed[1:] / np.maximum(albedo, 1e-9)).T
    whole = np.zeros(area.shape)
    whole[area] = albedo
    return PhotometricShape(normals, whole)
