"""Heads turned by their faces, and legs parted."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.body.fitting.body_fitting import Fit
from engine.body.fitting.posing import POSED_SHAPE_COEFFICIENTS
from engine.character.figure.figure import Figure
from engine.character.fit.head import joint_axes, turn_head
from engine.character.fit.template_fit import FittedBody, load_human
from engine.character.surface.face_warp import Face, with_face
from engine.character.surface.front_and_back import Layer, stitch_front_and_back
from engine.character.surface.part_surface import Surface, warp_part
from engine.geometry.camera import Camera
from engine.geometry.mesh.welding import is_closed
from engine.perception.face.head_pose import mesh_from_fiducials

FOCAL, CENTRE, PLACE = 1200.0, (299.5, 399.5), np.array([0, 0.1, -3.0])


def standing() -> FittedBody:
    human = load_human()
    turns = np.broadcast_to(np.eye(3, dtype=np.float32), (len(human.rig.names), 3, 3)).copy()
    fit = Fit(np.zeros(POSED_SHAPE_COEFFICIENTS, np.float32), turns, PLACE.astype(np.float32), 0.0, np.zeros(1))
    return FittedBody(fit, Camera((0, 0, 0), FOCAL, CENTRE, (800, 600)), np.zeros(len(turns), np.bool_))


def figure_with(face: np.ndarray | None) -> Figure:
    nothing = np.zeros((33, 3), np.float32)
    return Figure(np.zeros((800, 600, 3), np.uint8), None, nothing[:, :2], nothing[:, 0], nothing, True, (600, 800),
                  np.zeros((1, 4), np.float32), 0, np.zeros((800, 600), np.bool_), face, (None, None))  # fmt: skip


def seen_face(turn: np.ndarray, aside: tuple[float, float, float] = (0, 0, 0)) -> np.ndarray:
    """The face mesh (478, 3) of the standing body, its head turned, and moved so many metres."""
    human = load_human()
    nobody = np.zeros(POSED_SHAPE_COEFFICIENTS, np.float32)
    rest, heads = human.space.vertices(nobody), human.space.joints(nobody)
    joint = heads[human.rig.index("Head")]
    at = (rest[human.face] - joint) @ turn.T + joint - heads[0] + PLACE + aside
    pixels = at[:, :2] * [FOCAL, -FOCAL] / -at[:, 2:] + CENTRE
    return mesh_from_fiducials(pixels.astype(np.float32))


@pytest.mark.parametrize("degrees", [(0, 25, 0), (15, -20, 5), (0, 0, 0)])
def test_a_head_turns_to_where_its_face_is_seen(degrees: tuple[float, float, float]) -> None:
    turn = Rotation.from_euler("xyz", degrees, degrees=True).as_matrix()
    fitted = turn_head(standing(), figure_with(seen_face(turn)))
    head = load_human().rig.index("Head")
    neck = load_human().rig.index("Neck")
    bent, own = fitted.fit.rotations[neck], fitted.fit.rotations[head]
    assert np.degrees(Rotation.from_matrix((bent @ own).T @ turn).magnitude()) < 2
    assert np.degrees(Rotation.from_matrix(bent).magnitude()) < 3, "it is where it was"
    others = np.delete(np.arange(len(fitted.fit.rotations)), (neck, head))
    assert (fitted.fit.rotations[others] == standing().fit.rotations[others]).all()


@pytest.mark.parametrize("aside", [0.02, -0.015])
def test_the_neck_bends_to_where_a_face_is_seen(aside: float) -> None:
    """The head's joint is so many metres beside where the standing body has it; it looks as it did."""
    human = load_human()
    fitted = turn_head(standing(), figure_with(seen_face(np.eye(3), (aside, 0, 0))))
    heads = human.space.joints(np.zeros(POSED_SHAPE_COEFFICIENTS, np.float32))
    turns, places = joint_axes(human.rig.parents, fitted.fit.rotations, heads, PLACE)
    head = human.rig.index("Head")
    assert places[head, 0] == pytest.approx(heads[head, 0] - heads[0, 0] + PLACE[0] + aside, abs=0.004)
    assert np.degrees(Rotation.from_matrix(turns[head]).magnitude()) < 2


def test_without_a_face_to_believe_the_head_stays() -> None:
    for face in (None, np.random.default_rng(1).uniform(200, 400, (478, 3)).astype(np.float32)):
        kept = turn_head(standing(), figure_with(face))
        np.testing.assert_array_equal(kept.fit.rotations, standing().fit.rotations)


def test_fiducials_are_looked_up_exactly_and_the_heads_border_stays() -> None:
    mask = np.zeros((120, 120), np.uint8)
    cv2.circle(mask, (60, 60), 40, (1,), -1)
    head = mask > 0
    warp = warp_part(head, head)
    seen = np.array([[50, 50], [70, 50], [60, 62], [60, 75]], float)
    laid = seen + np.array([[2, 1], [-1, 2], [0, -3], [1.5, 0]])
    warped = with_face(warp, Face(seen, laid, head))
    for (x, y), place in zip(seen.astype(int), laid, strict=True):
        np.testing.assert_allclose(warped.places[y, x], place, atol=0.02)
    border = warp.border.astype(int)
    np.testing.assert_array_equal(warped.places[border[:, 1], border[:, 0]], warp.places[border[:, 1], border[:, 0]])


def test_legs_that_touch_are_two() -> None:
    """A block of two legs, joined above: below, no triangle is moved by both."""
    mask = np.zeros((60, 40), np.bool_)
    mask[5:55, 8:32] = True
    weights = np.zeros((60, 40, 3), np.float32)
    weights[:20, :, 0] = 1
    weights[20:, :20, 1] = 1
    weights[20:, 20:, 2] = 1
    cut = np.zeros(mask.shape, np.int8)
    cut[20:, 17:20], cut[20:, 20:23] = 1, 2
    cut[~mask] = 0
    flat = [np.where(mask, depth, np.nan).astype(np.float32) for depth in (4.0, -4.0)]
    mesh = stitch_front_and_back(
        [Layer(mask, Surface(flat[0], weights), Surface(flat[1], weights), cut)], mask.astype(np.float32)
    )
    _, point = np.unique(np.round(mesh.vertices, 6), axis=0, return_inverse=True)
    assert is_closed(point.ravel()[mesh.triangles])
    moved_by = mesh.bones[:, 0][mesh.triangles]
    left, right = (moved_by == 1).any(1), (moved_by == 2).any(1)
    assert left.sum() > 100 and right.sum() > 100
    assert not (left & right).any()
    assert ((moved_by == 0).any(1) & left).any(), "the legs hang on the trunk"
