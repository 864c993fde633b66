"""A face that drives another: what the project's own actors do, whose face units are known, is captured from their films."""

from pathlib import Path

import numpy as np
import pytest
from made_clip import write_frames
from template_character import template_character

from engine.avatar.face_performance import FacePerformance, acting_clip, capture_performance
from engine.errors import InputError
from engine.geometry.rigging.morph_target import MorphTrack
from engine.media.excerpt import Excerpt
from engine.motion import rotation
from engine.motion.library import built_in
from engine.performances import video
from engine.performances.catalogue import PERFORMANCE_FPS
from engine.performances.scores.score import SCORES


@pytest.fixture(scope="module")
def happy() -> FacePerformance:
    return capture_performance(Excerpt(video("happy")))


def test_a_smile_a_blink_and_a_jaw_are_captured_in_time_and_strength(happy: FacePerformance) -> None:
    acted = [SCORES["happy"](frame / PERFORMANCE_FPS).units for frame in range(len(happy.head))]
    for unit, tolerance in (("mouthSmileLeft", 0.2), ("mouthSmileRight", 0.2), ("eyeBlinkLeft", 0.2), ("jawOpen", 0.1)):
        truth = np.array([units.get(unit, 0.0) for units in acted])
        found = happy.units.of([unit])[:, 0]
        assert np.corrcoef(truth, found)[0, 1] > 0.95, unit
        assert found.max() == pytest.approx(truth.max(), abs=tolerance), unit


def test_the_head_turns_with_the_driver_s_and_neck_and_head_share_it(happy: FacePerformance) -> None:
    skeleton = template_character(texture_size=8).skeleton
    turn = rotation.from_vector([0.0, 0.5, 0.0])
    performance = FacePerformance(30.0, MorphTrack((), np.zeros((3, 0), np.float32)), np.stack([turn] * 3))
    body = built_in("idle", skeleton)
    clip = acting_clip(skeleton, performance, body)
    assert len(clip.rotations) == 3 and clip.name == "driver"
    neck, head = (
        rotation.multiply(clip.rotations[0, at], rotation.inverse(body.rotations[0, at]))
        for at in (skeleton.index("Neck"), skeleton.index("Head"))
    )
    assert rotation.angle(neck) == pytest.approx(0.2, abs=1e-5)
    assert rotation.angle(neck) + rotation.angle(head) == pytest.approx(0.5, abs=1e-5)


def test_a_body_at_another_rate_is_refused(happy: FacePerformance) -> None:
    skeleton = template_character(texture_size=8).skeleton
    with pytest.raises(ValueError, match="frames a second"):
        acting_clip(skeleton, happy, built_in("idle", skeleton, fps=24.0))


def test_a_driver_without_a_face_is_refused(tmp_path: Path) -> None:
    grey = write_frames(tmp_path / "grey.mp4", [np.full((96, 96, 3), 120, np.uint8)] * 5)
    with pytest.raises(InputError) as refused:
        capture_performance(Excerpt(grey))
    assert refused.value.code == "no_face_in_driver"
