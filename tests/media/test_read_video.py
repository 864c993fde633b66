"""Reading clips: which frames come, when, how turned."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from footage import counter, number, quadrants, write_clip

from engine.errors import InputError
from engine.media.video import probe_video, read_video


def numbers(path: Path, **options: object) -> list[int]:
    return [number(frame.rgb) for frame in read_video(path, **options)]


CONTAINERS = [
    ("mp4", "libx264", "yuv420p"),
    ("mov", "libx264", "yuv420p"),
    ("mkv", "libx264", "yuv420p"),
    ("webm", "libvpx-vp9", "yuv420p"),
    ("webm", "libvpx", "yuv420p"),
    ("avi", "mpeg4", "yuv420p"),
    ("avi", "libx264", "yuv420p"),
    ("mp4", "mpeg4", "yuv420p"),
    ("mp4", "libx265", "yuv420p10le"),
    ("mov", "prores_ks", "yuv422p10le"),
    ("mov", "mjpeg", "yuvj420p"),
    ("mkv", "ffv1", "yuv444p"),
    ("gif", "gif", "rgb8"),
    ("apng", "apng", "rgb24"),
]


@pytest.mark.parametrize(("ending", "codec", "layout"), CONTAINERS)
def test_constant_rate_gives_each_frame_once(tmp_path: Path, ending: str, codec: str, layout: str) -> None:
    pictures = [counter(k) for k in range(40)]
    path = write_clip(tmp_path / f"clip.{ending}", pictures, codec=codec, layout=layout)
    info = probe_video(path)
    assert (info.width, info.height, info.frames) == (64, 48, 40)
    assert info.fps == pytest.approx(25)
    assert info.seconds == pytest.approx(1.6, abs=0.05)
    assert not info.variable_rate and not info.has_sound and info.hdr is None
    frames = list(read_video(path))
    assert [number(frame.rgb) for frame in frames] == list(range(40))
    assert [frame.time for frame in frames] == pytest.approx(np.arange(40) / 25, abs=1e-3)


@pytest.mark.parametrize(("ending", "codec", "layout"), CONTAINERS)
def test_trim_takes_the_frames_of_its_span(tmp_path: Path, ending: str, codec: str, layout: str) -> None:
    path = write_clip(tmp_path / f"clip.{ending}", [counter(k) for k in range(80)], codec=codec, layout=layout)
    frames = list(read_video(path, trim=(2.0, 2.4)))
    assert [number(frame.rgb) for frame in frames] == list(range(50, 60))
    assert frames[0].time == pytest.approx(2.0, abs=1e-3)


@pytest.mark.parametrize(("ending", "codec", "layout"), CONTAINERS)
@pytest.mark.parametrize(
    ("options", "shown"),
    [
        ({"trim": (0.0, 0.01)}, 0),
        ({"trim": (0.125, 0.135)}, 3),
        ({"trim": (0.03, 0.055)}, 1),  # begins nearer to the next frame, and ends before its middle
        ({"trim": (0.39, 9.0)}, 9),
        ({"fps": 1.0}, 5),
        ({"fps": 1.0, "trim": (0.2, 0.24)}, 5),
    ],
)
def test_the_shortest_part_has_a_frame(
    tmp_path: Path, ending: str, codec: str, layout: str, options: dict, shown: int
) -> None:
    """The one in its middle, where no moment falls inside at which a frame would be taken."""
    path = write_clip(tmp_path / f"clip.{ending}", [counter(k) for k in range(10)], codec=codec, layout=layout)
    warned: list[str] = []
    frames = list(read_video(path, warn=lambda code, message: warned.append(code), **options))
    assert [number(frame.rgb) for frame in frames] == [shown]
    assert frames[0].time == pytest.approx(options.get("trim", (0.0,))[0], abs=0.02)
    assert not warned


def test_trim_outside(tmp_path: Path) -> None:
    path = write_clip(tmp_path / "clip.mp4", [counter(k) for k in range(10)])
    with pytest.raises(InputError) as caught:
        next(read_video(path, trim=(3.0, 4.0)))
    assert (caught.value.code, caught.value.correctable) == ("trim_outside", ("trim",))


@pytest.mark.parametrize("fps", [24000 / 1001, 30000 / 1001, 60, 120, 15, 12.5, 7])
@pytest.mark.parametrize("ending", ["mp4", "mkv"])
def test_rates(tmp_path: Path, fps: float, ending: str) -> None:
    path = write_clip(tmp_path / f"clip.{ending}", [counter(k) for k in range(50)], fps=fps)
    assert probe_video(path).fps == pytest.approx(fps, rel=1e-3)
    assert numbers(path) == list(range(50))


@pytest.mark.parametrize("codec", ["libvpx", "libvpx-vp9"])
def test_recordings_without_length_or_index(tmp_path: Path, codec: str) -> None:
    """What a browser's recorder writes: no duration, no cues, milliseconds that tremble."""
    times = np.round(np.arange(90) / 30 + np.random.default_rng(1).uniform(-0.004, 0.004, 90), 3)
    path = write_clip(
        tmp_path / "clip.webm",
        [counter(k) for k in range(90)],
        fps=1000,
        times=list(times - times[0]),
        codec=codec,
        container_options={"live": "1"},
    )
    info = probe_video(path)
    assert info.fps == pytest.approx(30, rel=0.01) and not info.variable_rate
    assert info.seconds == pytest.approx(3, abs=0.1)
    assert numbers(path) == list(range(90))
    assert numbers(path, trim=(2.0, 2.2)) == list(range(60, 66))


def test_trembling_timestamps_are_a_constant_rate(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    times = np.arange(60) / 30 + rng.uniform(-0.008, 0.008, 60)
    times[0] = 0
    path = write_clip(tmp_path / "clip.mp4", [counter(k) for k in range(60)], fps=30, times=list(times))
    info = probe_video(path)
    assert not info.variable_rate and info.fps == pytest.approx(30, rel=0.01)
    assert numbers(path) == list(range(60))


def test_variable_rate_is_resampled_by_timestamps(tmp_path: Path) -> None:
    times = [0, 0.04, 0.08, 0.11, 0.5, 0.53, 0.57, 1.0, 1.05]
    path = write_clip(tmp_path / "clip.mp4", [counter(k) for k in range(9)], times=times)
    info = probe_video(path)
    assert info.variable_rate
    frames = list(read_video(path, fps=25))
    middles = np.arange(len(frames)) / 25 + 0.02
    assert [number(frame.rgb) for frame in frames] == [int(np.searchsorted(times, t, "right")) - 1 for t in middles]
    assert [frame.time for frame in frames] == pytest.approx(np.arange(len(frames)) / 25)
    assert len(list(read_video(path))) == pytest.approx(info.frames, abs=1)


BURSTS = np.array([k for k in range(60) if k % 10 < 5]) / 30
UNEVEN = {
    "bursts": BURSTS,
    "30 then 24": np.concatenate([np.arange(0, 2, 1 / 30), np.arange(2, 4, 1 / 24)]),
    "25 then 5": np.concatenate([np.arange(20) / 25, 20 / 25 + np.arange(20) / 5]),
    "slow, then quick": np.concatenate([np.arange(12) / 10, 1.2 + np.arange(48) / 60]),
    "late": 0.7 + BURSTS,
}


@pytest.mark.parametrize("times", UNEVEN.values(), ids=UNEVEN)
@pytest.mark.parametrize("name", ["clip.mp4", "clip.mov", "clip.mkv"])
def test_each_frame_of_an_uneven_clip_comes_once_at_its_own_time(tmp_path: Path, name: str, times: np.ndarray) -> None:
    """Reordered frames (B-frames), a start later than 0 and edit lists included."""
    path = write_clip(tmp_path / name, [counter(k) for k in range(len(times))], fps=30, times=list(times))
    info = probe_video(path)
    assert info.variable_rate and info.frames == len(times)
    frames = list(read_video(path))
    assert [number(frame.rgb) for frame in frames] == list(range(len(times)))
    assert [frame.time for frame in frames] == pytest.approx(times - times[0], abs=0.0011)


def test_a_part_of_an_uneven_clip_begins_with_what_is_on_show(tmp_path: Path) -> None:
    path = write_clip(tmp_path / "clip.mp4", [counter(k) for k in range(30)], fps=30, times=list(BURSTS))
    frames = list(read_video(path, trim=(0.25, 0.4)))
    assert [number(frame.rgb) for frame in frames] == [4, 5, 6]
    assert [frame.time for frame in frames] == pytest.approx([0.25, 1 / 3, 1 / 3 + 1 / 30], abs=0.0011)
    assert [number(frame.rgb) for frame in read_video(path, trim=(0.2, 0.21))] == [4]


def test_another_rate_is_picked_not_blended(tmp_path: Path) -> None:
    path = write_clip(tmp_path / "clip.mp4", [counter(k) for k in range(30)], fps=30)
    assert numbers(path, fps=15) == list(range(1, 30, 2))
    assert numbers(path, fps=60) == [k // 2 for k in range(60)]


def test_gif_without_delays_plays_as_browsers_do(tmp_path: Path) -> None:
    from PIL import Image

    pictures = [Image.fromarray(counter(k)) for k in range(6)]
    pictures[0].save(tmp_path / "clip.gif", save_all=True, append_images=pictures[1:], duration=0)
    info = probe_video(tmp_path / "clip.gif")
    assert info.fps == pytest.approx(10)
    assert numbers(tmp_path / "clip.gif") == list(range(6))


def test_animated_webp(tmp_path: Path) -> None:
    from PIL import Image

    pictures = [Image.fromarray(counter(k)) for k in range(12)]
    path = tmp_path / "clip.webp"
    pictures[0].save(path, save_all=True, append_images=pictures[1:], duration=50, lossless=True)
    info = probe_video(path)
    assert (info.width, info.height, info.fps, info.frames, info.codec) == (64, 48, 20, 12, "webp")
    assert numbers(path) == list(range(12))
    assert numbers(path, trim=(0.2, 0.4)) == [4, 5, 6, 7]


TURNS = {
    "none": ((0, False, False), lambda image: image),
    "left": ((90, False, False), lambda image: np.rot90(image, 1)),
    "around": ((180, False, False), lambda image: np.rot90(image, 2)),
    "right": ((270, False, False), lambda image: np.rot90(image, -1)),
    "mirror": ((0, True, False), lambda image: image[:, ::-1]),
    "flip": ((0, False, True), lambda image: image[::-1]),
    "left and mirror": ((90, True, False), lambda image: np.rot90(image, 1)[:, ::-1]),
    "right and mirror": ((270, True, False), lambda image: np.rot90(image, -1)[:, ::-1]),
}


@pytest.mark.parametrize("name", TURNS)
@pytest.mark.parametrize("ending", ["mp4", "mov"])
def test_turned_and_mirrored_clips_are_shown_upright(tmp_path: Path, name: str, ending: str) -> None:
    (degrees, mirror, flip), expected = TURNS[name]
    path = write_clip(
        tmp_path / f"clip.{ending}",
        [quadrants(80, 48)] * 3,
        dress=lambda stream: stream.set_display_rotation(degrees, mirror, flip),
    )
    upright = expected(quadrants(80, 48))
    info = probe_video(path)
    assert (info.height, info.width) == upright.shape[:2]
    for frame in read_video(path):
        height, width = upright.shape[:2]
        assert frame.rgb.shape == upright.shape and frame.rgb.flags.c_contiguous
        for y, x in ((0.25, 0.25), (0.25, 0.75), (0.75, 0.25), (0.75, 0.75)):
            at = int(y * height), int(x * width)
            assert np.abs(frame.rgb[at].astype(int) - upright[at]).max() < 12


@pytest.mark.parametrize(("width", "height"), [(63, 47), (65, 48), (64, 49), (16, 16), (17, 16), (33, 35), (410, 412)])
def test_odd_sizes(tmp_path: Path, width: int, height: int) -> None:
    pictures = [np.full((height, width, 3), level, np.uint8) for level in (40, 120, 200)]
    path = write_clip(tmp_path / "clip.mkv", pictures, codec="ffv1")
    frames = list(read_video(path))
    assert [frame.rgb.shape for frame in frames] == [(height, width, 3)] * 3
    assert [frame.rgb.mean() for frame in frames] == pytest.approx([40, 120, 200], abs=1)


def test_pixels_that_are_not_square_become_square(tmp_path: Path) -> None:
    def anamorphic(stream: object) -> None:
        stream.codec_context.sample_aspect_ratio = 2  # type: ignore[attr-defined]

    path = write_clip(tmp_path / "clip.mkv", [quadrants(80, 48)] * 3, dress=anamorphic)
    info = probe_video(path)
    assert (info.width, info.height) == (160, 48)
    assert next(read_video(path)).rgb.shape == (48, 160, 3)


def test_longest_side_scales_down_and_never_up(tmp_path: Path) -> None:
    path = write_clip(
        tmp_path / "clip.mp4", [quadrants(160, 96)] * 3, dress=lambda stream: stream.set_display_rotation(90)
    )
    assert next(read_video(path, longest_side=80)).rgb.shape == (80, 48, 3)
    assert next(read_video(path, longest_side=1000)).rgb.shape == (160, 96, 3)


def test_real_clips(media) -> None:  # type: ignore[no-untyped-def]
    expected = {
        "man_grimace_d0": (512, 512, 25, 78, False),
        "man_mouth_open_d18": (480, 480, 30, 216, True),
        "man_selfie_talk_d13": (720, 1280, 30, 270, False),
        "man_talk_tps": (410, 412, 25, 169, True),
        "woman_talk_aoc": (512, 512, 25, 200, True),
    }
    for name, (width, height, fps, frames, has_sound) in expected.items():
        path = media(f"driving/{name}.mp4")
        info = probe_video(path)
        assert (info.width, info.height, info.fps, info.frames) == (width, height, fps, frames)
        assert info.has_sound == has_sound and not info.variable_rate
        assert sum(1 for _ in read_video(path)) == frames
