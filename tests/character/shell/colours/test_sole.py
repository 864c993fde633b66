"""The line between a shoe's upper and its sole."""

from __future__ import annotations

import numpy as np
import pytest

from engine.character.fit.template_fit import load_human
from engine.character.shell.colours.sole import (
    BESIDE_SHOES_METRES,
    SEAM_SHADE_SHARE,
    SOLE_SHADE_SHARE,
    above_the_sole,
    sole_shade,
)
from engine.character.shell.extremities import in_shoes
from engine.character.shell.template_mesh import template_mesh


def test_the_line_is_dark_and_the_sole_below_it_is_a_little() -> None:
    shade = sole_shade(np.array([-0.02, 0.0, 0.02, BESIDE_SHOES_METRES]))
    assert shade[1] < 1 - SEAM_SHADE_SHARE / 2
    np.testing.assert_allclose(shade[[0, 2, 3]], [1 - SOLE_SHADE_SHARE, 1, 1], atol=1e-6)


def test_a_sole_is_what_is_lowest_of_a_foot() -> None:
    mesh, above = template_mesh(), above_the_sole()
    height = in_shoes(load_human().space.mean[mesh.ids])[:, 1]
    foot = above < BESIDE_SHOES_METRES
    height -= height[foot].min()
    assert (above[foot & (height < 0.005)] < -0.005).all()
    assert (above[foot & (height > 0.06)] > 0.02).all()
    assert above[mesh.share("LeftArm") > 0.5] == pytest.approx(BESIDE_SHOES_METRES)
