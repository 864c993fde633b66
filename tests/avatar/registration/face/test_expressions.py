"""Face units of another face."""

from __future__ import annotations

import numpy as np

from engine.avatar.registration.face.expressions import transferred_units
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.models import HumanModels
from engine.body.face.visemes import VISEMES, viseme_displacements
from engine.body.template import FACE_UNITS


def test_the_template_itself_has_its_own_and_one_twice_as_large_has_them_twice(models: HumanModels) -> None:
    template = models.template
    for scale in (1.0, 2.0):
        units = transferred_units(template, models.skin, template.vertices * scale + [0, 1, 0])
        assert set(units) == set(FACE_UNITS)
        for name in ("jawOpen", "browInnerUp", "mouthSmileRight"):
            own = template.face_units.displacement({name: scale})
            for part in ("body", "lower_teeth", "left_eye"):
                at = template.vertices_of(part)
                assert np.abs(units[name][at] - own[at]).max() < 1e-4 * scale


def test_a_mouth_that_opens_leaves_the_upper_lip(models: HumanModels, fitted: FittedTemplate) -> None:
    lip = models.skin.vertices[models.skin.face_points[[61, 62, 63]]]
    own = models.template.face_units.displacement({"jawOpen": 1.0})[lip]
    assert np.abs(fitted.expressions["jawOpen"][lip] - own).max() < 0.002


def test_a_tongue_goes_where_the_lower_jaw_goes(models: HumanModels, fitted: FittedTemplate) -> None:
    jaw, tongue = (models.template.vertices_of(part) for part in ("lower_teeth", "tongue"))
    for name in ("jawOpen", "jawLeft", "jawForward"):
        moved = fitted.rest + fitted.expressions[name]
        away = [np.linalg.norm(of[jaw[:, None]] - of[tongue], axis=2) for of in (fitted.rest, moved)]
        assert np.abs(away[1] - away[0]).max() < 0.001, name


def test_visemes_are_sums_of_units() -> None:
    assert len(VISEMES) == 15
    assert {unit for weights in VISEMES.values() for unit in weights} <= set(FACE_UNITS)
    units = {name: np.full((2, 3), k, np.float32) for k, name in enumerate(FACE_UNITS)}
    found = viseme_displacements(units, 2)
    expected = 0.35 * FACE_UNITS.index("jawOpen") + 0.6 * FACE_UNITS.index("mouthFunnel")
    assert np.allclose(found["viseme_O"], expected)
    assert not found["viseme_sil"].any()
