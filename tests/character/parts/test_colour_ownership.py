"""Whose pixels beside a border are."""

from __future__ import annotations

from bordering_parts import BLUE, LEFT_ARM, SKIN, TORSO, beside_an_arm

from engine.character.parts.colour_ownership import owned_by_colour


def test_an_arms_pixels_that_are_labelled_as_the_trunks_are_the_arms() -> None:
    rgb, true = beside_an_arm(SKIN)
    wrong = true.copy()
    wrong[40:80, 80:86] = TORSO
    found = owned_by_colour(rgb, wrong)
    assert (found != true).sum() <= 0.2 * (wrong != true).sum(), "but for a column in which both are mixed"


def test_the_trunks_pixels_that_are_labelled_as_an_arms_are_the_trunks() -> None:
    rgb, true = beside_an_arm(SKIN)
    wrong = true.copy()
    wrong[40:80, 75:80] = LEFT_ARM
    found = owned_by_colour(rgb, wrong)
    assert (found != true).sum() <= 0.2 * (wrong != true).sum(), "but for a column in which both are mixed"


def test_where_sleeve_and_trunk_are_of_one_cloth_labels_stay() -> None:
    rgb, labels = beside_an_arm(BLUE)
    labels[40:80, 80:86] = TORSO
    assert (owned_by_colour(rgb, labels) == labels).all()
