"""A smile arrives on mouths whose corners hang, and nothing but a smile raises them."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import opened, placed, smiling
from numpy.typing import NDArray

from engine.face_animation.mouth.smile_curve import (
    INNER_UPPER_LIP_VERTICES,
    MAX_LIFT_SHARE,
    SmileCurve,
    corner_height,
    corner_influence,
    smile_share,
)
from engine.perception.face.landmarks import FACE_OVAL, MOUTH_CORNER_VERTICES


def hanging(face: NDArray, share: float) -> NDArray:
    """A face whose mouth's corners hang by a share of its width; upright."""
    bent = face.astype(float).copy()
    width = np.linalg.norm(face[MOUTH_CORNER_VERTICES[1]] - face[MOUTH_CORNER_VERTICES[0]])
    bent[:, 1] += share * width * corner_influence()
    return bent


def acted(target: NDArray, rest: NDArray, driver: NDArray, strength: float = 1.0) -> NDArray:
    face = target[None].astype(float).copy()
    SmileCurve(rest, target).lift(face, driver[None], strength)
    return face[0]


def height(face: NDArray) -> float:
    """Of an upright face's corners."""
    return float(corner_height(face, np.array([0.0, -1.0])))


def test_a_full_smile_raises_hanging_corners_to_the_driver_s() -> None:
    rest = placed(60)
    sad, smile = hanging(placed(90), 0.06), smiling(rest, 0.5)
    assert smile_share(smile[None], rest)[0] == 1
    assert height(acted(sad, rest, smile)) == pytest.approx(height(smile), abs=0.01)
    half = height(acted(sad, rest, smile, 0.5))
    assert half == pytest.approx((height(sad) + height(smile)) / 2, abs=0.01)


def test_no_more_than_so_much_is_added() -> None:
    rest = placed(60)
    sad = hanging(placed(90), 0.3)
    assert height(acted(sad, rest, smiling(rest, 0.5))) - height(sad) < MAX_LIFT_SHARE + 0.01


def test_nothing_but_a_smile_raises_corners() -> None:
    rest = placed(60)
    width = np.linalg.norm(rest[MOUTH_CORNER_VERTICES[1]] - rest[MOUTH_CORNER_VERTICES[0]])
    wide, high = rest.copy(), rest.copy()
    wide[MOUTH_CORNER_VERTICES[0], 0] -= 0.15 * width
    wide[MOUTH_CORNER_VERTICES[1], 0] += 0.15 * width
    high[list(MOUTH_CORNER_VERTICES), 1] -= 0.15 * width
    assert not smile_share(np.stack([rest, opened(rest, 0.4), wide, high]), rest).any()


def test_a_mouth_that_smiles_as_much_already_is_left_as_it_is() -> None:
    rest, target = placed(60), smiling(placed(90), 0.5)
    np.testing.assert_allclose(acted(target, rest, smiling(rest, 0.5)), target, atol=0.02)
    merry = hanging(target, -0.05)
    np.testing.assert_array_equal(acted(merry, rest, smiling(rest, 0.5)), merry)


def test_lips_bend_about_their_middle_within_the_face() -> None:
    influence = corner_influence()
    assert influence.min() >= -1e-9 and influence.max() <= 1 + 1e-9
    np.testing.assert_allclose(influence[list(MOUTH_CORNER_VERTICES)], 1, atol=0.01)
    np.testing.assert_allclose(influence[[0, 13, 14, 17]], 0, atol=1e-3)
    assert not influence[list(FACE_OVAL)].any()


def test_an_upper_lip_that_arches_over_teeth_is_bent_up_too() -> None:
    """Its corners hang below its middle, while both lips together are as curved as the driver's."""
    rest, target = placed(60), smiling(placed(90), 0.5)
    smile, up = smiling(rest, 0.5), np.array([0.0, -1.0])
    arched = target.copy()
    width = np.linalg.norm(target[MOUTH_CORNER_VERTICES[1]] - target[MOUTH_CORNER_VERTICES[0]])
    arched[[0, 13], 1] -= 0.06 * width
    arched[[14, 17], 1] += 0.06 * width
    assert height(arched) == pytest.approx(height(target), abs=1e-3)
    upper = [
        float(corner_height(face, up, INNER_UPPER_LIP_VERTICES)) for face in (smile, arched, acted(arched, rest, smile))
    ]
    assert upper[1] < upper[0] - 0.05 and upper[2] == pytest.approx(upper[0], abs=0.01)
