"""Lips of an open mouth are as thick beside their rest as the driver's are beside theirs."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.face_animation.mouth.lip_thickness import (
    MAX_OPENING_SHARE,
    THICKNESS_SHARES,
    keep_thickness,
    thickness_shares,
)
from engine.face_animation.mouth.lips_and_skin import LIP_COLUMNS
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import FACE_OVAL, LEFT_EYE, RIGHT_EYE

COLUMNS = np.array(LIP_COLUMNS)
INNER, BORDER = COLUMNS[..., -2], COLUMNS[..., -1]


@pytest.fixture(scope="module")
def rest() -> NDArray[np.float64]:
    """A face whose eyes are 100 pixels apart, y down, whose mouth is open by 20."""
    face = 100.0 * canonical_face()[:, :2]
    face[COLUMNS[1].ravel(), 1] += 20
    return face


def thickness(face: NDArray, lip: int) -> NDArray[np.float64]:
    return np.linalg.norm(face[BORDER[lip]] - face[INNER[lip]], axis=-1)


def thinned(rest: NDArray, lip: int, share: float) -> NDArray[np.float64]:
    """The face with one lip drawn together from its inner edge, which goes away from the opening."""
    face = rest.copy()
    for column in COLUMNS[lip]:
        face[column] = face[column[-1]] + share * (rest[column] - rest[column[-1]])
    return face


@pytest.mark.parametrize("lip", [0, 1])
def test_shares_are_of_the_same_lip_at_rest(rest: NDArray, lip: int) -> None:
    shares = thickness_shares(np.stack([rest, thinned(rest, lip, 0.7)]), rest)
    np.testing.assert_allclose(shares[0], 1)
    assert shares[1, lip] == pytest.approx(0.7) and shares[1, 1 - lip] == pytest.approx(1)


def test_shares_have_bounds(rest: NDArray) -> None:
    both = np.stack([thinned(rest, 1, 0.1), thinned(rest, 1, 1.4)])
    np.testing.assert_allclose(thickness_shares(both, rest)[:, 1], THICKNESS_SHARES)


@pytest.mark.parametrize("lip", [0, 1])
def test_a_lip_that_was_drawn_out_is_as_thick_as_it_is_to_be(rest: NDArray, lip: int) -> None:
    placed = thinned(rest, lip, 0.3)[None]
    keep_thickness(placed, rest[None], np.full((1, 2), 0.8))
    np.testing.assert_allclose(thickness(placed[0], lip), 0.8 * thickness(rest, lip), rtol=0.01)
    np.testing.assert_allclose(placed[0, COLUMNS[1 - lip]], rest[COLUMNS[1 - lip]], atol=1e-6)  # the other one stays


def test_lips_that_are_thick_enough_stay(rest: NDArray) -> None:
    for share in (0.8, 1.2):
        placed = thinned(rest, 1, share)[None]
        before = placed.copy()
        keep_thickness(placed, rest[None], np.full((1, 2), 0.8))
        np.testing.assert_allclose(placed, before, atol=1e-6)


def test_a_lip_that_lies_beyond_its_border_comes_back(rest: NDArray) -> None:
    placed = thinned(rest, 1, -0.2)[None]
    keep_thickness(placed, rest[None], np.full((1, 2), 0.5))
    ways = ((placed[0, INNER[1]] - placed[0, BORDER[1]]) * (rest[INNER[1]] - rest[BORDER[1]])).sum(axis=-1)
    assert (ways > 0).all()
    np.testing.assert_allclose(thickness(placed[0], 1), 0.5 * thickness(rest, 1), rtol=0.01)


def test_the_opening_stays_open_and_what_is_far_stays(rest: NDArray) -> None:
    """Each inner edge goes into the opening by a quarter of it at most; a mouth that is shut stays shut, its borders go out."""
    for opening in (8.0, 0.0):
        face = rest.copy()
        face[COLUMNS[1].ravel()] += face[INNER[0]].repeat(4, axis=0) - face[INNER[1]].repeat(4, axis=0) + (0, opening)
        placed = face.copy()
        for lip in (0, 1):
            for column in COLUMNS[lip]:
                placed[column] = placed[column[-2]] + 0.2 * (placed[column] - placed[column[-2]])
        made = placed.copy()[None]
        keep_thickness(made, face[None], np.ones((1, 2)))
        gap = made[0, INNER[1], 1] - made[0, INNER[0], 1]
        assert (gap >= (1 - 2 * MAX_OPENING_SHARE) * opening - 1e-6).all()
        for lip in (0, 1):
            np.testing.assert_allclose(thickness(made[0], lip), thickness(face, lip), rtol=0.02)
        far = [*RIGHT_EYE, *LEFT_EYE, *FACE_OVAL]
        np.testing.assert_allclose(made[0, far], placed[far], atol=1e-6)
