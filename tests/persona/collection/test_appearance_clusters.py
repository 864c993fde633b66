"""The looks of a person, of descriptors of which it is known how they were made."""

from __future__ import annotations

import numpy as np

from engine.persona.collection.appearance_clusters import appearance_clusters

SAME = 0.6


def descriptors(mean: float, count: int, seed: int) -> np.ndarray:
    """About a place along the first of 128 axes, as far from one another as a person's are."""
    made = np.random.default_rng(seed).normal(0, 0.3 / np.sqrt(128), (count, 128))
    made[:, 0] += mean
    return made


def test_two_decades_are_two_looks_the_one_with_more_photos_first() -> None:
    young, old = descriptors(0, 25, 1), descriptors(0.4, 60, 2)
    assert appearance_clusters([*young, *old], SAME) == (1,) * 25 + (0,) * 60


def test_what_differs_little_is_one_look() -> None:
    assert set(appearance_clusters([*descriptors(0, 40, 1), *descriptors(0.1, 40, 2)], SAME)) == {0}


def test_a_look_of_few_photos_is_none() -> None:
    assert set(appearance_clusters([*descriptors(0, 60, 1), *descriptors(0.4, 10, 2)], SAME)) == {0}
    assert appearance_clusters([], SAME) == ()
