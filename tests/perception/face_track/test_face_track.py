"""A face followed through a video, and what is said where there is none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from made_clip import write_frames

from engine.media.excerpt import Excerpt
from engine.media.video import read_video
from engine.perception.face.one_face import OneFace
from engine.perception.face_track.track import NoFaceSeen, NoSuchFace, track_face
from engine.performances import video


def test_a_video_without_a_face_says_so_in_no_system_s_words(tmp_path: Path) -> None:
    path = write_frames(tmp_path / "wall.mp4", [np.full((96, 96, 3), 120, np.uint8)] * 3)
    with pytest.raises(NoFaceSeen):
        track_face(Excerpt(path))


def test_a_face_that_is_counted_on_in_vain_says_how_many_there_are() -> None:
    with pytest.raises(NoSuchFace) as error:
        track_face(Excerpt(video("happy"), trim=(0.0, 0.1)), face_index=1)
    assert error.value.faces == 1


def test_the_track_is_where_the_face_is_seen() -> None:
    """Steadied, it stays within two pixels of what is seen frame by frame."""
    trim = (0.0, 0.3)
    track = track_face(Excerpt(video("happy"), trim=trim))
    frames = [frame.rgb.copy() for frame in read_video(video("happy"), trim=trim)]
    assert len(track) == len(frames) and track.found.all() and track.even
    with OneFace() as follow:
        for mesh, frame in zip(track.meshes, frames, strict=True):
            seen = follow(frame)
            assert seen is not None and np.abs(mesh[:, :2] - seen[:, :2]).max() < 2
