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


def test_of_an_arm_that_leaves_what_is_the_bodys_is_not_its_own() -> None:
    """Cloth of the trunk, and what is between it and the arm's middle."""
    rgb, labels = beside_an_arm(WHITE)
    rgb[20:40, 80:84] = BLUE
    rgb[45:65, 80:84] = np.add(BLUE, WHITE) // 2
    found = strange_colours(rgb, labels)
    assert found[22:38, 80:82].mean() > 0.9 and found[47:63, 80:82].mean() > 0.9
    assert not found[70:, 82:].any() and not found[:, 90:].any()


def test_a_hand_on_a_sleeve_is_the_arms() -> None:
    rgb, labels = beside_an_arm(BLUE)
    rgb[70:90, 80:84] = SKIN
    assert strange_colours(rgb, labels)[70:90, 80:84].mean() < 0.1


def test_a_wall_between_two_legs_is_neithers() -> None:
    rgb, labels = np.full((120, 130, 3), WALL, np.uint8), np.full((120, 130), -1, np.int8)
    rgb[10:110, 20:60], rgb[10:110, 66:106] = BLUE, BLUE
    labels[10:110, 20:63], labels[10:110, 63:106] = LEFT_LEG, RIGHT_LEG
    found = strange_colours(rgb, labels)
    assert found[15:105, 61:65].all() and not found[15:105, 20:58].any() and not found[15:105, 68:106].any()
