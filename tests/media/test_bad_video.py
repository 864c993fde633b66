"""Videos that cannot be used, or only in part: each has its code, and refusals come before any frame is decoded."""

from __future__ import annotations

import struct
import wave
from collections.abc import Callable
from pathlib import Path

import av
import numpy as np
import pytest
from footage import counter, number, quadrants, write_clip
from PIL import Image

from engine.errors import InputError
from engine.media.limits import Limits
from engine.media.video import probe_video, read_video


def refusal(path: Path, limits: Limits | None = None) -> str:
    """The code with which a file is refused, the same by both doors."""
    with pytest.raises(InputError) as by_probe:
        probe_video(path, limits)
    with pytest.raises(InputError) as by_reading:
        list(read_video(path, limits=limits))
    assert by_probe.value.code == by_reading.value.code
    assert str(path) not in by_probe.value.detail
    return by_probe.value.code


def count_up(path: Path, count: int = 100, **options: object) -> Path:
    return write_clip(path, [counter(k) for k in range(count)], **options)


def test_empty_file(tmp_path: Path) -> None:
    (tmp_path / "clip.mp4").touch()
    assert refusal(tmp_path / "clip.mp4") == "file_empty"


@pytest.mark.parametrize(
    "content",
    [
        b"just some text, nothing more",
        b"<svg xmlns='http://www.w3.org/2000/svg'/>",
        bytes(2000),
    ],
)
def test_files_that_are_no_video(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "clip.mp4").write_bytes(content)
    assert refusal(tmp_path / "clip.mp4") == "not_a_video"


@pytest.mark.parametrize("playlist", ["#EXTM3U\n#EXTINF:1,\n{uri}\n", "ffconcat version 1.0\nfile {path}\n"])
def test_a_playlist_does_not_open_other_files(tmp_path: Path, playlist: str) -> None:
    """The file that it names is a video that could be read, and is not."""
    other = count_up(tmp_path / "other.mp4", 5)
    (tmp_path / "clip.mp4").write_text(playlist.format(path=other, uri=other.as_uri()))
    assert refusal(tmp_path / "clip.mp4") == "not_a_video"


@pytest.mark.parametrize("ending", ["jpg", "png", "webp"])
def test_a_still_named_as_a_video(tmp_path: Path, ending: str) -> None:
    Image.fromarray(quadrants(64, 48)).save(tmp_path / f"still.{ending}")
    (tmp_path / f"still.{ending}").rename(tmp_path / "clip.mp4")
    assert refusal(tmp_path / "clip.mp4") == "not_a_video"


def test_a_video_with_a_wrong_name_is_read(tmp_path: Path) -> None:
    count_up(tmp_path / "clip.mkv", 10).rename(tmp_path / "clip.jpg")
    assert [number(frame.rgb) for frame in read_video(tmp_path / "clip.jpg")] == list(range(10))


def write_sound(path: Path, codec: str, cover: bool = False) -> None:
    with av.open(str(path), "w") as container:
        stream = container.add_stream(codec, rate=48000)
        picture = None
        if cover:
            picture = container.add_stream("mjpeg")
            picture.width, picture.height, picture.pix_fmt = 64, 48, "yuvj420p"
            picture.disposition = av.stream.Disposition.attached_pic
        for _ in range(20):
            samples = np.zeros((2, 1024), np.float32)
            frame = av.AudioFrame.from_ndarray(samples, "fltp", "stereo")
            frame.sample_rate = 48000
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
        if picture is not None:
            container.mux(picture.encode(av.VideoFrame.from_ndarray(quadrants(64, 48), "rgb24")))
            container.mux(picture.encode(None))


@pytest.mark.parametrize(
    ("name", "codec", "cover"),
    [("a.mp4", "aac", False), ("a.m4a", "aac", False), ("a.mkv", "aac", False), ("a.mp4", "aac", True)],
)
def test_sound_alone(tmp_path: Path, name: str, codec: str, cover: bool) -> None:
    write_sound(tmp_path / name, codec, cover)
    assert refusal(tmp_path / name) == "no_video_stream"


def test_a_wave_file(tmp_path: Path) -> None:
    with wave.open(str(tmp_path / "a.wav"), "wb") as file:
        file.setparams((1, 2, 8000, 0, "NONE", ""))
        file.writeframes(bytes(8000))
    assert refusal(tmp_path / "a.wav") == "no_video_stream"


@pytest.mark.parametrize("ending", ["mp4", "mkv", "gif"])
def test_one_frame(tmp_path: Path, ending: str) -> None:
    codec, layout = ("gif", "rgb8") if ending == "gif" else ("libx264", "yuv420p")
    count_up(tmp_path / f"clip.{ending}", 1, codec=codec, layout=layout)
    assert refusal(tmp_path / f"clip.{ending}") == "video_too_short"


def spoil_pictures(path: Path) -> Path:
    """Overwrite all coded pictures, so that nothing could be decoded if it were tried."""
    content = bytearray(path.read_bytes())
    with av.open(str(path)) as container:
        spans = [(packet.pos, packet.size) for packet in container.demux(video=0) if packet.size]
    for start, size in spans:
        content[start : start + size] = bytes(size)
    path.write_bytes(content)
    return path


def test_ten_minutes_are_refused_before_decoding(tmp_path: Path) -> None:
    path = count_up(tmp_path / "clip.mp4", 601, fps=1)
    assert probe_video(path, Limits(video_seconds=700)).seconds == pytest.approx(601)
    assert refusal(spoil_pictures(path)) == "video_too_long"


def test_a_length_that_the_header_hides_is_found_in_the_packets(tmp_path: Path) -> None:
    path = count_up(tmp_path / "clip.mkv", 601, fps=1)
    content = bytearray(path.read_bytes())
    at = content.index(b"\x44\x89\x88")  # the element Duration (8 bytes): 600 seconds become one
    content[at + 3 : at + 11] = struct.pack(">d", 1000.0)
    path.write_bytes(content)
    assert refusal(path) == "video_too_long"


def flat(width: int, height: int) -> np.ndarray:
    return np.full((height, width, 3), 90, np.uint8)


def test_4k_at_60_is_refused_and_at_30_is_not(tmp_path: Path) -> None:
    fast = {"preset": "ultrafast"}
    at_60 = write_clip(tmp_path / "60.mp4", [flat(3840, 2160)] * 3, fps=60, options=fast)
    assert refusal(spoil_pictures(at_60)) == "video_pixel_rate"
    at_30 = write_clip(tmp_path / "30.mp4", [flat(3840, 2160)] * 3, fps=30, options=fast)
    assert (probe_video(at_30).width, probe_video(at_30).height) == (3840, 2160)


def test_other_limits(tmp_path: Path) -> None:
    path = spoil_pictures(count_up(tmp_path / "clip.mp4", 50))
    assert refusal(path, Limits(video_megapixels=0.003)) == "video_too_large"
    assert refusal(path, Limits(video_frames=40)) == "video_too_many_frames"
    assert refusal(path, Limits(video_bytes=1000)) == "file_too_large"


@pytest.mark.parametrize(
    ("size", "code"), [((1, 1), "video_too_small"), ((400, 15), "video_too_small"), ((16_385, 16), "video_too_large")]
)
def test_sides_in_which_nobody_is_seen_and_those_that_detectors_cannot_take(
    tmp_path: Path, size: tuple[int, int], code: str
) -> None:
    assert refusal(write_clip(tmp_path / "clip.mkv", [flat(*size)] * 2, codec="ffv1")) == code


def test_absurd_dimensions_in_the_header(tmp_path: Path) -> None:
    path = count_up(tmp_path / "clip.mp4", 10)
    content = bytearray(path.read_bytes())
    entry = content.index(b"avc1", content.index(b"stsd"))
    content[entry + 28 : entry + 32] = (60000).to_bytes(2, "big") * 2
    track = content.index(b"tkhd")
    content[track + 80 : track + 88] = (60000 << 16).to_bytes(4, "big") * 2
    path.write_bytes(content)
    # Either the claim is believed and refused, or the stream's own size counts: never 60000 x 60000 pixels.
    try:
        assert probe_video(path).width == 64
    except InputError as error:
        assert error.code == "video_too_large"


def test_an_unknown_codec(tmp_path: Path) -> None:
    path = count_up(tmp_path / "clip.mp4", 10)
    path.write_bytes(path.read_bytes().replace(b"avc1", b"zzz9").replace(b"avcC", b"zzzC"))
    assert refusal(path) == "video_unreadable"


@pytest.mark.parametrize("scale", [0, 1])
def test_a_clock_without_ticks(tmp_path: Path, scale: int) -> None:
    path = count_up(tmp_path / "clip.mp4", 20)
    content = bytearray(path.read_bytes())
    at = content.index(b"mdhd") + 4 + 4 + 8
    content[at : at + 4] = scale.to_bytes(4, "big")
    path.write_bytes(content)
    try:
        assert sum(1 for _ in read_video(path, limits=Limits(video_seconds=1e9))) >= 1
    except InputError as error:
        assert error.code in ("video_unreadable", "video_too_long", "video_too_short")


CUT = {
    "mp4": ("libx264", "yuv420p", {"movflags": "+faststart"}),
    "mkv": ("libx264", "yuv420p", {}),
    "webm": ("libvpx-vp9", "yuv420p", {}),
    "gif": ("gif", "rgb8", {}),
    "avi": ("mpeg4", "yuv420p", {}),
}


@pytest.mark.parametrize("ending", CUT)
def test_a_broken_tail_is_left_out_with_a_warning(tmp_path: Path, ending: str) -> None:
    codec, layout, container_options = CUT[ending]
    rng = np.random.default_rng(0)
    noise = rng.integers(0, 40, (48, 64, 3))
    pictures = [np.clip(counter(k).astype(int) - noise, 0, 255).astype(np.uint8) for k in range(100)]
    path = write_clip(
        tmp_path / f"clip.{ending}", pictures, codec=codec, layout=layout, container_options=container_options
    )
    content = path.read_bytes()
    path.write_bytes(content[: int(len(content) * 0.6)])
    warnings: list[str] = []
    frames = list(read_video(path, warn=lambda code, message: warnings.append(code)))
    assert 20 < len(frames) < 95
    assert [number(frame.rgb) for frame in frames[:20]] == list(range(20))
    assert warnings == ["video_truncated"]


def test_a_cut_animated_webp(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    pictures = [Image.fromarray(rng.integers(0, 255, (48, 64, 3)).astype(np.uint8)) for _ in range(20)]
    path = tmp_path / "clip.webp"
    pictures[0].save(path, save_all=True, append_images=pictures[1:], duration=50)
    content = path.read_bytes()
    path.write_bytes(content[: int(len(content) * 0.6)])
    warnings: list[str] = []
    try:
        assert 2 <= len(list(read_video(path, warn=lambda code, message: warnings.append(code)))) < 20
        assert warnings == ["video_truncated"]
    except InputError as error:
        assert error.code == "video_unreadable"


def test_a_file_cut_before_its_index(tmp_path: Path) -> None:
    path = count_up(tmp_path / "clip.mp4")
    content = path.read_bytes()
    path.write_bytes(content[: int(len(content) * 0.6)])
    assert refusal(path) == "video_unreadable"


def test_damage_in_the_middle_holds_the_frame_before(tmp_path: Path) -> None:
    path = count_up(tmp_path / "clip.mov", 60, codec="png", layout="rgb24")
    content = bytearray(path.read_bytes())
    with av.open(str(path)) as container:
        spans = [(packet.pos, packet.size) for packet in container.demux(video=0) if packet.size]
    start, size = spans[30]
    content[start + 20 : start + size - 10] = bytes(size - 30)
    path.write_bytes(content)
    warnings: list[str] = []
    numbers = [number(frame.rgb) for frame in read_video(path, warn=lambda code, message: warnings.append(code))]
    assert numbers == [*range(30), 29, *range(31, 60)]
    assert warnings == ["video_damaged"]


def test_a_clip_that_starts_late_or_early(tmp_path: Path) -> None:
    for name, start in (("late.mp4", 3.0), ("late.mkv", 3.0), ("early.mp4", -0.2)):
        times = start + np.arange(20) / 25
        path = write_clip(tmp_path / name, [counter(k) for k in range(20)], times=list(times))
        frames = list(read_video(path))
        shown = [k for k in range(20) if times[k] >= 0] if name == "early.mp4" else list(range(20))
        assert [number(frame.rgb) for frame in frames][-len(shown) :] == shown
        assert frames[0].time == pytest.approx(0, abs=0.02)


def make_webp(path: Path) -> None:
    pictures = [Image.fromarray(counter(k)) for k in range(10)]
    pictures[0].save(path, save_all=True, append_images=pictures[1:], duration=40)


MAKERS: dict[str, Callable[[Path], object]] = {
    "mp4": lambda path: count_up(path, 10),
    "mkv": lambda path: count_up(path, 10),
    "webm": lambda path: count_up(path, 10, codec="libvpx-vp9"),
    "gif": lambda path: count_up(path, 10, codec="gif", layout="rgb8"),
    "avi": lambda path: count_up(path, 10, codec="mpeg4"),
    "apng": lambda path: count_up(path, 10, codec="apng", layout="rgb24"),
    "webp": make_webp,
}


@pytest.mark.parametrize("ending", MAKERS)
def test_random_damage_never_ends_in_anything_but_an_input_error(tmp_path: Path, ending: str) -> None:
    original = tmp_path / f"clip.{ending}"
    MAKERS[ending](original)
    content = original.read_bytes()
    rng = np.random.default_rng(7)
    path = tmp_path / f"spoilt.{ending}"
    for trial in range(40):
        spoilt = bytearray(content)
        for at in rng.integers(0, len(spoilt) if trial % 2 else min(len(spoilt), 600), 1 + trial % 12):
            spoilt[at] = rng.integers(256)
        path.write_bytes(spoilt)
        try:
            for frame in read_video(path):
                assert frame.rgb.dtype == np.uint8 and frame.rgb.ndim == 3
        except InputError as error:
            assert error.code and error.detail
