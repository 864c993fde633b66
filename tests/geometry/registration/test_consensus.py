"""A similarity is found among pairs of which most are wrong, and nothing is shrunk onto a spot where many points lie."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.geometry.registration.consensus import similarity_by_consensus
from engine.geometry.registration.rigid import Similarity

TRUTH = Similarity(3.5 * Rotation.from_euler("xyz", [0.3, -1.1, 2.0]).as_matrix(), np.array([2.0, -1.0, 0.5]))


def test_it_is_found_although_half_of_the_pairs_are_anywhere() -> None:
    random = np.random.default_rng(1)
    points = random.normal(0, 1, (120, 3))
    there = TRUTH(points) + random.normal(0, 0.005, points.shape)
    there[:60] = random.normal(0, 4, (60, 3))
    found = similarity_by_consensus(points, there, 0.05)
    assert found is not None
    assert found.transform.linear == pytest.approx(TRUTH.linear, abs=0.01)
    assert found.transform.shift == pytest.approx(TRUTH.shift, abs=0.01)
    assert found.agreed[60:].all() and found.agreed[:60].sum() <= 2


def test_it_does_not_shrink_everything_onto_a_crowd() -> None:
    random = np.random.default_rng(2)
    points = random.normal(0, 1, (100, 3))
    there = TRUTH(points)
    there[:55] = np.array([1.0, 2.0, 3.0]) + random.normal(
        0, 0.01, (55, 3)
    )  # most pairs say one place, whatever their own
    found = similarity_by_consensus(points, there, 0.05)
    assert found is not None
    assert found.transform.scale == pytest.approx(TRUTH.scale, rel=1e-6)
    assert found.agreed.sum() == 45


def test_too_few_pairs_or_one_place_make_none() -> None:
    assert similarity_by_consensus(np.zeros((2, 3)), np.zeros((2, 3)), 0.1) is None
    assert similarity_by_consensus(np.ones((9, 3)), np.zeros((9, 3)), 0.1) is None
