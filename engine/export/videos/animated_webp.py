"""Animated WebP, written frame by frame: each is a picture of its own, laid into the file as soon as it is coded.

libwebp's own writer of animations holds every coded frame until the last one is there. This one holds none. Each frame
covers the canvas and hangs on no other, so that any can be searched for at once.

Source: the WebP Container Specification (Google): RIFF chunks `VP8X`, `ANIM`, and an `ANMF` for each frame.

Measured on 100 frames of a woman at 600x600 whose mouth opens. libwebp coded whole pictures, or its writer of
animations coded what changes. The PSNR is of brightness; the deviation is the mean one over time of what never changes,
in grey levels:

| coding | kB | PSNR | deviation | ms a frame |
| --- | --- | --- | --- | --- |
| animation, quality 90, method 1 | 2073 | 41.7 | 0.16 | 17 |
| whole pictures, quality 90, method 2 | 2808 | 43.4 | 0.08 | 20 |
| whole pictures, quality 85, method 1 | 2560 | 42.2 | 0.10 | 14 |
| whole pictures, quality 85, method 2, which is used | 2078 | 41.5 | 0.10 | 13 |

Where everything sways a little (the idling portrait of `engine.export.videos.encoders`), the grain of whole pictures trembles more
from frame to frame, 1.2 grey levels in the median for 0.5, and no more where it repeats: 1.0 there for 1.7. It has 2327 kB
for 2148; quality 90 would take 3152, and tremble by 1.0.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import suppress
from errno import EFBIG

import numpy as np
from PIL import Image

from engine.export import synthetic
from engine.export.videos.encoders import VideoTarget

WEBP_QUALITY = 85
"""How fine libwebp codes, of 100."""
WEBP_METHOD = 2
"""How long libwebp may look for what is small, from 0 to 6."""

_XMP_FLAG, _ANIMATION_FLAG, _ALPHA_FLAG = 0x04, 0x02, 0x10
"""Flags of the extended header."""
_NO_BLENDING_FLAG = b"\x02"
"""Flag of a frame that stands in place of what was shown before, transparent parts included."""
_MAX_RIFF_BYTES = 2**32 - 2
"""Bytes that a RIFF file can say that it has, at most."""


class WebpEncoder:
    """Frames into an animated WebP; `transparent` ones keep their alpha."""

    def __init__(self, target: VideoTarget, transparent: bool):
        self._target = target
        self._size, self._transparent, self._synthetic = target.size, transparent, target.synthetic
        self._count = 0
        self._file = target.path.open("wb")
        flags = _ANIMATION_FLAG | (_ALPHA_FLAG if transparent else 0) | (_XMP_FLAG if target.synthetic else 0)
        repeats = 0 if target.loop else 1  # 0 is without end
        self._file.write(b"RIFF" + bytes(4) + b"WEBP")
        self._file.write(_chunk(b"VP8X", bytes([flags, 0, 0, 0]) + _sides(target.size)))
        self._file.write(_chunk(b"ANIM", bytes(4) + repeats.to_bytes(2, "little")))

    def prepare(self, rgb: np.ndarray, alpha: np.ndarray | None) -> np.ndarray:
        """The pixels as Pillow takes them."""
        if alpha is None or not self._transparent:
            return rgb.copy()
        return np.dstack([rgb, np.round(alpha * np.float32(255)).astype(np.uint8)])

    def add(self, prepared: np.ndarray) -> None:
        """Code a frame and write it."""
        coded = io.BytesIO()
        Image.fromarray(prepared).save(coded, "WEBP", quality=WEBP_QUALITY, method=WEBP_METHOD)
        picture = b"".join(_picture_chunks(coded.getvalue()))
        begins, ends = (round(1000 * self._target.begins(k)) for k in (self._count, self._count + 1))
        head = bytes(6) + _sides(self._size) + (ends - begins).to_bytes(3, "little") + _NO_BLENDING_FLAG
        self._write(_chunk(b"ANMF", head + picture))
        self._count += 1

    def finish(self) -> None:
        """Complete the file and close it."""
        if self._synthetic:
            self._write(_chunk(b"XMP ", synthetic.XMP_PACKET))
        size = self._file.tell()
        self._file.seek(4)
        self._file.write((size - 8).to_bytes(4, "little"))
        self._file.close()

    def abandon(self) -> None:
        """Close the file, whatever state it is in."""
        with suppress(OSError):
            self._file.close()

    def _write(self, chunk: bytes) -> None:
        if self._file.tell() + len(chunk) > _MAX_RIFF_BYTES:
            raise OSError(EFBIG, "A WebP has at most 4 GB")
        self._file.write(chunk)


def _chunk(name: bytes, content: bytes) -> bytes:
    return name + len(content).to_bytes(4, "little") + content + bytes(len(content) % 2)


def _sides(size: tuple[int, int]) -> bytes:
    """Width and height as a header has them."""
    return b"".join((side - 1).to_bytes(3, "little") for side in size)


def _picture_chunks(webp: bytes) -> Iterator[bytes]:
    """The chunks of a WebP of one picture that hold its pixels."""
    at = 12
    while at < len(webp):
        length = int.from_bytes(webp[at + 4 : at + 8], "little")
        end = at + 8 + length + length % 2
        if webp[at : at + 4] in (b"ALPH", b"VP8 ", b"VP8L"):
            yield webp[at:end]
        at = end
