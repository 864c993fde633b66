"""Holes in pictures whose hidden part is known, by each way to fill them."""

from __future__ import annotations

from typing import get_args

import numpy as np
import pytest

from engine.imaging.filling.inpaint import Method, grown_by_margin, inpaint

METHODS = get_args(Method)
HEIGHT, WIDTH = 60, 90


def stripes() -> np.ndarray:
    picture = np.full((HEIGHT, WIDTH, 3), 40, np.uint8)
    picture[(np.arange(HEIGHT) // 3) % 2 == 0] = (210, 190, 170)
    return picture


def hole() -> np.ndarray:
    mask = np.zeros((HEIGHT, WIDTH), np.bool_)
    mask[20:44, 30:50] = True
    return mask


def holed(picture: np.ndarray) -> np.ndarray:
    """What is in the hole is of a colour that is nowhere else."""
    return np.where(hole()[..., None], np.array([255, 0, 255], picture.dtype), picture)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("kind", [np.uint8, np.float32])
def test_a_plain_ground_goes_on_and_all_else_stays(method: Method, kind: type) -> None:
    plain = np.full((HEIGHT, WIDTH, 3), (90, 120, 150), kind)
    found = inpaint(holed(plain), hole(), ~hole(), method)
    assert found.dtype == kind
    assert np.abs(found.astype(float) - plain).max() <= 1
    np.testing.assert_array_equal(found[~hole()], plain[~hole()])


@pytest.mark.parametrize("method", ["patches", "exemplars"])
def test_stripes_go_on_through_the_hole(method: Method) -> None:
    found = inpaint(holed(stripes()), hole(), ~hole(), method)
    assert np.abs(found.astype(float) - stripes())[hole()].mean() < 8


def test_without_detail_a_hole_has_what_is_harmonic() -> None:
    """A plane is: it comes back to the digit, in any unit and of any number of channels."""
    y, x = np.mgrid[:HEIGHT, :WIDTH].astype(np.float32)
    plane = np.stack([0.01 * x - 3, 500 - 2 * y, x + y, np.zeros_like(x)], -1)
    found = inpaint(np.where(hole()[..., None], np.float32(np.nan), plane), hole(), ~hole(), "harmonic", margin=0)
    np.testing.assert_allclose(found, plane, atol=2e-3)


@pytest.mark.parametrize("method", METHODS)
def test_nothing_but_the_source_has_a_say(method: Method) -> None:
    """Half of the picture is no source: whatever is in it, and in the hole, the fill is the same."""
    source = ~hole()
    source[:, 56:] = False
    rng = np.random.default_rng(5)
    other = np.where(source[..., None], stripes(), rng.integers(0, 256, (HEIGHT, WIDTH, 3))).astype(np.uint8)
    filled, of_other = (inpaint(picture, hole(), source, method) for picture in (stripes(), other))
    np.testing.assert_array_equal(of_other[hole()], filled[hole()])
    np.testing.assert_array_equal(of_other[~hole()], other[~hole()])


@pytest.mark.parametrize("method", METHODS)
def test_colours_mixed_with_the_holes_are_not_copied(method: Method) -> None:
    """A rim around the hole has what was in it, as soft edges do."""
    plain = np.full((HEIGHT, WIDTH, 3), (90, 120, 150), np.uint8)
    spoiled = np.where(grown_by_margin(hole(), 3)[..., None], np.uint8(255), plain)
    found = inpaint(spoiled, hole(), ~hole(), method, margin=3)
    assert np.abs(found.astype(int) - plain)[hole()].max() <= 1
    assert np.abs(inpaint(spoiled, hole(), ~hole(), method, margin=0).astype(int) - plain)[hole()].max() > 50


def test_a_margin_is_a_disk_and_by_default_a_share_of_the_longer_side() -> None:
    point = np.zeros((41, 41), np.bool_)
    point[20, 20] = True
    y, x = np.mgrid[:41, :41] - 20
    for margin in (0, 1, 4):
        grown = grown_by_margin(point, margin)
        assert grown[np.hypot(y, x) <= margin - 0.5].all() and not grown[np.hypot(y, x) > margin + 0.5].any()
    np.testing.assert_array_equal(grown_by_margin(point), grown_by_margin(point, 2))
    wide = np.zeros((10, 1000), np.bool_)
    wide[5, 500] = True
    assert grown_by_margin(wide)[5].sum() == 2 * 6 + 1


@pytest.mark.parametrize("method", METHODS)
def test_where_nothing_is_missing_or_nothing_is_known_the_picture_stays(method: Method) -> None:
    nothing = np.zeros((HEIGHT, WIDTH), np.bool_)
    for missing, source in ((nothing, ~nothing), (hole(), nothing)):
        picture = stripes()
        found = inpaint(picture, missing, source, method)
        np.testing.assert_array_equal(found, picture)
        assert found is not picture


@pytest.mark.parametrize("method", METHODS)
def test_of_a_source_that_is_all_edge_the_hole_has_the_mean(method: Method) -> None:
    source = grown_by_margin(hole(), 1) & ~hole()
    found = inpaint(stripes(), hole(), source, method, margin=2)
    np.testing.assert_array_equal(found[hole()] - np.round(stripes()[source].mean(0)), 0)


def test_the_same_seed_gives_the_same_patches() -> None:
    rng = np.random.default_rng(2)
    noise = rng.integers(0, 256, (HEIGHT, WIDTH, 3)).astype(np.uint8)
    first = inpaint(noise, hole(), ~hole(), seed=4)
    np.testing.assert_array_equal(inpaint(noise, hole(), ~hole(), seed=4), first)
    assert (inpaint(noise, hole(), ~hole(), seed=5) != first).any()
