"""Those who are filmed stand in A-pose, on the ground, and are coloured where they should be."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from benchmarks.scan_studio.people.bearded import BEARD_METRES, with_beard
from benchmarks.scan_studio.people.scanned_people import (
    RIGGED_PEOPLE,
    SCANNED_HEIGHT_METRES,
    UNRIGGED_PEOPLE,
    read_subject,
)
from benchmarks.scan_studio.people.subject import Subject
from benchmarks.scan_studio.people.template_people import LIP_RGB, template_subject
from engine.body.body_space import load_body_space
from engine.body.face.face_points import face_points
from engine.body.makehuman import read_mask
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig, load_template


def direction(subject: Subject, start: str, end: str) -> np.ndarray:
    way = subject.joints[end] - subject.joints[start]
    return np.asarray(way / np.linalg.norm(way))


@pytest.mark.parametrize("name", [*RIGGED_PEOPLE, *UNRIGGED_PEOPLE])
def test_scanned_people_are_of_one_height_and_stand_on_the_ground(name: str, media: Callable[[str], Path]) -> None:
    subject = read_subject(name, media("scans3d"))
    assert subject.vertices[:, 1].min() == pytest.approx(0)
    assert subject.height == pytest.approx(SCANNED_HEIGHT_METRES)
    assert 0 <= subject.uv.min() <= subject.uv.max() <= 1
    assert subject.uv_triangles.shape == subject.triangles.shape


@pytest.mark.parametrize("name", RIGGED_PEOPLE)
def test_rigged_people_are_brought_to_a_pose_and_look_along_z(name: str, media: Callable[[str], Path]) -> None:
    subject = read_subject(name, media("scans3d"))
    assert subject.joints["LeftHand"][0] > 0 > subject.joints["RightHand"][0]
    for side in ("Left", "Right"):
        assert direction(subject, f"{side}Arm", f"{side}ForeArm")[1] == pytest.approx(-np.sin(np.radians(50)), abs=0.01)
        assert direction(subject, f"{side}Foot", f"{side}ToeBase")[2] > 0.3
    left, right = subject.arms
    hand = np.linalg.norm(subject.vertices - subject.joints["LeftHand"], axis=1) < 0.08
    assert left.weights[hand].mean() > 0.95
    assert right.weights[hand].max() == 0
    trunk = np.linalg.norm(subject.vertices - subject.joints["Spine1"], axis=1) < 0.12
    assert max(left.weights[trunk].max(), right.weights[trunk].max()) < 0.1


def test_joints_and_vertices_are_posed_alike(media: Callable[[str], Path]) -> None:
    """The skin about a joint is as thick in the pose as the limb is: the wrist's middle lies in the wrist."""
    subject = read_subject("soldier", media("scans3d"))
    wrist = subject.joints["LeftHand"]
    around = subject.vertices[np.linalg.norm(subject.vertices - wrist, axis=1) < 0.07]
    assert np.linalg.norm(around.mean(0) - wrist) < 0.03


@pytest.fixture(scope="module")
def template_a() -> Subject:
    return template_subject("template-a", texels=512)


def test_template_people_are_the_template_vertex_by_vertex(template_a: Subject) -> None:
    template, rig = load_template(), load_rig(HUMAN_RIG)
    assert template_a.template
    assert template_a.vertices.shape == template.vertices.shape
    assert tuple(template_a.joints) == rig.names
    heads, _ = rig.joints(template_a.vertices)
    body = [rig.index(name) for name in ("LeftLeg", "RightFoot", "Head", "LeftEye")]
    np.testing.assert_allclose(heads[body], [template_a.joints[rig.names[k]] for k in body], atol=0.012)
    for side in ("Left", "Right"):
        assert direction(template_a, f"{side}Arm", f"{side}ForeArm")[1] == pytest.approx(
            -np.sin(np.radians(50)), abs=0.02
        )


def test_a_beard_stands_off_as_far_as_is_said_below_the_nose_alone(template_a: Subject) -> None:
    bearded = with_beard(template_a, "bearded")
    height = np.linalg.norm(bearded.vertices - template_a.vertices, axis=1)
    assert height.max() == pytest.approx(BEARD_METRES, rel=1e-3)
    nose = template_a.vertices[face_points(load_template(), load_body_space())[33]]
    assert template_a.vertices[height > 0, 1].max() < nose[1]
    assert np.linalg.norm(template_a.vertices[height > 0] - nose, axis=1).max() < 0.12


def test_lips_are_red_where_the_mask_has_them_and_no_texel_is_bare(template_a: Subject) -> None:
    mask = read_mask("lips")
    rows, columns = np.nonzero(mask > 0.98)
    at = (np.stack([rows / mask.shape[0], columns / mask.shape[1]], 1) * 512).astype(int)
    shown = template_a.texture[at[:, 0], at[:, 1]].astype(float)
    np.testing.assert_allclose(np.median(shown, axis=0), LIP_RGB, atol=14)
    assert (template_a.texture.sum(-1) > 0).all()
