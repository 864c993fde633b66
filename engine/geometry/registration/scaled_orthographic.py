"""A camera so far off that what is nearer looks no larger: where it stands, by the places at which it shows known points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def scaled_orthographic(
    points: NDArray[np.floating], places: NDArray[np.floating]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Matrices (..., 2, 3), rows of one length at right angles, and shifts (..., 2) that carry `points` (V, 3) to `places` (..., V, 2):
    of the affine maps with the least squares the nearest ones that are such."""
    model, seen = np.asarray(points, np.float64), np.asarray(places, np.float64)
    middle, at = model.mean(axis=0), seen.mean(axis=-2)
    affine = np.swapaxes(np.linalg.pinv(model - middle) @ (seen - at[..., None, :]), -1, -2)
    left, lengths, right = np.linalg.svd(affine, full_matrices=False)
    matrices = lengths.mean(axis=-1)[..., None, None] * (left @ right)
    return matrices, at - matrices @ middle
