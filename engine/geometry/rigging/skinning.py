"""Posing meshes: forward kinematics and linear blend skinning, for one frame or for many at once.

Source: N. Magnenat-Thalmann, R. Laperrière, D. Thalmann, Joint-dependent local deformations for hand animation and
object grasping, Graphics Interface 1988.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit

MAX_VERTEX_INFLUENCES = 4
"""Joints that move a vertex, at most: what game engines take."""


def bone_transforms(
    parents: NDArray[np.integer],
    heads: NDArray[np.floating],
    rotations: NDArray[np.floating],
    root_offset: NDArray[np.floating] | None = None,
) -> NDArray[np.float64]:
    """What each bone does to the rest pose, (B, 4, 4), acting on column vectors.

    Parameters
    ----------
    parents : (B,) each bone's parent, before it; -1 for the root.
    heads : (B, 3) joints of the rest pose, metres.
    rotations : (B, 3, 3) each bone's own turn about its head, in the axes of the world at rest.
    root_offset : (3,) metres by which the root moves.
    """
    world = np.zeros((len(parents), 4, 4))
    for bone, parent in enumerate(parents):
        own = np.eye(4)
        own[:3, :3] = rotations[bone]
        own[:3, 3] = heads[bone] - rotations[bone] @ heads[bone]
        if parent < 0:
            if root_offset is not None:
                own[:3, 3] += root_offset
            world[bone] = own
        else:
            world[bone] = world[parent] @ own
    return world


def skin(
    vertices: NDArray[np.floating],
    bones: NDArray[np.integer],
    weights: NDArray[np.floating],
    transforms: NDArray[np.floating],
) -> NDArray[np.float32]:
    """Linear blend skinning: (V, 3) rest vertices and (V, K) influences to float32 posed vertices.

    `transforms` (B, 4, 4) give (V, 3); those of many frames, (F, B, 4, 4), give (F, V, 3).
    """
    single = transforms.ndim == 3
    matrices = np.ascontiguousarray(transforms[None] if single else transforms, np.float32)
    posed = np.empty((len(matrices), len(vertices), 3), np.float32)
    _skin(
        np.ascontiguousarray(vertices, np.float32),
        np.ascontiguousarray(bones),
        np.ascontiguousarray(weights, np.float32),
        matrices,
        posed,
    )
    return posed[0] if single else posed


@njit(nogil=True, boundscheck=False)  # no fastmath: what is drawn from posed figures must come out alike
def _skin(
    vertices: np.ndarray, bones: np.ndarray, weights: np.ndarray, transforms: np.ndarray, posed: np.ndarray
) -> None:
    for f in range(len(transforms)):
        for v in range(len(vertices)):
            x, y, z = vertices[v, 0], vertices[v, 1], vertices[v, 2]
            px, py, pz = np.float32(0), np.float32(0), np.float32(0)
            for k in range(bones.shape[1]):
                w = weights[v, k]
                if w == 0:
                    continue
                m = transforms[f, bones[v, k]]
                px += w * (m[0, 0] * x + m[0, 1] * y + m[0, 2] * z + m[0, 3])
                py += w * (m[1, 0] * x + m[1, 1] * y + m[1, 2] * z + m[1, 3])
                pz += w * (m[2, 0] * x + m[2, 1] * y + m[2, 2] * z + m[2, 3])
            posed[f, v, 0], posed[f, v, 1], posed[f, v, 2] = px, py, pz
