"""Posing the template: forward kinematics and linear blend skinning."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.body.rig import Rig


def bone_transforms(
    rig: Rig,
    heads: NDArray[np.floating],
    rotations: NDArray[np.floating],
    root_offset: NDArray[np.floating] | None = None,
) -> NDArray[np.float64]:
    """What each bone does to the rest pose, (B, 4, 4), acting on column vectors.

    Parameters
    ----------
    heads : (B, 3) joints of the rest pose (`Rig.joints`).
    rotations : (B, 3, 3) each bone's own turn about its head, in the axes of the world at rest.
    root_offset : (3,) metres by which the root moves.
    """
    world = np.zeros((len(rig.names), 4, 4))
    for bone, parent in enumerate(rig.parents):
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
    """Linear blend skinning: (V, 3) rest vertices and (V, K) influences to (V, 3) float32 posed vertices."""
    posed = np.zeros((len(vertices), 3), np.float32)
    rest = np.asarray(vertices, np.float32)
    matrices = np.asarray(transforms, np.float32)
    for k in range(bones.shape[1]):
        moved = np.flatnonzero(weights[:, k])
        chosen = matrices[bones[moved, k]]
        moved_to = np.einsum("vij,vj->vi", chosen[:, :3, :3], rest[moved]) + chosen[:, :3, 3]
        posed[moved] += weights[moved, k, None] * moved_to
    return posed
