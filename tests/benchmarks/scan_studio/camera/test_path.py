"""The phone goes round the body twice, and round the head, over it and under it."""

from __future__ import annotations

import numpy as np

from benchmarks.scan_studio.camera.path import FOCAL_SHARE, FOCUS_BREATHING_SHARE, HandHeld
from benchmarks.scan_studio.people.subject import Subject


def _filmed(egg: Subject, head: bool) -> tuple[np.ndarray, np.ndarray, HandHeld]:
    seconds = 30.0 if head else 80.0
    hand = HandHeld(egg, (360, 640), seconds, 7, head)
    cameras = hand.cameras(np.linspace(0, seconds, 300))
    return np.array([camera.eye for camera in cameras]), np.array([camera.focal for camera in cameras]), hand


def test_the_body_is_gone_round_twice_higher_and_then_lower(egg: Subject) -> None:
    eyes, _, _ = _filmed(egg, head=False)
    round_about = np.unwrap(np.arctan2(eyes[:, 0], eyes[:, 2]))
    assert 720 < np.degrees(round_about[-1] - round_about[0]) < 760
    away = np.hypot(eyes[:, 0], eyes[:, 2])
    assert (np.abs(away - 2) < 0.25).all()
    assert eyes[:140, 1].min() > 1.3
    assert eyes[165:, 1].max() < 1.0


def test_the_head_is_seen_from_all_around_from_above_and_from_below(egg: Subject) -> None:
    eyes, _, _ = _filmed(egg, head=True)
    away = eyes - egg.head
    distance = np.linalg.norm(away, axis=1)
    assert (np.abs(distance - 0.6) < 0.08).all()
    up = np.degrees(np.arcsin(away[:, 1] / distance))
    assert up.max() > 50
    assert up.min() < -25
    round_about = np.unwrap(np.arctan2(away[:150, 0], away[:150, 2]))
    assert np.degrees(round_about[-1] - round_about[0]) > 300


def test_the_camera_looks_at_whom_it_films_and_its_focus_breathes(egg: Subject) -> None:
    for head, middle in ((False, np.array([0, 0.9, 0])), (True, egg.head)):
        _, focal, hand = _filmed(egg, head)
        for camera in hand.cameras(np.linspace(0, hand.seconds, 50)):
            x, y, depth = camera.project(middle[None])[0]
            assert 60 < x < 300, camera
            assert 60 < y < 580, camera
            assert depth > 0
        usual = FOCAL_SHARE * 640
        assert np.abs(focal / usual - 1).max() <= FOCUS_BREATHING_SHARE * 1.01
        assert np.ptp(focal) > 0.5 * FOCUS_BREATHING_SHARE * usual
