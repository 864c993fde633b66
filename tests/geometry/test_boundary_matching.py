"""Matching outlines: the same outline finds itself, and the order is kept whatever comes."""

from __future__ import annotations

from itertools import product

import numpy as np

from engine.geometry.boundary_matching import match_boundaries, match_curves


def star(count: int, waves: int = 5) -> np.ndarray:
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return np.stack([np.cos(angle), np.sin(angle)], 1) * 100 * (1 + 0.3 * np.sin(waves * angle))[:, None]


def test_an_outline_finds_itself_wherever_it_begins() -> None:
    outline = star(400)
    for shift in (0, 57, 399):
        np.testing.assert_array_equal(
            match_boundaries(outline, np.roll(outline, shift, 0)), (np.arange(400) + shift) % 400
        )


def test_once_around_is_once_around() -> None:
    matched = match_boundaries(star(300), star(410, 4) + 20)
    steps = np.diff(np.append(matched, matched[0])) % 410
    assert steps.sum() == 410
    assert steps.max() <= 32


def test_few_points_may_match_many() -> None:
    matched = match_boundaries(star(12), star(900))
    assert np.diff(np.append(matched, matched[0])).__mod__(900).sum() == 900


def test_curves_cost_the_least_there_is() -> None:
    random = np.random.default_rng(3)
    curve, reference = random.uniform(0, 10, (5, 2)), random.uniform(0, 10, (4, 2))

    def cost(match: tuple[int, ...]) -> float:
        return float(np.linalg.norm(curve - reference[list(match)], axis=1).sum())

    allowed = [(0, *inner, 3) for inner in product(range(4), repeat=3) if list(inner) == sorted(inner)]
    found = match_curves(curve, reference)
    assert found[0] == 0
    assert found[-1] == 3
    assert np.isclose(cost(tuple(found)), min(cost(match) for match in allowed))
