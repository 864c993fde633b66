"""Feet in shoes."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from engine.avatar.registration.footwear import in_shoes
from engine.avatar.registration.models import HumanModels, load_models


@pytest.fixture(scope="module")
def models() -> HumanModels:
    return load_models()


def test_shoes_stand_where_feet_stood_and_have_no_toes(models: HumanModels) -> None:
    bare = models.space.mean[models.skin.vertices].astype(np.float64)
    shoes = in_shoes(models.skin, models.feet, bare)
    for mask, cap in zip(models.feet.masks, models.feet.caps, strict=True):
        assert shoes[mask, 1].min() == pytest.approx(bare[mask, 1].min(), abs=1e-9)
        assert np.ptp(shoes[mask, 2]) / np.ptp(bare[mask, 2]) == pytest.approx(1, abs=0.08)
        assert _hollow(shoes[cap.inside]) < 0.006 < _hollow(bare[cap.inside])  # between toes it is deep
    elsewhere = ~(models.feet.masks[0] | models.feet.masks[1])
    assert np.array_equal(shoes[elsewhere], bare[elsewhere])


def _hollow(places: NDArray[np.float64]) -> float:
    """How deep below their convex hull the deepest tenth of places (N, 3) lies at least, metres."""
    planes = ConvexHull(places).equations
    return float(np.percentile(-(places @ planes[:, :3].T + planes[:, 3]).max(1), 90))
