"""The skeleton of a GLB: its joints as nodes, and the pose in which they hold the mesh.

Specification: Khronos, glTF 2.0, 3.7.3 (skins).
"""

from __future__ import annotations

import numpy as np
import pygltflib as gl
from numpy.typing import NDArray

from engine.export.gltf.buffer import Buffer
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation

ROOT_NAME = "Armature"
"""The node above all joints, by the name that Blender gives it and players of avatars look for."""


def add_skeleton(gltf: gl.GLTF2, buffer: Buffer, skeleton: Skeleton, axes: NDArray[np.float64] | None = None) -> None:
    """Node `j` becomes joint `j`; after the joints comes the root of all, named `ROOT_NAME`.

    `axes` (J, 3, 3): those of each joint at rest, in the world, as columns; by default the world's.
    """
    children: list[list[int]] = [[] for _ in skeleton.names]
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            children[parent].append(joint)
    offsets = skeleton.offsets()
    rotations = None
    if axes is not None:
        above = axes_above(skeleton, axes)
        offsets = np.einsum("jki,jk->ji", above, offsets)
        rotations = rotation.from_matrix(np.einsum("jki,jkl->jil", above, axes))
    for joint, offset in enumerate(offsets):
        node = gl.Node(name=skeleton.names[joint], translation=offset.tolist(), children=children[joint])
        if rotations is not None:
            node.rotation = rotations[joint].tolist()
        gltf.nodes.append(node)
    gltf.nodes.append(gl.Node(name=ROOT_NAME, children=np.flatnonzero(skeleton.parents < 0).tolist()))
    gltf.skins = [
        gl.Skin(
            name="skeleton",
            joints=list(range(len(skeleton.names))),
            skeleton=len(skeleton.names),
            inverseBindMatrices=buffer.add(_inverse_bind(skeleton, axes)),
        )
    ]


def axes_above(skeleton: Skeleton, axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """The axes (J, 3, 3) at rest of each joint's parent; the world's above the root."""
    parents = skeleton.parents
    return np.where(parents[:, None, None] >= 0, axes[parents], np.eye(3))


def _inverse_bind(skeleton: Skeleton, axes: NDArray[np.float64] | None) -> NDArray[np.float32]:
    turned = np.tile(np.eye(3), (len(skeleton.names), 1, 1)) if axes is None else axes.transpose(0, 2, 1)
    found = np.tile(np.eye(4, dtype=np.float32), (len(skeleton.names), 1, 1))
    found[:, :3, :3] = turned
    found[:, :3, 3] = -np.einsum("jik,jk->ji", turned, skeleton.heads)
    return found
