"""What files are, by their first bytes alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pillow_heif
import pytest
from footage import counter, write_clip
from PIL import Image

from engine.media.sniff import IMAGE_TYPES, VIDEO_TYPES, is_still_webp, sniff, sniff_bytes

PICTURE = Image.fromarray(counter(5))


@pytest.mark.parametrize(
    ("ending", "media_type"),
    [("jpg", "image/jpeg"), ("png", "image/png"), ("webp", "image/webp"), ("gif", "image/gif"), ("avif", "image/avif")],
)
def test_pictures(tmp_path: Path, ending: str, media_type: str) -> None:
    path = tmp_path / "nameless"
    PICTURE.save(path, format={"jpg": "jpeg"}.get(ending, ending))
    assert sniff(path) == media_type and media_type in IMAGE_TYPES


def test_heic(tmp_path: Path) -> None:
    pillow_heif.from_pillow(PICTURE).save(tmp_path / "picture")
    assert sniff(tmp_path / "picture") == "image/heic"


@pytest.mark.parametrize(
    ("ending", "codec", "media_type"),
    [
        ("mp4", "libx264", "video/mp4"),
        ("mov", "libx264", "video/quicktime"),
        ("mkv", "libx264", "video/x-matroska"),
        ("webm", "libvpx", "video/webm"),
        ("avi", "mpeg4", "video/x-msvideo"),
    ],
)
def test_videos(tmp_path: Path, ending: str, codec: str, media_type: str) -> None:
    path = write_clip(tmp_path / f"clip.{ending}", [counter(k) for k in range(3)], codec=codec)
    path.rename(tmp_path / "nameless")
    assert sniff(tmp_path / "nameless") == media_type and media_type in VIDEO_TYPES


def test_animations_are_told_from_stills(tmp_path: Path) -> None:
    more = [Image.fromarray(counter(k)) for k in range(1, 4)]
    PICTURE.save(tmp_path / "moving.png", save_all=True, append_images=more)
    PICTURE.save(tmp_path / "moving.webp", save_all=True, append_images=more)
    PICTURE.save(tmp_path / "still.webp")
    PICTURE.putalpha(Image.fromarray(np.full((48, 64), 99, np.uint8)))
    PICTURE.save(tmp_path / "still_alpha.webp")
    assert sniff(tmp_path / "moving.png") == "image/apng"
    assert not is_still_webp(tmp_path / "moving.webp")
    assert is_still_webp(tmp_path / "still.webp") and is_still_webp(tmp_path / "still_alpha.webp")


@pytest.mark.parametrize(
    ("head", "media_type"),
    [
        (b"", None),
        (b"\xff", None),
        (b"hello world, this is a text", None),
        (b"Hierarchy\nroot Hips\n{", "text/x-bvh"),
        (b"HIERARCHY\nROOT Hips\n{", "text/x-bvh"),
        (b"\xef\xbb\xbf \r\nHIERARCHY\r\nROOT Hips", "text/x-bvh"),
        (b"a HIERARCHY of ranks", None),
        (b"glTF\x02\x00\x00\x00", "model/gltf-binary"),
        (b'{"asset":{"version":"2.0"}', "model/gltf+json"),
        (b'\xef\xbb\xbf{\r\n  "accessors" : [', "model/gltf+json"),
        (b'{"name": "asset"}', None),
        (b'{"asset"', None),
        (b'["asset", 1]', None),
        (b"<html><body>", None),
        (b"#EXTM3U\n", None),
        (b"%PDF-1.7", None),
        (b"PK\x03\x04", "application/zip"),
        (b"\x1f\x8b\x08", "application/gzip"),
        (b"BZh9", "application/x-bzip2"),
        (b"\xfd7zXZ\x00", "application/x-xz"),
        (bytes(257) + b"ustar", "application/x-tar"),
        (b"RIFF\x00\x00\x00\x00WAVEfmt ", "audio/wav"),
        (b"RIFF\x00\x00\x00\x00ACON", None),
        (b"ID3\x04", "audio/mpeg"),
        (b"OggS\x00", "audio/ogg"),
        (b"fLaC\x00", "audio/flac"),
        (b"\x00\x00\x00\x18ftypM4A \x00\x00\x00\x00", "audio/mp4"),
        (b"\x00\x00\x00\x18ftyp3gp4\x00\x00\x00\x00isom3gp4", "video/mp4"),
        (b"\x00\x00\x00\x18ftypmif1\x00\x00\x00\x00mif1avif", "image/avif"),
        (b"\x00\x00\x00\x18ftypmif1\x00\x00\x00\x00mif1heic", "image/heic"),
        (b"\x00\x00\x00\x08wide\x00\x00\x00\x00mdat", "video/quicktime"),
    ],
)
def test_heads(head: bytes, media_type: str | None) -> None:
    assert sniff_bytes(head) == media_type
