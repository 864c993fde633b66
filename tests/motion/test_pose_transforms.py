"""Poses of a skeleton, against what can be worked out by hand."""

import numpy as np
from scipy.spatial.transform import Rotation

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.kinematics import pose_transforms

ARM = Skeleton(
    ("Hips", "Arm", "Hand"), np.array([-1, 0, 1], np.int32), np.array([[0, 1, 0], [1, 1, 0], [2, 1, 0]], "f4")
)


def quaternions(*turns: Rotation) -> np.ndarray:
    return np.stack([turn.as_quat() for turn in turns])[None].astype(np.float32)


def place(transforms: np.ndarray, point: list[float]) -> np.ndarray:
    return (transforms @ np.array([*point, 1.0]))[:3]


def test_a_bent_arm_reaches_where_it_should() -> None:
    """Shoulder turned down by a quarter, elbow forward by a quarter: worked out on paper."""
    down, forward = Rotation.from_euler("z", -90, degrees=True), Rotation.from_euler("y", -90, degrees=True)
    found = pose_transforms(ARM, quaternions(Rotation.identity(), down, forward), np.array([[0, 1, 0]]))[0]
    np.testing.assert_allclose(place(found[1], [2, 1, 0]), [1, 0, 0], atol=1e-6)
    np.testing.assert_allclose(place(found[2], [3, 1, 0]), [1, 0, 1], atol=1e-6)


def test_the_root_carries_everything() -> None:
    turn = Rotation.from_euler("xyz", [0.2, -0.5, 1.1])
    found = pose_transforms(ARM, quaternions(turn, Rotation.identity(), Rotation.identity()), np.array([[3, 4, 5]]))[0]
    for transform in found:
        np.testing.assert_allclose(place(transform, [2, 1, 3]), turn.apply([2, 0, 3]) + np.array([3, 4, 5]), atol=1e-5)
