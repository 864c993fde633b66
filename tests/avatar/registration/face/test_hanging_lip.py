"""The lower lip of an open mouth."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.avatar.mouth_chart import mouth_faces
from engine.avatar.registration.face.hanging_lip import hanging_lip
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.template_skin.lip_sides import lip_rims


def test_the_lip_hangs_in_a_curve_from_corner_to_corner(models: HumanModels) -> None:
    """A parabola is half-way down 0.29 of its half width from the corners, a V 0.5 of it. The middle and the corners stay."""
    skin, template = models.skin, models.template
    own = template.vertices[skin.vertices]
    _, rim = lip_rims(own, skin.triangles, np.tile(mouth_faces(template), 2))
    rim = rim[np.argsort(own[rim, 0])]
    opened = template.face_units.dense(("jawOpen",))[0, skin.vertices]
    straight, hanging = (one[rim, 1] for one in (opened, opened + hanging_lip(template, skin)))
    half = (straight.max() + straight.min()) / 2

    def widths(down: NDArray[np.floating]) -> float:
        """Where it is half-way down, in half widths from the corner."""
        side = own[rim, 0] >= 0
        at = np.interp(half, down[side], own[rim, 0][side])
        return float(1 - at / own[rim, 0].max())

    assert widths(hanging) < 0.33 < widths(straight)
    stay = np.isin(np.arange(len(rim)), [0, len(rim) // 2, len(rim) - 1])
    assert np.abs(hanging - straight)[stay].max() < 1e-6


def test_what_is_no_lower_lip_stays(models: HumanModels) -> None:
    moved = np.linalg.norm(hanging_lip(models.template, models.skin), axis=1)
    assert moved[models.skin.regions["lower_lip"]].max() > 0.003
    assert not moved[~models.skin.regions["lower_lip"]].any()


def test_a_mouth_that_opens_and_closes_again_is_shut(models: HumanModels, fitted: FittedTemplate) -> None:
    units = fitted.expressions
    shut = fitted.rest + units["jawOpen"] + units["mouthClose"]
    open_by = np.linalg.norm(models.skin.lip_contact @ shut[models.skin.vertices], axis=1)
    assert open_by.max() < 0.0012
