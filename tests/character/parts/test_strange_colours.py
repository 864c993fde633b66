"""Which pixels beside a border are nobody's."""

from __future__ import annotations

import numpy as np
from bordering_parts import BLUE, LEFT_LEG, RIGHT_LEG, SKIN, TORSO, WALL, WHITE, beside_an_arm

from engine.character.parts.strange_colours import strange_colours


def test_nothing_is_strange_where_sleeve_and_trunk_are_of_one_cloth() -> None:
    rgb, labels = beside_an_arm(BLUE)
    labels[40:80, 80:86] = TORSO
    assert not strange_colours(rgb, labels).any()


def test_a_shadow_beside_an_arm_is_strange_and_a_print_is_not() -> None:
    rgb, labels = beside_an_arm(SKIN)
    rgb[20:50, 77:80] = 5
    rgb[70:100, 70:77] = WHITE
    found = strange_colours(rgb, labels)
    assert found[22:48, 77:80].mean() > 0.9, "the shadow"
    assert not found[70:100, 70:76].any(), "white is neither skin nor dark"
    assert not found[labels < 0].any() and not found[:, 20:60].any()


def test_of_an_arm_that_leaves_nothing_is_its_own_that_its_middle_has_not() -> None:
    """Light on the edge of a sleeve is neither like the sleeve nor like the trunk; a cuff is in the middle, too."""
    rgb, labels = beside_an_arm(SKIN)
    rgb[20:50, 80:84] = WHITE
    rgb[70:90, 80:106] = WHITE
    found = strange_colours(rgb, labels)
    assert found[22:48, 80:82].mean() > 0.9 and not found[72:88, 82:106].any() and not found[:, 90:].any()


def test_a_wall_between_two_legs_is_neithers() -> None:
    rgb, labels = np.full((120, 130, 3), WALL, np.uint8), np.full((120, 130), -1, np.int8)
    rgb[10:110, 20:60], rgb[10:110, 66:106] = BLUE, BLUE
    labels[10:110, 20:63], labels[10:110, 63:106] = LEFT_LEG, RIGHT_LEG
    found = strange_colours(rgb, labels)
    assert found[15:105, 61:65].all() and not found[15:105, 20:58].any() and not found[15:105, 68:106].any()
