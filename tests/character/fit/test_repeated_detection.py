"""The same person seen twice: looks that agree are one, and of those that do not the fit chooses."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from engine.body.fitting.observation import DIRECTED_LIMBS
from engine.character.figure.figure import Choice, Figure, find_figure
from engine.character.figure.silhouette import Silhouette, cut_out
from engine.character.fit.repeated_detection import (
    COMPARED_LANDMARKS,
    MAX_JOINT_DISAGREEMENT_SHARE,
    MIRRORED_LANDMARKS,
    detect_again,
)
from engine.character.fit.template_fit import FOREARM_DEPTH_BIAS, fit_best, forearms_back
from engine.character.sample import sample_picture
from engine.media.image import write_image
from engine.media.limits import Limits
from engine.perception.pose.body import BODY_LANDMARKS

Seen = tuple[Figure, Silhouette]


@pytest.fixture(scope="module")
def seen(tmp_path_factory: pytest.TempPathFactory) -> Seen:
    path: Path = tmp_path_factory.mktemp("seen") / "photo.png"
    write_image(path, sample_picture())
    figure = find_figure(path, Choice(), False, Limits(), lambda code, message: None)
    return figure, cut_out(figure, None, (), Limits(), None, None, lambda code, message: None)


def height(silhouette: Silhouette) -> float:
    return float(np.ptp(np.flatnonzero((silhouette.alpha > 0.5).any(1))))


def test_a_mirror_seen_in_a_mirror_is_what_it_was() -> None:
    np.testing.assert_array_equal(MIRRORED_LANDMARKS[MIRRORED_LANDMARKS], np.arange(len(BODY_LANDMARKS)))
    assert BODY_LANDMARKS[MIRRORED_LANDMARKS[BODY_LANDMARKS.index("LeftKnee")]] == "RightKnee"


def test_one_who_is_seen_well_is_seen_alike_without_surroundings(seen: Seen) -> None:
    figure, silhouette = seen
    looks = detect_again(figure, silhouette.alpha)
    assert len(looks) == 1
    away = np.linalg.norm(looks[0].points - figure.points, axis=1)[list(COMPARED_LANDMARKS)]
    assert (away < MAX_JOINT_DISAGREEMENT_SHARE * height(silhouette)).all()


def test_one_who_was_seen_wrongly_is_fitted_as_they_are_seen_cut_out(seen: Seen) -> None:
    """The first look has the arms at the hips' height and everything to the side."""
    figure, silhouette = seen
    wrong = figure.points + np.array([0.3 * height(silhouette), 0], np.float32)
    looks = detect_again(replace(figure, points=wrong), silhouette.alpha)
    assert len(looks) > 1
    fitted = fit_best(looks, silhouette.alpha > 0.5)
    hips = fitted.camera.project(fitted.fit.root_translation[None])[0, 0]
    true = (figure.point("LeftHip")[0] + figure.point("RightHip")[0]) / 2
    assert abs(hips - true) < 0.05 * height(silhouette)


def test_joints_placed_by_hand_stay_in_every_look(seen: Seen) -> None:
    figure, silhouette = seen
    at = BODY_LANDMARKS.index("LeftWrist")
    points, confidence = figure.points.copy(), figure.confidence.copy()
    points[at] += 0.2 * height(silhouette)
    confidence[at] = 1
    for look in detect_again(
        replace(figure, points=points, confidence=confidence, placed=("LeftWrist",)), silhouette.alpha
    ):
        np.testing.assert_allclose(look.points[at], points[at])


def test_forearms_hang_back_and_those_that_point_at_the_viewer_stay() -> None:
    down = np.tile([0.0, -1.0, 0.0], (len(DIRECTED_LIMBS), 1))
    near = down.copy()
    near[[1, 3]] = np.array([0, -1, FOREARM_DEPTH_BIAS]) / np.hypot(1, FOREARM_DEPTH_BIAS)
    found = forearms_back(near)
    np.testing.assert_array_equal(found[[0, 2, 4, 5, 6, 7]], down[[0, 2, 4, 5, 6, 7]])
    assert (np.abs(found[[1, 3], 2]) < 0.02).all()
    near[[1, 3]] = [0, 0, 1]
    np.testing.assert_allclose(forearms_back(near)[[1, 3]], near[[1, 3]])
