"""What arms may not enter, and the arms that may not: points on the skin of one body, which its joints move.

Trunk and legs are known by points of their surface with its normals: where a motion bends them, cloth and folds included,
is where they are seen.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.geometry.mesh.welding import seamless_normals
from engine.geometry.rigging.half_joints import whole_joints
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion.library.posture import ELBOW_AXES

SOLID_JOINTS = ("Hips", "Spine", "Spine1", "Spine2", *(side + part for side in SIDE_NAMES for part in ("UpLeg", "Leg")))
"""The joints that move what is not to be entered."""

MAX_ARM_WEIGHT = 0.05
"""How much an arm may move of what is not to be entered: what goes along with it, as an armpit does, gives way."""

SURFACE_SPACING_METRES, ARM_SPACING_METRES = 0.03, 0.025
"""Metres between points of trunk and legs, and of an arm."""

NORMAL_METRES = 0.01
"""Metres above the surface at which a second point tells where its normal goes."""


@dataclass(frozen=True)
class BoundPoints:
    """Points that joints move.

    places : (N, 3) float32 metres, at rest.
    bones : (N, 4) uint8, the joints that move each.
    weights : (N, 4) float32, how much each does.
    """

    places: NDArray[np.float32]
    bones: NDArray[np.uint8]
    weights: NDArray[np.float32]

    def posed(self, transforms: NDArray[np.floating]) -> NDArray[np.float32]:
        """(F, N, 3) where they are; `transforms` (F, J, 4, 4) as `pose_transforms` gives them."""
        return skin(self.places, self.bones, self.weights, transforms)


@dataclass(frozen=True)
class SolidArm:
    """An arm from the elbow down.

    joints : of shoulder, elbow and wrist.
    heads : (3, 3) metres, where these are at rest.
    hand : the wrist and all joints that hang on it.
    hinge : the axis about which the elbow bends.
    points : of its skin.
    along : (N,) how far along the forearm each is: 0 at the elbow, 1 at the wrist and beyond.
    """

    joints: tuple[int, int, int]
    heads: NDArray[np.float64]
    hand: list[int]
    hinge: tuple[float, float, float]
    points: BoundPoints
    along: NDArray[np.float64]


@dataclass(frozen=True)
class SolidBody:
    """A body whose arms stop at its surface.

    skeleton : its joints.
    surface : points of trunk and legs.
    above : the same, `NORMAL_METRES` further out.
    arms : the left one and the right one.
    """

    skeleton: Skeleton
    surface: BoundPoints
    above: BoundPoints
    arms: tuple[SolidArm, ...]


def solid_body(mesh: SkinnedMesh) -> SolidBody:
    """The body that a mesh is. Half joints are left out: with what they move goes the joint that they hang on."""
    mesh = replace(mesh, bones=whole_joints(mesh.skeleton)[mesh.bones])
    names = mesh.skeleton.names
    arms = np.array([name.endswith("Arm") or "Hand" in name for name in names])
    solid = np.array([name in SOLID_JOINTS for name in names])
    by_arms = (mesh.weights * arms[mesh.bones]).sum(1)
    chosen = _thinned(
        mesh, np.flatnonzero(solid[mesh.bones[:, 0]] & (by_arms < MAX_ARM_WEIGHT)), SURFACE_SPACING_METRES
    )
    surface = _bound(mesh, chosen, mesh.vertices[chosen])
    above = _bound(mesh, chosen, mesh.vertices[chosen] + NORMAL_METRES * seamless_normals(mesh)[chosen])
    return SolidBody(mesh.skeleton, surface, above, tuple(_arm(mesh, names, side) for side in SIDE_NAMES))


def _arm(mesh: SkinnedMesh, names: Sequence[str], side: str) -> SolidArm:
    shoulder, elbow, wrist = (names.index(side + part) for part in ("Arm", "ForeArm", "Hand"))
    lower = np.array([name == f"{side}ForeArm" or name.startswith(f"{side}Hand") for name in names])
    chosen = _thinned(mesh, np.flatnonzero(lower[mesh.bones[:, 0]]), ARM_SPACING_METRES)
    bone = (mesh.skeleton.heads[wrist] - mesh.skeleton.heads[elbow]).astype(np.float64)
    along = (mesh.vertices[chosen] - mesh.skeleton.heads[elbow]) @ bone / (bone @ bone)
    return SolidArm(
        joints=(shoulder, elbow, wrist),
        heads=mesh.skeleton.heads[[shoulder, elbow, wrist]].astype(np.float64),
        hand=[joint for joint, name in enumerate(names) if name.startswith(f"{side}Hand")],
        hinge=ELBOW_AXES[side],
        points=_bound(mesh, chosen, mesh.vertices[chosen]),
        along=np.clip(along, 0, 1).astype(np.float64),
    )


def _thinned(mesh: SkinnedMesh, vertices: NDArray[np.intp], spacing: float) -> NDArray[np.intp]:
    """One of the vertices of each cube of this side, metres."""
    cubes = np.floor(mesh.vertices[vertices] / spacing).astype(np.int64)
    return vertices[np.unique(cubes, axis=0, return_index=True)[1]]


def _bound(mesh: SkinnedMesh, chosen: NDArray[np.intp], places: NDArray[np.float32]) -> BoundPoints:
    return BoundPoints(places.astype(np.float32), mesh.bones[chosen], mesh.weights[chosen])
