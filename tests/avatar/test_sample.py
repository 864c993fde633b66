"""The clips that ship with the program show one person, whole in one and near in the other, as their script filmed them."""

from __future__ import annotations

import pytest
from made_clip import read_frames

from benchmarks.scan_studio.sample_clips import SAMPLE_ORDER, sample_truth
from engine.avatar.capture.people_shown import look_for_people, refuse_wrong_clips
from engine.avatar.sample import SAMPLE_FRAMES, sample_clip
from engine.media.video import probe_video, read_video


def test_both_have_the_frames_and_the_size_of_their_order() -> None:
    for name, count in SAMPLE_FRAMES.items():
        assert len(read_frames(sample_clip(name))) == count
        info = probe_video(sample_clip(name))
        assert (info.width, info.height) == SAMPLE_ORDER.size


def test_they_are_not_swapped_and_each_camera_of_the_truth_looks_at_the_person() -> None:
    shown = {}
    for name in ("body", "head"):
        frames = [frame.rgb for frame in read_video(sample_clip(name))]
        shown[name] = look_for_people(frames[::6])
    refuse_wrong_clips(shown["body"], shown["head"])
    truth = sample_truth()
    assert truth.subject.height == pytest.approx(1.8, abs=0.01)
    for name, count in SAMPLE_FRAMES.items():
        for frame in range(count):
            x, y, depth = truth.person_camera(name, frame).project(truth.subject.head)
            assert depth > 0.3 and 0 < x < SAMPLE_ORDER.size[0] and 0 < y < SAMPLE_ORDER.size[1]
