"""Arms behind the trunk, of which the picture shows nothing. The template stands for the person, seen from its right side."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS, vertex_parts
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_fit import load_human, pose_template
from engine.character.parts.label_map import LabelHints, Labels, label_parts
from engine.character.parts.regions import find_regions
from engine.character.parts.unseen_limbs import unseen_limbs, with_limbs_hidden
from engine.character.surface.front_and_back import Layer, stitch_front_and_back
from engine.character.surface.layers import build_layers
from engine.character.surface.solid_limb import places_on_the_picture
from engine.geometry.mesh.welding import is_closed
from tests.character.parts.test_overlapping_legs import SIZE, fitted_as, standing

LEFT, RIGHT, TORSO = (BODY_PARTS.index(name) for name in ("left_arm", "right_arm", "torso"))
SHIRT, SKIN, WALL = (60, 60, 160), (220, 170, 140), (200, 200, 200)


@pytest.fixture(scope="module")
def template() -> PosedTemplate:
    return standing({"Hips": (0, 90, 0)})


@pytest.fixture(scope="module")
def labels(template: PosedTemplate) -> Labels:
    return labelled(template, clothed(template))


@pytest.fixture(scope="module")
def layers(labels: Labels, template: PosedTemplate) -> list[Layer]:
    return build_layers(labels, template, load_human().rig)


def clothed(template: PosedTemplate) -> NDArray[np.bool_]:
    """The person's outline: clothes stand off by three pixels."""
    covered = template.covers(np.ones(len(template.triangles), np.bool_), SIZE)
    return cv2.dilate(covered.astype(np.uint8), np.ones((7, 7), np.uint8)) > 0


def labelled(template: PosedTemplate, mask: NDArray[np.bool_]) -> Labels:
    rgb = np.where(mask[..., None], SHIRT, WALL).astype(np.uint8)
    return label_parts(rgb, mask, template, load_human().rig)


def triangles_of(template: PosedTemplate, limb: int) -> NDArray[np.bool_]:
    return (vertex_parts(load_human().rig)[template.triangles] == limb).all(1)


def test_an_arm_behind_the_trunk_is_made_apart_from_it(
    labels: Labels, template: PosedTemplate, layers: list[Layer]
) -> None:
    assert not (labels.labels == LEFT).any()
    body, _ = find_regions(labels, [int(limb) for limb in labels.apart], template, load_human().rig, [LEFT])
    assert not (body.triangles & triangles_of(template, LEFT)).any()
    arm = next(layer for layer in layers if layer.limb == LEFT)
    assert arm.solid is not None
    mesh = stitch_front_and_back(layers, clothed(template).astype(np.float32))
    _, point = np.unique(np.round(mesh.vertices, 6), axis=0, return_inverse=True)
    assert is_closed(point.ravel()[mesh.triangles])
    long = np.ptp(arm.solid.vertices[:, 1]) / template.pixels_per_metre
    assert 0.55 < long < 0.75


def test_nothing_of_it_is_seen(labels: Labels, template: PosedTemplate) -> None:
    """Not even where the fit has it before the trunk, 60 pixels of depth too near."""
    mask, rig = clothed(template), load_human().rig
    arm = vertex_parts(rig) == LEFT
    wrong = replace(template, vertices=template.vertices + np.outer(arm, [0, 0, 60]))
    layers = build_layers(labels, wrong, rig)
    shown = stitch_front_and_back(layers, mask.astype(np.float32)).seen_layer(SIZE)
    number = next(k for k, layer in enumerate(layers) if layer.limb == LEFT)
    assert not (shown == number).any()
    assert (shown >= 0).sum() > 0.98 * mask.sum()


def test_it_is_moved_by_its_own_joints_alone(layers: list[Layer]) -> None:
    arm = next(layer for layer in layers if layer.limb == LEFT).solid
    assert arm is not None
    own = [name.startswith("Left") for name in load_human().rig.names]
    assert arm.weights[~arm.upper][:, own].sum(1).min() > 0.99


def test_it_has_the_colours_of_the_other_arm(labels: Labels, template: PosedTemplate, layers: list[Layer]) -> None:
    arm = next(layer for layer in layers if layer.limb == LEFT).solid
    assert arm is not None and arm.like is not None
    (places,) = places_on_the_picture([arm])
    assert np.isfinite(places).all()
    x, y = np.clip(np.rint(places), 0, np.array(SIZE)[::-1] - 1).astype(int).T
    assert (labels.labels[y, x] == RIGHT).mean() > 0.98
    upper, lower = (places[~arm.hand & (share < abs(arm.rest[:, 0])) & (abs(arm.rest[:, 0]) < share + 0.1), 1].mean()
                    for share in (0.2, 0.5))  # fmt: skip
    assert lower - upper > 0.2 * template.pixels_per_metre, "a forearm is like the forearm"
    sleeve, hand = places[~arm.hand, 1], places[arm.hand, 1]
    assert sleeve.min() < hand.min(), "a hand is like a hand, below the sleeves"
    wrist = arm.like.vertices[arm.like.hand, 1].min()
    assert (hand >= wrist - 1).all()


@pytest.mark.parametrize("cut", [0.0, 0.5])
def test_an_arm_that_the_picture_cuts_off_is_not_made_up(cut: float) -> None:
    """Nor where a half of it lies before the trunk."""
    template, rig = standing({"LeftArm": (0, 0, -75)}), load_human().rig
    covered = template.covers(triangles_of(template, LEFT), SIZE).astype(np.uint8)
    columns = np.flatnonzero(covered.any(0))
    beyond = cv2.dilate(covered, np.ones((15, 15), np.uint8)) > 0
    beyond[:, : int(columns[0] + cut * np.ptp(columns))] = False
    mask = clothed(template) & ~beyond
    found = labelled(template, mask).labels
    without = np.where(found == LEFT, TORSO, found).astype(np.int8)
    given = label_parts(np.zeros((*SIZE, 3), np.uint8), mask, template, rig, LabelHints(without))
    assert not (given.labels == LEFT).any()
    assert unseen_limbs(given, template, rig) == []


@pytest.mark.parametrize("turns", [{"LeftForeArm": (0, -75, 0)}, {"LeftArm": (0, -25, -60)}])
def test_a_pose_that_would_show_the_arm_gives_way_to_one_that_hides_it(turns: dict[str, tuple[int, int, int]]) -> None:
    human, right = load_human(), standing({"Hips": (0, 90, 0)})
    mask = clothed(right)
    labels = labelled(right, mask)
    fitted = fitted_as({"Hips": (0, 90, 0)} | turns)
    camera = fitted.picture_camera()
    assert unseen_limbs(labels, pose_template(fitted, camera, human), human.rig) == []
    told: list[str] = []
    hidden = with_limbs_hidden(fitted, camera, labels, lambda code, message: told.append(code))
    assert told == ["limb_unseen"]
    (arm,) = unseen_limbs(labels, pose_template(hidden, camera, human), human.rig)
    assert arm.limb == LEFT
    changed = ~np.isclose(hidden.fit.rotations, fitted.fit.rotations).all((1, 2))
    assert set(np.array(human.rig.names)[changed]) <= {"LeftArm", "LeftForeArm"}
    again = with_limbs_hidden(hidden, camera, labels, lambda code, message: None)
    np.testing.assert_array_equal(again.fit.rotations, hidden.fit.rotations)


def test_whoever_is_seen_whole_lacks_nothing() -> None:
    template = standing({})
    assert unseen_limbs(labelled(template, clothed(template)), template, load_human().rig) == []


def test_a_leg_that_nobody_sees_stands_beside_the_other() -> None:
    template, rig = standing({"Hips": (0, 90, 0)}), load_human().rig
    mask = clothed(template)
    left, right = BODY_PARTS.index("left_leg"), BODY_PARTS.index("right_leg")
    found = labelled(template, mask).labels
    given = np.where(found == left, right, found).astype(np.int8)
    labels = label_parts(np.zeros((*SIZE, 3), np.uint8), mask, template, rig, LabelHints(given))
    assert {one.limb for one in unseen_limbs(labels, template, rig)} == {LEFT, left}
    layers = build_layers(labels, template, rig)
    shown = stitch_front_and_back(layers, mask.astype(np.float32)).seen_layer(SIZE)
    leg = next(layer for layer in layers if layer.limb == left).solid
    assert leg is not None
    assert [layers[k].limb for k in np.unique(shown[shown >= 0])] == [-1, RIGHT]
    own = template.vertices[np.unique(template.triangles[triangles_of(template, left)])]
    off = (leg.vertices[:, 2].mean() - own[:, 2].mean()) / template.pixels_per_metre
    assert abs(off) < 0.05, "behind the other as the template has it"
    assert np.ptp(leg.vertices[:, 2]) < np.ptp(own[:, 2]) + 0.05 * template.pixels_per_metre
