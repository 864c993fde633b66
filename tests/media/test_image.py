"""Still pictures: pixels upright and in sRGB, whatever the file; bad files by their codes."""

from __future__ import annotations

import io
import struct
import warnings
import zlib
from pathlib import Path

import cv2
import numpy as np
import pillow_heif
import pytest
from footage import quadrants, write_clip
from PIL import Image, ImageCms

from engine.errors import InputError
from engine.media.image import read_image, write_image
from engine.media.limits import Limits
from engine.perception.face.faces import find_faces
from engine.perception.pose.people import find_people

PIXELS = quadrants(64, 48)


def refused(path: Path, limits: Limits | None = None) -> InputError:
    with pytest.raises(InputError) as caught:
        read_image(path, limits)
    assert str(path) not in caught.value.detail
    return caught.value


def refusal(path: Path, limits: Limits | None = None) -> str:
    return refused(path, limits).code


def near(rgb: np.ndarray, expected: np.ndarray, tolerance: float) -> bool:
    """Whether the middles of the quarters agree."""
    assert rgb.dtype == np.uint8 and rgb.shape == expected.shape and rgb.flags.c_contiguous
    height, width = rgb.shape[:2]
    rows, columns = [height // 4, height * 3 // 4], [width // 4, width * 3 // 4]
    difference = rgb[np.ix_(rows, columns)].astype(int) - expected[np.ix_(rows, columns)]
    return bool(np.abs(difference).max() <= tolerance)


@pytest.mark.parametrize(
    ("format", "tolerance", "options"),
    [
        ("png", 0, {}),
        ("gif", 3, {}),
        ("webp", 0, {"lossless": True}),
        ("webp", 8, {"quality": 90}),
        ("jpeg", 8, {"quality": 95}),
        ("avif", 8, {"quality": 90}),
    ],
)
def test_formats(tmp_path: Path, format: str, tolerance: float, options: dict[str, object]) -> None:
    Image.fromarray(PIXELS).save(tmp_path / "picture", format=format, **options)
    picture = read_image(tmp_path / "picture")
    assert near(picture.rgb, PIXELS, tolerance)
    assert picture.format == f"image/{format}" and picture.alpha is None


def test_heic(tmp_path: Path) -> None:
    pillow_heif.from_pillow(Image.fromarray(PIXELS)).save(tmp_path / "picture.heic", quality=95)
    picture = read_image(tmp_path / "picture.heic")
    assert near(picture.rgb, PIXELS, 8) and picture.format == "image/heic"


def test_heic_that_is_turned_twice_over_is_turned_once(tmp_path: Path) -> None:
    """Phones write the turn as a property of the picture (`irot`) and into EXIF, too: the property alone counts."""
    exif = Image.Exif()
    exif[0x0112] = 6
    stored = Image.fromarray(np.ascontiguousarray(np.rot90(PIXELS, 1)))
    pillow_heif.from_pillow(stored).save(tmp_path / "a.heic", quality=95, exif=exif.tobytes())
    content = (tmp_path / "a.heic").read_bytes()
    entry = bytes.fromhex("01120003 00000001")
    assert b"irot" in content and content.count(entry) == 1
    at = content.index(entry) + len(entry)  # the writer says 1 there, phones say what the property says
    (tmp_path / "a.heic").write_bytes(content[:at] + b"\0\6" + content[at + 2 :])
    picture = read_image(tmp_path / "a.heic")
    assert near(picture.rgb, PIXELS, 8)


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("format", ["jpeg", "png", "webp", "heic"])
def test_exif_orientation_is_applied(tmp_path: Path, orientation: int, format: str) -> None:
    to_stored = {
        1: lambda a: a,
        2: lambda a: a[:, ::-1],
        3: lambda a: a[::-1, ::-1],
        4: lambda a: a[::-1],
        5: lambda a: a.swapaxes(0, 1),
        6: lambda a: np.rot90(a, 1),
        7: lambda a: np.rot90(a, 1)[:, ::-1],
        8: lambda a: np.rot90(a, -1),
    }[orientation]
    stored = Image.fromarray(np.ascontiguousarray(to_stored(PIXELS)))
    exif = Image.Exif()
    exif[0x0112] = orientation
    path = tmp_path / "picture"
    if format == "heic":
        file = pillow_heif.from_pillow(stored)
        file.info["exif"] = exif.tobytes()
        file.save(path, quality=95)
    else:
        stored.save(path, format=format, exif=exif, quality=95)
    assert near(read_image(path).rgb, PIXELS, 12)


@pytest.mark.parametrize("channels", [1, 3, 4])
def test_16_bits(tmp_path: Path, channels: int) -> None:
    ramp = np.linspace(0, 65535, 64).astype(np.uint16)
    stored = np.broadcast_to(ramp[None, :, None], (48, 64, channels)).copy()
    if channels == 4:
        stored[..., 3] = 65535
    cv2.imwrite(str(tmp_path / "picture.png"), stored)
    picture = read_image(tmp_path / "picture.png")
    assert picture.alpha is None
    assert np.abs(picture.rgb.astype(float) - (ramp / 257)[None, :, None]).max() <= 1


@pytest.mark.parametrize("mode", ["L", "1", "P", "LA", "RGBA", "CMYK"])
def test_kinds_of_pixels(tmp_path: Path, mode: str) -> None:
    grey = np.full((48, 64), 0, np.uint8)
    grey[:, 32:] = 255
    image = Image.fromarray(grey).convert("RGB").convert(mode)
    image.save(tmp_path / "picture", format="jpeg" if mode == "CMYK" else "png")
    rgb = read_image(tmp_path / "picture").rgb
    assert rgb.shape == (48, 64, 3)
    assert rgb[24, 8].max() <= 3 and rgb[24, 56].min() >= 252


def test_alpha(tmp_path: Path) -> None:
    alpha = np.linspace(0, 255, 64).astype(np.uint8)[None].repeat(48, 0)
    image = Image.fromarray(PIXELS)
    image.putalpha(Image.fromarray(alpha))
    for format in ("png", "webp"):
        image.save(tmp_path / "picture", format=format, lossless=True)
        picture = read_image(tmp_path / "picture")
        assert picture.alpha is not None and picture.alpha.dtype == np.float32
        assert np.abs(picture.alpha - alpha / 255).max() < 1e-6
        assert near(picture.rgb, PIXELS, 0)


def test_a_transparent_palette_entry_is_alpha(tmp_path: Path) -> None:
    image = Image.fromarray(np.repeat(np.arange(2, dtype=np.uint8)[None], 32, 1).reshape(1, 64).repeat(48, 0), "P")
    image.putpalette([200, 30, 30, 30, 200, 30])
    image.save(tmp_path / "picture.png", transparency=0)
    picture = read_image(tmp_path / "picture.png")
    assert picture.alpha is not None
    assert picture.alpha[0, 0] == 0 and picture.alpha[0, 63] == 1
    assert picture.rgb[0, 63].tolist() == [30, 200, 30]


BENEATH = (255, 0, 255)


def cut_out(mode: str) -> tuple[Image.Image, dict[str, object]]:
    """`PIXELS`, of which the left third is transparent and magenta beneath, as background removers leave it; and how to
    save it."""
    rgb = PIXELS.copy()
    rgb[:, :21] = BENEATH
    alpha = np.full(rgb.shape[:2], 255, np.uint8)
    alpha[:, :21] = 0
    whole = Image.fromarray(np.dstack([rgb, alpha]))
    if mode == "P":
        paletted = Image.fromarray(rgb).quantize(8, dither=Image.Dither.NONE)
        return paletted, {"transparency": paletted.getpixel((0, 0))}
    if mode == "LA":
        return whole.convert("LA"), {}
    return whole, {"lossless": True, "exact": True} if mode == "webp" else {}


@pytest.mark.parametrize("mode", ["RGBA", "LA", "P", "webp", "16 bits"])
def test_what_alpha_hides_is_nowhere_in_the_pixels(tmp_path: Path, mode: str) -> None:
    """What is transparent has the colours of the nearest that is not, whichever way the file says so."""
    image, options = cut_out(mode)
    path = tmp_path / "picture"
    if mode == "16 bits":
        deep = np.asarray(image)[..., [2, 1, 0, 3]].astype(np.uint16) * 257
        path.write_bytes(cv2.imencode(".png", deep)[1].tobytes())
    else:
        image.save(path, format="webp" if mode == "webp" else "png", **options)
    picture = read_image(path)
    assert picture.alpha is not None
    assert picture.alpha[:, :18].max() == 0 and picture.alpha[:, 24:].min() == 1
    expected = np.where(np.arange(64)[None, :, None] < 21, PIXELS[:, 24:25], PIXELS)
    if mode == "LA":
        expected = np.asarray(Image.fromarray(expected).convert("L").convert("RGB"))
    assert np.abs(picture.rgb.astype(int) - expected).max() <= 1


@pytest.mark.parametrize("mode", ["RGBA", "LA"])
def test_a_picture_of_which_nothing_is_seen_is_refused_in_words(tmp_path: Path, mode: str) -> None:
    image = Image.fromarray(PIXELS).convert(mode)
    image.putalpha(0)
    image.save(tmp_path / "picture.png")
    error = refused(tmp_path / "picture.png")
    assert error.code == "image_transparent" and "transparent" in error.detail


def test_fully_opaque_alpha_is_none(tmp_path: Path) -> None:
    Image.fromarray(PIXELS).convert("RGBA").save(tmp_path / "picture.png")
    assert read_image(tmp_path / "picture.png").alpha is None


def profile(name: str) -> bytes:
    """An ICC profile written by hand: matrix and curve, gamma 2.2, the primaries of Adobe RGB (D50-adapted)."""

    def number(value: float) -> bytes:
        return struct.pack(">i", round(value * 65536))

    columns = {
        "rXYZ": (0.60974, 0.31111, 0.01947),
        "gXYZ": (0.20528, 0.62567, 0.06087),
        "bXYZ": (0.14919, 0.06322, 0.74457),
        "wtpt": (0.9642, 1.0, 0.8249),
    }
    tags = {key: b"XYZ \0\0\0\0" + b"".join(map(number, value)) for key, value in columns.items()}
    curve = b"curv\0\0\0\0" + struct.pack(">I", 1) + struct.pack(">H", round(2.19921875 * 256)) + b"\0\0"
    tags |= {"rTRC": curve, "gTRC": curve, "bTRC": curve}
    text = name.encode() + b"\0"
    tags["desc"] = b"desc\0\0\0\0" + struct.pack(">I", len(text)) + text + bytes(78 + (-len(text)) % 4)
    tags["cprt"] = b"text\0\0\0\0none\0\0\0\0"
    offset = 128 + 4 + 12 * len(tags)
    table, body = struct.pack(">I", len(tags)), b""
    for key, value in tags.items():
        table += key.encode() + struct.pack(">II", offset + len(body), len(value))
        body += value
    header = struct.pack(">I4sI4s4s4s", 128 + len(table) + len(body), b"none", 0x02100000, b"mntr", b"RGB ", b"XYZ ")
    header += bytes(12) + b"acsp" + bytes(28) + number(0.9642) + number(1) + number(0.8249)
    return header + bytes(128 - len(header)) + table + body


@pytest.mark.parametrize("format", ["jpeg", "png", "webp", "heic"])
def test_profiles_are_converted_to_srgb(tmp_path: Path, format: str) -> None:
    # (200, 100, 50) in sRGB is (178.9, 100.3, 57.6) in Adobe RGB (1998), by its definition.
    linear = np.array([((c / 255 + 0.055) / 1.055) ** 2.4 for c in (200, 100, 50)])
    to_adobe = np.array([[0.71513, 0.28487, 0.0], [0.0, 1.0, 0.0], [0.0, 0.04117, 0.95883]])
    stored = np.round(255 * (to_adobe @ linear) ** (1 / 2.19921875)).astype(np.uint8)
    image = Image.fromarray(np.broadcast_to(stored, (48, 64, 3)).copy())
    path = tmp_path / "picture"
    if format == "heic":
        file = pillow_heif.from_pillow(image)
        file.info["icc_profile"] = profile("a wide one")
        file.save(path, quality=-1)
    else:
        image.save(path, format=format, icc_profile=profile("a wide one"), quality=98, lossless=True)
    assert np.abs(read_image(path).rgb[24, 32].astype(int) - [200, 100, 50]).max() <= 3


def test_profiles_with_alpha_and_grey(tmp_path: Path) -> None:
    image = Image.fromarray(PIXELS).convert("RGBA")
    image.putalpha(128)
    image.save(tmp_path / "picture.png", icc_profile=ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes())
    picture = read_image(tmp_path / "picture.png")
    assert (
        near(picture.rgb, PIXELS, 2) and picture.alpha is not None and picture.alpha[0, 0] == pytest.approx(128 / 255)
    )


@pytest.mark.parametrize("spoilt", [b"", b"rubbish", profile("x")[:200]])
def test_a_broken_profile_is_ignored(tmp_path: Path, spoilt: bytes) -> None:
    Image.fromarray(PIXELS).save(tmp_path / "picture.png", icc_profile=spoilt)
    assert near(read_image(tmp_path / "picture.png").rgb, PIXELS, 0)


def chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def test_a_claim_of_100000_by_100000_is_refused(tmp_path: Path) -> None:
    claims = {
        "a.png": b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", 100_000, 100_000, 8, 2, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(bytes(1000)))
        + chunk(b"IEND", b""),
        "a.gif": b"GIF89a" + struct.pack("<HHBBB", 65535, 65535, 0, 0, 0) + b"\x2c" + struct.pack("<HHHHB", 0, 0, 65535, 65535, 0) + b"\x02\x02\x4c\x01\x00\x3b",
        "a.jpg": b"\xff\xd8\xff\xc0\x00\x11\x08" + struct.pack(">HH", 65500, 65500) + b"\x03\x01\x11\x00\x02\x11\x01\x03\x11\x01\xff\xd9",
    }  # fmt: skip
    for name, content in claims.items():
        (tmp_path / name).write_bytes(content)
        error = refused(tmp_path / name)
        assert error.code == "image_too_large"
        assert error.detail == "The picture is too large: scale it down to at most 40 megapixels."


def test_a_size_that_is_known_is_told_in_our_own_words(tmp_path: Path) -> None:
    """From 89 megapixels on, Pillow warns by itself."""
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", 12_000, 9_000, 8, 2, 0, 0, 0))
    (tmp_path / "a.png").write_bytes(b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", b"") + chunk(b"IEND", b""))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        error = refused(tmp_path / "a.png")
    assert error.code == "image_too_large"
    assert error.detail == ("The picture is too large (12000 x 9000 pixels): scale it down to at most 40 megapixels.")


@pytest.mark.parametrize("format", ["png", "jpeg", "webp", "gif", "heic", "avif"])
def test_the_limit_on_pixels_counts_for_all(tmp_path: Path, format: str) -> None:
    image = Image.fromarray(np.zeros((100, 120, 3), np.uint8))
    path = tmp_path / "picture"
    if format == "heic":
        pillow_heif.from_pillow(image).save(path)
    else:
        image.save(path, format=format)
    assert read_image(path, Limits(image_megapixels=0.0121)).rgb.shape == (100, 120, 3)
    assert refusal(path, Limits(image_megapixels=0.0119)) == "image_too_large"


@pytest.mark.parametrize("size", [(1, 39_000), (39_000, 1), (20, 16_385)])
def test_a_long_picture_of_few_pixels_is_refused(tmp_path: Path, size: tuple[int, int]) -> None:
    """Within 40 megapixels, and yet detectors and warps abort the process from 32,767 pixels a side on."""
    Image.new("RGB", size).save(tmp_path / "a.png")
    error = refused(tmp_path / "a.png")
    assert error.code == "image_too_large" and f"{size[0]} x {size[1]}" in error.detail and "16384" in error.detail


@pytest.mark.parametrize("size", [(1, 1), (15, 400), (400, 15)])
def test_a_picture_in_which_nobody_can_be_seen_is_refused(tmp_path: Path, size: tuple[int, int]) -> None:
    Image.new("RGB", size).save(tmp_path / "a.png")
    assert refusal(tmp_path / "a.png") == "image_too_small"


def test_the_longest_sides_that_are_taken_are_looked_at(tmp_path: Path) -> None:
    """No detector breaks down on them, neither for faces nor for bodies."""
    for turn in (1, -1):
        Image.new("RGB", (16_384, 16)[::turn], (90, 120, 60)).save(tmp_path / "a.png")
        rgb = read_image(tmp_path / "a.png").rgb
        assert find_faces(rgb) == [] and find_people(rgb) == []


@pytest.mark.parametrize("format", ["png", "jpeg", "webp", "heic", "avif"])
def test_truncated(tmp_path: Path, format: str) -> None:
    noise = Image.fromarray(np.random.default_rng(0).integers(0, 255, (64, 64, 3)).astype(np.uint8))
    path = tmp_path / "picture"
    if format == "heic":
        pillow_heif.from_pillow(noise).save(path)
    else:
        noise.save(path, format=format)
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    assert refusal(path) in ("image_truncated", "image_unreadable")
    if format in ("png", "jpeg", "webp"):
        assert refusal(path) == "image_truncated"


def test_a_whole_webp_that_is_damaged_is_not_called_cut(tmp_path: Path) -> None:
    path = tmp_path / "picture.webp"
    Image.fromarray(PIXELS).save(path)
    content = path.read_bytes()
    path.write_bytes(content[:20] + bytes(len(content) - 20))
    assert refusal(path) == "image_unreadable"
    path.write_bytes(content[:-1])
    assert refusal(path) == "image_truncated"


def test_empty_and_foreign_files(tmp_path: Path) -> None:
    path = tmp_path / "picture.jpg"
    path.touch()
    assert refusal(path) == "file_empty"
    path.write_bytes(b"hello")
    assert refusal(path) == "not_an_image"
    write_clip(tmp_path / "clip.mp4", [PIXELS] * 3).rename(path)
    assert refusal(path) == "not_an_image"
    path.write_bytes(bytes(2000))
    assert refusal(path, Limits(image_bytes=1000)) == "file_too_large"
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(100))
    assert refusal(path) == "image_unreadable"


def test_a_wrong_name_does_not_matter(tmp_path: Path) -> None:
    Image.fromarray(PIXELS).save(tmp_path / "picture.png")
    (tmp_path / "picture.png").rename(tmp_path / "picture.jpg")
    assert read_image(tmp_path / "picture.jpg").format == "image/png"


@pytest.mark.parametrize("format", ["png", "jpeg", "webp", "gif", "heic", "avif"])
def test_random_damage_never_ends_in_anything_but_an_input_error(tmp_path: Path, format: str) -> None:
    buffer = io.BytesIO()
    if format == "heic":
        pillow_heif.from_pillow(Image.fromarray(PIXELS)).save(buffer)
    else:
        Image.fromarray(PIXELS).save(buffer, format=format)
    content, rng, path = buffer.getvalue(), np.random.default_rng(3), tmp_path / "spoilt"
    for trial in range(60):
        spoilt = bytearray(content)
        for at in rng.integers(0, len(spoilt), 1 + trial % 10):
            spoilt[at] = rng.integers(256)
        path.write_bytes(spoilt)
        try:
            assert read_image(path).rgb.dtype == np.uint8
        except InputError as error:
            assert error.code and error.detail


def test_what_is_written_is_read(tmp_path: Path) -> None:
    alpha = np.linspace(0, 1, 64, dtype=np.float32)[None].repeat(48, 0)
    for name, tolerance in (("a.png", 0), ("a.jpg", 10), ("a.webp", 10)):
        write_image(tmp_path / name, PIXELS)
        assert near(read_image(tmp_path / name).rgb, PIXELS, tolerance)
    for name in ("a.png", "a.webp"):
        write_image(tmp_path / name, PIXELS, alpha)
        read = read_image(tmp_path / name).alpha
        assert read is not None and np.abs(read - alpha).max() < 0.01
    with pytest.raises(ValueError, match="alpha"):
        write_image(tmp_path / "a.jpg", PIXELS, alpha)


def test_real_portraits(media) -> None:  # type: ignore[no-untyped-def]
    for name, shape in {
        "cartoon_boy_3d.jpg": (852, 852, 3),
        "painting_mona_lisa.jpg": (1280, 720, 3),
        "photo_bw_einstein.jpg": (500, 375, 3),
        "pair1_smile.png": (256, 256, 3),
    }.items():
        picture = read_image(media(f"portraits/{name}"))
        assert picture.rgb.shape == shape and picture.alpha is None


def dated(path: Path, told: str) -> Path:
    """A grey JPEG whose EXIF says that it was taken then."""
    picture = Image.new("RGB", (64, 64), (90, 90, 90))
    exif = picture.getexif()
    exif.get_ifd(0x8769)[0x9003] = told
    picture.save(path, exif=exif)
    return path


@pytest.mark.parametrize(
    ("told", "year"),
    [("1984:05:01 12:00:00", 1984), ("0000:00:00 00:00:00", None), ("yesterday", None), ("\x00\x00", None)],
)
def test_the_year_is_what_exif_says(told: str, year: int | None, tmp_path: Path) -> None:
    assert read_image(dated(tmp_path / "dated.jpg", told)).year == year


def test_exif_that_is_no_exif_says_no_year(tmp_path: Path) -> None:
    Image.new("RGB", (64, 64)).save(tmp_path / "odd.jpg", exif=b"Exif\x00\x00II*\x00\xff\xff\xff\x7f")
    assert read_image(tmp_path / "odd.jpg").year is None
