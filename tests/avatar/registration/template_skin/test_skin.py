"""What the template's skin is made of."""

from __future__ import annotations

import numpy as np

from engine.avatar.registration.models import HumanModels


def test_each_corner_of_the_mouth_is_of_both_lips(models: HumanModels) -> None:
    skin = models.skin
    width = np.ptp(models.template.vertices[skin.vertices][skin.face_points[[48, 54]], 0])
    for lip in ("upper_lip", "lower_lip"):
        across = models.template.vertices[skin.vertices[skin.regions[lip] & ~skin.regions["inner"]], 0]
        assert np.ptp(across) > width and abs(across.max() + across.min()) < 0.005


def test_lips_have_an_inside_each_and_one_is_above_the_other(models: HumanModels) -> None:
    skin = models.skin
    upper, lower = skin.regions["upper_lip"], skin.regions["lower_lip"]
    assert not (upper & lower).any()
    for lip in (upper, lower):
        assert (lip & skin.regions["inner"]).sum() > 20 and (lip & ~skin.regions["inner"]).sum() > 50
    height = models.template.vertices[skin.vertices, 1]
    assert height[upper & ~skin.regions["inner"]].mean() > height[lower & ~skin.regions["inner"]].mean() + 0.005
