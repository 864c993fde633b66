"""Lids that close."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine.avatar.registration.eyes.blinking import EYE_OF_BLINK_UNIT, before_the_eye, meeting_rims
from engine.avatar.registration.eyes.eyeballs import sphere
from engine.avatar.registration.face.expressions import STIFF_LID_EYE_WIDTHS
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.models import HumanModels


@pytest.mark.parametrize("blink", EYE_OF_BLINK_UNIT)
def test_a_blink_closes_the_eye_and_keeps_lids_before_the_ball(
    models: HumanModels, fitted: FittedTemplate, blink: str
) -> None:
    template, skin = models.template, models.skin
    rest, moved = fitted.rest.astype(np.float64), fitted.expressions[blink]
    rims = meeting_rims(template, skin, blink)
    assert np.linalg.norm(rims.gap(rest), axis=1).max() > 0.004
    assert np.linalg.norm(rims.gap(rest + moved), axis=1).max() < 0.0005
    middle, radius = sphere(rest[template.vertices_of(EYE_OF_BLINK_UNIT[blink])])
    lids = skin.vertices[skin.regions["lids"] & ~skin.regions["inner"]]
    for share in (0.0, 0.5, 1.0):
        away = np.linalg.norm((rest + share * moved)[lids] - middle, axis=1)
        assert away.min() > radius - 2e-5


@pytest.mark.parametrize("blink", EYE_OF_BLINK_UNIT)
def test_what_is_above_the_fold_of_a_lid_stays_in_a_blink(
    models: HumanModels, fitted: FittedTemplate, blink: str
) -> None:
    skin = models.skin
    rest = fitted.rest[skin.vertices].astype(np.float64)
    rim = rest[skin.regions[f"{EYE_OF_BLINK_UNIT[blink]}_rim"]]
    away = cKDTree(rim).query(rest)[0]
    beyond = (away > STIFF_LID_EYE_WIDTHS * np.ptp(rim, axis=0).max()) & ~skin.regions["inner"]
    assert not fitted.expressions[blink][skin.vertices[beyond]].any()


def test_half_the_way_across_a_ball_is_outside_of_it() -> None:
    around = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    tilt = np.linspace(0, np.pi, 200)[:, None]
    ball = 0.012 * np.stack(
        [np.sin(tilt) * np.cos(around), np.sin(tilt) * np.sin(around), np.cos(tilt) + 0 * around], 2
    ).reshape(-1, 3)
    rest = np.array([[0, 0.006, 0.0108]])
    moved = before_the_eye(ball, rest, np.array([[0, -0.012, 0.0]]))
    assert np.linalg.norm(rest + moved / 2) >= 0.012 - 1e-7
    assert np.linalg.norm(rest + moved) >= 0.0124 - 1e-7
