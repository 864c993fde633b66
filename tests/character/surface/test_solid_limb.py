"""A forearm that points at the viewer is the template's, where the picture shows the arm."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.parts import BODY_PARTS, vertex_parts
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_fit import load_human, pose_template
from engine.character.parts.crossed_labels import Behind
from engine.character.parts.label_map import Labels
from engine.character.surface.front_and_back import Layer, stitch_front_and_back
from engine.character.surface.layers import arm_behind_the_other
from engine.character.surface.part_surface import Surface
from engine.character.surface.solid_limb import SolidLimb, places_on_the_picture, solid_arms, solid_limb
from engine.geometry.mesh.welding import is_closed
from tests.character.fit.test_head_and_legs import standing

SHAPE = (800, 600)
LEFT = BODY_PARTS.index("left_arm")


def posed(forearm: float) -> PosedTemplate:
    """The template with its left arm down and the forearm raised towards the viewer by so many degrees."""
    fitted, rig = standing(), load_human().rig
    fitted.fit.rotations[rig.index("LeftArm")] = Rotation.from_euler("z", -90, degrees=True).as_matrix()
    fitted.fit.rotations[rig.index("LeftForeArm")] = Rotation.from_euler("y", -forearm, degrees=True).as_matrix()
    return pose_template(fitted, fitted.picture_camera(), load_human())


@pytest.fixture(scope="module")
def template() -> PosedTemplate:
    return posed(85)


@pytest.fixture(scope="module")
def sleeve(template: PosedTemplate) -> NDArray[np.bool_]:
    """Where the picture shows the arm: it is wider than the template's all around."""
    covered = template.covers(arm(template), SHAPE).astype(np.uint8)
    return cv2.dilate(covered, np.ones((9, 9), np.uint8)) > 0


@pytest.fixture(scope="module")
def limb(template: PosedTemplate, sleeve: NDArray[np.bool_]) -> SolidLimb:
    return solid_limb(arm(template), sleeve, template, load_human().rig, sleeve)


def arm(template: PosedTemplate) -> NDArray[np.bool_]:
    return (vertex_parts(load_human().rig)[template.triangles] == LEFT).any(1)


def test_only_an_arm_that_is_more_deep_than_long_is_solid(template: PosedTemplate) -> None:
    rig = load_human().rig
    assert solid_arms(template, rig) == {LEFT}
    assert solid_arms(posed(30), rig) == set()


def test_it_has_the_outline_of_the_arm_in_the_picture(limb: SolidLimb, sleeve: NDArray[np.bool_]) -> None:
    covered = np.isfinite(limb.front)
    assert (covered & sleeve).sum() / (covered | sleeve).sum() > 0.95
    assert (limb.front >= limb.back)[covered].all()


def test_it_is_closed_and_keeps_the_length_of_the_forearm(limb: SolidLimb, template: PosedTemplate) -> None:
    assert is_closed(limb.triangles)
    mesh = stitch_front_and_back(
        [body(), Layer(np.isfinite(limb.front), *nothing(limb), solid=limb)], np.ones(SHAPE, np.float32)
    )
    before = len(mesh.vertices) - len(limb.vertices)
    np.testing.assert_array_equal(mesh.triangles[-len(limb.triangles) :] - before, limb.triangles)
    long = np.ptp(limb.vertices[~limb.upper, 2]) / template.pixels_per_metre
    assert 0.25 < long < 0.6, "a forearm and a hand, which the picture shows from the tip"


def test_what_is_not_seen_takes_the_colours_of_the_nearest_that_is(limb: SolidLimb, sleeve: NDArray[np.bool_]) -> None:
    (places,) = places_on_the_picture([limb])
    assert limb.seen.any() and not limb.seen.all()
    np.testing.assert_array_equal(places[limb.seen], limb.vertices[limb.seen, :2])
    x, y = np.rint(places).astype(int).T
    assert sleeve[y, x].all()
    shown = {tuple(place) for place in limb.vertices[limb.seen & limb.hand, :2]}
    assert {tuple(place) for place in places[limb.hand]} == shown, "a hand has the colours of a hand"


def test_it_goes_where_its_depths_go(limb: SolidLimb) -> None:
    further = limb.moved(limb.front + 7, limb.back + 7, limb.upper)
    np.testing.assert_allclose(further.vertices[limb.upper, 2], limb.vertices[limb.upper, 2] + 7, atol=1e-4)
    np.testing.assert_array_equal(further.vertices[~limb.upper], limb.vertices[~limb.upper])


def body() -> Layer:
    mask = np.zeros(SHAPE, np.bool_)
    mask[300:340, 100:140] = True
    weights = np.zeros((*SHAPE, len(load_human().rig.names)), np.float32)
    weights[..., 0] = 1
    flat = np.where(mask, 0, np.nan).astype(np.float32)
    return Layer(mask, Surface(flat + 2, weights), Surface(flat - 2, weights))


def nothing(limb: SolidLimb) -> tuple[Surface, Surface]:
    empty = np.zeros((*SHAPE, 0), np.float32)
    return Surface(limb.front, empty), Surface(limb.back, empty)


def test_behind_the_other_arm_it_is_beneath_its_surface(
    limb: SolidLimb, sleeve: NDArray[np.bool_], template: PosedTemplate
) -> None:
    right = BODY_PARTS.index("right_arm")
    none, unused = np.zeros(SHAPE, np.bool_), np.zeros((*SHAPE, 1), np.float32)
    rows = np.flatnonzero(sleeve.any(1))
    lower = np.arange(SHAPE[0])[:, None] > rows.mean()
    crossing = cv2.dilate((sleeve & lower).astype(np.uint8), np.ones((15, 15), np.uint8)) > 0
    depth = np.where(crossing, 0, np.nan).astype(np.float32)
    other = Layer(crossing, Surface(depth, unused), Surface(depth - 4, unused), limb=right)
    own = Layer(np.isfinite(limb.front), Surface(limb.front, unused), Surface(limb.back, unused), solid=limb, limb=LEFT)
    assert limb.vertices[:, 2].max() > 10, "it would come out of the other"
    labels = np.where(crossing, right, np.where(sleeve, LEFT, -1)).astype(np.int8)
    found = Labels(
        labels, none, np.array([LEFT, right], np.int8), none, np.full(SHAPE, -1, np.int8), Behind(LEFT, sleeve, none)
    )
    nobody = Layer(none, Surface(depth, unused), Surface(depth, unused))
    moved = arm_behind_the_other([other, own], nobody, Behind(LEFT, sleeve, none), found)[1]
    assert moved.solid is not None
    x, y = np.rint(moved.solid.vertices[:, :2]).astype(int).T
    inside = cv2.erode((crossing & sleeve).astype(np.uint8), np.ones((7, 7), np.uint8))[y, x] > 0
    assert inside.sum() > 20
    assert moved.solid.vertices[inside, 2].max() < 0
    assert is_closed(moved.solid.triangles)
