"""The sound of a driver, carried into the result: copied where its codec fits, else coded anew, cut in step."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from fractions import Fraction
from itertools import islice
from math import inf
from pathlib import Path
from typing import cast

import av
import numpy as np
from av.audio.stream import AudioStream
from av.container import InputContainer, OutputContainer

from engine.errors import InputError
from engine.media.decoding.demux import open_container, video_stream
from engine.media.sniff import VIDEO_TYPES, sniff

_SAMPLES_PER_SECOND = 48_000
"""Samples a second of sound that is coded anew; always in stereo."""

_FITTING_CODECS = {"mp4": "aac", "webm": "opus"}
_ENCODERS = {"mp4": ("aac", "160k"), "webm": ("libopus", "128k")}
_GLOBAL_HEADER_FORMATS = ("mov", "matroska")
"""FFmpeg's names of the formats that keep the codec's set-up apart from the packets, where the output wants it."""
_MAX_GAP_SAMPLES = _SAMPLES_PER_SECOND // 20
"""Samples by which sound may stray from its timestamps before silence is put in, or what overlaps is left out."""
_RESTART_SAMPLES = _SAMPLES_PER_SECOND
"""Samples: timestamps that fall back further were begun anew, as in clips that were joined: the sound goes on."""
_MAX_TRIED_PACKETS = 100
"""Packets of which one must decode for a track to count as sound."""
_SOUND_ERRORS = (av.FFmpegError, ValueError)
"""What reading, decoding and laying in of sound may raise; none of it ends a video."""


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
    if media_type not in VIDEO_TYPES or not _decodes(path, media_type):
        return None
    source = open_container(path, media_type)
    return SoundTrack(
        source, source.streams.audio[0], container, format, trim or (0.0, inf), _can_be_copied(path, media_type)
    )


def _decodes(path: Path, media_type: str) -> bool:
    """Whether the first sound of a file can be made anything of."""
    with suppress(InputError, *_SOUND_ERRORS), open_container(path, media_type) as source:
        if not source.streams.audio or source.streams.audio[0].codec_context is None:
            return False
        for packet in islice(source.demux(source.streams.audio[0]), _MAX_TRIED_PACKETS):
            with suppress(*_SOUND_ERRORS):
                if packet.decode():
                    return True
    return False


def _can_be_copied(path: Path, media_type: str) -> bool:
    """Whether the packets of a file's sound can be laid into another file as they are: each has a time of its own, later
    than the one before, and one set-up of the codec is that of all."""
    with suppress(*_SOUND_ERRORS), open_container(path, media_type) as source:
        stream = source.streams.audio[0]
        if not (
            source.format.name.startswith(_GLOBAL_HEADER_FORMATS)
            and stream.time_base
            and stream.codec_context.extradata
        ):
            return False
        before: int | None = None
        for packet in source.demux(stream):
            if not packet.size:
                continue
            if (
                packet.pts is None
                or (before is not None and packet.pts <= before)
                or packet.has_sidedata("new_extradata")
            ):
                return False
            before = packet.pts
        return True
    return False


class SoundTrack:
    """Sound on its way from one container to another; see `open_sound`. Whatever is wrong with it, the picture goes on:
    `damaged` tells whether some of it was left out for that."""

    def __init__(
        self,
        source: InputContainer,
        stream: AudioStream,
        container: OutputContainer,
        format: str,
        trim: tuple[float, float],
        whole: bool,
    ):
        self._source, self._stream, self._container = source, stream, container
        self._seconds = trim[1] - trim[0]
        picture = video_stream(source)
        origin = float((picture.start_time or 0) * picture.time_base) if picture and picture.time_base else 0.0
        self._zero = origin + trim[0]
        self.damaged = False
        if whole and stream.codec_context.name.removeprefix("lib") == _FITTING_CODECS[format]:
            self._out = container.add_stream_from_template(stream)
            self._packets = self._copied(keep_lead=format == "mp4")
        else:
            codec, bit_rate = _ENCODERS[format]
            self._out = cast(
                AudioStream, container.add_stream(codec, rate=_SAMPLES_PER_SECOND, options={"b": bit_rate})
            )
            self._out.codec_context.layout = "stereo"
            self._packets = self._coded()
        self._waiting: tuple[float, av.Packet] | None = None

    def mux_until(self, seconds: float) -> None:
        """Mux what begins before `seconds` of the result."""
        while True:
            if self._waiting is None:
                try:
                    self._waiting = next(self._packets, None)
                except _SOUND_ERRORS:
                    self.damaged = True  # and the generator is at its end
            if self._waiting is None or self._waiting[0] >= seconds:
                return
            try:
                self._container.mux(self._waiting[1])
            except (av.error.ArgumentError, av.error.InvalidDataError):
                self.damaged = True
            self._waiting = None

    def close(self) -> None:
        """Close the source."""
        self._source.close()

    def _demux(self) -> Iterator[av.Packet]:
        try:
            for packet in self._source.demux(self._stream):
                if packet.size:
                    yield packet
        except av.FFmpegError:
            self.damaged = True  # a broken tail: what came before it is used

    def _copied(self, keep_lead: bool) -> Iterator[tuple[float, av.Packet]]:
        """`keep_lead` keeps the packet that overlaps the cut and the one before: a decoder needs them to be exact. MP4
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
            frame.sample_rate, frame.pts, frame.time_base = (
                _SAMPLES_PER_SECOND,
                written,
                Fraction(1, _SAMPLES_PER_SECOND),
            )
            for packet in self._out.encode(frame):
                yield written / _SAMPLES_PER_SECOND, packet
            written += samples.shape[1]
        for packet in self._out.encode(None):
            yield written / _SAMPLES_PER_SECOND, packet

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
        at: int | None = None  # where the next samples belong, counted from the cut
        moved = 0  # by how much timestamps that begin anew are too early
        resampler, kind = av.AudioResampler("fltp", "stereo", _SAMPLES_PER_SECOND), None
        for frame in self._frames():
            spare = 0
            if frame.pts is not None and frame.time_base:
                place = round((float(frame.pts * frame.time_base) - self._zero) * _SAMPLES_PER_SECOND) + moved
                if at is not None and place < at - _RESTART_SAMPLES:
                    moved, place = moved + at - place, at
                if at is None or place > at + _MAX_GAP_SAMPLES:
                    yield from _silence(place - max(at or 0, 0))
                    at = place
                elif place < at - _MAX_GAP_SAMPLES:
                    spare = at - place
            if kind != (kind := (frame.format.name, frame.layout.name, frame.sample_rate)):
                resampler = av.AudioResampler("fltp", "stereo", _SAMPLES_PER_SECOND)  # it takes one kind alone
            frame.pts = None
            for piece in resampler.resample(frame):
                samples = cast(np.ndarray, piece.to_ndarray())[:, spare:]
                spare = max(0, spare - piece.samples)
                at = (at or 0) + samples.shape[1]
                if at > 0 and samples.shape[1]:
                    yield samples[:, -min(at, samples.shape[1]) :]
            if (at or 0) >= self._seconds * _SAMPLES_PER_SECOND:
                return

    def _frames(self) -> Iterator[av.AudioFrame]:
        """What decodes."""
        for packet in self._demux():
            try:
                yield from cast(list[av.AudioFrame], packet.decode())
            except av.FFmpegError:
                self.damaged = True


def _silence(samples: int) -> Iterator[np.ndarray]:
    """So many samples, a second at a time: a file may claim a gap of years."""
    while samples > 0:
        yield np.zeros((2, min(samples, _SAMPLES_PER_SECOND)), np.float32)
        samples -= _SAMPLES_PER_SECOND
