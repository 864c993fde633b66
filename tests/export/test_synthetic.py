"""The mark of synthetic media: read back from every format by other means than those that wrote it."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import av
import numpy as np
import pytest
from PIL import Image

from engine.export.synthetic import append_to_mp4, mark_image
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.media.image import write_image
from engine.media.video import probe_video

COMPOSITE = "http://cv.iptc.org/newscodes/digitalsourcetype/compositeSynthetic"
SOURCE_TYPE = "{http://iptc.org/std/Iptc4xmpExt/2008-02-29/}DigitalSourceType"
PIXELS = np.random.default_rng(3).integers(0, 256, (48, 64, 3), np.uint8)


def write(path: Path, format: str, synthetic: bool = True) -> Path:
    with VideoWriter(VideoTarget(path, (64, 48), 25, format, synthetic=synthetic)) as writer:  # type: ignore[arg-type]
        for k in range(12):
            writer.write(np.roll(PIXELS, 4 * k, axis=1))
    return path


def source_type(xmp: bytes) -> str | None:
    """What an XMP packet names as the digital source type."""
    return next(ElementTree.fromstring(xmp.decode("utf-8")).iter(SOURCE_TYPE)).text


def boxes(data: bytes) -> Iterator[tuple[bytes, int, int]]:
    """The boxes of an MP4 file: type, where the content begins, where it ends."""
    at = 0
    while at < len(data):
        size = int.from_bytes(data[at : at + 4], "big")
        assert size >= 8
        yield data[at + 4 : at + 8], at + 8, at + size
        at += size
    assert at == len(data)


def decoded(path: Path) -> list[bytes]:
    with av.open(str(path)) as container:
        return [frame.to_ndarray(format="rgb24").tobytes() for frame in container.decode(video=0)]


def test_mp4(tmp_path: Path) -> None:
    path = write(tmp_path / "out.mp4", "mp4")
    data = path.read_bytes()
    found = {kind: data[start:end] for kind, start, end in boxes(data)}
    assert found[b"uuid"][:16].hex() == "be7acfcb97a942e89c71999491e3afac"
    assert source_type(found[b"uuid"][16:]) == COMPOSITE
    kinds = [kind for kind, _, _ in boxes(data)]
    assert kinds.index(b"moov") < kinds.index(b"mdat") < kinds.index(b"uuid")  # still ready to be streamed
    with av.open(str(path)) as container:
        assert container.metadata["comment"].startswith("Synthetic")


def test_webm(tmp_path: Path) -> None:
    with av.open(str(write(tmp_path / "out.webm", "webm"))) as container:
        tags = {name.lower(): value for name, value in container.metadata.items()}
    assert tags["digital_source_type"] == COMPOSITE and tags["comment"].startswith("Synthetic")


def test_webp(tmp_path: Path) -> None:
    path = write(tmp_path / "out.webp", "webp")
    with Image.open(path) as image:
        assert source_type(image.info["xmp"]) == COMPOSITE
        assert image.n_frames == 12
    assert int.from_bytes(path.read_bytes()[4:8], "little") + 8 == path.stat().st_size
    assert probe_video(path).frames == 12


def test_gif(tmp_path: Path) -> None:
    marked, plain = write(tmp_path / "out.gif", "gif"), write(tmp_path / "plain.gif", "gif", synthetic=False)
    data = marked.read_bytes()
    begin = data.index(b"\x21\xff\x0bXMP DataXMP") + 14
    assert source_type(data[begin : data.index(b"<?xpacket end", begin)] + b'<?xpacket end="r"?>') == COMPOSITE
    assert decoded(marked) == decoded(plain) and data[-1:] == b"\x3b"
    with Image.open(marked) as image:
        assert image.n_frames == 12


def test_a_sequence_of_png(tmp_path: Path) -> None:
    with zipfile.ZipFile(write(tmp_path / "out.zip", "png")) as archive:
        for k, name in enumerate(archive.namelist()):
            with Image.open(io.BytesIO(archive.read(name))) as image:
                assert source_type(image.info["xmp"]) == COMPOSITE
                assert np.array_equal(np.asarray(image), np.roll(PIXELS, 4 * k, axis=1))


@pytest.mark.parametrize("name", ["picture.jpg", "picture.png"])
def test_pictures(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    write_image(path, PIXELS)
    with Image.open(path) as image:
        before = np.asarray(image)
    mark_image(path)
    with Image.open(path) as image:
        assert source_type(image.info["xmp"]) == COMPOSITE
        assert np.array_equal(np.asarray(image), before)
    with Image.open(path) as image:
        image.verify()


def test_players_see_the_same_frames_with_and_without(tmp_path: Path) -> None:
    """The same file, before and after it is marked: coding twice may give two files that differ in a bit."""
    plain = write(tmp_path / "out.mp4", "mp4", synthetic=False)
    before = decoded(plain)
    append_to_mp4(plain)
    assert decoded(plain) == before
    assert COMPOSITE.encode() in plain.read_bytes()


def test_a_marked_webm_shows_the_same(tmp_path: Path) -> None:
    marked, plain = (write(tmp_path / name, "webm", synthetic=name == "marked") for name in ("marked", "plain"))
    with_mark, without = (np.frombuffer(b"".join(decoded(path)), np.uint8).astype(float) for path in (marked, plain))
    assert b"compositeSynthetic" in marked.read_bytes() and b"compositeSynthetic" not in plain.read_bytes()
    assert with_mark.shape == without.shape
    assert np.abs(with_mark - without).mean() < 2


def test_an_animated_webp_shows_the_same_with_and_without(tmp_path: Path) -> None:
    marked, plain = write(tmp_path / "marked", "webp"), write(tmp_path / "plain", "webp", synthetic=False)
    with Image.open(marked) as one, Image.open(plain) as other:
        assert "xmp" not in other.info
        for k in range(12):
            one.seek(k)
            other.seek(k)
            assert np.array_equal(np.asarray(one), np.asarray(other))


def test_a_webp_that_never_moves(tmp_path: Path) -> None:
    shown = []
    for synthetic in (True, False):
        path = tmp_path / f"{synthetic}.webp"
        with VideoWriter(VideoTarget(path, (64, 48), 25, "webp", synthetic=synthetic)) as writer:
            for _ in range(3):
                writer.write(PIXELS)
        with Image.open(path) as image:
            assert (source_type(image.info["xmp"]) == COMPOSITE) if synthetic else "xmp" not in image.info
            shown.append(np.asarray(image.convert("RGBA")))
    assert shown[0].shape == (48, 64, 4) and np.array_equal(*shown)
