"""A head's pose that its face alone gets wrong and its hair does not."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import placed
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.head_motion import HeadMotion, split_motion
from engine.face_animation.motion_transfer.head_proxy import HeadProxy, build_head_proxy, move_head
from engine.face_animation.motion_transfer.head_room import skull_centre
from engine.face_animation.motion_transfer.pose_refinement import refine_pose
from engine.perception.face.landmarks import MESH_SIZE

FACE = placed(40.0, (150.0, 120.0))


def hair() -> NDArray[np.float64]:
    x, y = np.meshgrid(np.linspace(80, 220, 10), np.linspace(FACE[10, 1] - 60, FACE[10, 1] - 15, 5))
    return np.column_stack([x.ravel(), y.ravel()])


def turned(degrees: tuple[float, float, float], about: NDArray[np.floating] | None = None) -> NDArray[np.float64]:
    """The face turned about its skull's middle, or another place."""
    rotation = cv2.Rodrigues(np.deg2rad(degrees))[0]
    centre = skull_centre(FACE) if about is None else about
    return np.asarray(((FACE - centre) @ rotation.T + centre)[None])


def driver(places: NDArray[np.floating]) -> HeadProxy:
    """The neutral face with tracked points around it."""
    return build_head_proxy(np.concatenate([FACE[:, :2], places]), FACE)


def moved(motion: HeadMotion) -> NDArray[np.float64]:
    """(1, K, 2) what the head's `motion` does with its hair."""
    return np.asarray(move_head(driver(hair()), motion, FACE)[:, MESH_SIZE:, :2] - hair(), float)


def degrees_apart(motion: HeadMotion, other: HeadMotion) -> float:
    return float(np.rad2deg(np.linalg.norm(cv2.Rodrigues(motion.rotation[0] @ other.rotation[0].T)[0])))


@pytest.mark.parametrize("degrees", [(0.0, 0.0, 0.0), (6.0, 0.0, 0.0), (-4.0, 12.0, 3.0)])
def test_a_pose_that_face_and_hair_agree_on_stays(degrees: tuple[float, float, float]) -> None:
    meshes = turned(degrees)
    motion = split_motion(meshes, FACE)
    refined = refine_pose(motion, driver(hair()), meshes, moved(motion), np.ones((1, len(hair()))))
    assert degrees_apart(refined, motion) < 0.01
    np.testing.assert_allclose(refined.expression, motion.expression, atol=0.01)


def test_a_tilt_that_only_the_face_seems_to_make_is_most_of_it_expression() -> None:
    """And face and expression together still are where the tracker has them."""
    meshes = turned((4.0, 0.0, 0.0), FACE.mean(axis=0))
    motion = split_motion(meshes, FACE)
    refined = refine_pose(motion, driver(hair()), meshes, np.zeros((1, len(hair()), 2)), np.ones((1, len(hair()))))
    assert degrees_apart(refined, split_motion(FACE[None], FACE)) < 2.4
    assert np.linalg.norm(moved(refined), axis=2).mean() < 0.6 * np.linalg.norm(moved(motion), axis=2).mean()
    again = refined.scale[0] * (FACE + refined.expression[0]) @ refined.rotation[0].T + refined.shift[0]
    np.testing.assert_allclose(again, meshes[0], atol=0.01)


def test_a_turn_that_the_depth_hides_is_seen_by_the_hair() -> None:
    """A tracker that flattens what it sees gives a nod of ten degrees too small."""
    true = split_motion(turned((10.0, 0.0, 0.0)), FACE)
    flat = turned((10.0, 0.0, 0.0))
    flat[..., 2] = 0.6 * flat[..., 2] + 0.4 * FACE[:, 2]
    motion = split_motion(flat, FACE)
    refined = refine_pose(motion, driver(hair()), flat, moved(true), np.ones((1, len(hair()))))
    assert degrees_apart(refined, true) < 0.7 * degrees_apart(motion, true)


def test_hair_that_slipped_or_is_not_trusted_says_nothing() -> None:
    meshes = turned((5.0, 0.0, 0.0))
    motion = split_motion(meshes, FACE)
    slipped, one = moved(motion), np.ones((1, len(hair())))
    slipped[:, ::4] += (60.0, 40.0)
    assert degrees_apart(refine_pose(motion, driver(hair()), meshes, slipped, one), motion) < 0.1
    away = np.full(slipped.shape, 5.0)
    nobody = refine_pose(motion, driver(hair()), meshes, away, 0 * one)
    none = refine_pose(motion, driver(hair()[:0]), meshes, away[:, :0], one[:, :0])
    for refined in (nobody, none):
        assert degrees_apart(refined, motion) < 0.5
