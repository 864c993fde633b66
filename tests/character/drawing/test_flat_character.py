"""Drawings that move: found on paper, bound in T-pose, posed back to where they were drawn."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from engine.body.parts import BODY_PARTS
from engine.character.drawing.flat_character import bind_drawing, close_drawing, label_drawing
from engine.character.drawing.flat_pose import DRAWING_HEIGHT_METRES, fit_drawing, flat_pose
from engine.character.figure.figure import Choice, Figure, find_figure
from engine.character.figure.silhouette import Silhouette, cut_out
from engine.character.fit.template_fit import load_human
from engine.character.rig.measures import pose
from engine.character.rig.rigging import Character
from engine.media.limits import Limits

Drawn = tuple[Figure, Silhouette, Character]


def found(photo: Path, *placed: tuple[str, float, float]) -> tuple[Figure, list[str]]:
    told: list[str] = []
    figure = find_figure(photo, Choice(placed=placed), False, Limits(), lambda code, message: told.append(code))
    return figure, told


@pytest.fixture(scope="module")
def drawn(media: Callable[[str], Path]) -> Drawn:
    figure, told = found(media("fullbody/drawing_child_girl.png"))
    assert told == ["figure_drawn"]
    silhouette = cut_out(figure, None, (), Limits(), None, None, lambda code, message: None)
    mesh = close_drawing(figure, silhouette, label_drawing(figure, silhouette))
    return figure, silhouette, bind_drawing(figure, silhouette, fit_drawing(figure, silhouette.alpha > 0.5), mesh)


def test_a_childs_drawing_is_found_unaided(drawn: Drawn) -> None:
    figure = drawn[0]
    assert figure.drawn
    for joint in ("Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle"):
        assert figure.point(f"Left{joint}")[0] > figure.point(f"Right{joint}")[0]
    assert figure.point("LeftWrist")[0] > 0.9 * figure.rgb.shape[1]
    assert figure.point("LeftAnkle")[1] > 0.9 * figure.rgb.shape[0]
    assert figure.point("Nose")[1] < 0.25 * figure.rgb.shape[0]


def test_a_joint_placed_by_hand_takes_the_place_of_the_outlines(media: Callable[[str], Path]) -> None:
    figure, _ = found(media("fullbody/drawing_child_girl.png"), ("LeftElbow", 250.0, 160.0))
    assert figure.drawn
    np.testing.assert_allclose(figure.point("LeftElbow"), [250, 160], atol=0.6)


def test_as_pictured_it_lies_in_the_pictures_plane_and_in_t_pose_its_limbs_are_straight(drawn: Drawn) -> None:
    character, rig = drawn[2], load_human().rig
    heads = character.mesh.skeleton.heads
    for side, towards in (("Left", 1), ("Right", -1)):
        arm, elbow, hand, hip, knee, ankle = (
            heads[rig.index(side + name)] for name in ("Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot")
        )
        for bone in (elbow - arm, hand - elbow):
            np.testing.assert_allclose(bone / np.linalg.norm(bone), [towards, 0, 0], atol=1e-3)
        for bone in (knee - hip, ankle - knee):
            np.testing.assert_allclose(bone / np.linalg.norm(bone), [0, -1, 0], atol=1e-3)
    posed = pose(character, character.pictured)
    assert np.ptp(posed[:, 2]) < 0.06  # a cut-out, not a body
    assert abs(np.ptp(posed[:, 1]) - DRAWING_HEIGHT_METRES) < 0.05
    assert character.mesh.vertices[:, 1].min() == pytest.approx(0, abs=1e-5)


def test_its_joints_are_pictured_where_they_were_drawn(drawn: Drawn) -> None:
    figure, silhouette, _ = drawn
    fitted = fit_drawing(figure, silhouette.alpha > 0.5)
    camera = fitted.picture_camera()
    places = flat_pose(figure).places
    root = camera.to_picture(fitted.fit.root_translation[None].astype(float))[0]
    np.testing.assert_allclose(root[:2], places[0], atol=0.05)


def test_labels_painted_by_hand_are_moved_with_their_part(drawn: Drawn) -> None:
    figure, silhouette, _ = drawn
    head = BODY_PARTS.index("head")
    given = np.full(silhouette.mask.shape, -1, np.int8)
    given[:200] = head
    labels = label_drawing(figure, silhouette, given)
    assert (labels.labels[:200][silhouette.mask[:200]] == head).all()
    mesh = close_drawing(figure, silhouette, labels)
    rig = load_human().rig
    of_head = [rig.index(name) for name in ("Head", "Neck")]
    upper = mesh.vertices[:, 1] < 120
    share = (mesh.weights * np.isin(mesh.bones, of_head)).sum(1)
    assert share[upper].min() > 0.5
