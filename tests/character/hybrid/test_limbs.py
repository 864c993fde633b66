"""Limbs that go on in the trunk, of the template itself in its own outline, and what a hand before a hip does to both."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.character.fit.template_fit import load_human, pose_template
from engine.character.hybrid.limbs import Limbs, joined_in_depth, limbs_of
from engine.character.hybrid.trunk import trunk_labels, trunk_layer
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS, LEG_LABELS, TRUNK_LABEL
from engine.character.shell.template_mesh import TemplateMesh, template_mesh
from engine.character.surface.front_and_back import Layer
from engine.imaging.masks.mask_distance import distance_to
from tests.character.hybrid.test_hybrid import figure_and_outline

HAND_PIXELS = 34
"""Pixels of the sides of a hand that is drawn before a hip."""
FAR_FROM_THE_CUT_PIXELS = 6

Found = tuple[TemplateMesh, NDArray[np.float64], Limbs, Layer, Labels]


@pytest.fixture(scope="module")
def with_a_hand() -> Found:
    """The template with its arms down, and a hand before its left hip: the shell, its limbs, the trunk, and what is seen."""
    _, fitted, silhouette, labels = figure_and_outline()
    mesh, human = template_mesh(), load_human()
    body = pose_template(fitted, silhouette.camera(fitted.picture_camera()), human)
    pictured = body.vertices[mesh.ids].astype(np.float64)
    limbs = limbs_of(mesh, pictured, trunk_labels(labels), fitted)
    found = labels.labels.copy()
    x, y = np.rint(pictured[:, :2]).astype(int).T
    trunk = (found == TRUNK_LABEL) & (distance_to(np.isin(found, LEG_LABELS)) > FAR_FROM_THE_CUT_PIXELS)
    hip = np.median(pictured[limbs.overlap & (limbs.limb == LEG_LABELS[0]) & trunk[y, x], :2], 0).astype(int)
    hand = tuple(slice(at - HAND_PIXELS // 2, at + HAND_PIXELS // 2) for at in hip[::-1])
    found[hand] = np.where(found[hand] >= 0, ARM_LABELS[0], -1)
    seen = trunk_labels(replace(labels, labels=found))
    return mesh, pictured, limbs, trunk_layer(seen, body, human.rig, None), seen


def of_the_leg(found: Found, where: NDArray[np.bool_], places: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which vertices (V,) go on from a leg in the trunk, away from where it is cut from that, and are at pixels `where` (h, w)."""
    _, _, limbs, _, labels = found
    x, y = np.rint(places[:, :2]).astype(int).T
    away = distance_to(np.isin(labels.labels, LEG_LABELS)) > FAR_FROM_THE_CUT_PIXELS
    return np.asarray(limbs.overlap & np.isin(limbs.limb, LEG_LABELS) & (where & away)[y, x])


def test_a_leg_is_within_the_trunk_behind_a_hand_that_hangs_before_it(with_a_hand: Found) -> None:
    mesh, pictured, limbs, trunk, labels = with_a_hand
    moved, body = joined_in_depth(mesh, pictured, limbs, trunk, labels)
    chosen = of_the_leg(with_a_hand, (labels.labels == ARM_LABELS[0]) & (distance_to(~body.mask) > 3), moved)
    x, y = np.rint(moved[:, :2]).astype(int).T
    assert chosen.sum() > 10
    assert (moved[:, 2] <= body.front.depth[y, x] + 0.5)[chosen].mean() > 0.95
    assert (moved[:, 2] >= body.back.depth[y, x] - 0.5)[chosen].mean() > 0.95


def test_a_leg_is_not_seen_beside_a_narrower_trunk(with_a_hand: Found) -> None:
    mesh, pictured, limbs, trunk, labels = with_a_hand
    narrow = trunk.mask.copy()
    middle = int(np.median(np.nonzero(narrow)[1]))
    narrow[:, middle + 12 :] = False
    moved, body = joined_in_depth(mesh, pictured, limbs, replace(trunk, mask=narrow), labels)
    beside = of_the_leg(with_a_hand, ~narrow, pictured)
    x, y = np.rint(moved[:, :2]).astype(int).T
    assert beside.sum() > 10 and body.mask[y, x][beside].all()


def test_the_trunk_behind_an_arm_does_not_go_with_it(with_a_hand: Found) -> None:
    mesh, pictured, limbs, trunk, labels = with_a_hand
    body = joined_in_depth(mesh, pictured, limbs, trunk, labels)[1]
    names = load_human().rig.names
    arm = np.isin(np.arange(len(names)), [names.index(f"{side}Arm") for side in ("Left", "Right")])
    behind = body.mask & np.isin(labels.labels, ARM_LABELS)
    assert behind.sum() > 1000
    for side in (body.front, body.back):
        assert 0.2 < side.weights[behind][:, arm].sum(1).max() < 0.45, (
            "a shoulder's share, as the template's trunk has it"
        )
