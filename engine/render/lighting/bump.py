"""Fine relief of a surface: normals as a height over its chart bends them.

Source: J. Blinn, Simulation of wrinkled surfaces, SIGGRAPH 1978.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def bump(
    normals: NDArray[np.floating], tangents: NDArray[np.floating], slopes: NDArray[np.floating]
) -> NDArray[np.float32]:
    """Unit normals (N, 3) of a surface raised by a height over its chart.

    `tangents` (N, 6) are dP/du and dP/dv, `slopes` (N, 2) dh/du and dh/dv, heights in the unit of P.
    """
    along_u, along_v = tangents[:, :3], tangents[:, 3:]
    from_u, from_v = np.cross(along_v, normals), np.cross(normals, along_u)
    determinant = (along_u * from_u).sum(1, keepdims=True)
    turn = np.where(determinant < 0, -1.0, 1.0)
    raised = np.abs(determinant) * normals - turn * (slopes[:, :1] * from_u + slopes[:, 1:] * from_v)
    return (raised / np.maximum(np.linalg.norm(raised, axis=1, keepdims=True), 1e-12)).astype(np.float32)
