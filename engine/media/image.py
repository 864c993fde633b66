"""Still pictures: any common file in, upright sRGB pixels out, and back."""

from __future__ import annotations

import io
import re
import struct
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import ExifTags, Image, ImageOps, UnidentifiedImageError

from engine.errors import InputError
from engine.imaging.filling.nearest import nearest_colours
from engine.media.limits import MAX_DECODED_SIDE_PIXELS, MIN_SIDE_PIXELS, Limits
from engine.media.sniff import IMAGE_TYPES, sniff

_FORMATS = {f"image/{name.lower()}": name for name in ("JPEG", "PNG", "WEBP", "AVIF", "GIF")}
"""Pillow's name of what a file begins like: its other decoders are neither asked nor loaded."""

FIRST_PHOTOGRAPH = 1826
"""The year of Niepce's view from his window: cameras whose clock was never set say less."""
_CUT_OUT = 0.01
"""A picture with more than this share of transparent pixels is a cut-out."""


@dataclass(frozen=True)
class Picture:
    """A decoded picture.

    rgb : uint8 (H, W, 3) sRGB, upright.
    alpha : float32 (H, W) [0, 1], None where opaque.
    format : the media type of the file it came from.
    year : in which it was taken, where the file says so (EXIF).
    """

    rgb: np.ndarray
    alpha: np.ndarray | None
    format: str
    year: int | None = None


def read_image(path: Path, limits: Limits | None = None) -> Picture:
    """Read a JPEG, PNG, WebP, HEIC, AVIF or GIF (its first frame) as upright 8-bit sRGB.

    EXIF orientation is applied, colour profiles are converted, 16-bit, grey, palette and CMYK pictures become RGB.
    What is wholly transparent has the colours of the nearest that is not: whatever the file keeps beneath, as background
    removers leave it, is seen by nobody.

    Raises `InputError`: `file_empty`, `file_too_large`, `not_an_image`, `image_too_large` and `image_too_small` (known
    from the header, before decoding), `image_truncated`, `image_unreadable`,
    `image_transparent` (all of it).
    """
    limits = limits or Limits()
    media_type = _admit(path, limits)
    try:
        if media_type == "image/heic":
            image = _read_heic(path, limits)
        else:
            with _opened(path, media_type) as opened:
                _check_size(opened.size, limits)
                opened.load()
                image = ImageOps.exif_transpose(opened)
    except Image.DecompressionBombError:
        raise _too_large("", limits) from None
    except (OSError, SyntaxError, ValueError, EOFError, IndexError, RuntimeError, UnidentifiedImageError) as error:
        raise _broken(error, media_type == "image/webp" and _ends_early(path)) from error
    rgb, alpha = _to_srgb(image)
    if alpha is not None:
        rgb = _without_hidden_colours(rgb, alpha)
    return Picture(rgb, alpha, media_type, _year_taken(image))


def is_cut_out(alpha: np.ndarray | None) -> bool:
    """Whether a picture's own alpha (H, W) [0, 1] cuts something out of it: then it says what belongs to the picture. A few
    transparent pixels say nothing."""
    return alpha is not None and float(np.mean(alpha < 0.5)) > _CUT_OUT


def over_grey(rgb: np.ndarray, alpha: np.ndarray | None) -> np.ndarray:
    """`rgb` uint8 (H, W, 3) as a detector wants it, what is transparent in a plain grey."""
    return rgb if alpha is None else _over(rgb, alpha, 127)


def over_white(rgb: np.ndarray, alpha: np.ndarray | None) -> np.ndarray:
    """`rgb` uint8 (H, W, 3) as it is seen on white paper; `alpha` float32 (H, W) [0, 1], None where all is opaque."""
    return rgb if alpha is None else _over(rgb, alpha, 255)


def _over(rgb: np.ndarray, alpha: np.ndarray, level: int) -> np.ndarray:
    share = alpha[..., None]
    return (rgb * share + np.float32(level) * (1 - share) + np.float32(0.5)).astype(np.uint8)


def _without_hidden_colours(rgb: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    hidden = alpha == 0
    if hidden.all():
        raise InputError(
            "image_transparent",
            "The picture is transparent everywhere, nothing is to be seen: save it anew with its alpha.",
        )
    return nearest_colours(rgb, ~hidden) if hidden.any() else rgb


def write_image(path: Path, rgb: np.ndarray, alpha: np.ndarray | None = None, quality: int = 90) -> None:
    """Write `rgb` uint8 (H, W, 3), with `alpha` float32 (H, W) [0, 1] where given, in the format of the name's ending.

    `quality` (1 to 100) counts for JPEG and WebP. JPEG has no alpha: giving one is an error of the caller.
    """
    image = Image.fromarray(rgb)
    if alpha is not None:
        if path.suffix.lower() in (".jpg", ".jpeg"):
            raise ValueError("a JPEG cannot hold alpha")
        image.putalpha(Image.fromarray(np.round(alpha * 255).astype(np.uint8)))
    image.save(path, quality=quality)


def _admit(path: Path, limits: Limits) -> str:
    size = path.stat().st_size
    if size == 0:
        raise InputError("file_empty", "The picture file is empty (0 bytes): send it again.")
    if size > limits.image_bytes:
        raise InputError(
            "file_too_large",
            f"The picture file has {size / 1e6:.0f} MB, the limit is {limits.image_bytes / 1e6:.0f} MB: send a smaller "
            "one.",
        )
    media_type = sniff(path)
    if media_type == "image/apng":
        media_type = "image/png"
    if media_type not in IMAGE_TYPES:
        what = f"a file of type {media_type}" if media_type else "no picture"
        raise InputError("not_an_image", f"This is {what}: send a JPEG, PNG, WebP or HEIC picture.")
    return media_type


def _opened(path: Path, media_type: str) -> Image.Image:
    """The picture before it is decoded. Pillow's warning of large ones is not for users: they get our own limit."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Image.DecompressionBombWarning)
        return Image.open(path, formats=[_FORMATS[media_type]])


def _read_heic(path: Path, limits: Limits) -> Image.Image:
    import pi_heif  # few pictures need it: it is loaded for those alone

    heif = pi_heif.open_heif(path, convert_hdr_to_8bit=True)
    _check_size(heif.size, limits)
    return heif.to_pillow()


def _year_taken(image: Image.Image) -> int | None:
    """What EXIF's DateTimeOriginal begins with; None where there is none, or nonsense."""
    try:
        told = str(image.getexif().get_ifd(ExifTags.IFD.Exif).get(ExifTags.Base.DateTimeOriginal, ""))
    except (OSError, SyntaxError, ValueError, EOFError, IndexError, KeyError, TypeError, struct.error):
        return None  # what a stranger has written there
    found = re.match(r"(\d{4}):", told)
    return int(found[1]) if found and int(found[1]) >= FIRST_PHOTOGRAPH else None


def _check_size(size: tuple[int, int], limits: Limits) -> None:
    width, height = size
    if width * height > limits.image_megapixels * 1e6:
        raise _too_large(f" ({width} x {height} pixels)", limits)
    if max(size) > MAX_DECODED_SIDE_PIXELS:
        raise InputError(
            "image_too_large",
            f"The picture is too long ({width} x {height} pixels): cut or scale it to at most {MAX_DECODED_SIDE_PIXELS} pixels a side.",
        )
    if min(size) < MIN_SIDE_PIXELS:
        raise InputError(
            "image_too_small",
            f"The picture is too small ({width} x {height} pixels) to show anybody: each side must have at least "
            f"{MIN_SIDE_PIXELS} pixels.",
        )


def _too_large(size: str, limits: Limits) -> InputError:
    return InputError(
        "image_too_large",
        f"The picture is too large{size}: scale it down to at most {limits.image_megapixels:g} megapixels.",
    )


def _ends_early(path: Path) -> bool:
    """Whether a RIFF file is shorter than it says: libwebp does not tell cut pictures from damaged ones."""
    with path.open("rb") as file:
        return int.from_bytes(file.read(8)[4:], "little") + 8 > path.stat().st_size


def _broken(error: BaseException, cut: bool) -> InputError:
    if cut or "truncated" in str(error).lower() or isinstance(error, EOFError):
        return InputError("image_truncated", "The picture file ends too early: send it again.")
    return InputError("image_unreadable", "The picture file is damaged: open it in a viewer and save it anew.")


def _to_srgb(image: Image.Image) -> tuple[np.ndarray, np.ndarray | None]:
    alpha = None
    profile = image.info.get("icc_profile")
    if image.mode.startswith("I") or image.mode == "F":  # 16-bit grey
        grey = np.asarray(image, np.float32)
        image = Image.fromarray(np.clip(grey / 257.0 + 0.5, 0, 255).astype(np.uint8))
    if image.has_transparency_data:
        image = image.convert("RGBA")
        alpha = np.asarray(image.getchannel("A"), np.float32) / 255.0
        image = image.convert("RGB")
    elif image.mode not in ("L", "RGB", "CMYK"):
        image = image.convert("RGB")
    if profile:
        image = _apply_profile(image, profile)
    return np.array(image.convert("RGB")), None if alpha is None or alpha.min() == 1.0 else alpha


def _apply_profile(image: Image.Image, profile: bytes) -> Image.Image:
    from PIL import ImageCms  # few pictures need it

    try:
        source = ImageCms.ImageCmsProfile(io.BytesIO(profile))
        converted = ImageCms.profileToProfile(image, source, ImageCms.createProfile("sRGB"), outputMode="RGB")
    except (ImageCms.PyCMSError, OSError):
        return image  # a broken profile, or one for another kind of pixels: viewers ignore it too
    return converted if converted is not None else image
