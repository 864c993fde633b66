"""Videos written: what a player finds in them, and that they appear whole or not at all."""

from __future__ import annotations

import io
import subprocess
import sys
import zipfile
from fractions import Fraction
from pathlib import Path

import av
import cv2
import numpy as np
import pytest
from PIL import Image

from engine.export.videos import animated_gif
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.media.video import probe_video, read_video

COLOURS = [(0, 0, 0), (255, 255, 255), (224, 172, 138), (141, 85, 54), (200, 40, 40), (40, 160, 60), (40, 60, 200)]


def chart(shift: int = 0) -> np.ndarray:
    """Bars of 32 pixels of `COLOURS`, moved on by `shift` bars; uint8 (64, 224, 3)."""
    bars = np.array(COLOURS[shift % 7 :] + COLOURS[: shift % 7], np.uint8)
    return np.broadcast_to(np.repeat(bars, 32, 0)[None], (64, 224, 3)).copy()


def bars_of(rgb: np.ndarray) -> np.ndarray:
    return rgb[16:48].reshape(32, 7, 32, 3)[:, :, 8:24].mean(axis=(0, 2))


def write(path: Path, count: int = 20, fps: float = 25, **options: object) -> Path:
    with VideoWriter(VideoTarget(path, (224, 64), fps, **options)) as writer:
        for k in range(count):
            writer.write(chart(k))
    return path


@pytest.mark.parametrize(("format", "tolerance"), [("mp4", 3), ("webm", 5), ("webp", 6)])
def test_colours_and_order_come_back(tmp_path: Path, format: str, tolerance: float) -> None:
    path = write(tmp_path / f"out.{format}", format=format)
    info = probe_video(path)
    assert (info.width, info.height, info.fps, info.frames) == (224, 64, 25, 20)
    frames = list(read_video(path))
    assert len(frames) == 20
    for k, frame in enumerate(frames):
        assert np.abs(bars_of(frame.rgb) - bars_of(chart(k))).max() <= tolerance


@pytest.mark.parametrize("fps", [30000 / 1001, 24, 12.5, 60])
def test_rates_are_exact(tmp_path: Path, fps: float) -> None:
    with av.open(str(write(tmp_path / "out.mp4", 30, fps))) as container:
        assert container.streams.video[0].average_rate == Fraction(fps).limit_denominator(1001)


def test_mp4_is_what_players_want(tmp_path: Path) -> None:
    path = write(tmp_path / "out.mp4")
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        assert stream.codec_context.name == "h264" and stream.profile == "High"
        frame = next(container.decode(stream))
        assert frame.format.name == "yuv420p"
        assert (frame.colorspace, frame.color_primaries, frame.color_trc, frame.color_range) == (1, 1, 1, 1)
    content = path.read_bytes()
    assert content.index(b"moov") < content.index(b"mdat"), "starts before it is loaded"
    assert b"colr" in content
    assert not list(tmp_path.glob(".*")), "no draft is left"


def test_other_decoders_see_the_same_colours(tmp_path: Path) -> None:
    """swscale, independent of our own conversion, takes the matrix from the tags."""
    path = write(tmp_path / "out.mp4", 3)
    with av.open(str(path)) as container:
        frame = next(container.decode(video=0))
    flags = av.video.reformatter.Interpolation
    rgb = frame.reformat(
        format="rgb24", dst_color_range=2, interpolation=flags.ACCURATE_RND | flags.FULL_CHR_H_INT | flags.BICUBIC
    ).to_ndarray()
    assert np.abs(bars_of(rgb) - bars_of(chart(0))).max() <= 3


def ramp() -> np.ndarray:
    return np.broadcast_to(np.linspace(0, 1, 224, dtype=np.float32)[None], (64, 224)).copy()


def test_webp_keeps_alpha_and_loops(tmp_path: Path) -> None:
    for loop in (False, True):
        with VideoWriter(VideoTarget(tmp_path / "out.webp", (224, 64), 20, "webp", loop=loop)) as writer:
            for k in range(5):
                writer.write(chart(k), ramp())
        with Image.open(tmp_path / "out.webp") as image:
            assert image.n_frames == 5 and image.info["loop"] == (0 if loop else 1)
            image.seek(2)
            pixels = np.asarray(image.convert("RGBA"))
        assert np.abs(pixels[..., 3] / 255 - ramp()).max() < 0.02
        assert np.abs(pixels[32, 208, :3].astype(int) - chart(2)[32, 208]).max() < 12


def test_any_frame_of_a_webp_stands_by_itself(tmp_path: Path) -> None:
    """Whole pictures with times that keep to the rate, read here from the bytes as the container's specification has
    them: what lies in one frame alone is that frame."""
    path = write(tmp_path / "out.webp", 30, 24, format="webp", synthetic=False)
    data = path.read_bytes()
    assert (data[:4], data[8:12], int.from_bytes(data[4:8], "little")) == (b"RIFF", b"WEBP", len(data) - 8)
    chunks, at = [], 12
    while at < len(data):
        length = int.from_bytes(data[at + 4 : at + 8], "little")
        chunks.append((data[at : at + 4], data[at + 8 : at + 8 + length]))
        at += 8 + length + length % 2
    assert [name for name, _ in chunks] == [b"VP8X", b"ANIM", *[b"ANMF"] * 30] and at == len(data)
    frames = [content for name, content in chunks if name == b"ANMF"]
    for k, frame in enumerate(frames):
        assert frame[:12] == bytes(6) + (223).to_bytes(3, "little") + (63).to_bytes(3, "little")
        assert frame[15] & 0b11 == 0b10, "in place of the one before, which is left"
        alone = b"RIFF" + (4 + len(frame) - 16).to_bytes(4, "little") + b"WEBP" + frame[16:]
        with Image.open(io.BytesIO(alone)) as image:
            assert np.abs(bars_of(np.asarray(image)) - bars_of(chart(k))).max() <= 6
    ends = np.cumsum([int.from_bytes(frame[12:15], "little") for frame in frames])
    assert np.abs(ends - (np.arange(30) + 1) * 1000 / 24).max() <= 0.5


def swaying() -> list[np.ndarray]:
    """A grainy picture that sways and comes to rest where it began: each frame uint8 (200, 200, 3)."""
    grain = np.random.default_rng(0).normal(0, 12, (200, 200, 3)).astype(np.float32)
    picture = cv2.GaussianBlur(grain, (0, 0), 1.0) + np.linspace(60, 190, 200, dtype=np.float32)[None, :, None]
    away = 3 * np.sin(np.linspace(0, np.pi, 60)) ** 2
    moves = [np.array([[1, 0, x], [0, 1, x / 2]], np.float32) for x in away]
    frames = [cv2.warpAffine(picture, move, (200, 200), borderMode=cv2.BORDER_REFLECT) for move in moves]
    return [np.clip(frame, 0, 255).astype(np.uint8) for frame in frames]


@pytest.mark.parametrize(("format", "highest"), [("mp4", 0.5), ("webm", 0.3)])
def test_a_loop_s_end_leads_into_its_beginning(tmp_path: Path, format: str, highest: float) -> None:
    """From the last frame to the first hardly anything is seen, decoded as well: the pictures are the same."""
    seams, frames = [], swaying()
    for loop in (False, True):
        with VideoWriter(
            VideoTarget(tmp_path / f"out.{format}", (200, 200), 30, format, loop=loop, frames=60)
        ) as writer:
            for frame in frames:
                writer.write(frame)
        shown = np.array([frame.rgb.copy() for frame in read_video(tmp_path / f"out.{format}")], np.int16)
        steps = np.abs(shown - np.roll(shown, 1, axis=0)).mean(axis=(1, 2, 3))
        seams.append(steps[0])
    assert seams[1] < 0.5 * seams[0] and seams[1] < steps[1:].max()
    assert seams[1] < highest


def test_a_short_loop_is_written(tmp_path: Path) -> None:
    for count in (1, 2, 5):
        with VideoWriter(VideoTarget(tmp_path / "out.mp4", (224, 64), 25, loop=True, frames=count)) as writer:
            for k in range(count):
                writer.write(chart(k))
        with av.open(str(tmp_path / "out.mp4")) as container:
            assert sum(1 for _ in container.decode(video=0)) == count


def test_webm_keeps_alpha(tmp_path: Path) -> None:
    path = tmp_path / "out.webm"
    with VideoWriter(VideoTarget(path, (224, 64), 20, "webm")) as writer:
        for k in range(5):
            writer.write(chart(k), ramp())
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        decoder = av.CodecContext.create("libvpx-vp9", "r")
        frames = [frame for packet in container.demux(stream) for frame in decoder.decode(packet)]
    assert [frame.format.name for frame in frames] == ["yuva420p"] * 5
    alpha = np.frombuffer(memoryview(frames[3].planes[3]), np.uint8).reshape(64, -1)[:, :224]
    assert np.abs(alpha / 255 - ramp()).max() < 0.05


@pytest.mark.parametrize("with_alpha", [False, True])
def test_png_sequence_is_exact(tmp_path: Path, with_alpha: bool) -> None:
    alpha = np.round(ramp() * 255) / np.float32(255)
    with VideoWriter(VideoTarget(tmp_path / "out.zip", (224, 64), 20, "png")) as writer:
        for k in range(3):
            writer.write(chart(k), alpha if with_alpha else None)
    with zipfile.ZipFile(tmp_path / "out.zip") as archive:
        assert archive.namelist() == ["000000.png", "000001.png", "000002.png"]
        assert archive.comment == b"20 frames per second"
        for k, name in enumerate(archive.namelist()):
            pixels = np.asarray(Image.open(io.BytesIO(archive.read(name))))
            assert np.array_equal(pixels[..., :3], chart(k))
            if with_alpha:
                assert np.array_equal(pixels[..., 3], np.round(alpha * 255).astype(np.uint8))


def test_a_frame_may_be_changed_after_it_was_written(tmp_path: Path) -> None:
    for format in ("mp4", "png"):
        frame = chart()
        with VideoWriter(VideoTarget(tmp_path / f"out.{format}", (224, 64), 25, format)) as writer:
            for k in range(30):
                frame[:] = chart(k)
                writer.write(frame)
                frame[:] = 0
    frames = list(read_video(tmp_path / "out.mp4"))
    assert np.abs(bars_of(frames[0].rgb) - bars_of(chart(0))).max() <= 3
    with zipfile.ZipFile(tmp_path / "out.png") as archive:
        assert np.array_equal(np.asarray(Image.open(io.BytesIO(archive.read("000011.png")))), chart(11))


@pytest.mark.parametrize("format", ["mp4", "webm", "webp", "gif", "png"])
def test_an_error_in_the_block_leaves_nothing(tmp_path: Path, format: str) -> None:
    with pytest.raises(KeyError), VideoWriter(VideoTarget(tmp_path / "out", (224, 64), 25, format)) as writer:
        writer.write(chart())
        raise KeyError
    assert not list(tmp_path.iterdir())


def test_an_earlier_file_stays_until_the_new_one_is_whole(tmp_path: Path) -> None:
    path = write(tmp_path / "out.mp4", 5)
    before = path.read_bytes()
    with pytest.raises(KeyError), VideoWriter(VideoTarget(path, (224, 64), 25)) as writer:
        writer.write(chart())
        raise KeyError
    assert path.read_bytes() == before
    write(path, 9)
    assert probe_video(path).frames == 9


def test_what_cannot_be_written(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="even"):
        VideoWriter(VideoTarget(tmp_path / "out.mp4", (225, 64), 25))
    with (
        pytest.raises(ValueError, match="shape"),
        VideoWriter(VideoTarget(tmp_path / "out.mp4", (224, 66), 25)) as writer,
    ):
        writer.write(chart())
    with (
        pytest.raises(ValueError, match="alpha"),
        VideoWriter(VideoTarget(tmp_path / "out.mp4", (224, 64), 25)) as writer,
    ):
        writer.write(chart(), ramp())
    with pytest.raises(ValueError, match="no frames"), VideoWriter(VideoTarget(tmp_path / "out.mp4", (224, 64), 25)):
        pass
    assert not list(tmp_path.iterdir())


FULL_DISK = """
import resource, signal, sys
from pathlib import Path
import numpy as np
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
folder, format = Path(sys.argv[1]), sys.argv[2]
rng = np.random.default_rng(0)
def write(name):
    with VideoWriter(VideoTarget(folder / name, (224, 64), 25, format)) as writer:
        for k in range(60):
            writer.write(rng.integers(0, 255, (64, 224, 3), dtype=np.uint8))
write("whole")
size = (folder / "whole").stat().st_size
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
for limit in (1000, size // 2, size * 9 // 10):
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
    try:
        write("out")
    except OSError:
        print("refused", [path.name for path in folder.iterdir()])
"""


@pytest.mark.parametrize("format", ["mp4", "webm", "webp", "gif", "png"])
def test_a_full_disk_is_an_os_error_and_leaves_nothing(tmp_path: Path, format: str) -> None:
    """A limit on the size of files stands for the full disk; it is met at the start, in the middle and at the end."""
    script = [sys.executable, "-c", FULL_DISK, str(tmp_path), format]
    done = subprocess.run(script, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == ["refused ['whole']"] * 3


WRITING = """
import re, sys
from pathlib import Path
import numpy as np
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
rng = np.random.default_rng(0)
def peak():
    return int(re.search(r"VmHWM:\\s+(\\d+)", Path("/proc/self/status").read_text())[1])
with VideoWriter(VideoTarget(Path(sys.argv[1]), (320, 240), 30, sys.argv[2])) as writer:
    for k in range(int(sys.argv[3])):
        writer.write(rng.integers(0, 255, (240, 320, 3), dtype=np.uint8))
        if k == 60:
            before = peak()
print(peak() - before)
"""


@pytest.mark.parametrize(
    ("format", "frames", "megabytes"), [("mp4", 250, 3), ("webm", 330, 8), ("webp", 150, 3), ("png", 100, 3)]
)
def test_a_writer_lets_go_of_what_it_has_written(tmp_path: Path, format: str, frames: int, megabytes: int) -> None:
    """From the third second on memory grows by a small part of what the file does; all frames take as many bytes."""
    script = [sys.executable, "-c", WRITING, str(tmp_path / "out"), format, str(frames)]
    done = subprocess.run(script, capture_output=True, text=True, check=True)
    written = (tmp_path / "out").stat().st_size / 1e6 * (frames - 60) / frames
    assert written > megabytes + 5
    assert int(done.stdout) / 1000 < megabytes, written


READING = """
import re, sys
from pathlib import Path
from engine.media.video import read_video
def peak():
    # Not getrusage, whose peak a child inherits from its parent.
    return int(re.search(r"VmHWM:\\s+(\\d+)", Path("/proc/self/status").read_text())[1])
for k, frame in enumerate(read_video(Path(sys.argv[1]))):
    if k == 60:
        before = peak()
print(k + 1, peak() - before)
"""


@pytest.mark.parametrize("format", ["mp4", "webm", "webp"])
def test_a_reader_lets_go_of_what_it_has_read(tmp_path: Path, format: str) -> None:
    """Of one colour a frame: nothing is quicker to code, and a frame that is held takes as much as any. (That a writer lets go of
    frames, too, is told above: those that it gets take five times as many bytes as the file.)"""
    frames, size = 400, (208, 160)
    with VideoWriter(VideoTarget(tmp_path / "out", size, 10, format)) as writer:
        for k in range(frames):
            writer.write(np.full((size[1], size[0], 3), 20 + k % 200, np.uint8))
    held = 3 * size[0] * size[1] * (frames - 60) / 1e6
    script = [sys.executable, "-c", READING, str(tmp_path / "out")]
    done = subprocess.run(script, capture_output=True, text=True, check=True)
    count, grown = map(int, done.stdout.split())
    assert count == frames and held > 30
    assert grown / 1000 < 3, held


UNEVEN = [0.0, 0.033, 0.066, 0.3, 0.34, 0.5, 1.1, 1.2]
"""When seven frames come on show, and the last one ends, seconds."""


@pytest.mark.parametrize("format", ["mp4", "webm", "webp"])
def test_frames_are_shown_as_long_as_they_are_to_be(tmp_path: Path, format: str) -> None:
    path = write(tmp_path / "out", 7, 30, format=format, times=UNEVEN)
    frames = list(read_video(path))
    assert [frame.time for frame in frames] == pytest.approx(UNEVEN[:-1], abs=0.0011)
    for k, frame in enumerate(frames):
        assert np.abs(bars_of(frame.rgb) - bars_of(chart(k))).max() < 8
    assert probe_video(path).seconds == pytest.approx(1.2, abs=0.002 if format != "webm" else 0.1)


def test_numbered_pictures_come_with_their_times(tmp_path: Path) -> None:
    write(tmp_path / "out.zip", 7, 30, format="png", times=UNEVEN)
    with zipfile.ZipFile(tmp_path / "out.zip") as archive:
        first, *times = archive.read("timecodes.txt").decode().splitlines()
        assert first == "# timecode format v2" and [float(time) / 1000 for time in times] == UNEVEN[:-1]
        assert len(archive.namelist()) == 8
    write(tmp_path / "even.zip", 7, 30, format="png")
    assert "timecodes.txt" not in zipfile.ZipFile(tmp_path / "even.zip").namelist()


def test_a_gif_has_the_colours_the_times_and_the_alpha(tmp_path: Path) -> None:
    path = write(tmp_path / "out.gif", 7, 30, format="gif", times=UNEVEN)
    frames = list(read_video(path))
    assert [frame.time for frame in frames] == pytest.approx(UNEVEN[:-1], abs=0.011)
    for k, frame in enumerate(frames):
        assert np.abs(bars_of(frame.rgb) - bars_of(chart(k))).max() < 6
    with Image.open(path) as image:
        assert image.info["loop"] == 0, "it repeats for ever"
    alpha = np.ones((64, 224), np.float32)
    alpha[:, 32:64] = 0
    with VideoWriter(VideoTarget(tmp_path / "clear.gif", (224, 64), 25, "gif")) as writer:
        for _ in range(3):
            writer.write(chart(), alpha)
    with Image.open(tmp_path / "clear.gif") as image:
        image.seek(2)
        seen = np.asarray(image.convert("RGBA"))
    assert seen[32, 48, 3] == 0 and seen[32, 16, 3] == 255


def test_the_dither_of_a_gif_stays_where_it_is(tmp_path: Path) -> None:
    """More colours than 256, before which something moves: what stands still is the same in all frames."""
    across, down = np.meshgrid(np.linspace(0, 255, 160), np.linspace(0, 255, 120))
    still = np.stack([across, down, 255 - across], -1).astype(np.uint8)
    with VideoWriter(VideoTarget(tmp_path / "out.gif", (160, 120), 20, "gif")) as writer:
        for k in range(40):
            frame = still.copy()
            frame[50:60, 3 * k : 3 * k + 10] = (250, 240, 20)
            writer.write(frame)
    frames = np.array([frame.rgb for frame in read_video(tmp_path / "out.gif")]).astype(int)
    assert len(frames) == 40
    assert np.ptp(frames[:, :48], axis=0).max() == 0, "no flicker, and no crawling"
    rough = cv2.blur(frames[0].astype(np.float32), (8, 8)) - cv2.blur(still.astype(np.float32), (8, 8))
    assert np.abs(rough[8:40, 8:-8]).mean() < 5


def test_few_large_frames_of_a_gif_are_held(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A quarter of a hundred of 4096 x 4096 pixels would be 1.7 GB."""
    monkeypatch.setattr(animated_gif, "MAX_HELD_BYTES", 3 * 4 * 224 * 64)
    target = VideoTarget(tmp_path / "out.gif", (224, 64), 10, "gif")
    encoder = animated_gif.GifEncoder(target, False)
    held = []
    for k in range(6):
        encoder.add(encoder.prepare(chart(k), None))
        held.append(encoder.frames_held)
    encoder.finish()
    assert held == [1, 2, 0, 0, 0, 0]
    assert [frame.time for frame in read_video(tmp_path / "out.gif")] == pytest.approx(np.arange(6) / 10)


def test_a_gif_leaves_out_frames_that_browsers_would_hold_too_long(tmp_path: Path) -> None:
    """They show for a tenth of a second what claims less than a fiftieth."""
    path = write(tmp_path / "out.gif", 60, 60, format="gif")
    with Image.open(path) as image:
        lengths = []
        for k in range(image.n_frames):
            image.seek(k)
            lengths.append(image.info["duration"])
    assert min(lengths) >= 20 and sum(lengths) == pytest.approx(1000, abs=20)
