"""The sound of a driver, carried into the result: copied where its codec fits, else coded anew, cut in step."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import inf
from pathlib import Path
from typing import cast

import av
import numpy as np
from av.audio.stream import AudioStream
from av.container import InputContainer, OutputContainer

from engine.errors import InputError
from engine.media.demux import open_container, video_stream
from engine.media.sniff import sniff

_RATE = 48_000
"""Samples a second of sound that is coded anew; always in stereo."""

_FITTING = {"mp4": "aac", "webm": "opus"}
_ENCODERS = {"mp4": ("aac", "160k"), "webm": ("libopus", "128k")}
_GAP = _RATE // 20
"""Samples by which sound may stray from its timestamps before silence is put in."""


def open_sound(
    path: Path, container: OutputContainer, format: str, trim: tuple[float, float] | None = None
) -> SoundTrack | None:
    """The sound of a video file, to be muxed into `container`, of `format` "mp4" or "webm", which nothing was muxed
    into yet. None where the file has none that can be decoded.

    Parameters
    ----------
    trim : (start, end) seconds since the first frame of the file's video; the sound is moved to begin at 0.
    """
    media_type = sniff(path)
    try:
        source = open_container(path, media_type or "")
    except (InputError, KeyError):
        return None
    stream = next((s for s in source.streams.audio if s.codec_context is not None), None)
    if stream is None or not stream.time_base:
        source.close()
        return None
    return SoundTrack(source, stream, container, format, trim or (0.0, inf))


class SoundTrack:
    """Sound on its way from one container to another; see `open_sound`."""

    def __init__(
        self,
        source: InputContainer,
        stream: AudioStream,
        container: OutputContainer,
        format: str,
        trim: tuple[float, float],
    ):
        self._source, self._stream, self._container = source, stream, container
        self._seconds = trim[1] - trim[0]
        picture = video_stream(source)
        origin = float((picture.start_time or 0) * picture.time_base) if picture and picture.time_base else 0.0
        self._zero = origin + trim[0]
        # Only these two keep the codec's set-up apart from the packets, where the output wants it.
        copied = stream.codec_context.name.removeprefix("lib") == _FITTING[format]
        if copied and source.format.name.startswith(("mov", "matroska")):
            self._out = container.add_stream_from_template(stream)
            self._packets = self._copied(keep_lead=format == "mp4")
        else:
            codec, bit_rate = _ENCODERS[format]
            self._out = cast(AudioStream, container.add_stream(codec, rate=_RATE, options={"b": bit_rate}))
            self._out.codec_context.layout = "stereo"
            self._packets = self._coded()
        self._waiting: tuple[float, av.Packet] | None = None

    def mux_until(self, seconds: float) -> None:
        """Mux what begins before `seconds` of the result."""
        while True:
            if self._waiting is None:
                self._waiting = next(self._packets, None)
            if self._waiting is None or self._waiting[0] >= seconds:
                return
            self._container.mux(self._waiting[1])
            self._waiting = None

    def close(self) -> None:
        """Close the source."""
        self._source.close()

    def _demux(self) -> Iterator[av.Packet]:
        try:
            for packet in self._source.demux(self._stream):
                if packet.pts is not None and packet.size:
                    yield packet
        except av.FFmpegError:
            return  # a broken tail: what came before it is used

    def _copied(self, keep_lead: bool) -> Iterator[tuple[float, av.Packet]]:
        """`keep_lead`: keep the packet that overlaps the cut and the one before, which a decoder needs to be exact; MP4
        hides what they sound before the cut."""
        clock = cast(Fraction, self._stream.time_base)
        shift = round(self._zero / clock)
        for packet in self._demux():
            begin = float((cast(int, packet.pts) - shift) * clock)
            length = float((packet.duration or 0) * clock)
            if begin >= self._seconds:
                return
            if begin < 0 and (not keep_lead or begin + 2 * length <= 0):
                continue
            packet.pts = packet.dts = cast(int, packet.pts) - shift
            packet.stream = self._out
            yield begin, packet

    def _coded(self) -> Iterator[tuple[float, av.Packet]]:
        written = 0
        for samples in self._blocks():
            frame = av.AudioFrame.from_ndarray(samples, "fltp", "stereo")
            frame.sample_rate, frame.pts, frame.time_base = _RATE, written, Fraction(1, _RATE)
            for packet in self._out.encode(frame):
                yield written / _RATE, packet
            written += samples.shape[1]
        for packet in self._out.encode(None):
            yield written / _RATE, packet

    def _blocks(self) -> Iterator[np.ndarray]:
        """Samples float32 (2, n) from the cut to the end, without a gap, in the encoder's blocks."""
        self._out.codec_context.open()
        size = self._out.codec_context.frame_size or 960
        pending = np.zeros((2, 0), np.float32)
        for samples in self._samples():
            pending = np.concatenate([pending, samples], axis=1)
            while pending.shape[1] >= size:
                yield np.ascontiguousarray(pending[:, :size])
                pending = pending[:, size:]
        if pending.shape[1]:
            yield np.pad(pending, ((0, 0), (0, size - pending.shape[1])))

    def _samples(self) -> Iterator[np.ndarray]:
        """Samples float32 (2, n) one after another; the first is at the cut. What is missing is silence."""
        resampler = av.AudioResampler("fltp", "stereo", _RATE)
        at: int | None = None  # where the next samples belong, counted from the cut
        for packet in self._demux():
            try:
                frames = cast(list[av.AudioFrame], packet.decode())
            except av.FFmpegError:
                continue
            for frame in frames:
                if frame.pts is not None and frame.time_base:
                    place = round((float(frame.pts * frame.time_base) - self._zero) * _RATE)
                    if at is None or place > at + _GAP:
                        silence = place - max(at or 0, 0)
                        if silence > 0:
                            yield np.zeros((2, silence), np.float32)
                        at = place
                frame.pts = None
                for piece in resampler.resample(frame):
                    samples = cast(np.ndarray, piece.to_ndarray())
                    at = (at or 0) + samples.shape[1]
                    if at > 0:
                        yield samples[:, -min(at, samples.shape[1]) :]
                if (at or 0) >= self._seconds * _RATE:
                    return
