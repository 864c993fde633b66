"""What a shell has beside the template: shoes, relaxed hands, a skirt, what is held."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.character.figure.silhouette import Silhouette
from engine.character.fit.template_fit import load_human, pose_template
from engine.character.parts.free_cloth import FreeCloth, Ring
from engine.character.shell.extremities import in_shoes, with_relaxed_hands
from engine.character.shell.piece import Piece
from engine.character.shell.props import props_of
from engine.character.shell.skirt import skirt_of
from engine.character.shell.template_mesh import template_mesh
from engine.geometry.mesh.surface import area_vectors
from engine.geometry.mesh.welding import is_closed
from engine.render.rasterisation.rasteriser import rasterise
from tests.character.shell.test_displacement import SHAPE, arms_down, covered, labels_of, on_grid


@pytest.fixture(scope="module")
def body() -> NDArray[np.float64]:
    return on_grid(pose_template(arms_down(), arms_down().picture_camera(), load_human()), template_mesh())


def silhouette_of(mask: NDArray[np.bool_]) -> Silhouette:
    soft, rgb = mask.astype(np.float32), np.zeros((*mask.shape, 3), np.uint8)
    return Silhouette(soft, soft, mask, rgb, np.eye(2, 3))


def volume(piece: Piece) -> float:
    """In metres' turn, y up: more than none where the outside is outside."""
    places = piece.vertices * [1, -1, 1]
    areas = area_vectors(places, piece.triangles)
    return float((areas * places[piece.triangles[:, 0]]).sum() / 6)


def test_shoes_close_over_the_toes_and_leave_the_rest() -> None:
    mesh = template_mesh()
    straight = load_human().space.mean[mesh.ids].astype(np.float64)
    shoes = in_shoes(straight)
    moved = np.linalg.norm(shoes - straight, axis=1) > 1e-9
    assert moved[mesh.foot > 0.9].mean() > 0.95 and not moved[mesh.parts[:, BODY_PARTS.index("torso")] > 0.5].any()
    left = mesh.share("LeftFoot", "LeftToe") > 0.9
    length, bare = np.ptp(shoes[left, 2]), np.ptp(straight[left, 2])
    assert 1.02 < length / bare < 1.15


def test_fingers_that_nothing_is_known_of_are_curled_and_others_stay() -> None:
    fitted, rig = arms_down(), load_human().rig
    fitted.fit.rotations[rig.index("LeftHandIndex1")] = np.diag([1, -1, -1])
    relaxed = with_relaxed_hands(fitted)
    right, left = (rig.index(f"{side}HandRing2") for side in ("Right", "Left"))
    cosine = (np.trace(relaxed.fit.rotations[right]) - 1) / 2
    assert np.degrees(np.arccos(cosine)) == pytest.approx(28, abs=0.1) and relaxed.kept[right]
    assert (relaxed.fit.rotations[left] == np.eye(3)).all() and not relaxed.kept[left]
    straight, curled = (
        pose_template(one, one.picture_camera(), load_human()).vertices[template_mesh().ids]
        for one in (fitted, relaxed)
    )
    hand = template_mesh().share("RightHandRing", "RightHandMiddle") > 0.9
    palm = template_mesh().share("RightHand") > 0.9
    reach = [np.linalg.norm(one[hand].mean(0) - one[palm & ~hand].mean(0)) for one in (straight, curled)]
    assert reach[1] < 0.98 * reach[0]


def test_a_skirt_is_a_closed_tube_around_both_legs_to_its_hem(body: NDArray[np.float64]) -> None:
    labels = labels_of(body)
    rows = np.flatnonzero((labels.labels == BODY_PARTS.index("torso")).any(1))
    crotch, middle = int(rows[-1]), SHAPE[1] // 2
    worn = np.zeros(SHAPE, np.bool_)
    rings = []
    for row in range(crotch - 40, crotch + 60):
        half = 45 + (row - crotch + 40) // 4
        worn[row, middle - half : middle + half + 1] = True
        rings.append(Ring(row, middle - half, middle + half, 0.0, 30.0, 1.0, (middle + 20.0, middle - 20.0)))
    clothed = np.where(worn, BODY_PARTS.index("torso"), labels.labels).astype(np.int8)
    cloth = FreeCloth(worn, tuple(rings), 40, True, False, np.zeros(SHAPE, np.bool_), 4.0)
    skirt = skirt_of(template_mesh(), body, replace(labels, labels=clothed, cloth=cloth))
    assert skirt is not None and is_closed(skirt.triangles) and volume(skirt) > 0
    np.testing.assert_allclose(skirt.weights.sum(1), 1, atol=1e-6)
    assert abs(skirt.vertices[:, 1].max() - (crotch + 60)) < 2
    legs = template_mesh().parts[:, [BODY_PARTS.index("left_leg"), BODY_PARTS.index("right_leg")]].sum(1) > 0.9
    around = body[legs & (body[:, 1] > crotch) & (body[:, 1] < crotch + 50)]
    assert around[:, 2].max() < skirt.vertices[:, 2].max() and around[:, 2].min() > skirt.vertices[:, 2].min()


def test_what_is_beside_a_hand_is_a_closed_piece_in_it(body: NDArray[np.float64]) -> None:
    mask = covered(body)
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    tips = body[template_mesh().share("LeftHandMiddle3") > 0.9]
    ball = np.hypot(x - tips[:, 0].mean(), y - tips[:, 1].max() - 18) < 22
    (piece,) = props_of(template_mesh(), body, silhouette_of(mask | ball), [])
    assert piece.kind == "LeftHand" and is_closed(piece.triangles) and volume(piece) > 0
    assert (piece.bones[:, 0] == template_mesh().names.index("LeftHand")).all() and (piece.weights[:, 0] == 1).all()
    assert props_of(template_mesh(), body, silhouette_of(mask), []) == []


def test_what_is_held_is_a_ball_of_its_own_depth_whose_front_is_before_the_hand(body: NDArray[np.float64]) -> None:
    mesh, radius = template_mesh(), 20
    palm = body[mesh.share("LeftHand") > 0.9].mean(0)
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    ball = np.hypot(x - palm[0], y - palm[1]) < radius
    held = np.where(ball, BODY_PARTS.index("left_arm"), -1).astype(np.int8)
    (piece,) = props_of(mesh, body, silhouette_of(covered(body) | ball), [], held)
    assert piece.kind == "LeftHand" and is_closed(piece.triangles) and volume(piece) > 0
    assert (piece.bones[:, 0] == mesh.names.index("LeftHand")).all()
    assert 1.3 * radius < np.ptp(piece.vertices[:, 2]) < 2 * radius
    nearest = [
        np.where((seen := rasterise(places * [1, 1, -1], triangles, SHAPE)).triangle >= 0, -seen.depth, -np.inf)
        for places, triangles in ((piece.vertices, piece.triangles), (body, mesh.triangles))
    ]
    assert (nearest[0] > nearest[1])[ball].mean() > 0.8
    volumes = 4 / 3 * np.pi * radius**3
    assert 0.6 * volumes < volume(piece) < 1.1 * volumes


def test_a_loose_piece_goes_with_the_arm_or_with_the_rest(body: NDArray[np.float64]) -> None:
    """A flap between forearm and thigh: drawn out between both it would be a sail as the arm is raised."""
    mesh = template_mesh()
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    arm = body[mesh.share("LeftForeArm") > 0.9]
    leg = body[mesh.share("LeftUpLeg") > 0.9]
    rows = (y > arm[:, 1].max() - 50) & (y < arm[:, 1].max())
    between = rows & (x > min(leg[:, 0].max(), arm[:, 0].min()) - 2) & (x < max(leg[:, 0].max(), arm[:, 0].min()) + 2)
    of_arm = np.flatnonzero(mesh.parts[:, BODY_PARTS.index("left_arm")] > 0.99)
    joints = np.unique(mesh.bones[of_arm, 0])
    found = [one for one in props_of(mesh, body, silhouette_of(covered(body) | between), []) if one.kind == "soft"]
    assert found
    for piece in found:
        share = (piece.weights * np.isin(piece.bones, joints)).sum()
        assert share == pytest.approx(0, abs=1e-3) or share == pytest.approx(piece.weights.sum(), rel=1e-2)
