"""The driver's sound in the result: in step with the picture, whatever it was coded in and however it was cut."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest

from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.media.video import probe_video

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
    with VideoWriter(VideoTarget(tmp_path / "out", (64, 48), 25, format, sound=driver, sound_trim=trim)) as writer:
        for _ in range(round((end - start) * 25)):
            writer.write(np.full((48, 64, 3), 90, np.uint8))
    heard, last, coded = clicks_in(tmp_path / "out")
    assert heard == pytest.approx([click - start for click in CLICKS if start <= click < end], abs=0.004)
    assert end - start - 0.1 < last < end - start + 0.05
    assert coded == {"mp4": "aac", "webm": "opus"}[format]


def test_fitting_sound_is_copied_bit_by_bit(tmp_path: Path) -> None:
    driver = write_driver(tmp_path / "in.mp4", "aac")
    with VideoWriter(VideoTarget(tmp_path / "out.mp4", (64, 48), 25, sound=driver)) as writer:
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
        with VideoWriter(VideoTarget(tmp_path / "out.mp4", (64, 48), 25, sound=driver)) as writer:
            for _ in range(frames):
                writer.write(np.full((48, 64, 3), 90, np.uint8))
        assert clicks_in(tmp_path / "out.mp4")[1] == pytest.approx(expected, abs=0.06)


@pytest.mark.parametrize("format", ["mp4", "webm", "webp", "gif", "png"])
def test_without_sound_there_is_a_warning(tmp_path: Path, format: str) -> None:
    silent = tmp_path / "silent.mp4"
    warnings: list[str] = []
    with VideoWriter(VideoTarget(silent, (64, 48), 25)) as writer:
        for _ in range(5):
            writer.write(np.full((48, 64, 3), 90, np.uint8))
    with VideoWriter(
        VideoTarget(tmp_path / "out", (64, 48), 25, format, sound=silent), lambda code, message: warnings.append(code)
    ) as writer:
        writer.write(np.full((48, 64, 3), 90, np.uint8))
    assert warnings == ["no_sound"] and (tmp_path / "out").exists()


def test_broken_sound_does_not_break_the_picture(tmp_path: Path) -> None:
    driver = write_driver(tmp_path / "in.mkv", "flac")
    content = driver.read_bytes()
    driver.write_bytes(content[: len(content) * 2 // 3])
    with VideoWriter(VideoTarget(tmp_path / "out.mp4", (64, 48), 25, sound=driver)) as writer:
        for _ in range(75):
            writer.write(np.full((48, 64, 3), 90, np.uint8))
    with av.open(str(tmp_path / "out.mp4")) as container:
        assert sum(1 for _ in container.decode(video=0)) == 75


def remuxed(path: Path, out: Path, change) -> Path:  # type: ignore[no-untyped-def]
    """The same file with its packets of sound as `change(packets)` has them; each packet is (seconds, bytes)."""
    with av.open(str(path)) as source, av.open(str(out), "w") as container:
        video, sound = source.streams.video[0], source.streams.audio[0]
        streams = container.add_stream_from_template(video), container.add_stream_from_template(sound)
        sounds, rest = [], []
        for packet in source.demux(video, sound):
            if not packet.size:
                continue
            if packet.stream.type == "audio":
                sounds.append((float(packet.pts * packet.time_base), bytes(packet)))
            else:
                packet.stream = streams[0]
                rest.append((float(packet.dts * packet.time_base), packet))
        for time, content in change(sounds):
            packet = av.Packet(content)
            packet.time_base, packet.pts = Fraction(1, 1000), round(time * 1000)
            packet.dts, packet.duration, packet.stream = packet.pts, 21, streams[1]
            rest.append((time, packet))
        for _, packet in sorted(rest, key=lambda one: one[0]):
            container.mux(packet)
    return out


def doubled_time(packets):  # type: ignore[no-untyped-def]
    """One packet bears the timestamp of the one before it, as in clips that were joined or muxed anew."""
    return [(packets[k - 1][0], content) if k == 40 else (time, content) for k, (time, content) in enumerate(packets)]


def garbage(packets):  # type: ignore[no-untyped-def]
    """From two thirds on, nothing decodes; one packet is missing."""
    noise = np.random.default_rng(3).integers(0, 256, 400).astype(np.uint8).tobytes()
    return [(time, noise if time > 2.2 else content) for k, (time, content) in enumerate(packets) if k != 100]


def carried(driver: Path, out: Path, format: str, seconds: float = 3.0) -> list[str]:
    """The codes of the warnings of a result with a driver's sound."""
    warnings: list[str] = []
    warn = lambda code, message: warnings.append(code)  # noqa: E731
    with VideoWriter(VideoTarget(out, (64, 48), 25, format, sound=driver), warn) as writer:  # type: ignore[arg-type]
        for _ in range(round(seconds * 25)):
            writer.write(np.full((48, 64, 3), 90, np.uint8))
    with av.open(str(out)) as container:
        assert sum(1 for _ in container.decode(video=0)) == round(seconds * 25)
    return warnings


@pytest.mark.parametrize("format", ["mp4", "webm"])
def test_two_packets_of_one_time_are_sounded_one_after_the_other(tmp_path: Path, format: str) -> None:
    driver = remuxed(write_driver(tmp_path / "in.mp4", "aac"), tmp_path / "in.mkv", doubled_time)
    assert carried(driver, tmp_path / "out", format) == []
    clicks, _, _ = clicks_in(tmp_path / "out")
    assert clicks == pytest.approx(CLICKS, abs=0.015)


@pytest.mark.parametrize("format", ["mp4", "webm"])
def test_sound_that_breaks_off_is_kept_up_to_there_and_told_of(tmp_path: Path, format: str) -> None:
    driver = remuxed(write_driver(tmp_path / "in.mov", "aac", 44100), tmp_path / "in.mkv", garbage)
    codes = carried(driver, tmp_path / "out", format)
    if format == "webm":  # coded anew; in an MP4 it is copied as it is
        assert codes == ["sound_damaged"]
        assert clicks_in(tmp_path / "out")[0] == pytest.approx(CLICKS, abs=0.015)


@pytest.mark.parametrize("format", ["mp4", "webm"])
def test_a_cut_within_a_gap_leaves_of_it_what_comes_after(tmp_path: Path, format: str) -> None:
    """Of sound that is missing from 0.75 to 1.75 s, cut at 1.25 s: the click at 2 s is heard after 0.75 s."""
    gap = lambda packets: [(time, content) for time, content in packets if not 0.75 < time < 1.75]  # noqa: E731
    driver = remuxed(write_driver(tmp_path / "in.mov", "aac", 44100), tmp_path / "in.mkv", gap)
    with VideoWriter(VideoTarget(tmp_path / "out", (64, 48), 25, format, sound=driver, sound_trim=(1.25, 3))) as writer:
        for _ in range(44):
            writer.write(np.full((48, 64, 3), 90, np.uint8))
    assert clicks_in(tmp_path / "out")[0] == pytest.approx([0.75], abs=0.03)


def test_sound_of_which_nothing_decodes_is_left_out(tmp_path: Path) -> None:
    spoil = lambda packets: [(time, b"\x81" * 50) for time, _ in packets]  # noqa: E731
    driver = remuxed(write_driver(tmp_path / "in.mp4", "aac"), tmp_path / "in.mkv", spoil)
    for format in ("mp4", "webm"):
        assert carried(driver, tmp_path / f"out.{format}", format) == ["no_sound"]


def test_sound_that_changes_its_format_on_the_way_goes_on(tmp_path: Path) -> None:
    """Packets of MP3 say of themselves what they hold: rate and channels change in the middle of the stream."""

    def coded(rate: int, layout: str, start: float, end: float) -> list[tuple[float, bytes]]:
        codec = av.CodecContext.create("libmp3lame", "w")
        codec.sample_rate, codec.layout, codec.format, codec.time_base = rate, layout, "fltp", Fraction(1, rate)
        found, size = [], 1152 if rate > 24000 else 576
        channels = 1 if layout == "mono" else 2
        for k in range(int((end - start) * rate / size) + 2):
            times = start + (k * size + np.arange(size)) / rate
            loud = sum(((times >= click) & (times < click + 0.004)).astype(np.float32) for click in CLICKS)
            samples = np.repeat((0.9 * loud * np.sin(times * 2 * np.pi * 2000))[None].astype(np.float32), channels, 0)
            frame = av.AudioFrame.from_ndarray(samples, "fltp", layout)
            frame.sample_rate, frame.pts, frame.time_base = rate, k * size, Fraction(1, rate)
            found += [(start + max(0, p.pts * float(p.time_base)), bytes(p)) for p in codec.encode(frame)]
        return [one for one in found if one[0] < end]

    first, second = coded(44100, "stereo", 0, 1.0), coded(22050, "mono", 1.0, 3.0)
    driver = remuxed(
        write_driver(tmp_path / "in.mp4", "libmp3lame", 44100), tmp_path / "b.mkv", lambda _: first + second
    )
    for format in ("mp4", "webm"):
        assert carried(driver, tmp_path / f"out.{format}", format) == []
        clicks, seconds, _ = clicks_in(tmp_path / f"out.{format}")
        assert clicks == pytest.approx(CLICKS, abs=0.06) and seconds > 2.8


@pytest.mark.parametrize("name", ["in.mp4", "in.mov", "in.mkv", "in.webm", "in.avi"])
def test_a_track_without_sound_in_it_is_no_sound(tmp_path: Path, name: str) -> None:
    codecs = ("libvpx", "libopus") if name == "in.webm" else ("libx264", "aac")
    with av.open(str(tmp_path / name), "w") as container:
        video, sound = container.add_stream(codecs[0], rate=25), container.add_stream(codecs[1], rate=48000)
        video.width, video.height, video.pix_fmt = 64, 48, "yuv420p"
        sound.codec_context.layout = "stereo"
        sound.codec_context.open()
        for k in range(25):
            frame = av.VideoFrame.from_ndarray(np.full((48, 64, 3), 90, np.uint8), "rgb24")
            frame.pts, frame.time_base = k, Fraction(1, 25)
            container.mux(video.encode(frame))
        container.mux(video.encode(None))
    with av.open(str(tmp_path / name)) as container:
        tracks = len(container.streams.audio)
    assert tracks == 1 or name in ("in.mp4", "in.mov")  # these are written without it
    assert not probe_video(tmp_path / name).has_sound
    assert carried(tmp_path / name, tmp_path / "out", "mp4", 1.0) == ["no_sound"]


UNEVEN = np.cumsum([0, *([0.02, 0.03, 0.11, 0.04] * 14)])


@pytest.mark.parametrize("format", ["mp4", "webm"])
def test_a_flash_and_a_click_come_together_at_any_rate(tmp_path: Path, format: str) -> None:
    """Pictures that are not shown equally long: the one on show when a click is heard is white."""
    driver = write_driver(tmp_path / "in.mp4", "aac")
    flashes = [int(np.searchsorted(UNEVEN, click, "right")) - 1 for click in CLICKS]
    with VideoWriter(VideoTarget(tmp_path / "out", (64, 48), 25, format, sound=driver, times=UNEVEN)) as writer:
        for k in range(len(UNEVEN) - 1):
            writer.write(np.full((48, 64, 3), 255 if k in flashes else 30, np.uint8))
    with av.open(str(tmp_path / "out")) as container:
        shown = [(frame.time, frame.to_ndarray(format="gray").mean() > 128) for frame in container.decode(video=0)]
    assert [time for time, _ in shown] == pytest.approx(UNEVEN[:-1], abs=0.0011)
    assert [time for time, bright in shown if bright] == pytest.approx(UNEVEN[flashes], abs=0.0011)
    for click, flash in zip(clicks_in(tmp_path / "out")[0], flashes, strict=True):
        assert UNEVEN[flash] - 0.015 <= click < UNEVEN[flash + 1] + 0.015
