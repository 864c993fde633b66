"""What is let in: a video file's kind and size, and the limits on what its headers claim."""

from __future__ import annotations

from pathlib import Path

from engine.errors import InputError
from engine.media.decoding.demux import Header, without_picture
from engine.media.limits import MAX_DECODED_SIDE_PIXELS, MIN_SIDE_PIXELS, Limits
from engine.media.sniff import VIDEO_TYPES, is_still_webp, sniff


def admit_video(path: Path, limits: Limits) -> str:
    """The media type of a file that may be a video.

    Raises `InputError`: `file_empty`, `file_too_large`, `no_video_stream` (sound), `not_a_video`.
    """
    size = path.stat().st_size
    if size == 0:
        raise InputError("file_empty", "The video file is empty (0 bytes): send it again.")
    if size > limits.video_bytes:
        raise InputError(
            "file_too_large",
            f"The video file has {size / 1e6:.0f} MB, the limit is {limits.video_bytes / 1e6:.0f} MB: send a shorter "
            "or smaller one.",
        )
    media_type = sniff(path)
    if media_type is not None and media_type.startswith("audio/"):
        raise without_picture()
    if media_type is None or media_type not in VIDEO_TYPES or is_still_webp(path):
        raise InputError(
            "not_a_video", f"This is {media_type or 'no video'}: send an MP4, MOV, WebM, MKV or GIF video."
        )
    return media_type


def check_claims(header: Header, limits: Limits) -> None:
    """Refuse what its header alone shows to be beyond the limits. The rate is left to the packets: recordings from
    browsers claim their clock's ticks, a thousand a second."""
    check_video(header.width, header.height, 0.0, header.seconds, header.frames, limits)


def check_video(width: int, height: int, fps: float, seconds: float, frames: int, limits: Limits) -> None:
    """Raise `InputError` where a video is beyond the limits: `video_too_large`, `video_too_small`, `video_too_long`,
    `video_pixel_rate`, `video_too_many_frames`."""
    if width * height > limits.video_megapixels * 1e6:
        raise InputError(
            "video_too_large",
            f"The video is {width} x {height}: scale it to at most {limits.video_megapixels:g} megapixels a frame.",
        )
    if max(width, height) > MAX_DECODED_SIDE_PIXELS:
        raise InputError(
            "video_too_large",
            f"The video is {width} x {height}: cut or scale it to at most {MAX_DECODED_SIDE_PIXELS} pixels a side.",
        )
    if 0 < min(width, height) < MIN_SIDE_PIXELS:  # 0 is not known yet
        raise InputError(
            "video_too_small",
            f"The video is {width} x {height}, too small to show anybody: each side must have at least {MIN_SIDE_PIXELS} "
            "pixels.",
        )
    if seconds > limits.video_seconds:
        raise InputError(
            "video_too_long", f"The video lasts {seconds:.0f} s, the limit is {limits.video_seconds:g} s: cut it."
        )
    if width * height * fps > limits.video_megapixels_per_second * 1e6:
        raise InputError(
            "video_pixel_rate",
            f"The video has {width} x {height} pixels at {fps:.0f} frames a second: send it smaller or at a lower "
            f"rate (at most {limits.video_megapixels_per_second:g} megapixels a second).",
        )
    if frames > limits.video_frames:
        raise InputError(
            "video_too_many_frames",
            f"The video has {frames} frames, the limit is {limits.video_frames}: cut it, or lower its rate.",
        )
