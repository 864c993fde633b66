"""The rigged people of the test media in T-pose, as the project's own characters are bound: clips and poses move both alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from benchmarks.scan_studio.people.rigged_glb import TexturedPart, accessor_array, material_image, node_worlds
from benchmarks.scan_studio.people.scanned_people import RIGGED_PEOPLE, one_texture
from engine.body.rest_pose import T_POSE_DIRECTIONS, shortest_rotation
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import bone_transforms, skin
from engine.motion.clip import Clip
from engine.motion.files.gltf_file import GltfFile

T_POSE_HEIGHT_METRES = 1.8
"""Height in T-pose to which people are scaled."""
BONE_END_JOINTS = {
    **{f"{side}Arm": f"{side}ForeArm" for side in ("Left", "Right")},
    **{f"{side}ForeArm": f"{side}Hand" for side in ("Left", "Right")},
    **{f"{side}Hand": f"{side}HandMiddle1" for side in ("Left", "Right")},
    **{f"{side}UpLeg": f"{side}Leg" for side in ("Left", "Right")},
    **{f"{side}Leg": f"{side}Foot" for side in ("Left", "Right")},
}
"""Where bones end: the joint at the other end."""

Directions = Mapping[str, tuple[float, float, float]]


def read_rigged(name: str, scans: Path) -> SkinnedMesh:
    """One of `scanned_people.RIGGED` in T-pose, `T_POSE_HEIGHT_METRES` high, on one texture."""
    file_name, facing = RIGGED_PEOPLE[name]
    file = GltfFile(scans / file_name)
    towards = np.diag([facing, 1.0, facing])
    worlds = node_worlds(file, lambda node, world: world)
    nodes, joints = file.parts.nodes, file.parts.skins[0].joints
    names = tuple(str(nodes[joint].name).removeprefix("mixamorig:") for joint in joints)
    heads = worlds[joints][:, :3, 3] @ towards
    parents = _parents(file, joints)
    order = _parents_first(parents)
    place = {joint: order.index(k) for k, joint in enumerate(joints)}
    skeleton = Skeleton(
        tuple(names[k] for k in order),
        np.array([order.index(parents[k]) if parents[k] >= 0 else -1 for k in order], np.int32),
        heads[order].astype(np.float32),
    )
    parts, bones, weights = _surface(file, worlds, towards, place)
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    corner = np.concatenate([part.triangles + start for part, start in zip(parts, starts, strict=False)]).ravel()
    uv, texture = one_texture(parts)
    mesh = SkinnedMesh(
        skeleton,
        np.concatenate([part.vertices for part in parts])[corner].astype(np.float32),
        np.arange(len(corner), dtype=np.int32).reshape(-1, 3),
        uv,
        np.concatenate(bones)[corner],
        np.concatenate(weights)[corner],
        texture,
    )
    return _on_the_ground(in_t_pose(mesh))


def in_t_pose(mesh: SkinnedMesh) -> SkinnedMesh:
    """The mesh bound with its arms and legs as `T_POSE_DIRECTIONS` has them."""
    skeleton = mesh.skeleton
    turns = _turns(skeleton, T_POSE_DIRECTIONS)
    transforms = bone_transforms(skeleton.parents, skeleton.heads, turns)
    heads = np.einsum("jab,jb->ja", transforms[:, :3, :3], skeleton.heads) + transforms[:, :3, 3]
    rest = Skeleton(skeleton.names, skeleton.parents, heads.astype(np.float32))
    vertices = skin(mesh.vertices, mesh.bones, mesh.weights, transforms)
    return SkinnedMesh(rest, vertices, mesh.triangles, mesh.uv, mesh.bones, mesh.weights, mesh.texture)


def held_pose(skeleton: Skeleton, directions: Directions) -> Clip:
    """A clip of one frame in which bones point as told: `directions`, in the world, by the joint at which a bone begins."""
    quaternions = Rotation.from_matrix(_turns(skeleton, directions)).as_quat()
    return Clip("held", 1.0, quaternions[None].astype(np.float32), skeleton.heads[:1])


def _turns(skeleton: Skeleton, directions: Directions) -> NDArray[np.float64]:
    """(J, 3, 3) turns of joints in their parents' axes; those without a direction go with their parents."""
    world = np.tile(np.eye(3), (len(skeleton.names), 1, 1))
    for joint, name in enumerate(skeleton.names):
        parent = skeleton.parents[joint]
        world[joint] = world[parent] if parent >= 0 else np.eye(3)
        if name in directions and BONE_END_JOINTS[name] in skeleton.names:
            along = world[joint] @ (skeleton.heads[skeleton.index(BONE_END_JOINTS[name])] - skeleton.heads[joint])
            world[joint] = shortest_rotation(along, np.array(directions[name])) @ world[joint]
        if name.endswith(("LeftFoot", "RightFoot")):
            world[joint] = np.eye(3)
    return np.stack([world[p].T @ world[j] if p >= 0 else world[j] for j, p in enumerate(skeleton.parents)])


def _parents(file: GltfFile, joints: Sequence[int]) -> list[int]:
    """The place among `joints` of each one's parent, -1 for the root."""
    above = {child: node for node, part in enumerate(file.parts.nodes) for child in part.children or ()}
    return [joints.index(above[joint]) if above.get(joint) in joints else -1 for joint in joints]


def _parents_first(parents: Sequence[int]) -> list[int]:
    order: list[int] = []
    while len(order) < len(parents):
        order += [k for k, parent in enumerate(parents) if k not in order and (parent < 0 or parent in order)]
    return order


def _surface(
    file: GltfFile, worlds: NDArray[np.float64], towards: NDArray[np.float64], place: Mapping[int, int]
) -> tuple[list[TexturedPart], list[NDArray[np.uint8]], list[NDArray[np.float32]]]:
    """The parts of all meshes with a skin as their joints stand, each vertex' bones by `place`, and weights."""
    parts, bones, weights = [], [], []
    for node in file.parts.nodes:
        if node.mesh is None or node.skin is None:
            continue
        skin_of = file.parts.skins[node.skin]
        inverse_bind = accessor_array(file, skin_of.inverseBindMatrices).reshape(-1, 4, 4).transpose(0, 2, 1)
        moves = worlds[skin_of.joints] @ inverse_bind
        for primitive in file.parts.meshes[node.mesh].primitives:
            at = primitive.attributes
            share, bone = accessor_array(file, at.WEIGHTS_0).astype(np.float64), accessor_array(file, at.JOINTS_0)
            share /= share.sum(1, keepdims=True)
            blended = np.einsum("vk,vkij->vij", share, moves[bone])
            points = accessor_array(file, at.POSITION)
            points = np.einsum("vij,vj->vi", blended[:, :3, :3], points) + blended[:, :3, 3]
            triangles = accessor_array(file, primitive.indices).reshape(-1, 3).astype(np.int64)
            image = material_image(file, file.parts.materials[primitive.material])
            uv = accessor_array(file, at.TEXCOORD_0).astype(float)
            parts.append(TexturedPart(points @ towards, triangles, uv, image, np.zeros((2, len(points)))))
            bones.append(np.array([place[joint] for joint in skin_of.joints], np.uint8)[bone])
            weights.append(share.astype(np.float32))
    return parts, bones, weights


def _on_the_ground(mesh: SkinnedMesh) -> SkinnedMesh:
    scale = T_POSE_HEIGHT_METRES / float(np.ptp(mesh.vertices[:, 1]))
    hips = mesh.skeleton.heads[mesh.skeleton.index("Hips")]
    ground = np.array([hips[0], mesh.vertices[:, 1].min(), hips[2]], np.float32)
    skeleton = Skeleton(mesh.skeleton.names, mesh.skeleton.parents, (mesh.skeleton.heads - ground) * np.float32(scale))
    vertices = (mesh.vertices - ground) * np.float32(scale)
    return SkinnedMesh(skeleton, vertices, mesh.triangles, mesh.uv, mesh.bones, mesh.weights, mesh.texture)
