"""What perception sees of a body and of a face, on the template."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body import Template
from engine.body.body_space import BodySpace, load_body_space
from engine.body.face.face_points import face_points
from engine.body.landmarks import landmark_model
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig
from engine.perception.pose.body import BODY_LANDMARKS

MIRRORED = (*range(16, -1, -1), *range(26, 16, -1), *(27, 28, 29, 30), *range(35, 30, -1))
"""The point on the other side for each of the first 36 of the face: jaw, brows and nose."""


@pytest.fixture(scope="module")
def space() -> BodySpace:
    return load_body_space()


def test_all_33_landmarks_of_the_body_are_there(template: Template, space: BodySpace) -> None:
    model = landmark_model(template, space, load_rig(HUMAN_RIG))
    assert sorted(model.names) == sorted(BODY_LANDMARKS)
    place = dict(zip(model.names, model.mean, strict=True))
    for name in model.names:
        if name.startswith("Left"):
            other = place["Right" + name.removeprefix("Left")]
            np.testing.assert_allclose(place[name] * [-1, 1, 1], other, atol=0.008, err_msg=name)
    across = ["RightEar", "RightEyeOuter", "RightEyeInner", "Nose", "LeftEyeInner", "LeftEyeOuter", "LeftEar"]
    assert (np.diff([place[name][0] for name in across]) > 0).all()
    assert place["MouthLeft"][0] > 0 > place["MouthRight"][0]
    assert place["MouthLeft"][1] < place["Nose"][1]


def test_face_points_follow_their_scheme(template: Template, space: BodySpace) -> None:
    points = face_points(template, space)
    assert len(points) == 68
    assert set(points) <= set(template.vertices_of("body"))
    at = space.mean[points]
    np.testing.assert_allclose(at[:36] * [-1, 1, 1], at[list(MIRRORED)], atol=0.02)
    chin, brows, nose, mouth = at[8], at[17:27], at[30], at[48:]
    assert chin[1] < mouth[:, 1].min() < mouth[:, 1].max() < nose[1] < brows[:, 1].min()
    assert nose[2] == at[:, 2].max()
    for side, corners in (("right", at[36:42]), ("left", at[42:48])):
        eye = space.mean[template.vertices_of(f"{side}_eye")].mean(0)
        assert np.linalg.norm(corners.mean(0)[:2] - eye[:2]) < 0.01
