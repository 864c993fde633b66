"""Lids that close."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from engine.avatar.registration.eyes.blinking import EYE_OF_BLINK_UNIT, meeting_rims
from engine.avatar.registration.eyes.eyeballs import sphere
from engine.avatar.registration.eyes.shut_lids import MAX_DRAWN_BACK_METRES, SHUT_LID_METRES
from engine.avatar.registration.eyes.tucked_lids import LidColumns
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.template_skin.lid_rims import lid_rim, upper_lid_columns


@pytest.mark.parametrize("blink", EYE_OF_BLINK_UNIT)
def test_a_blink_closes_the_eye_and_its_lid_stays_before_the_ball_that_draws_back(
    models: HumanModels, fitted: FittedTemplate, blink: str
) -> None:
    template, part = models.template, EYE_OF_BLINK_UNIT[blink]
    rest, moved = fitted.rest.astype(np.float64), fitted.expressions[blink].astype(np.float64)
    rims = meeting_rims(template, models.skin, blink)
    assert np.linalg.norm(rims.gap(rest), axis=1).max() > 0.004
    assert np.linalg.norm(rims.gap(rest + moved), axis=1).max() < 1e-5
    ball, columns = template.vertices_of(part), upper_lid_columns(template, part)
    back = moved[ball]
    assert np.ptp(back, axis=0).max() < 1e-6 and 1e-4 < np.linalg.norm(back[0]) <= MAX_DRAWN_BACK_METRES
    for share in np.linspace(0, 1, 9):
        middle, radius = sphere((rest + share * moved)[ball])
        assert np.linalg.norm((rest + share * moved)[columns] - middle, axis=2).min() > radius + 5e-5
    middle, radius = sphere(rest[ball])
    up = LidColumns.of(rest[columns], rest[lid_rim(template, part)]).up()
    lid = np.linalg.norm((rest + moved)[columns] - middle, axis=2)[(up > 0.2) & (up < 0.6)]
    np.testing.assert_allclose(lid, radius + SHUT_LID_METRES, atol=2e-5)


@pytest.mark.parametrize("blink", EYE_OF_BLINK_UNIT)
def test_what_is_above_the_fold_of_a_lid_stays_in_a_blink_and_so_does_the_lower_lid(
    models: HumanModels, fitted: FittedTemplate, blink: str
) -> None:
    skin, template = models.skin, models.template
    rest, part = fitted.rest.astype(np.float64), EYE_OF_BLINK_UNIT[blink]
    columns = upper_lid_columns(template, part)
    up = LidColumns.of(rest[columns], rest[lid_rim(template, part)]).up()
    moving = np.linalg.norm(fitted.expressions[blink], axis=1) > 0
    assert moving[columns[up < 0.9]].all()
    outside = np.setdiff1d(skin.vertices[~skin.regions["inner"]], columns[up < 1])
    assert not moving[outside].any()


@pytest.mark.parametrize("blink", EYE_OF_BLINK_UNIT)
def test_what_is_behind_a_lid_that_comes_down_is_within_the_ball(
    models: HumanModels, fitted: FittedTemplate, blink: str
) -> None:
    skin = models.skin
    rest, moved = fitted.rest.astype(np.float64), fitted.expressions[blink]
    middle, radius = sphere(rest[models.template.vertices_of(EYE_OF_BLINK_UNIT[blink])])
    behind = skin.vertices[skin.regions["inner"]]
    behind = behind[np.linalg.norm(moved[behind], axis=1) > 0]
    assert len(behind) > 10
    assert np.linalg.norm((rest + moved)[behind] - middle, axis=1).max() < radius + 1e-5
    rim = rest[skin.vertices[skin.regions[f"{EYE_OF_BLINK_UNIT[blink]}_rim"]]]
    assert np.max(cKDTree(rim).query(rest[behind])[0]) < 0.01
