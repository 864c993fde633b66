"""Shoes are level all round: what is seen of them in front says what they are like behind."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.character.shell.colours.shoe_bands import FootEvidence, foot_heights, level_round
from engine.character.shell.colours.unrolled import UnrolledPart, unrolled_parts
from engine.character.shell.template_mesh import template_mesh
from engine.render.rasterisation.attributes import interpolate

SOLE, UPPER, SOLE_METRES = np.array([240.0, 235, 225]), np.array([60.0, 20, 20]), 0.025


def foot(name: str) -> tuple[UnrolledPart, np.ndarray]:
    """An unrolled foot and the heights of its cells."""
    part = next(part for part in unrolled_parts() if part.name == name)
    heights = interpolate(foot_heights()[:, None], template_mesh().triangles, part.raster)[..., 0]
    return part, np.asarray(heights)


def shod(heights: np.ndarray) -> np.ndarray:
    return np.where((heights < SOLE_METRES)[..., None], SOLE, UPPER).astype(np.float32)


def seen_from_before(name: str) -> tuple[UnrolledPart, np.ndarray, FootEvidence]:
    """A shoe of which the front half is seen, the rest being green to nobody's knowledge."""
    part, heights = foot(name)
    source = np.zeros(heights.shape, np.bool_)
    source[len(source) // 2 :] = True
    colours = np.where(source[..., None], shod(heights), np.array([0.0, 255, 0])).astype(np.float32)
    return part, heights, (colours, source, source.astype(np.float32))


def off_the_edge(heights: np.ndarray) -> np.ndarray:
    return abs(heights - SOLE_METRES) > 0.012


def test_a_sole_goes_round_at_its_height() -> None:
    part, heights, evidence = seen_from_before("left_foot")
    around, sure = level_round(part, evidence, None)
    behind = ~evidence[1] & off_the_edge(heights) & (heights < 0.07)
    assert behind.sum() > 1000
    assert np.abs(around - shod(heights))[behind].max() < 25
    np.testing.assert_array_equal(around[evidence[1]], evidence[0][evidence[1]], "what is seen stays")
    assert (sure == 1).all()


def test_a_foot_that_nobody_sees_is_like_the_other() -> None:
    part, heights = foot("right_foot")
    other, _, evidence = seen_from_before("left_foot")
    nothing = np.zeros(heights.shape, np.bool_)
    unseen = np.zeros((*heights.shape, 3), np.float32), nothing, nothing.astype(np.float32)
    around, _ = level_round(part, unseen, (other, evidence))
    told = off_the_edge(heights) & (heights < 0.07)
    assert np.abs(around - shod(heights))[told].max() < 25


def test_laces_stay_in_front() -> None:
    """A stripe along the top of a dark shoe does not make its heel light."""
    part, heights, (colours, source, facing) = seen_from_before("left_foot")
    laces = source & (abs(np.arange(heights.shape[1]) - heights.shape[1] / 2) < 16)
    laced = np.where(laces[..., None], np.float32(255), np.where(source[..., None], UPPER, colours)).astype(np.float32)
    around, _ = level_round(part, (laced, source, facing), None)
    heel = np.zeros_like(source)
    heel[: len(heel) // 4] = True
    assert np.median(around[heel & (heights < 0.07)], axis=0) == pytest.approx(UPPER, abs=15)


def test_where_nothing_is_seen_nothing_changes() -> None:
    part, _, (colours, source, facing) = seen_from_before("left_foot")
    around, sure = level_round(replace(part), (colours, source & False, facing), None)
    np.testing.assert_array_equal(around, colours)
    assert not sure.any()
