"""The template posed by the parameters of a fit, for many of them at once: derivatives come from differences."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.body_space import BodySpace
from engine.body.landmarks import LandmarkModel
from engine.geometry.rigging.joint_names import SIDE_NAMES

FITTED_JOINTS = (
    *("Hips", "Spine", "Spine1", "Spine2", "Neck", "Head"),
    *(f"{side}{name}" for side in SIDE_NAMES for name in ("Shoulder", "Arm", "ForeArm", "Hand")),
    *(f"{side}{name}" for side in SIDE_NAMES for name in ("UpLeg", "Leg", "Foot")),
)
"""The joints whose rotations are sought; the others stay as at rest."""

POSED_SHAPE_COEFFICIENTS = 12
"""Of the body space, that are sought."""


class CarriedPoints(Protocol):
    """Points each carried by one joint, linear in the coefficients: `joints` (L,), `mean` (L, 3), `basis` (K, L, 3)."""

    @property
    def joints(self) -> NDArray[np.intp]: ...
    @property
    def mean(self) -> NDArray[np.float32]: ...
    @property
    def basis(self) -> NDArray[np.float32]: ...


@dataclass(frozen=True)
class PosedBodies:
    """N bodies.

    coefficients : (N, K) of the body space.
    rest : (N, J, 3) joints at rest, metres.
    joints : (N, J, 3) joints in the pose, metres, in the world.
    world_rotations : (N, J, 3, 3) the turns of their axes in the world.
    """

    coefficients: NDArray[np.float64]
    rest: NDArray[np.float64]
    joints: NDArray[np.float64]
    world_rotations: NDArray[np.float64]

    def carry(self, points: CarriedPoints) -> NDArray[np.float64]:
        """Where points (L) that joints carry are, (N, L, 3)."""
        at_rest = points.mean + np.tensordot(self.coefficients, points.basis[: self.coefficients.shape[1]], 1)
        at = points.joints
        turned = self.world_rotations[:, at] @ (at_rest - self.rest[:, at])[..., None]
        return np.asarray(self.joints[:, at] + turned[..., 0])


class BodyPoser:
    """The body of a space for parameters (P,): the root's translation (3,), `FITTED_JOINTS`' rotation vectors, coefficients."""

    def __init__(self, space: BodySpace):
        self.space = space
        self.fitted = [space.names.index(name) for name in FITTED_JOINTS]

    def split(
        self, parameters: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Root translations (N, 3), rotation vectors (N, T, 3), coefficients (N, K)."""
        root_translation, rotation_vectors, coefficients = np.split(
            parameters, [3, 3 + 3 * len(FITTED_JOINTS)], axis=-1
        )
        shape = *rotation_vectors.shape[:-1], len(FITTED_JOINTS), 3
        return root_translation, rotation_vectors.reshape(shape), coefficients

    def __call__(self, parameters: NDArray[np.float64]) -> PosedBodies:
        """Posed by parameters (N, P)."""
        root_translation, rotation_vectors, coefficients = self.split(parameters)
        own = rotation_matrices(rotation_vectors)
        rest = self.space.joints(coefficients).astype(np.float64)
        world = np.empty((len(parameters), len(self.space.names), 3, 3))
        joints = np.empty_like(rest)
        for joint, parent in enumerate(self.space.parents):
            if parent < 0:
                world[:, joint], joints[:, joint] = np.eye(3), root_translation
            else:
                offset = rest[:, joint] - rest[:, parent]
                joints[:, joint] = joints[:, parent] + np.einsum("nij,nj->ni", world[:, parent], offset)
                world[:, joint] = world[:, parent]
            if joint in self.fitted:
                world[:, joint] = world[:, joint] @ own[:, self.fitted.index(joint)]
        return PosedBodies(coefficients, rest, joints, world)


def forward(
    space: BodySpace, landmarks: LandmarkModel, parameters: NDArray[np.floating]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Joints (J, 3) and landmarks (L, 3), metres in the world, for the parameters (P,) of a fit."""
    posed = BodyPoser(space)(np.asarray(parameters, np.float64)[None])
    return posed.joints[0], posed.carry(landmarks)[0]


def rotation_matrices(vectors: NDArray[np.floating]) -> NDArray[np.float64]:
    """Rotation vectors (..., 3) to matrices (..., 3, 3)."""
    found = Rotation.from_rotvec(np.asarray(vectors, np.float64).reshape(-1, 3)).as_matrix()
    return np.asarray(found.reshape(*np.shape(vectors), 3))
