"""Feet in shoes."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from engine.avatar.registration.footwear import in_shoes
from engine.avatar.registration.models import HumanModels, load_models
from engine.body.garments.shoes import SHOE_LENGTH_RATIO, SHOE_WIDTH_RATIO
from engine.geometry.mesh.surface import face_normals, triangle_areas


@pytest.fixture(scope="module")
def models() -> HumanModels:
    return load_models()


def test_shoes_stand_where_feet_stood_and_have_no_toes(models: HumanModels) -> None:
    bare = models.space.mean[models.skin.vertices].astype(np.float64)
    shoes = in_shoes(models.skin, models.feet, bare)
    for mask, cap in zip(models.feet.masks, models.feet.caps, strict=True):
        assert shoes[mask, 1].min() == pytest.approx(bare[mask, 1].min(), abs=0.001)
        assert np.ptp(shoes[mask, 2]) / np.ptp(bare[mask, 2]) == pytest.approx(SHOE_LENGTH_RATIO, abs=0.03)
        assert np.ptp(shoes[mask, 0]) / np.ptp(bare[mask, 0]) == pytest.approx(SHOE_WIDTH_RATIO, abs=0.08)
        assert _hollow(shoes[cap.inside]) < 0.004 < _hollow(bare[cap.inside])  # between toes it is deep
        assert (shoes[mask, 1] < bare[mask, 1].min() + 0.004).mean() > 0.1  # the sole, of all that is foot
    elsewhere = ~(models.feet.masks[0] | models.feet.masks[1])
    assert np.array_equal(shoes[elsewhere], bare[elsewhere])


def test_a_shoe_s_surface_is_not_turned_over(models: HumanModels) -> None:
    skin = models.skin
    shoes = in_shoes(skin, models.feet, models.space.mean[skin.vertices])
    for mask in models.feet.masks:
        own = skin.triangles[mask[skin.triangles].all(1)]
        places = shoes[own].mean(1)
        middle = np.repeat([shoes[mask].mean(0) * [1, 0, 1] + [0, 0.03, 0]], len(own), axis=0)
        middle[:, 2] = np.clip(places[:, 2], shoes[mask, 2].min() + 0.04, shoes[mask, 2].max() - 0.05)  # its axis
        outwards = (face_normals(shoes, own) * (places - middle)).sum(1)
        areas = triangle_areas(shoes, own)
        assert areas[outwards < 0].sum() < 0.01 * areas.sum()


def test_a_shoe_stands_on_heel_and_ball(models: HumanModels) -> None:
    shoes = in_shoes(models.skin, models.feet, models.space.mean[models.skin.vertices])
    for mask in models.feet.masks:
        own = shoes[mask] - shoes[mask].min(0)
        along = own[:, 2] / own[:, 2].max()
        lowest = [
            own[(along > first) & (along < last), 1].min() for first, last in ((0.1, 0.2), (0.38, 0.44), (0.6, 0.7))
        ]
        assert max(lowest[0], lowest[2]) < 0.001 < 0.003 < lowest[1]


def _hollow(places: NDArray[np.float64]) -> float:
    """How deep below their convex hull the deepest tenth of places (N, 3) lies at least, metres."""
    planes = ConvexHull(places).equations
    return float(np.percentile(-(places @ planes[:, :3].T + planes[:, 3]).max(1), 90))
