"""Legs under cloth that hangs are moved by it, and are themselves where they come out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.body.parts import BODY_PARTS
from engine.character.fit.template_fit import load_human
from engine.character.hybrid.limbs import Limbs
from engine.character.hybrid.under_cloth import HELD_BY_CLOTH_SHARE, bare_under_cloth, going_with_the_cloth
from engine.character.parts.free_cloth import FreeCloth, Ring
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import LEG_LABELS, TRUNK_LABEL
from engine.character.shell.template_mesh import TemplateMesh, template_mesh
from engine.character.surface.front_and_back import Layer
from engine.character.surface.legs_beneath import LEG_UNDER_CLOTH_SHARE
from engine.character.surface.part_surface import Surface

HIGH, WIDE, WAIST, HEM = 400, 300, 170, 300
UP = HELD_BY_CLOTH_SHARE * LEG_UNDER_CLOTH_SHARE * HIGH


@pytest.fixture(scope="module")
def skirted() -> tuple[TemplateMesh, np.ndarray, Limbs, Layer, Labels]:
    """The template from head to sole of a picture, in a skirt down to a hem, which moves with the hips alone."""
    mesh = template_mesh()
    body = load_human().space.mean[mesh.ids].astype(np.float64)
    scale = (HIGH - 1) / np.ptp(body[:, 1])
    pictured = np.stack([WIDE / 2 + scale * body[:, 0], scale * (body[:, 1].max() - body[:, 1]), scale * body[:, 2]], 1)
    labels = np.full((HIGH, WIDE), -1, np.int8)
    labels[:HEM, 100:200] = TRUNK_LABEL
    for leg, columns in zip(LEG_LABELS, (slice(155, 190), slice(110, 145)), strict=True):
        labels[HEM:, columns] = leg
    none = np.zeros(labels.shape, np.bool_)
    rings = tuple(Ring(row, 100, 199, 0.0, 30.0, 1.0, (172.0, 127.0)) for row in range(WAIST, HEM))
    cloth = FreeCloth(labels >= 0, rings, 20, True, False, none, 4.0)
    whole = Labels(labels, none, np.array(LEG_LABELS, np.int8), none, np.full(labels.shape, -1, np.int8), cloth=cloth)
    weights = np.zeros((HIGH, WIDE, len(load_human().rig.names)), np.float32)
    weights[..., load_human().rig.index("Hips")] = 1
    sides = [Surface(np.full(labels.shape, z, np.float32), weights) for z in (30, -30)]
    most = mesh.parts.argmax(1)
    limb = np.where(np.isin(most, LEG_LABELS), most, -1)
    limbs = Limbs(limb, np.zeros(len(limb), np.bool_), np.zeros(len(limb), np.float32))
    return mesh, pictured, limbs, Layer(labels == TRUNK_LABEL, *sides), whole


def test_legs_are_the_cloths_further_up_and_their_own_below(
    skirted: tuple[TemplateMesh, np.ndarray, Limbs, Layer, Labels],
) -> None:
    mesh, pictured, limbs, trunk, labels = skirted
    held = going_with_the_cloth(mesh, pictured, limbs, trunk, labels)
    leg = np.isin(limbs.limb, LEG_LABELS)
    above, below = leg & (pictured[:, 1] < HEM - UP - 1), leg & (pictured[:, 1] > HEM + 1)
    assert above.sum() > 100 and below.sum() > 100
    np.testing.assert_allclose(held.share("Hips")[above], 1, atol=1e-5)
    np.testing.assert_array_equal(held.weights[~leg | below], mesh.weights[~leg | below])
    np.testing.assert_array_equal(held.bones[~leg | below], mesh.bones[~leg | below])
    np.testing.assert_allclose(held.weights.sum(1), 1, atol=1e-5)
    between = leg & ~above & ~below
    order = np.argsort(pictured[between, 1])
    gained = (held.share("Hips") - mesh.share("Hips"))[between][order]
    assert gained[:5].mean() > gained[-5:].mean() + 0.5, "less and less towards the hem"


def test_without_cloth_that_hangs_nothing_changes(
    skirted: tuple[TemplateMesh, np.ndarray, Limbs, Layer, Labels],
) -> None:
    mesh, pictured, limbs, trunk, labels = skirted
    assert going_with_the_cloth(mesh, pictured, limbs, trunk, replace(labels, cloth=None)) is mesh
    assert not bare_under_cloth(replace(labels, cloth=None)).any()


def test_just_above_the_hem_legs_have_their_own_colours(
    skirted: tuple[TemplateMesh, np.ndarray, Limbs, Layer, Labels],
) -> None:
    labels = skirted[-1]
    rows = np.flatnonzero(bare_under_cloth(labels).any(1))
    assert rows[-1] == HEM - 1 and len(rows) == round(UP / 2)
    assert (labels.labels[bare_under_cloth(labels)] == BODY_PARTS.index("torso")).all()
