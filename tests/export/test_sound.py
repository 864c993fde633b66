"""The driver's sound in the result: in step with the picture, whatever it was coded in and however it was cut."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest

from engine.export.video import VideoWriter

CLICKS = (0.5, 1.25, 2.0)  # seconds after the first picture


def write_driver(path: Path, codec: str, rate: int = 48000, late: float = 0.0, seconds: float = 3.0) -> Path:
    """A clip of grey pictures, the first at `late` seconds, with short clicks at `CLICKS` after that."""
    samples = np.zeros((2, int((seconds + late) * rate)), np.float32)
    for click in CLICKS:
        at = int((click + late) * rate)
        samples[:, at : at + rate // 500] = 0.9 * np.sin(np.arange(rate // 500) * 2 * np.pi * 2000 / rate)
    with av.open(str(path), "w") as container:
        video = container.add_stream("libvpx" if path.suffix == ".webm" else "libx264", rate=25)
        video.width, video.height, video.pix_fmt = 64, 48, "yuv420p"
        sound = container.add_stream(codec, rate=rate)
        sound.codec_context.layout = "stereo"
        sound.codec_context.open()
        size = sound.codec_context.frame_size or 1024
        kind = sound.codec_context.format.name
        for k in range(int(seconds * 25)):
            frame = av.VideoFrame.from_ndarray(np.full((48, 64, 3), 90, np.uint8), "rgb24")
            frame.pts, frame.time_base = k + round(late * 25), Fraction(1, 25)
            container.mux(video.encode(frame))
        container.mux(video.encode(None))
        resampler = av.AudioResampler(kind, "stereo", rate)
        for start in range(0, samples.shape[1] // size * size, size):
            frame = av.AudioFrame.from_ndarray(np.ascontiguousarray(samples[:, start : start + size]), "fltp", "stereo")
            frame.sample_rate, frame.pts, frame.time_base = rate, start, Fraction(1, rate)
            for piece in resampler.resample(frame):
                container.mux(sound.encode(piece))
        container.mux(sound.encode(None))
    return path


def clicks_in(path: Path) -> tuple[list[float], float, str]:
    """When clicks begin after the first picture (s), how long the sound lasts, and its codec."""
    with av.open(str(path)) as container:
        first = next(container.decode(video=0)).time
    with av.open(str(path)) as container:
        stream = container.streams.audio[0]
        pieces = [(frame.time - first, frame.to_ndarray(), frame.sample_rate) for frame in container.decode(stream)]
        codec = stream.codec_context.name
    rate = pieces[0][2]
    times = np.concatenate([time + np.arange(piece.shape[1]) / rate for time, piece, _ in pieces])
    loud = times[np.abs(np.concatenate([piece[0] for _, piece, _ in pieces])) > 0.3]
    starts = [float(time) for k, time in enumerate(loud) if k == 0 or time - loud[k - 1] > 0.1]
    return starts, float(times[-1]), codec


DRIVERS = [
    ("in.mp4", "aac", 48000),
    ("in.mp4", "aac", 16000),
    ("in.mkv", "aac", 44100),
    ("in.webm", "libopus", 48000),
    ("in.mov", "pcm_s16le", 44100),
    ("in.mkv", "flac", 48000),
]


@pytest.mark.parametrize(("name", "codec", "rate"), DRIVERS)
@pytest.mark.parametrize("format", ["mp4", "webm"])
@pytest.mark.parametrize("trim", [None, (0.4, 2.5), (1.013, 2.9)])
@pytest.mark.parametrize("late", [0.0, 0.6])
def test_sound_stays_in_step(
    tmp_path: Path, name: str, codec: str, rate: int, format: str, trim: tuple[float, float] | None, late: float
) -> None:
    driver = write_driver(tmp_path / name, codec, rate, late)
    start, end = trim or (0.0, 3.0)
    with VideoWriter(tmp_path / "out", (64, 48), 25, format, sound=driver, sound_trim=trim) as writer:
        for _ in range(round((end - start) * 25)):
            writer.write(np.full((48, 64, 3), 90, np.uint8))
    heard, last, coded = clicks_in(tmp_path / "out")
    assert heard == pytest.approx([click - start for click in CLICKS if start <= click < end], abs=0.004)
    assert end - start - 0.1 < last < end - start + 0.05
    assert coded == {"mp4": "aac", "webm": "opus"}[format]


def test_fitting_sound_is_copied_bit_by_bit(tmp_path: Path) -> None:
    driver = write_driver(tmp_path / "in.mp4", "aac")
    with VideoWriter(tmp_path / "out.mp4", (64, 48), 25, sound=driver) as writer:
        for _ in range(75):
            writer.write(np.full((48, 64, 3), 90, np.uint8))

    def packets(path: Path) -> list[bytes]:
        with av.open(str(path)) as container:
            return [bytes(packet) for packet in container.demux(audio=0) if packet.size]

    before, after = packets(driver), packets(tmp_path / "out.mp4")
    assert len(after) > 100 and after == before[: len(after)]


def test_sound_longer_or_shorter_than_the_picture(tmp_path: Path) -> None:
    driver = write_driver(tmp_path / "in.mp4", "aac")
    for frames, expected in ((25, 1.0), (150, 3.0)):
        with VideoWriter(tmp_path / "out.mp4", (64, 48), 25, sound=driver) as writer:
            for _ in range(frames):
                writer.write(np.full((48, 64, 3), 90, np.uint8))
        assert clicks_in(tmp_path / "out.mp4")[1] == pytest.approx(expected, abs=0.06)


@pytest.mark.parametrize("format", ["mp4", "webm", "webp", "png"])
def test_without_sound_there_is_a_warning(tmp_path: Path, format: str) -> None:
    silent = tmp_path / "silent.mp4"
    warnings: list[str] = []
    with VideoWriter(silent, (64, 48), 25) as writer:
        for _ in range(5):
            writer.write(np.full((48, 64, 3), 90, np.uint8))
    with VideoWriter(
        tmp_path / "out", (64, 48), 25, format, sound=silent, warn=lambda code, message: warnings.append(code)
    ) as writer:
        writer.write(np.full((48, 64, 3), 90, np.uint8))
    assert warnings == ["no_sound"] and (tmp_path / "out").exists()


def test_broken_sound_does_not_break_the_picture(tmp_path: Path) -> None:
    driver = write_driver(tmp_path / "in.mkv", "flac")
    content = driver.read_bytes()
    driver.write_bytes(content[: len(content) * 2 // 3])
    with VideoWriter(tmp_path / "out.mp4", (64, 48), 25, sound=driver) as writer:
        for _ in range(75):
            writer.write(np.full((48, 64, 3), 90, np.uint8))
    with av.open(str(tmp_path / "out.mp4")) as container:
        assert sum(1 for _ in container.decode(video=0)) == 75
