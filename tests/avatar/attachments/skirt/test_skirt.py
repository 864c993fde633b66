"""Cloth that goes around both legs is one ring with a smooth hem, and what does not go around is none."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import trimesh

from engine.avatar.attachments.attaching import Sighting, attachments, standing_points
from engine.avatar.attachments.body_surface import BodySurface
from engine.avatar.attachments.silhouettes import silhouettes_beside
from engine.avatar.attachments.skirt.leg_influences import leg_influences
from engine.avatar.attachments.skirt.legs import Legs
from engine.avatar.attachments.skirt.skirt import Skirt, skirt_around, smooth_hem
from engine.avatar.attachments.skirt.skirt_mesh import RING_THICKNESS_METRES, skirt_mesh
from engine.avatar.registration.models import HumanModels, load_models
from engine.avatar.worn import Attachments
from tests.avatar.attachments.skirt.skirted_person import DEEP_METRES, WIDE_METRES, Mesh, filmed, hanging, standing

ALL_AROUND = 2 * np.pi * np.arange(90) / 90
DROP_METRES, LONGER_BEHIND_METRES = 0.13, 0.03
"""Metres below the crotch to the hem at the sides, and how much longer it is behind, and shorter before."""


def drop(turns: np.ndarray) -> np.ndarray:
    return DROP_METRES - LONGER_BEHIND_METRES * np.sin(turns)


@dataclass(frozen=True)
class Dressed:
    body: BodySurface
    legs: Legs
    seen: Sighting
    skirt: Skirt


@pytest.fixture(scope="module")
def human() -> HumanModels:
    return load_models()


def found(body: BodySurface, legs: Legs, seen: Sighting) -> Skirt | None:
    return skirt_around(body, legs, silhouettes_beside(body, seen.masks, seen.cameras), seen.cloud)


@pytest.fixture(scope="module")
def dressed(human: HumanModels) -> Dressed:
    body, legs = standing(human)
    seen = filmed(body, hanging(legs, ALL_AROUND, drop))
    skirt = found(body, legs, seen)
    assert skirt is not None
    return Dressed(body, legs, seen, skirt)


@pytest.fixture(scope="module")
def worn(human: HumanModels, dressed: Dressed) -> Attachments:
    return attachments(human, human.template.vertices.astype(np.float64), dressed.seen)


def test_it_ends_where_its_hem_is_and_is_as_wide_as_it_hangs(dressed: Dressed) -> None:
    skirt = dressed.skirt
    np.testing.assert_allclose(dressed.legs.crotch - skirt.hem, drop(skirt.turns), atol=0.012)
    ellipse = 1 / np.hypot(np.cos(skirt.turns) / WIDE_METRES, np.sin(skirt.turns) / DEEP_METRES)
    below = skirt.radii[:, skirt.heights < dressed.legs.crotch]
    np.testing.assert_allclose(np.median(below, axis=1), ellipse, atol=0.01)


@pytest.mark.parametrize("turns", [np.linspace(1.1 * np.pi, 1.9 * np.pi, 40), np.zeros(0)], ids=["tails", "nothing"])
def test_tails_and_bare_legs_are_none(human: HumanModels, turns: np.ndarray) -> None:
    body, legs = standing(human)
    nothing: Mesh = (np.zeros((0, 3)), np.zeros((0, 3), np.int32))
    worn = hanging(legs, turns, lambda at: np.full(len(at), 0.3)) if len(turns) else nothing
    assert found(body, legs, filmed(body, worn)) is None


def test_a_hem_is_one_curve_through_what_is_seen_of_it_whatever_single_directions_say() -> None:
    turns = 2 * np.pi * np.arange(96) / 96
    true = -0.1 - 0.02 * np.sin(turns)
    told = np.where(np.abs(np.cos(turns)) < 0.6, true, np.inf)  # beside the legs nothing is
    told[22] -= 0.2
    np.testing.assert_allclose(smooth_hem(turns, told, 0.0), true, atol=0.004)


def test_its_surface_is_closed_goes_around_both_legs_and_begins_within_the_hips(dressed: Dressed) -> None:
    vertices, triangles = skirt_mesh(dressed.skirt)
    ring = trimesh.Trimesh(vertices, triangles, process=False)
    assert ring.is_watertight and ring.volume > 0, "counter-clockwise from outside"
    thighs = dressed.body.vertices[dressed.legs.skin["Left"] | dressed.legs.skin["Right"]]
    level = np.abs(thighs[:, 1] - (dressed.legs.crotch - 0.06)) < 0.01
    outer = vertices[np.abs(vertices[:, 1] - (dressed.legs.crotch - 0.06)) < 0.01]
    reach, own = (np.linalg.norm(of[:, [0, 2]] - dressed.legs.axis, axis=1) for of in (outer, thighs[level]))
    assert reach.max() > own.max() and reach.min() > DEEP_METRES - RING_THICKNESS_METRES - 0.015
    top = vertices[:, 1] > vertices[:, 1].max() - 1e-6
    assert (dressed.body.distances(vertices[top]) < 0).all()


def test_what_is_worn_is_that_ring_and_its_points_are_no_skin_s(
    human: HumanModels, dressed: Dressed, worn: Attachments
) -> None:
    vertices = human.template.vertices.astype(np.float64)
    low = worn.vertices[worn.vertices[:, 1] < dressed.legs.crotch - 0.03]
    off = low[:, [0, 2]] - dressed.legs.axis
    assert np.linalg.norm(off, axis=1).min() > DEEP_METRES - RING_THICKNESS_METRES - 0.015, (
        "nothing else is between the legs"
    )
    assert np.histogram(np.arctan2(off[:, 1], off[:, 0]), 24)[0].min() > 0
    points = standing_points(human, vertices, dressed.seen)
    below = points[:, 1] < dressed.legs.crotch - 0.02
    assert below.sum() > 100 and dressed.skirt.is_cloth(points[below]).all()


def test_before_a_leg_it_goes_with_that_leg_and_between_with_both(human: HumanModels, dressed: Dressed) -> None:
    legs, rig, skin = dressed.legs, human.rig, human.skin
    weights = np.zeros((len(skin.vertices), len(rig.names)), np.float32)
    np.add.at(weights, (np.arange(len(weights))[:, None], skin.bones), skin.weights)
    vertices, triangles = skirt_mesh(dressed.skirt)
    bones, shares = leg_influences(vertices, triangles, dressed.body, legs, weights)
    np.testing.assert_allclose(shares.sum(1), 1, atol=1e-6)
    left = np.where(bones == rig.index("LeftUpLeg"), shares, 0).sum(1)
    right = np.where(bones == rig.index("RightUpLeg"), shares, 0).sum(1)
    aside, low = legs.sideways(vertices), vertices[:, 1] < legs.crotch - 0.09
    assert left[low & (aside > 0.95)].min() > 0.8 and right[low & (aside > 0.95)].max() < 0.1
    between = low & (np.abs(aside) < 0.05)
    np.testing.assert_allclose(left[between], right[between], atol=0.12)


def test_a_hand_beside_the_hips_neither_moves_the_ring_nor_hides_it(
    human: HumanModels, dressed: Dressed, worn: Attachments
) -> None:
    """Of what stays by itself no triangle is left to be asked."""
    bare = dressed.body.without_own()
    assert not dressed.body.own[bare.triangles].any() and len(bare.triangles) < len(dressed.body.triangles)
    moving = np.unique(worn.bones[worn.weights > 0])
    assert not any("Hand" in human.rig.names[joint] or "Arm" in human.rig.names[joint] for joint in moving)


def test_its_outside_and_its_inside_move_alike(human: HumanModels, dressed: Dressed) -> None:
    rig, skin = human.rig, human.skin
    weights = np.zeros((len(skin.vertices), len(rig.names)), np.float32)
    np.add.at(weights, (np.arange(len(weights))[:, None], skin.bones), skin.weights)
    vertices, triangles = skirt_mesh(dressed.skirt)
    bones, shares = leg_influences(vertices, triangles, dressed.body, dressed.legs, weights)
    own = np.zeros((len(vertices), len(rig.names)))
    np.add.at(own, (np.arange(len(own))[:, None], bones), shares)
    around = own.reshape(len(dressed.skirt.turns), -1, len(rig.names))
    rows = (around.shape[1] - 1) // 2
    outside, inside = around[:, rows - 2 :: -1], around[:, rows + 2 :]  # from the second row above the hem on
    np.testing.assert_allclose(outside, inside, atol=0.03)
