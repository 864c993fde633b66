"""Glasses and beards are told of by most frames, not by one."""

from __future__ import annotations

from engine.avatar.landmarks.in_frames import FrameLandmarks
from engine.avatar.landmarks.worn_on_face import worn_on_face
from engine.perception.face.face_wear import FaceWear


def _codes(*worn: FaceWear) -> list[str]:
    return [notice.code for notice in worn_on_face([FrameLandmarks({}, None, wear=one) for one in worn])]


def test_most_frames_decide() -> None:
    glasses, beard, bare = FaceWear(0.1, 0.0), FaceWear(0.0, 2.0), FaceWear(0.01, 0.2)
    assert _codes(glasses, glasses, bare) == ["glasses_as_skin"]
    assert _codes(beard, bare, beard, beard) == ["beard_as_skin"]
    assert _codes(bare, bare, glasses, beard) == []


def test_two_frames_tell_nothing() -> None:
    unseen = FaceWear()
    assert _codes(FaceWear(0.1, 2.0), FaceWear(0.1, 2.0), unseen, unseen) == []


def test_what_a_face_wears_is_kept_where_landmarks_are_scaled() -> None:
    wear = FaceWear(0.1, 0.2)
    assert FrameLandmarks({}, None, wear=wear).scaled(2.0).wear == wear
