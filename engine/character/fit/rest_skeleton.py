"""The skeleton of a fitted template in T-pose, and how its joints stand in the picture."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.body_space import BodySpace
from engine.character.fit.template_fit import FittedBody
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.kinematics import pose_transforms


def rest_skeleton(fitted: FittedBody, space: BodySpace) -> Skeleton:
    """The skeleton in T-pose, but for the joints that are kept as they are in the picture."""
    straight = space.skeleton(fitted.fit.coefficients)
    transforms = kept_transforms(fitted, space)
    heads = np.einsum("jab,jb->ja", transforms[:, :3, :3], straight.heads) + transforms[:, :3, 3]
    return Skeleton(straight.names, straight.parents, heads.astype(np.float32))


def kept_transforms(fitted: FittedBody, space: BodySpace) -> NDArray[np.float32]:
    """(J, 4, 4) what brings the template in T-pose to the rest of a character, in which kept joints are as pictured."""
    straight = space.skeleton(fitted.fit.coefficients)
    rotations = np.where(fitted.kept[:, None, None], fitted.fit.rotations, np.eye(3))
    return pose_transforms(straight, _quaternions(rotations)[None], straight.heads[None, 0])[0]


@dataclass(frozen=True)
class PicturedJoints:
    """How the joints of a skeleton stand in the picture.

    rest : the skeleton at rest.
    rotations : (J, 4) of its joints in the picture, quaternions (x, y, z, w).
    root : (3,) where its root is there, metres, with the picture's camera at the origin.
    """

    rest: Skeleton
    rotations: NDArray[np.float32]
    root: NDArray[np.float32]

    def transforms(self) -> NDArray[np.float64]:
        """(J, 4, 4) from rest to the picture."""
        return pose_transforms(self.rest, self.rotations[None], self.root[None])[0].astype(np.float64)

    def seen_from(self, eye: NDArray[np.floating]) -> PicturedJoints:
        """This skeleton in a world in which the picture's camera stands at `eye` (3,)."""
        return replace(self, root=np.asarray(self.root + eye, np.float32))

    def lifted(self, lift: NDArray[np.floating]) -> Skeleton:
        """The skeleton at rest, moved by `lift` (3,) metres."""
        return replace(self.rest, heads=np.asarray(self.rest.heads + lift, np.float32))


def pictured_joints(fitted: FittedBody, space: BodySpace) -> PicturedJoints:
    """How the joints of a fit stand in its picture. Those that are kept do not turn: at rest they are as in the picture."""
    own = np.where(fitted.kept[:, None, None], np.eye(3), fitted.fit.rotations.astype(np.float64))
    root = np.asarray(fitted.fit.root_translation, np.float32)
    return PicturedJoints(rest_skeleton(fitted, space), _quaternions(own), root)


def _quaternions(rotations: NDArray[np.floating]) -> NDArray[np.float32]:
    return np.asarray(Rotation.from_matrix(rotations).as_quat(), np.float32)
