"""Expressions from the driver's face to the target's, which has other proportions.

Equation 1 carries every offset by one similarity. A smile then moves a wide mouth as much as a narrow one.
Here the linear part varies over the face: at each vertex it is the linear map that carries the driver's
neutral face around it to the target's, held near the similarity where the faces say little.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import Similarity

NEIGHBOURHOOD_EYE_DISTANCES = 0.6
"""Width of the neighbourhood the local map is fitted over, in eye distances."""
SIMILARITY_RIDGE = 0.15
"""How strongly the local map is held to the similarity, against a neighbourhood's own spread."""


def local_maps(
    phi: Similarity, neutral: NDArray[np.floating], target: NDArray[np.floating], unit: float
) -> NDArray[np.float64]:
    """(478, 2, 2): the linear map at each vertex.

    Parameters
    ----------
    neutral, target : (478, 3) meshes. unit : the driver's eye distance, pixels.
    """
    source, destination = (mesh[:, :2] - mesh[:, :2].mean(axis=0, dtype=float) for mesh in (neutral, target))
    (x, y), (u, v) = source.T, destination.T
    weight = np.exp(-((x[:, None] - x) ** 2 + (y[:, None] - y) ** 2) / (2 * (NEIGHBOURHOOD_EYE_DISTANCES * unit) ** 2))
    weight /= weight.sum(axis=1, keepdims=True)
    mean = weight @ np.column_stack([source, destination])
    squares = weight @ np.column_stack([x * x, x * y, x * y, y * y, u * x, u * y, v * x, v * y])
    squares -= mean[:, [0, 0, 1, 1, 2, 2, 3, 3]] * mean[:, [0, 1, 0, 1, 0, 1, 0, 1]]
    spread, cross = squares[:, :4].reshape(-1, 2, 2), squares[:, 4:].reshape(-1, 2, 2)
    ridge = SIMILARITY_RIDGE * np.trace(spread, axis1=1, axis2=2)[:, None, None] / 2 * np.eye(2)
    return (cross + phi.linear @ ridge) @ np.linalg.inv(spread + ridge)


def carry_expression(
    maps: NDArray[np.float64], phi: Similarity, expression: NDArray[np.floating]
) -> NDArray[np.float64]:
    """Offsets (N, 478, 3) in the driver's neutral frame to the target's, pixels."""
    plane = np.einsum("vij,nvj->nvi", maps, expression[..., :2])
    return np.concatenate([plane, phi.scale * expression[..., 2:]], axis=-1)
