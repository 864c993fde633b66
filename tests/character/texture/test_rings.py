"""Limbs as rings: what is hidden of one is as it is at the same height, on it or on the other side's."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body.parts import BODY_PARTS
from engine.character.parts.labels import ARM_LABELS, LEG_LABELS
from engine.character.texture.limb_texture import filled
from engine.character.texture.rings import Heights, rings

HIGH, WIDE = 200, 120
SKIN, TROUSERS, SHOE, SHADE = (220, 170, 140), (40, 60, 110), (20, 20, 20), (255, 255, 255)
LEFT, RIGHT = LEG_LABELS
Y, X = np.indices((HIGH, WIDE))
DOWN = ((HIGH - Y) * 0.005).astype(np.float32)
HEIGHTS = {LEFT: Heights(DOWN, None), RIGHT: Heights(DOWN, None)}
FACE = np.array(SKIN)


def legs() -> tuple[np.ndarray, np.ndarray]:
    """Two legs in trousers that end below the knee, bare calves and shoes; and their labels."""
    labels = np.full((HIGH, WIDE), -1, np.int8)
    labels[:, 20:50], labels[:, 70:100] = RIGHT, LEFT
    rgb = np.full((HIGH, WIDE, 3), SHADE, np.uint8)
    rgb[labels >= 0] = TROUSERS
    rgb[(labels >= 0) & (Y > 120)] = SKIN
    rgb[(labels >= 0) & (Y > 180)] = SHOE
    return rgb, labels


def test_what_a_leg_hides_of_itself_and_of_the_other_is_told_at_its_height() -> None:
    rgb, labels = legs()
    labels[60:170, 70:100] = -1  # of this leg the middle is not seen, nor where trousers end
    rgb[60:170, 70:100] = SHADE
    found = rings(rgb, labels, labels >= 0, HEIGHTS, FACE)[LEFT]
    for rows, colour in ((slice(4, 116), TROUSERS), (slice(126, 176), SKIN), (slice(186, 200), SHOE)):
        assert np.abs(found[rows] - colour).max() < 4
    assert np.ptp(found, axis=1).max() < 1e-3, "whole rings"


def test_what_neither_shows_lies_between() -> None:
    rgb, labels = legs()
    rgb[(labels >= 0) & (Y < 100)] = (100, 100, 100)
    rgb[(labels >= 0) & (Y >= 100)] = (200, 200, 200)
    labels[60:140] = -1
    found = rings(rgb, labels, labels >= 0, HEIGHTS, FACE)[RIGHT]
    assert found[100].mean() == pytest.approx(150, abs=4)
    assert (np.diff(found[:, 0, 0]) > -1e-3).all()


def test_a_limb_in_the_shade_stays_in_it() -> None:
    rgb, labels = legs()
    rgb[labels == LEFT] //= 2
    labels[100:, 70:100] = -1
    found = rings(rgb, labels, labels >= 0, HEIGHTS, None)[LEFT]
    assert np.abs(found[126:170, 80] - np.array(SKIN)).min() > 10 and found[126:170].mean() < np.mean(SKIN)


@pytest.mark.parametrize("gloves", [True, False])
def test_hands_that_are_not_seen_are_the_face_s_colour_unless_the_other_wears_a_glove(gloves: bool) -> None:
    labels = np.full((HIGH, WIDE), -1, np.int8)
    labels[: 200 if gloves else 150, 20:50] = ARM_LABELS[0]
    labels[:100, 70:100] = ARM_LABELS[1]
    rgb = np.full((HIGH, WIDE, 3), TROUSERS, np.uint8)
    rgb[150:, 20:50] = SHOE
    along = (Y * 0.005).astype(np.float32)
    found = rings(rgb, labels, labels >= 0, dict.fromkeys(ARM_LABELS, Heights(along, 0.75)), FACE)
    assert np.abs(found[ARM_LABELS[1]][156:] - (SHOE if gloves else SKIN)).max() < 4
    assert np.abs(found[ARM_LABELS[1]][:144] - TROUSERS).max() < 4


def test_of_whom_no_limb_is_seen_no_ring_is_told() -> None:
    rgb, labels = legs()
    assert not rings(rgb, np.full_like(labels, BODY_PARTS.index("head")), labels >= 0, HEIGHTS, FACE)


def test_a_hole_has_the_rings_and_the_grain_of_what_is_seen() -> None:
    rgb, labels = legs()
    noise = np.random.default_rng(1).normal(0, 8, rgb.shape)
    seen = np.clip(rgb + noise, 0, 255).astype(np.uint8)
    found = rings(seen, labels, labels >= 0, HEIGHTS, FACE)[LEFT]
    hole = (labels == LEFT) & (Y > 40) & (Y < 170)
    made = filled(np.where(hole[..., None], 255, seen).astype(np.uint8), hole, (labels >= 0) & ~hole, found)
    inner = hole & (np.abs(Y - 120) > 6)
    assert np.abs(made[inner].astype(int) - rgb[inner]).mean() < 12
    assert 3 < (made[inner].astype(float) - rgb[inner]).std() < 14
    np.testing.assert_array_equal(made[~hole], seen[~hole])
