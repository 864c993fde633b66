"""Which skin is of which lip."""

from __future__ import annotations

import numpy as np

from engine.avatar.registration.models import HumanModels
from engine.avatar.registration.template_skin.lip_sides import lip_sides


def test_of_two_sheets_that_touch_each_keeps_what_hangs_together_with_it() -> None:
    """Two strips of skin, a tenth of a millimetre apart, that meet at neither end."""
    along = np.arange(5) * 0.004
    strips = [np.array([[x, y, z] for x in along for z in (0, 0.004)]) for y in (0.0, -0.0001)]
    quads = np.array([[2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2] for k in range(4)])
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    upper, lower = lip_sides(
        np.concatenate(strips), np.concatenate([faces, faces + 10]), np.array([0, 1]), np.array([10, 11])
    )
    assert np.array_equal(np.flatnonzero(upper), np.arange(10))
    assert np.array_equal(np.flatnonzero(lower), np.arange(10, 20))


def test_lips_have_an_inside_each_and_one_is_above_the_other(models: HumanModels) -> None:
    skin = models.skin
    upper, lower = skin.regions["upper_lip"], skin.regions["lower_lip"]
    assert not (upper & lower).any()
    for lip in (upper, lower):
        assert (lip & skin.regions["inner"]).sum() > 20 and (lip & ~skin.regions["inner"]).sum() > 50
    height = models.template.vertices[skin.vertices, 1]
    assert height[upper & ~skin.regions["inner"]].mean() > height[lower & ~skin.regions["inner"]].mean() + 0.005
