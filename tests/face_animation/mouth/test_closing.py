"""Closed on the driver is closed on the target, whole lips with their skin."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import opened, placed
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.lids_and_lips import INNER_LIP_PAIRS
from engine.face_animation.mouth.closing import ClosingLips, lip_influence
from engine.face_animation.mouth.lips_and_skin import SKIN_ABOVE_COLUMNS, SKIN_BELOW_COLUMNS
from engine.perception.face.landmarks import FACE_OVAL, mouth_opening

UPPER_BORDER, LOWER_BORDER = ([column[0] for column in skin] for skin in (SKIN_ABOVE_COLUMNS, SKIN_BELOW_COLUMNS))
TOP, BOTTOM = np.array(INNER_LIP_PAIRS).T


def closed(target: NDArray, rest: NDArray, driver: NDArray, strength: float = 1.0) -> NDArray:
    """The target as it is at rest, its lips as the driver's are."""
    face = target[None].astype(float).copy()
    ClosingLips(rest, target).close(face, driver[None], strength)
    return face[0]


def test_parted_lips_are_closed_where_the_driver_s_stay_closed() -> None:
    calm, parted = placed(60), opened(placed(90), 0.2)
    assert float(mouth_opening(closed(parted, calm, calm))) == pytest.approx(0, abs=1e-6)


def test_what_a_driver_opens_is_what_parted_lips_open() -> None:
    """The target begins where the driver does: with closed lips."""
    calm, parted = placed(60), opened(placed(60), 0.2)
    driver = opened(calm, 0.3)
    acted = parted + driver - calm
    ClosingLips(calm, parted).close(acted[None], driver[None], 1.0)
    assert float(mouth_opening(acted)) == pytest.approx(float(mouth_opening(driver)), abs=0.03)


def test_lips_that_are_parted_on_both_meet_together() -> None:
    """A smile that is broader than its driver's would stay open by what it is broader."""
    rest, broad = opened(placed(60), 0.15), opened(placed(90), 0.2)
    left = [float(mouth_opening(closed(broad, rest, opened(placed(60), gap)))) for gap in (0.15, 0.05, 0.01)]
    assert left[0] == pytest.approx(float(mouth_opening(broad)))
    assert left[0] > left[1] > left[2] == pytest.approx(0, abs=1e-6)


def test_lips_that_are_closed_on_both_are_left_to_their_offsets() -> None:
    calm = placed(60)
    np.testing.assert_array_equal(closed(calm, calm, opened(calm, 0.3)), calm)
    np.testing.assert_array_equal(closed(calm, calm, calm), calm)


def test_lips_keep_their_thickness_and_the_contour_its_place() -> None:
    calm, parted = placed(60), opened(placed(90), 0.2)
    now = closed(parted, calm, calm)
    for border, edge in ((UPPER_BORDER, TOP), (LOWER_BORDER, BOTTOM)):
        np.testing.assert_allclose(now[border] - now[edge], parted[border] - parted[edge], rtol=1e-3)
    np.testing.assert_array_equal(now[list(FACE_OVAL)], parted[list(FACE_OVAL)])


def test_half_a_strength_closes_half_of_the_gap() -> None:
    calm, parted = placed(60), opened(placed(90), 0.2)
    gap = [np.linalg.norm(face[BOTTOM] - face[TOP], axis=1) for face in (parted, closed(parted, calm, calm, 0.5))]
    np.testing.assert_allclose(gap[1], gap[0] / 2, atol=1e-6)


def test_skin_goes_along_in_shares() -> None:
    upper, lower = lip_influence()
    for influence in (upper, lower):
        assert influence.min() >= -1e-9
        assert influence.sum(axis=1).max() <= 1 + 1e-9
    np.testing.assert_allclose(upper[UPPER_BORDER], np.eye(9))
    np.testing.assert_allclose(lower[LOWER_BORDER], np.eye(9))
    assert not upper[LOWER_BORDER].any() and not lower[UPPER_BORDER].any()
