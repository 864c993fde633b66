"""Ears, as far forward as they are seen."""

from __future__ import annotations

import numpy as np
import pytest

from engine.avatar.registration.ears_seen import EAR_LANDMARK_SIGMA_METRES, EAR_SURROUNDINGS_METRES, with_ears_seen
from engine.avatar.registration.models import HumanModels

AHEAD = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_an_ear_comes_forward_as_a_whole_and_only_what_is_about_it_with_it(models: HumanModels, side: str) -> None:
    """Twice as far off as landmarks are usually, a quarter of that is held to be noise."""
    skin = models.skin
    before = models.template.vertices[skin.vertices].astype(np.float64)
    ear = skin.regions[f"{side.lower()}_ear"]
    front = before[ear, 2].max() + 2 * EAR_LANDMARK_SIGMA_METRES
    landmark = np.array([0.0, before[ear, 1].mean() + 0.02, front])  # too high, and within the head
    moved = with_ears_seen(skin, before, {f"{side}Ear": landmark}, AHEAD) - before
    np.testing.assert_allclose(moved[ear], np.tile(1.5 * EAR_LANDMARK_SIGMA_METRES * AHEAD, (ear.sum(), 1)), atol=1e-9)
    away = np.linalg.norm(before[:, None] - before[ear], axis=2).min(1)
    assert not moved[away > EAR_SURROUNDINGS_METRES + 0.002].any()
    assert not moved[~skin.regions["head"]].any()
    joined = skin.triangles[ear[skin.triangles].any(1)]
    assert np.ptp(moved[joined, 2], axis=1).max() < 0.6 * EAR_LANDMARK_SIGMA_METRES  # nothing is torn off


def test_an_ear_that_is_where_it_may_be_seen_stays(models: HumanModels) -> None:
    skin = models.skin
    before = models.template.vertices[skin.vertices].astype(np.float64)
    for off in (-0.9, 0.9):
        seen = {
            f"{side}Ear": before[skin.regions[f"{side.lower()}_ear"]].max(0) + off * EAR_LANDMARK_SIGMA_METRES * AHEAD
            for side in ("Left", "Right")
        }
        assert np.array_equal(with_ears_seen(skin, before, seen, AHEAD), before)


def test_ears_are_the_person_s_own(models: HumanModels) -> None:
    skin = models.skin
    own = models.template.vertices[skin.vertices]
    left, right = (own[skin.regions[name]] for name in ("left_ear", "right_ear"))
    assert left[:, 0].min() > 0.05 and right[:, 0].max() < -0.05
    assert 0.04 < np.ptp(left[:, 1]) < 0.08 and abs(len(left) - len(right)) < 0.1 * len(left)
