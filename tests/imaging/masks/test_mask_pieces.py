"""Pieces of masks against a flood of their pixels, one by one, and what is known of what was drawn."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.imaging.masks.mask_pieces import (
    Connectivity,
    bounding_box,
    largest_piece,
    mask_height,
    outline,
    pieces_by_area,
    pieces_touching,
    rows_apart,
    without_small_pieces,
)

SIDES = ((0, 1), (1, 0), (0, -1), (-1, 0))
CORNERS = ((1, 1), (1, -1), (-1, 1), (-1, -1))


def random_mask(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).random((13, 17)) < 0.5


def flooded(mask: np.ndarray, start: tuple[int, int], connectivity: int) -> frozenset[tuple[int, int]]:
    """What hangs together with a pixel, found by walking."""
    seen, to_do = {start}, [start]
    while to_do:
        y, x = to_do.pop()
        for dy, dx in SIDES + (CORNERS if connectivity == 8 else ()):
            there = y + dy, x + dx
            inside = 0 <= there[0] < mask.shape[0] and 0 <= there[1] < mask.shape[1]
            if inside and mask[there] and there not in seen:
                seen.add(there)
                to_do.append(there)
    return frozenset(seen)


def walked(mask: np.ndarray, connectivity: int) -> set[frozenset[tuple[int, int]]]:
    return {flooded(mask, (int(y), int(x)), connectivity) for y, x in np.argwhere(mask)}


def places(mask: np.ndarray) -> frozenset[tuple[int, int]]:
    return frozenset((int(y), int(x)) for y, x in np.argwhere(mask))


def drawn(pieces: set[frozenset[tuple[int, int]]]) -> np.ndarray:
    mask = np.zeros((13, 17), np.bool_)
    for piece in pieces:
        for place in piece:
            mask[place] = True
    return mask


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("seed", range(4))
def test_pieces_are_what_can_be_walked_to(seed: int, connectivity: Connectivity) -> None:
    mask, random = random_mask(seed), random_mask(seed + 100) & random_mask(seed + 200) & random_mask(seed + 300)
    expected = walked(mask, connectivity)
    found = pieces_by_area(mask, connectivity=connectivity)
    assert {places(piece) for piece in found} == expected and len(found) == len(expected)
    areas = [int(piece.sum()) for piece in found]
    assert areas == sorted(areas, reverse=True)
    large = {piece for piece in expected if len(piece) >= 4}
    assert {places(piece) for piece in pieces_by_area(mask, 4, connectivity)} == large
    np.testing.assert_array_equal(without_small_pieces(mask, 4, connectivity), drawn(large))
    np.testing.assert_array_equal(largest_piece(mask, connectivity), found[0])
    touched = {piece for piece in expected if piece & places(random)}
    assert touched and touched != expected
    np.testing.assert_array_equal(pieces_touching(mask, random, connectivity), drawn(touched))


def test_an_empty_mask_has_no_pieces() -> None:
    nothing, everything = np.zeros((5, 6), np.bool_), np.ones((5, 6), np.bool_)
    assert pieces_by_area(nothing) == []
    for found in (largest_piece(nothing), pieces_touching(nothing, everything), without_small_pieces(nothing, 1)):
        assert found.dtype == np.bool_ and not found.any()
    assert not pieces_touching(everything, nothing).any()
    assert mask_height(nothing) == rows_apart(nothing) == 0
    with pytest.raises(ValueError, match="no bounding box"):
        bounding_box(nothing)
    with pytest.raises(ValueError, match="no outline"):
        outline(nothing)


def test_pixels_that_meet_in_a_corner_are_no_piece() -> None:
    mask = np.zeros((9, 9), np.bool_)
    mask[:4, :4] = mask[4:, 4:] = True
    expected = np.zeros_like(mask)
    expected[4:, 4:] = True
    np.testing.assert_array_equal(largest_piece(mask), expected)


def disk(size: int, radius: float, x: float, y: float) -> np.ndarray:
    rows, columns = np.mgrid[:size, :size]
    return np.hypot(columns - x, rows - y) < radius


def test_the_outline_goes_round_the_largest_piece() -> None:
    mask = disk(64, 20, 30, 30) | disk(64, 3, 60, 60)
    border = outline(mask)
    np.testing.assert_allclose(np.hypot(*(border - 30).T), 20, atol=1.5)
    steps = np.abs(border - np.roll(border, 1, 0)).max(1)
    assert steps.max() == 1 and steps.min() == 1, "each pixel is beside the one before it"


def test_the_largest_piece_is_that_of_the_largest_area_and_not_of_the_longest_outline() -> None:
    mask = disk(120, 12, 40, 40)
    mask[100, 5:115] = True
    np.testing.assert_allclose(np.hypot(*(outline(mask) - 40).T), 12, atol=1.5)


@pytest.mark.parametrize("seed", range(3))
def test_the_outline_of_one_piece_is_all_of_it_that_the_outside_touches(seed: int) -> None:
    """Held against a flood of the outside by sides: inner rims of holes are no outline."""
    mask = largest_piece(random_mask(seed), 8)
    rim = np.pad(np.zeros_like(mask), 1, constant_values=True)
    outside = pieces_touching(rim | ~np.pad(mask, 1), rim)
    beside = cv2.dilate(outside.astype(np.uint8), np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], np.uint8))[1:-1, 1:-1] > 0
    assert {(int(y), int(x)) for x, y in outline(mask)} == places(mask & beside)


def test_a_box_holds_all_of_a_mask_and_ends_at_the_picture() -> None:
    mask = np.zeros((20, 30), np.bool_)
    mask[4, 10], mask[9, 7] = True, True
    assert bounding_box(mask) == (slice(4, 10), slice(7, 11))
    assert bounding_box(mask, 2) == (slice(2, 12), slice(5, 13))
    assert bounding_box(mask, 8) == (slice(0, 18), slice(0, 19))
    assert bounding_box(mask, 100) == (slice(0, 20), slice(0, 30))
    assert mask[bounding_box(mask)].sum() == mask.sum()
    assert mask_height(mask) == 6 and rows_apart(mask) == 5
