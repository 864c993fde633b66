"""Eyeballs behind lids, and what they look like."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.body.face.face_capture import MAX_GAZE_TRAVEL_EYE_WIDTHS
from engine.face_animation.eyes.eyeball import prepare_eyes
from engine.perception.expression.features import frontalise
from engine.perception.face.head_pose import canonical_face
from engine.persona.eyes.eye_texture import EYE_TEXTURE_SIZE_TEXELS, texture_of
from engine.persona.eyes.eyeball import CAP_RADIANS, EYE_AND_IRIS_VERTICES, eyeball, lid_rim

FACE = frontalise(canonical_face()[None].astype(np.float64))[0]


@pytest.mark.parametrize("side", EYE_AND_IRIS_VERTICES)
def test_an_eyeball_lies_behind_its_lids_and_fills_their_opening(side: str) -> None:
    contour, iris = EYE_AND_IRIS_VERTICES[side]
    ball = eyeball(FACE, side, FACE)
    lids = FACE[list(contour)]
    away = np.linalg.norm(lids[:, :2] - ball.centre[:2], axis=1)
    assert (away < ball.radius).all(), "its rim is not seen"
    np.testing.assert_array_less(lids[:, 2] - 1e-9, ball.centre[2] - np.sqrt(ball.radius**2 - away**2))
    np.testing.assert_allclose(np.linalg.norm(ball.vertices - ball.centre, axis=1), ball.radius)
    looked = ball.vertices[0] - ball.centre
    np.testing.assert_allclose((ball.centre + looked)[:2], FACE[iris[0], :2], atol=1e-9)
    corners = ball.vertices[ball.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (((corners.mean(axis=1) - ball.centre) * normals).sum(axis=1) > 0).all(), "seen from outside"


@pytest.mark.parametrize(("way", "axis"), [("In", 0), ("Out", 0), ("Up", 1), ("Down", 1)])
def test_an_iris_travels_as_far_as_peoples(way: str, axis: int) -> None:
    for side, aside in (("Left", 1), ("Right", -1)):
        ball = eyeball(FACE, side, FACE)
        sign = {"In": -aside, "Out": aside, "Up": -1, "Down": 1}[way]
        middle = ball.vertices[np.argmin(ball.vertices[:, 2])] - ball.centre
        there = ball.turned(way)[np.argmin(ball.vertices[:, 2])]
        assert sign * there[axis] == pytest.approx(MAX_GAZE_TRAVEL_EYE_WIDTHS[way] * ball.width, rel=0.25)
        assert np.linalg.norm(middle + there) == pytest.approx(ball.radius), "it turns as a solid"


def test_the_rim_of_lids_is_seen_from_within() -> None:
    for contour, _ in EYE_AND_IRIS_VERTICES.values():
        points, triangles = lid_rim(FACE[list(contour)])
        corners = points[triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        inward = points.mean(axis=0) - corners.mean(axis=1)
        assert ((inward * normals)[:, :2].sum(axis=1) > 0).mean() > 0.9


def test_an_iris_is_completed_to_its_disk() -> None:
    mesh = (FACE * 160 + (320, 300, 0)).astype(np.float32)
    rgb = np.full((640, 640, 3), (190, 150, 130), np.uint8)
    for contour, iris in EYE_AND_IRIS_VERTICES.values():
        seen = np.zeros(rgb.shape[:2], np.uint8)
        cv2.fillPoly(seen, [np.rint(mesh[list(contour), :2]).astype(np.int32)], 1)
        radius = float(np.linalg.norm(mesh[iris[1], :2] - mesh[iris[0], :2]))
        ball = np.full_like(rgb, (225, 225, 220))
        cv2.circle(ball, tuple(int(one) for one in np.rint(mesh[iris[0], :2])), round(radius), (60, 110, 70), -1)
        rgb[seen > 0] = ball[seen > 0]
    eye = prepare_eyes(rgb, mesh)[0]
    assert eye is not None
    ball_radius = 0.56 * eye.width
    texture = texture_of(eye, mesh[EYE_AND_IRIS_VERTICES["Right"][1][0], :2] - eye.corner, ball_radius, 1.0).astype(int)
    iris_radius = float(
        np.linalg.norm(mesh[EYE_AND_IRIS_VERTICES["Right"][1][1], :2] - mesh[EYE_AND_IRIS_VERTICES["Right"][1][0], :2])
    )
    reach = np.arcsin(iris_radius / ball_radius) / CAP_RADIANS * EYE_TEXTURE_SIZE_TEXELS / 2
    angle = np.linspace(0, 2 * np.pi, 32, endpoint=False)
    for share, green in ((0.7, True), (1.5, False)):
        at = np.rint(
            EYE_TEXTURE_SIZE_TEXELS / 2 + share * reach * np.column_stack([np.cos(angle), np.sin(angle)])
        ).astype(int)
        colours = texture[at[:, 1], at[:, 0]]
        assert ((colours[:, 1] - colours[:, 0] > 20) == green).all(), "all around, under the lids too"
