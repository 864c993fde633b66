"""Hair that a raised arm cuts in two stays the head's, and hangs together behind the arm."""

from __future__ import annotations

import cv2
import numpy as np

from engine.body.parts import BODY_PARTS
from engine.character.parts.hair_behind_arms import hair_behind_arms
from engine.character.parts.occlusion import completed

HEAD, TORSO, ARM = (BODY_PARTS.index(name) for name in ("head", "torso", "right_arm"))
HAIR, SKIN, SLEEVE = (45, 30, 25), (225, 175, 150), (240, 240, 245)


def disk(centre: tuple[int, int], radius: int) -> np.ndarray:
    drawn = np.zeros((400, 300), np.uint8)
    return cv2.circle(drawn, centre, radius, (1,), -1) > 0


def scene(sleeve: tuple[int, int, int] = SLEEVE) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A face in wide hair, a forearm raised before it, and a trunk: the picture; its true labels; labels in which all that is
    left of the face's middle above the shoulders is the arm's; and those of the template, which has no hair."""
    truth = np.full((400, 300), -1)
    truth[180:380, 100:200] = TORSO
    truth[disk((150, 110), 80)] = HEAD
    arm = np.zeros((400, 300), np.uint8)
    cv2.line(arm, (60, 230), (118, 20), (1,), 22)
    truth[arm > 0] = ARM
    template = np.full((400, 300), -1)
    template[180:380, 100:200] = TORSO
    template[disk((150, 120), 45)] = HEAD
    template[arm > 0] = ARM
    rough = np.where((truth >= 0) & (np.arange(300) < 112) & (np.arange(400)[:, None] < 180), ARM, truth)
    rgb = np.random.default_rng(2).normal(0, 6, (400, 300, 3))
    rgb[truth == HEAD] += HAIR
    rgb[disk((150, 120), 40)] += np.subtract(SKIN, HAIR)
    rgb[truth == TORSO] += (60, 120, 60)
    rgb[truth == ARM] += sleeve
    return np.clip(rgb, 0, 255).astype(np.uint8), truth, rough, template


def test_hair_on_both_sides_of_a_raised_arm_is_the_heads() -> None:
    rgb, truth, rough, template = scene()
    found = hair_behind_arms(rgb, rough, template, np.full(rough.shape, -1))
    left = (truth == HEAD) & (np.arange(300) < 112) & (rough == ARM)
    outer = left & (np.arange(300) < 85) & (np.arange(400)[:, None] < 150)
    assert outer.sum() > 300, "beyond the arm"
    assert (found[left] == HEAD).mean() > 0.85 and (found[outer] == HEAD).mean() > 0.85
    assert (found[truth == ARM] == ARM).mean() > 0.95
    assert (found[truth == TORSO] == TORSO).all()


def test_where_sleeve_and_hair_are_of_one_colour_nothing_is_changed() -> None:
    rgb, _, rough, template = scene(HAIR)
    np.testing.assert_array_equal(hair_behind_arms(rgb, rough, template, np.full(rough.shape, -1)), rough)


def test_what_is_seen_on_both_sides_of_a_limb_hangs_together_behind_it() -> None:
    _, truth, _, template = scene()
    body, arm = np.isin(truth, (HEAD, TORSO)), truth == ARM
    count, _ = cv2.connectedComponents(body.astype(np.uint8), connectivity=4)
    assert count > 2, "the arm cuts the hair off"
    whole = completed(body, arm, np.zeros_like(body), np.isin(template, (HEAD, TORSO)))
    assert whole[body].mean() > 0.99
    assert not (whole & ~body & ~arm).any()
