"""The driver's motion taken apart: known motions put together by the test are found again."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import opened, placed, smiling, turn
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.control_motion import scale_motion
from engine.face_animation.motion_transfer.head_motion import split_motion
from engine.perception.face.landmarks import MESH_SIZE

MOTIONS = [
    (1.0, turn(), (0.0, 0.0, 0.0)),
    (1.0, turn(yaw=20), (0.0, 0.0, 0.0)),
    (1.2, turn(pitch=-12, roll=8), (14.0, -6.0, 3.0)),
    (0.8, turn(-25, 10, -20), (-40.0, 25.0, 0.0)),
]


def angle(a: NDArray, b: NDArray) -> float:
    """Degrees between two rotations."""
    return float(np.rad2deg(np.arccos(np.clip((np.trace(a @ b.T) - 1) / 2, -1, 1))))


def moved(mesh: NDArray, scale: float, rotation: NDArray, shift: tuple[float, ...]) -> NDArray:
    return scale * mesh @ rotation.T + shift


@pytest.mark.parametrize("motion", MOTIONS, ids=["still", "yaw", "nod", "all"])
def test_a_head_that_only_moves_has_no_expression(motion) -> None:
    neutral = placed(60)
    found = split_motion(moved(neutral, *motion)[None], neutral)
    assert found.scale[0] == pytest.approx(motion[0], abs=1e-5)
    assert angle(found.rotation[0], motion[1]) < 0.01
    assert np.abs(found.expression).max() < 1e-3


@pytest.mark.parametrize("motion", MOTIONS, ids=["still", "yaw", "nod", "all"])
@pytest.mark.parametrize("face", [lambda m: opened(m, 0.4), smiling], ids=["open", "smile"])
def test_head_and_expression_are_told_apart(motion, face) -> None:
    """A wide open mouth takes the head along by 1.5 degrees and 1.5 % of its size at most."""
    neutral = placed(60)
    acted = face(neutral)
    found = split_motion(moved(acted, *motion)[None], neutral)
    assert angle(found.rotation[0], motion[1]) < 1.5
    assert found.scale[0] == pytest.approx(motion[0], rel=0.015)
    assert np.abs(found.expression[0] - (acted - neutral)).max() < 0.05 * 60


def test_the_parts_make_the_whole_again() -> None:
    neutral = placed(60)
    meshes = np.stack([moved(smiling(neutral), *m) for m in MOTIONS])
    found = split_motion(meshes, neutral)
    again = (
        found.scale[:, None, None] * np.einsum("nij,nvj->nvi", found.rotation, found.neutral + found.expression)
        + found.shift[:, None]
    )
    np.testing.assert_allclose(again, meshes, atol=1e-3)
    assert found.expression.shape == (4, MESH_SIZE, 3)


def test_strength_scales_the_turn_the_size_and_the_way() -> None:
    neutral = placed(60)
    found = split_motion(np.stack([moved(neutral, 1.21, turn(yaw=20), (10.0, 0.0, 0.0))]), neutral)
    half = scale_motion(found, 0.5)
    assert angle(half.rotation[0], turn(yaw=10)) < 0.05
    assert half.scale[0] == pytest.approx(1.1, abs=1e-3)
    centre = neutral.mean(axis=0)
    way = [m.scale[0] * m.rotation[0] @ centre + m.shift[0] - centre for m in (found, half)]
    np.testing.assert_allclose(way[1], way[0] / 2, atol=1e-3)
    still = scale_motion(found, 0.0)
    np.testing.assert_allclose(still.scale[0] * neutral @ still.rotation[0].T + still.shift[0], neutral, atol=1e-3)
