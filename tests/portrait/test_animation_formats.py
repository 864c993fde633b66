"""What users may ask of the animation: its size, rate, format, sound, loop, and its colours kept."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path

import av
import cv2
import numpy as np
import pytest
from made_clip import OPENS, read_frames, unpacked
from numpy.typing import NDArray

from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.media.image import read_image, write_image
from engine.media.video import read_video


def test_size_and_rate_are_the_asked_ones(animation, woman, driver) -> None:
    made = animation(woman, driver, trim=OPENS, neutral_frame=0, size=(200, 160), fps=10)
    assert made.frames[0].shape == (160, 160, 3)
    assert len(made.frames) == 8
    report = json.loads((made.out / "report.json").read_text())
    assert report["inputs"]["fps"] == 10


def test_the_neutral_frame_is_counted_as_the_result_s_frames_are(animation, woman, driver) -> None:
    """Eight frames are left of the driver's 24 in this part: the last of them shows the picture."""
    made = animation(woman, driver, trim=OPENS, fps=10, neutral_frame=7)
    picture = read_image(woman).rgb.astype(int)
    apart = [float(np.abs(frame - picture).mean()) for frame in made.frames]
    assert len(apart) == 8 and int(np.argmin(apart)) == 7
    report = json.loads((made.out / "report.json").read_text())["inputs"]
    landmarks = json.loads((made.out / "landmarks.json").read_text())
    assert [(told["neutral_frame"], told["frames"]) for told in (report, landmarks)] == [(7, 8)] * 2


@pytest.mark.parametrize("format", ["webm", "webp", "png"])
def test_formats(animation, opens, woman, driver, format: str) -> None:
    made = animation(woman, driver, trim=OPENS, neutral_frame=0, format=format)
    path = made.out / ("animation.zip" if format == "png" else f"animation.{format}")
    if format == "png":
        frames = unpacked(path)
    elif format == "webp":
        from PIL import Image, ImageSequence

        with Image.open(path) as image:
            frames = [np.asarray(f.convert("RGB")) for f in ImageSequence.Iterator(image)]
    else:
        frames = read_frames(path)
    assert len(frames) == 24
    for index in (0, 12, 23):
        assert np.abs(frames[index].astype(int) - opens.frames[index]).mean() < 5


def test_a_loop_repeats_without_a_jump_when_it_is_decoded(animation, woman, driver) -> None:
    frames = np.array(animation(woman, driver, trim=OPENS, neutral_frame=0, loop=True).frames, np.int16)
    steps = np.abs(frames - np.roll(frames, 1, axis=0)).mean(axis=(1, 2, 3))
    assert steps[0] < steps[1:].max() and steps[0] < 0.7


def test_black_and_white_in_no_colour_out(animation, small, driver, tmp_path: Path) -> None:
    grey = cv2.cvtColor(read_image(small("photo_bw_einstein.jpg", 280)).rgb, cv2.COLOR_RGB2GRAY)
    write_image(tmp_path / "grey.png", np.repeat(grey[..., None], 3, axis=2))
    made = animation(tmp_path / "grey.png", driver, trim=OPENS, neutral_frame=0, format="png")
    frames = np.array(unpacked(made.out / "animation.zip"), int)
    assert np.ptp(frames, axis=3).max() <= 2
    assert np.abs(frames - frames[0]).max() > 50  # and yet it moves


def test_a_cut_out_stays_one(animation, woman, driver, tmp_path: Path) -> None:
    rgb = read_image(woman).rgb
    alpha = np.zeros(rgb.shape[:2], np.float32)
    cv2.ellipse(alpha, (150, 190), (110, 150), 0, 0, 360, 1.0, -1, cv2.LINE_AA)
    write_image(tmp_path / "cut.png", rgb, alpha)
    made = animation(tmp_path / "cut.png", driver, trim=OPENS, neutral_frame=0, format="png")
    frames = unpacked(made.out / "animation.zip")
    assert frames[0].shape == (300, 300, 4)
    assert np.abs(frames[0][..., 3] / 255 - alpha).mean() < 0.01
    assert frames[-1][5, 5, 3] == 0 and frames[-1][150, 150, 3] == 255


def test_the_driver_s_sound_is_kept_when_asked(animation, woman, driver) -> None:
    made = animation(woman, driver, trim=OPENS, neutral_frame=0, sound=True)
    with av.open(str(made.out / "animation.mp4")) as container:
        assert len(container.streams.audio) == 1
        length = sum(f.samples for f in container.decode(audio=0)) / container.streams.audio[0].rate
    assert length == pytest.approx(0.8, abs=0.1)


def test_a_driver_without_sound_is_said_so(animation, woman, media) -> None:
    made = animation(woman, media("driving/man_grimace_d0.mp4"), trim=(0.0, 0.3), sound=True)
    assert "driver_has_no_sound" in {n.code for n in made.run.notices}


@pytest.mark.parametrize("format", ["webp", "gif", "png"])
def test_a_format_that_holds_no_sound_is_said_so(animation, woman, driver, format: str) -> None:
    made = animation(woman, driver, trim=(1.9, 2.1), neutral_frame=0, sound=True, format=format)
    assert [notice.code for notice in made.run.notices] == ["no_sound"]
    report = json.loads((made.out / "report.json").read_text())
    assert [warning["code"] for warning in report["warnings"]] == ["no_sound"]


def test_a_loop_has_no_jump(animation, woman, driver) -> None:
    """From the last frame to the first is no larger a step than any within."""
    straight = animation(woman, driver, trim=OPENS, neutral_frame=0, format="png")
    made = animation(woman, driver, trim=OPENS, neutral_frame=0, format="png", loop=True)

    def step(a: NDArray, b: NDArray) -> float:
        return float(np.abs(a.astype(int) - b).mean())

    ends = [step(f[-1], f[0]) for f in (unpacked(m.out / "animation.zip") for m in (straight, made))]
    frames = unpacked(made.out / "animation.zip")
    within = [step(a, b) for a, b in pairwise(frames)]
    assert ends[1] <= 1.2 * max(within)
    assert ends[1] < 0.5 * ends[0]


def test_a_driver_that_stalls_gives_one_frame_for_each_of_its_own(animation, woman, driver, tmp_path: Path) -> None:
    """Five frames at 30 a second, then a sixth of a second without any: each is shown when the driver shows it."""
    source = [frame.rgb for frame in read_video(driver, trim=OPENS)]
    times = [k / 30 for k in range(len(source)) if k % 10 < 5]
    with VideoWriter(
        VideoTarget(tmp_path / "bursts.mp4", source[0].shape[1::-1], 30, times=[*times, times[-1] + 1 / 30])
    ) as writer:
        for k, frame in enumerate(source):
            if k % 10 < 5:
                writer.write(frame)
    made = animation(woman, tmp_path / "bursts.mp4")
    with av.open(str(made.out / "animation.mp4")) as container:
        assert [frame.time for frame in container.decode(video=0)] == pytest.approx(times, abs=0.0011)
    assert json.loads((made.out / "report.json").read_text())["inputs"]["frames"] == len(times)
    at_ten = animation(woman, tmp_path / "bursts.mp4", fps=10)
    with av.open(str(at_ten.out / "animation.mp4")) as container:
        shown = [frame.time for frame in container.decode(video=0)]
    assert shown == pytest.approx(np.arange(len(shown)) / 10) and len(shown) == round(10 * (times[-1] + 1 / 30))
