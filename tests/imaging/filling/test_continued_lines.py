"""Straight lines that a hole interrupts, or that end at it."""

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.imaging.filling.background_plate import background_plate
from engine.imaging.filling.continued_lines import continue_lines

SIZE = 200
CENTRE = (SIZE - 1) / 2


def disc(radius: float = 40.0, x: float = CENTRE, y: float = CENTRE) -> NDArray[np.bool_]:
    rows, columns = np.mgrid[:SIZE, :SIZE]
    return np.asarray(np.hypot(columns - x, rows - y) < radius)


def aside(degrees: float, shift: float = 0.0) -> NDArray[np.float64]:
    """Pixels from the line at this angle that passes the middle at `shift`, signed."""
    y, x = np.mgrid[:SIZE, :SIZE] - CENTRE
    angle = np.deg2rad(degrees)
    return np.asarray(y * np.cos(angle) - x * np.sin(angle) - shift)


def thin_line(degrees: float, shift: float = 0.0) -> NDArray[np.float32]:
    grey = 170 - 110 * np.exp(-0.5 * aside(degrees, shift) ** 2)
    return np.repeat(grey[..., None], 3, axis=2).astype(np.float32)


def edge(degrees: float) -> NDArray[np.float32]:
    share = 1 / (1 + np.exp(-2 * aside(degrees)))[..., None]
    return np.asarray((1 - share) * (200, 190, 180) + share * (70, 90, 60), np.float32)


def covered(picture: NDArray[np.float32], hole: NDArray[np.bool_]) -> NDArray[np.float32]:
    return np.where(hole[..., None], np.float32(40), picture)


@pytest.mark.parametrize("degrees", [0, 7, 33, 45, 78, 90, 120])
@pytest.mark.parametrize("drawn", [thin_line, edge])
def test_a_line_goes_on_behind_what_interrupts_it(drawn, degrees):
    truth, hole = drawn(degrees), disc()
    found = continue_lines(covered(truth, hole), hole, reach=10)
    on_it = hole & (np.abs(aside(degrees)) < 1)
    assert found.painted[on_it].mean() > 0.95  # the outermost pixels may be left, where rows are cut
    assert np.abs(found.picture - truth)[found.painted].max() < 6


def test_nothing_outside_the_hole_changes():
    truth, hole = thin_line(20), disc()
    picture = covered(truth, hole)
    found = continue_lines(picture, hole, reach=10)
    assert not (found.painted & ~hole).any()
    np.testing.assert_array_equal(found.picture[~found.painted], picture[~found.painted])


def test_a_line_that_is_not_found_again_goes_on_as_far_as_asked():
    hole = disc(radius=60, x=SIZE, y=CENTRE)  # reaches the picture's edge
    truth = thin_line(0, 0.5)
    found = continue_lines(covered(truth, hole), hole, reach=25)
    first = int(np.flatnonzero(hole[SIZE // 2])[0])
    columns = np.flatnonzero(found.painted[SIZE // 2])
    assert abs(columns[0] - first) <= 1 and abs(columns[-1] - first - 25) <= 1
    assert np.abs(found.picture - truth)[found.painted].max() < 3


def test_one_that_ends_behind_the_hole_goes_to_its_middle_at_most():
    truth, hole = thin_line(0), disc()
    truth[:, SIZE // 2 + 20 :] = 170
    found = continue_lines(covered(truth, hole), hole, reach=500)
    assert np.flatnonzero(found.painted.any(axis=0)).max() <= CENTRE + 2


def test_where_lines_cross_both_are_seen():
    truth, hole = np.minimum(thin_line(0), thin_line(90)), disc()
    found = continue_lines(covered(truth, hole), hole, reach=10)
    assert np.abs(found.picture - truth)[found.painted].mean() < 1


def test_a_line_is_found_between_those_that_cross_it():
    crossed = np.min([thin_line(0)] + [thin_line(90, s) for s in range(-96, 97, 24)], axis=0)
    hole = disc()
    found = continue_lines(covered(crossed, hole), hole, reach=10)
    assert found.painted[SIZE // 2][hole[SIZE // 2]].mean() > 0.95


@pytest.mark.parametrize("name", ["plain", "noise", "soft", "along", "too faint"])
def test_what_is_no_line_that_ends_there_is_left(name):
    hole = disc()
    y = np.mgrid[:SIZE, :SIZE][0] - CENTRE
    grey = {
        "plain": np.full((SIZE, SIZE), 120.0),
        "noise": np.random.default_rng(0).uniform(60, 200, (SIZE, SIZE)),
        "soft": 120 + 60 * np.sin(y / 20),
        "along": np.where(np.abs(y + 43) < 1.5, 40.0, 170.0),  # passes by without touching
        "too faint": 120 - 4 * np.exp(-0.5 * y**2),
    }[name]
    picture = np.repeat(grey[..., None], 3, axis=2).astype(np.float32)
    assert not continue_lines(covered(picture, hole), hole, reach=10).painted.any()


@pytest.mark.parametrize(("degrees", "goes_on"), [(3, False), (8, False), (25, True)])
def test_a_line_that_only_grazes_the_hole_is_left(degrees: float, goes_on: bool) -> None:
    hole = np.zeros((SIZE, SIZE), bool)
    hole[: SIZE // 2] = True
    found = continue_lines(covered(thin_line(degrees), hole), hole, reach=30)
    assert found.painted.any() == goes_on


def test_a_hole_that_is_everything_and_one_that_is_nothing():
    picture = thin_line(10)
    for hole in (np.ones((SIZE, SIZE), bool), np.zeros((SIZE, SIZE), bool)):
        assert not continue_lines(picture, hole, reach=10).painted.any()


def test_a_grid_behind_a_head_is_straight_in_the_plate():
    y, x = np.mgrid[:SIZE, :SIZE]
    away = [np.minimum((v - 11.5) % 24, 24 - (v - 11.5) % 24) for v in (x, y)]
    wall = 170 - 110 * np.max([np.exp(-0.5 * a**2) for a in away], axis=0)
    truth = np.repeat(wall[..., None], 3, axis=2).round().astype(np.uint8)
    hole = disc()
    plate = background_plate(np.where(hole[..., None], np.uint8(40), truth), hole.astype(np.float32))
    assert np.abs(plate.astype(float) - truth).mean(axis=2)[hole].mean() < 3


@pytest.mark.parametrize("size", [(1, 1), (1, 60), (9, 9), (60, 12)])
def test_pictures_too_small_for_a_line_are_left(size: tuple[int, int]) -> None:
    hole = np.zeros(size, bool)
    hole[: (size[0] + 1) // 2, : (size[1] + 1) // 2] = True
    picture = np.full((*size, 3), 90, np.float32)
    picture[:, size[1] // 2] = 200
    assert not continue_lines(picture, hole, reach=10).painted.any()
