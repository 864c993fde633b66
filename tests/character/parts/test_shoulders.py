"""Shoulders whose arm and trunk are told apart by colours: bare ones, and sleeves of another cloth."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from engine.body.parts import BODY_PARTS, vertex_parts
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_fit import load_human
from engine.character.parts.label_map import Labels
from engine.character.parts.regions import find_regions
from engine.character.parts.shoulders import labelled_shoulders
from engine.imaging.masks.mask_distance import dilate_mask
from tests.character.parts.test_overlapping_legs import SIZE, standing

HEAD, TORSO, LEFT, RIGHT = (BODY_PARTS.index(name) for name in ("head", "torso", "left_arm", "right_arm"))
SKIN, WHITE, HAIR, GREY = (215, 170, 145), (235, 235, 238), (45, 30, 25), (120, 120, 125)


def seen() -> tuple[PosedTemplate, np.ndarray, np.ndarray]:
    """The standing template, its labels, and which of its pixels the left shoulder's are (h, w)."""
    rig, template = load_human().rig, standing({})
    labels = np.full(SIZE, -1)
    part = vertex_parts(rig)[template.triangles]
    for index in range(len(BODY_PARTS)):
        labels[template.covers((part == index).all(1), SIZE)] = index
    y, x = np.mgrid[: SIZE[0], : SIZE[1]]
    joint = template.joints[rig.index("LeftArm")]
    near = np.hypot(x - joint[0], y - joint[1]) < 0.1 * template.pixels_per_metre
    return template, labels, near & (labels >= 0)


def painted(labels: np.ndarray, arms: tuple[int, ...], torso: tuple[int, ...]) -> np.ndarray:
    rgb = np.full((*SIZE, 3), GREY, float)
    for which, colour in ((np.isin(labels, (LEFT, RIGHT)), arms), (labels == TORSO, torso), (labels == HEAD, SKIN)):
        rgb[which] = colour
    head = np.flatnonzero((labels == HEAD).any(1))
    rgb[: head[0] + len(head) // 3][labels[: head[0] + len(head) // 3] == HEAD] = HAIR
    return np.clip(rgb + np.random.default_rng(0).normal(0, 5, rgb.shape), 0, 255).astype(np.uint8)


def test_a_bare_shoulder_is_the_arms_as_far_as_skin_goes() -> None:
    template, truth, near = seen()
    rgb = painted(truth, SKIN, WHITE)
    astray = truth.copy()
    astray[near & (truth == LEFT)] = TORSO
    found, plain = labelled_shoulders(rgb, astray, template, load_human().rig)
    assert plain[near].all()
    assert (found == truth)[near].mean() > 0.98
    np.testing.assert_array_equal(found[~plain], astray[~plain])


def test_hair_over_a_shoulder_is_the_heads() -> None:
    template, truth, near = seen()
    rgb = painted(truth, SKIN, WHITE)
    y, x = np.nonzero(near & (truth == TORSO))
    lock = y[0] + 4, x[0]
    rgb[lock[0] : lock[0] + 8, lock[1] - 4 : lock[1] + 4] = HAIR
    found, _ = labelled_shoulders(rgb, truth, template, load_human().rig)
    assert (found[lock[0] + 1 : lock[0] + 7, lock[1] - 3 : lock[1] + 3] == HEAD).mean() > 0.9


def test_skin_within_the_trunk_is_no_arms() -> None:
    """As that of a neck, or in a low neckline."""
    template, truth, near = seen()
    rgb = painted(truth, SKIN, WHITE)
    inner = cv2.erode((near & (truth == TORSO)).astype(np.uint8), np.ones((5, 5), np.uint8)) > 0
    assert inner.sum() > 30
    rgb[inner] = SKIN
    found, plain = labelled_shoulders(rgb, truth, template, load_human().rig)
    assert plain[inner].all() and (found[inner] == TORSO).mean() > 0.9


def test_short_sleeves_of_the_shirts_cloth_and_shirts_of_one_colour_stay_as_they_are() -> None:
    template, truth, near = seen()
    sleeves = painted(truth, SKIN, WHITE)
    sleeves[near & (truth == LEFT)] = WHITE
    for rgb in (sleeves, painted(truth, WHITE, WHITE)):
        found, plain = labelled_shoulders(rgb, truth, template, load_human().rig)
        assert not plain[near].any()
        np.testing.assert_array_equal(found[near], truth[near])


def test_an_arm_that_comes_out_in_two_places_behind_the_trunk_is_one_and_hides_nothing() -> None:
    template, truth, near = seen()
    rig = load_human().rig
    elbow = int(template.joints[rig.index("LeftForeArm"), 1])
    rows = np.arange(SIZE[0])[:, None]
    labels = truth.copy()
    labels[(truth == LEFT) & ~near & (rows < elbow)] = TORSO  # a cloak over the upper arm
    none = np.zeros(SIZE, np.bool_)
    apart = Labels(labels.astype(np.int8), none, np.array([LEFT], np.int8), none, np.full(SIZE, -1, np.int8))
    body, (arm,) = find_regions(apart, [LEFT], template, rig)
    assert arm.behind
    assert arm.mask[labels == LEFT].mean() > 0.97, "hand and shoulder"
    assert arm.mask[(truth == LEFT) & (rows < elbow)].mean() > 0.9, "and what is between"
    deep = cv2.erode((labels == LEFT).astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    assert not body.mask[deep].any()
    whole = Labels(truth.astype(np.int8), none, np.array([LEFT], np.int8), none, np.full(SIZE, -1, np.int8))
    assert not find_regions(whole, [LEFT], template, rig)[1][0].behind


def test_a_forearm_whose_upper_arm_is_before_the_trunk_hides_it() -> None:
    """Nothing but hand and forearm are labelled the arm's: the template's upper arm is before the trunk, or behind it."""
    template, truth, _ = seen()
    rig = load_human().rig
    elbow = int(template.joints[rig.index("LeftForeArm"), 1])
    labels = np.where((truth == LEFT) & (np.arange(SIZE[0])[:, None] < elbow), TORSO, truth)
    none = np.zeros(SIZE, np.bool_)
    apart = Labels(labels.astype(np.int8), none, np.array([LEFT], np.int8), none, np.full(SIZE, -1, np.int8))
    _, (arm,) = find_regions(apart, [LEFT], template, rig)
    assert not arm.behind and arm.mask[truth == LEFT].mean() > 0.9
    turned = replace(template, vertices=template.vertices + _behind(template, LEFT))
    body, (behind,) = find_regions(apart, [LEFT], turned, rig)
    assert behind.behind
    assert body.mask[(labels == LEFT) & dilate_mask(labels == TORSO, 1)].any(), "nothing gapes between them"


def _behind(template: PosedTemplate, limb: int) -> np.ndarray:
    """What moves a limb of the template (V, 3) to the middle of the trunk, and behind it."""
    part = vertex_parts(load_human().rig) == limb
    middle = template.joints[load_human().rig.index("Hips"), 0]
    away = np.zeros_like(template.vertices)
    shoulder = template.joints[load_human().rig.index("LeftArm"), 0]
    away[part] = [middle - shoulder, 0, -1.0 * template.pixels_per_metre]
    return away
