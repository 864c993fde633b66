"""A body's clip that goes half around the person: an avatar is made of what was seen, and the side that was not is named."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from benchmarks.scan_studio.sample_clips import sample_truth
from engine.avatar import KIND, AvatarOptions
from engine.avatar.sample import SAMPLE_FRAMES, sample_clip
from engine.errors import Canceled
from engine.media.video import read_video
from engine.run import Run
from engine.store import StageStore

UNSEEN_DEGREES = (15, 170)
"""Of a circle around the person, from before them towards their left: from where no frame is used."""


@pytest.mark.timeout(900)
def test_half_an_orbit_is_used_and_the_side_that_nobody_saw_is_named(tmp_path: Path) -> None:
    truth = sample_truth()
    count = sum(1 for _ in read_video(sample_clip("body")))
    eyes = np.array([truth.person_camera("body", frame).eye for frame in range(count)])
    around = np.degrees(np.arctan2(eyes[:, 0], eyes[:, 2]))
    unseen = np.flatnonzero((around > UNSEEN_DEGREES[0]) & (around < UNSEEN_DEGREES[1]))
    options = AvatarOptions(
        height_m=1.8,
        body_frames=SAMPLE_FRAMES["body"],
        body_frames_left_out=tuple(unseen.tolist()),
        texture_size=1024,
    )
    begun: list[str] = []
    with (
        Run(
            StageStore(tmp_path / "stages"),
            canceled=lambda: "find_landmarks" in begun,
            on_stage=lambda name, turn: begun.append(name),
        ) as run,
        suppress(Canceled),
    ):
        KIND.work({"body": sample_clip("body")}, options, tmp_path, run)
    assert begun[-1] == "find_landmarks"
    (told,) = [notice.message for notice in run.notices if notice.code == "side_unseen"]
    assert "left side" in told
