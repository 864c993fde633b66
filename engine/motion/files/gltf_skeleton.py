"""The skeletons of a glTF file: which of its nodes are whose joints, and how they lie before anything moves them."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.motion import rotation
from engine.motion.files.gltf_accessors import Accessors
from engine.motion.files.gltf_file import GltfFile, unreadable
from engine.motion.files.source_motion import MAX_JOINTS, Array, place

MIN_JOINTS = 10
"""What has fewer is no skeleton of a person: hips, limbs, head."""


@dataclass(frozen=True)
class NodeTree:
    """All nodes of a file: each one's parent (-1: none), its children, and their order, parents first."""

    parents: list[int]
    children: list[list[int]]
    order: list[int]


def node_tree(parts: Any) -> NodeTree:
    """The nodes of a file.

    Raises
    ------
    InputError : `motion_unreadable`, they are no trees.
    """
    children: list[list[int]] = [list(node.children or []) for node in parts.nodes or []]
    parents = [-1] * len(children)
    for index, below in enumerate(children):
        for child in below:
            if not 0 <= child < len(children) or parents[child] != -1 or child == index:
                raise unreadable("its nodes are no tree")
            parents[child] = index
    order = [index for index, parent in enumerate(parents) if parent == -1]
    for index in order:
        order.extend(children[index])
    if len(order) != len(children):
        raise unreadable("its nodes are no tree")
    return NodeTree(parents, children, order)


def find_skeletons(tree: NodeTree, joints: Collection[int], turned: Collection[int]) -> list[set[int]]:
    """The joints of each skeleton: those that skins name, and nodes that are `turned` where nothing above or below them is in
    a skin.

    Going down from the roots, joints belong together until several branches have a person's number of them, and nothing
    above these is a joint.

    Raises
    ------
    InputError : `motion_unreadable`, a joint is not there.
    """
    if not all(0 <= joint < len(tree.parents) for joint in (*joints, *turned)):
        raise unreadable("a joint is not there")
    marked = set(joints)
    marked.update(_apart(tree, marked, set(turned)))
    count = [int(node in marked) for node in range(len(tree.parents))]
    for node in reversed(tree.order):
        if tree.parents[node] >= 0:
            count[tree.parents[node]] += count[node]
    waiting, found = [[node for node in tree.order if tree.parents[node] < 0]], []
    while waiting:
        branches = level = waiting.pop()
        large = [node for node in level if count[node] >= MIN_JOINTS]
        while len(large) == 1 and large[0] not in marked:
            branches = tree.children[large[0]]
            large = [node for node in branches if count[node] >= MIN_JOINTS]
        if len(large) > 1:
            waiting.extend([node] for node in reversed(large))
        else:
            found.append(level)
    groups = [marked.intersection(_below(tree, level)) for level in found]
    return [group for group in groups if group]


def skeleton_nodes(tree: NodeTree, joints: set[int]) -> list[int]:
    """The joints, what they hang on, and what hangs on them, parents first.

    Raises
    ------
    InputError : `motion_too_large`.
    """
    kept = set(joints)
    for joint in joints:
        while (joint := tree.parents[joint]) >= 0 and joint not in kept:
            kept.add(joint)
    kept.update(_below(tree, list(joints)))
    if len(kept) > MAX_JOINTS:
        raise InputError("motion_too_large", f"A motion's skeleton can have {MAX_JOINTS} joints: use a simpler one.")
    return [node for node in tree.order if node in kept]


def _apart(tree: NodeTree, joints: set[int], turned: set[int]) -> set[int]:
    """Those of `turned` that have no joint above or below."""
    above, below = set(), set(joints)
    for node in reversed(tree.order):
        if (node in joints or node in above) and tree.parents[node] >= 0:
            above.add(tree.parents[node])
    for node in tree.order:
        if tree.parents[node] in below:
            below.add(node)
    return turned - above - below


def _below(tree: NodeTree, nodes: Sequence[int]) -> set[int]:
    """The nodes and all that hangs on them."""
    found, waiting = set(nodes), list(nodes)
    while waiting:
        fresh = [child for child in tree.children[waiting.pop()] if child not in found]
        found.update(fresh)
        waiting.extend(fresh)
    return found


@np.errstate(over="ignore", invalid="ignore")
def at_rest(parts: Any, nodes: list[int], parents: NDArray[np.int32]) -> tuple[Array, Array, Array]:
    """Turns (J, 4) and offsets (J, 3) as the nodes have them, in parents' axes, and by what their parents scale (J,).

    Raises
    ------
    InputError : `motion_unreadable`, `motion_not_finite`.
    """
    rotations, offsets, scales = rotation.identity(len(nodes)), np.zeros((len(nodes), 3)), np.ones(len(nodes))
    own = np.ones(len(nodes))
    for joint, node in enumerate(parts.nodes[index] for index in nodes):
        if node.matrix is not None:
            matrix = _numbers(node.matrix, 16).reshape(4, 4).T
            rotations[joint], own[joint] = _rotation_and_scale(matrix[:3, :3])
            offsets[joint] = matrix[:3, 3]
        else:
            turn = _numbers(node.rotation, 4, rotation.IDENTITY_QUATERNION)
            rotations[joint] = rotation.normalize(turn if turn.any() else rotation.IDENTITY_QUATERNION)
            offsets[joint] = _numbers(node.translation, 3, (0, 0, 0))
            own[joint] = np.mean(_numbers(node.scale, 3, (1, 1, 1)))
        if parents[joint] >= 0:
            scales[joint] = scales[parents[joint]] * own[parents[joint]]
    offsets = offsets * scales[:, None]
    if not (np.isfinite(rotations).all() and np.isfinite(offsets).all()):
        raise InputError("motion_not_finite", "The glTF file holds numbers that are not finite: export it again.")
    return rotations, offsets, scales


def _numbers(value: Any, count: int, default: Any = None) -> Array:
    if value is None and default is not None:
        return np.array(default, np.float64)
    if not (isinstance(value, list) and len(value) == count and all(type(one) in (int, float) for one in value)):
        raise unreadable("a node is broken")
    try:
        return np.array([float(one) for one in value])
    except OverflowError as error:
        raise unreadable("a node is broken") from error


def _rotation_and_scale(matrix: Array) -> tuple[Array, float]:
    """The rotation nearest to a matrix (3, 3), and its mean scale."""
    if not np.isfinite(matrix).all():
        raise InputError("motion_not_finite", "The glTF file holds numbers that are not finite: export it again.")
    u, sizes, v = np.linalg.svd(matrix)
    sign = np.sign(np.linalg.det(u @ v))
    return rotation.from_matrix(u @ np.diag([1, 1, sign]) @ v), float(sizes.mean())


def bind_pose(
    file: GltfFile, accessors: Accessors, nodes: list[int], parents: NDArray[np.int32], rotations: Array, offsets: Array
) -> tuple[Array, Array]:
    """Turns and offsets in parents' axes of the pose in which the skin was bound; joints outside of it stay at rest.

    Raises
    ------
    InputError : what reading numbers may raise.
    """
    world, places = place(parents, rotations, offsets)
    bound = np.zeros(len(nodes), bool)
    index = {node: joint for joint, node in enumerate(nodes)}
    for skin in file.parts.skins or []:
        if skin.inverseBindMatrices is None or not any(node in index for node in skin.joints):
            continue
        file.require_known(skin)
        found = accessors.numbers(skin.inverseBindMatrices)
        if found.shape[1] != 16:
            raise unreadable("a skin's matrices are broken")
        matrices = found.reshape(-1, 4, 4).swapaxes(1, 2)
        regular = np.abs(np.linalg.det(matrices)) > 1e-12
        for node, matrix, invertible in zip(skin.joints, matrices, regular, strict=False):
            joint = index.get(node, -1)
            if joint >= 0 and invertible and not bound[joint]:
                bind = np.asarray(np.linalg.inv(matrix), np.float64)
                world[joint], places[joint], bound[joint] = _rotation_and_scale(bind[:3, :3])[0], bind[:3, 3], True
    own_rotations, own_offsets = rotations.copy(), offsets.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0 and bound[joint]:
            back = rotation.inverse(world[parent])
            own_rotations[joint] = rotation.multiply(back, world[joint])
            own_offsets[joint] = rotation.rotate(back, places[joint] - places[parent])
        elif parent >= 0:
            world[joint] = rotation.multiply(world[parent], rotations[joint])
            places[joint] = places[parent] + rotation.rotate(world[parent], offsets[joint])
    return own_rotations, own_offsets
