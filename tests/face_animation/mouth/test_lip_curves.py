"""Lips are curves from corner to corner, and neither slanted, nor dented, nor missing."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.face_animation.mouth.lip_curves import (
    THICKNESS_SHARES,
    TOUCHING_THICKNESS_SHARES,
    VOLUME_SHARES,
    construct_lips,
    thickness_shares,
)
from engine.face_animation.mouth.lips_and_skin import LIP_COLUMNS
from engine.face_animation.mouth.smile_curve import CORNER_VERTICES
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import FACE_OVAL, INNER_MOUTH_CORNER_VERTICES, LEFT_EYE, RIGHT_EYE

COLUMNS = np.array(LIP_COLUMNS)
INNER, BORDER = COLUMNS[..., -2], COLUMNS[..., -1]
LIPS = [*COLUMNS.ravel(), *CORNER_VERTICES]
ONE = np.ones((1, 2))


@pytest.fixture(scope="module")
def rest() -> NDArray[np.float64]:
    """A face whose eyes are 100 pixels apart, y down, with closed lips."""
    face = 100.0 * canonical_face()[:, :2].astype(float)
    face[INNER] = face[INNER].mean(axis=0)
    return face


def parted(rest: NDArray, gap: float, narrower: float = 1.0) -> NDArray[np.float64]:
    """The face with its mouth made narrower, and open by `gap` in the middle: as a lozenge, as a tracker has it."""
    face = rest.copy()
    face[LIPS, 0] *= narrower
    for lip, side in ((0, -0.5), (1, 0.5)):
        reach = 1 - np.abs(np.linspace(-1, 1, 11)[1:-1])
        face[COLUMNS[lip], 1] += side * gap * reach[:, None]
    return face


def constructed(placed: NDArray, rest: NDArray, shares: NDArray = ONE) -> NDArray[np.float64]:
    face = placed[None].copy()
    construct_lips(face, rest[None], shares)
    return np.asarray(face[0])


def thickness(face: NDArray, lip: int) -> NDArray[np.float64]:
    return np.linalg.norm(face[BORDER[lip]] - face[INNER[lip]], axis=-1)


def test_a_face_at_rest_stays_parted_or_not_wherever_its_head_is(rest: NDArray) -> None:
    turn = np.array([[0.9, -0.3], [0.3, 0.9]])
    for face in (rest, parted(rest, 20.0)):
        there = face @ turn.T + (40, 7)
        np.testing.assert_allclose(constructed(there, there), there, atol=1e-9)


def test_a_mouth_that_says_o_is_round(rest: NDArray) -> None:
    """Its edges are on an ellipse from corner to corner, and no less near these."""
    face = constructed(parted(rest, 50.0, 0.6), rest)
    right, left = face[list(INNER_MOUTH_CORNER_VERTICES)]
    edges = face[INNER] - (right + left) / 2
    edges = edges - (edges[0] + edges[1]) / 2 * (0, 1)  # beside the line on which they meet
    reach = np.abs(edges[0, 4, 1])
    off = np.hypot(edges[..., 0] / (np.linalg.norm(left - right) / 2), edges[..., 1] / reach)
    np.testing.assert_allclose(off, 1, atol=0.08)
    assert np.abs(edges[..., 1]).min() > 0.15 * reach


def test_one_that_parts_has_its_corners(rest: NDArray) -> None:
    face = constructed(parted(rest, 10.0), rest)
    gap = face[INNER[1], 1] - face[INNER[0], 1]
    places = rest[INNER[0], 0] / rest[INNER_MOUTH_CORNER_VERTICES[1], 0]
    np.testing.assert_allclose(gap, gap[4] * (1 - places**2), rtol=0.02)


@pytest.mark.parametrize("gap", [10.0, 50.0])
def test_a_slanted_opening_is_even_and_as_wide_open(rest: NDArray, gap: float) -> None:
    straight = parted(rest, gap, 0.7)
    slanted = straight.copy()
    slanted[COLUMNS[1], 1] += 0.2 * gap * np.linspace(-1, 1, 9)[:, None]
    one, other = constructed(straight, rest), constructed(slanted, rest)
    np.testing.assert_allclose(other[COLUMNS], one[COLUMNS], atol=1e-6)
    opening = [face[INNER[1, 4], 1] - face[INNER[0, 4], 1] for face in (other, straight)]
    assert opening[0] == pytest.approx(opening[1], rel=0.2)


@pytest.mark.parametrize("shares", [(1.0, 1.0), (0.8, 1.2)])
def test_lips_are_as_thick_as_told_however_they_were_drawn_out(rest: NDArray, shares: tuple[float, float]) -> None:
    placed = parted(rest, 30.0)
    placed[BORDER[1]] -= (0, 25)  # turned inside out
    face = constructed(placed, rest, np.array([shares]))
    for lip in (0, 1):
        assert thickness(face, lip)[4] == pytest.approx(shares[lip] * thickness(rest, lip)[4], rel=0.06)
        assert ((face[BORDER[lip], 1] - face[INNER[lip], 1]) * (-1, 1)[lip] > 0).all()


def test_lips_that_have_met_meet_also_where_they_are_parted_in_the_picture(rest: NDArray) -> None:
    face = constructed(rest, parted(rest, 20.0))
    np.testing.assert_allclose(face[INNER[1]], face[INNER[0]], atol=1e-6)


def test_corners_are_as_thick_as_at_rest_and_what_is_far_stays(rest: NDArray) -> None:
    placed = parted(rest, 40.0, 0.6)
    placed[[61, 291], 0] *= 1.3
    face = constructed(placed, rest)
    for outer, *_, inner in np.reshape(CORNER_VERTICES, (2, -1)):
        np.testing.assert_allclose(face[outer] - face[inner], rest[outer] - rest[inner], atol=1e-9)
        np.testing.assert_allclose(face[inner], placed[inner], atol=1e-9)
    far = [*RIGHT_EYE, *LEFT_EYE, *FACE_OVAL]
    np.testing.assert_allclose(face[far], placed[far], atol=1e-6)


def test_the_skin_around_goes_along(rest: NDArray) -> None:
    """No further than the lips do."""
    placed = parted(rest, 40.0)
    placed[BORDER[0]] += (0, 6)
    moved = np.abs(constructed(placed, rest) - placed).max(axis=1)
    around = np.setdiff1d(np.arange(468), LIPS)
    assert 0.5 < moved[around].max() <= moved[LIPS].max() + 1e-9


def with_lower_lip(face: NDArray, share: float) -> NDArray[np.float64]:
    """The face with its lower lip so many times as thick."""
    out = face.copy()
    for column in COLUMNS[1]:
        out[column] = out[column[-2]] + share * (out[column] - out[column[-2]])
    return out


def test_parted_lips_keep_their_volume(rest: NDArray) -> None:
    """Thicker the narrower the mouth is, and the driver's in what bounds that leaves."""
    apart = parted(rest, 20.0)
    shares = thickness_shares(np.stack([with_lower_lip(apart, share) for share in (1, 0.9, 0, 2)]), apart)
    np.testing.assert_allclose(shares[:, 1], [1, 0.9, *THICKNESS_SHARES])
    np.testing.assert_allclose(shares[:, 0], 1)
    narrow = apart.copy()
    narrow[:, 0] *= 0.5
    assert (thickness_shares(narrow[None], apart) >= THICKNESS_SHARES[0] * VOLUME_SHARES[1] - 1e-9).all()


def test_lips_that_touch_are_as_thick_as_they_are_pressed_or_pout(rest: NDArray) -> None:
    faces = np.stack([with_lower_lip(rest, share) for share in (0, 0.6, 0.9, 1, 1.3, 2)])
    least, most = TOUCHING_THICKNESS_SHARES
    np.testing.assert_allclose(thickness_shares(faces, rest)[:, 1], [least, 0.6, 0.9, 1, 1.3, most])


def test_pressed_lips_part_without_a_jump(rest: NDArray) -> None:
    gaps = np.linspace(0, 12, 200)
    shares = thickness_shares(np.stack([with_lower_lip(parted(rest, gap), 0.4) for gap in gaps]), rest)[:, 1]
    assert shares[0] < 0.6 < 0.8 < shares[-1] and np.abs(np.diff(shares)).max() < 0.03
