"""The surface whose slopes come nearest to those given, and that stays near another one where they leave it open.

Source: P. Bhat, B. Curless, M. Cohen, C. L. Zitnick, Fourier analysis of the 2D screened Poisson equation for gradient domain problems,
ECCV 2008.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.fft import dctn, idctn


def screened_poisson(slopes: NDArray[np.floating], near: NDArray[np.floating], screening: float) -> NDArray[np.float64]:
    """(H, W) the surface z that minimises the sum of |grad z - slopes|^2 + screening * (z - near)^2.

    slopes : (H, W, 2) by how much z rises to the next pixel on the right, and below; those of the last column and row do not count.
    near : (H, W). Solved exactly, by cosine transforms: nothing flows over the rim.
    """
    right, below = np.asarray(slopes[..., 0], np.float64).copy(), np.asarray(slopes[..., 1], np.float64).copy()
    right[:, -1], below[-1] = 0, 0
    divergence = right + below
    divergence[:, 1:] -= right[:, :-1]
    divergence[1:] -= below[:-1]
    height, width = near.shape
    laplacian = (
        (2 - 2 * np.cos(np.pi * np.arange(height) / height))[:, None] + 2 - 2 * np.cos(np.pi * np.arange(width) / width)
    )
    wanted = dctn(screening * np.asarray(near, np.float64) - divergence, type=2, norm="ortho")
    return np.asarray(idctn(wanted / (laplacian + screening), type=2, norm="ortho"))
