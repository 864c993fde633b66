"""What a call may be given, as the files that the engine reads."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageOps

from engine.errors import InputError

File: TypeAlias = str | os.PathLike[str] | bytes | bytearray | memoryview
"""A file: where it is, or what it holds."""
Picture: TypeAlias = File | NDArray[Any] | Image.Image
"""A picture: a file, an array or a picture of Pillow's. Arrays are (H, W), or RGB as (H, W, 3) or (H, W, 4), as Pillow
has them: bool, uint8, or float in [0, 1]."""
Photos: TypeAlias = File | Sequence[Picture]
"""Photographs: a folder, an archive, or a sequence of pictures and archives."""

KEPT_MODES = ("1", "L", "LA", "P", "RGB", "RGBA", "I;16")
"""Pillow's modes that a PNG holds as they are."""


def picture_file(given: Picture, name: str, folder: Path) -> Path:
    """The file of a picture; one that is in memory is written into `folder`, without loss.

    Raises
    ------
    InputError : `file_not_found`, `not_an_image`.
    """
    if isinstance(given, np.ndarray):
        given = _from_array(given, name)
    if not isinstance(given, Image.Image):
        return file(given, name, folder)
    upright = ImageOps.exif_transpose(given)
    kept = upright if upright.mode in KEPT_MODES else upright.convert("RGB")
    profile = upright.info.get("icc_profile") if kept is upright else None
    path = folder / f"{name}.png"
    kept.save(path, icc_profile=profile, compress_level=1)
    return path


def photo_files(given: Photos, name: str, folder: Path) -> tuple[Path, ...]:
    """The files of photographs; those that are in memory are written into `folder`, without loss.

    Raises
    ------
    InputError : `file_not_found`, `not_an_image`.
    """
    if isinstance(given, str | os.PathLike) and Path(given).is_dir():
        return tuple(sorted(one for one in Path(given).iterdir() if one.is_file() and not one.name.startswith(".")))
    if isinstance(given, str | os.PathLike | bytes | bytearray | memoryview):
        return (file(given, name, folder),)
    return tuple(picture_file(one, f"{name}-{number}", folder) for number, one in enumerate(given))


def file(given: File, name: str, folder: Path, offered: Sequence[str] = ()) -> Path:
    """A file; one that is in memory is written into `folder`. `offered` are the names that would have been something, too.

    Raises
    ------
    InputError : `file_not_found`.
    """
    if isinstance(given, bytes | bytearray | memoryview):
        path = folder / name
        path.write_bytes(given)
        return path
    path = Path(given)
    if not path.is_file():
        built_in = f", nor a built-in one of this name ({', '.join(offered)})" if offered else ""
        raise InputError("file_not_found", f"{name}: there is no file {path}{built_in}.", (name,))
    return path


def _from_array(pixels: NDArray[Any], name: str) -> Image.Image:
    form = pixels.ndim == 2 or (pixels.ndim == 3 and pixels.shape[2] in (3, 4))
    if pixels.dtype == np.uint8:
        values = pixels
    elif pixels.dtype == np.bool_ or (pixels.dtype.kind == "f" and np.all((pixels >= 0) & (pixels <= 1))):
        values = np.round(pixels.astype(np.float32) * 255).astype(np.uint8)
    else:
        form, values = False, pixels
    if not form or not pixels.size:
        raise InputError(
            "not_an_image",
            f"{name}: an array is a picture as (H, W), (H, W, 3) or (H, W, 4), of uint8, bool, or floats in [0, 1]; this "
            f"is {pixels.shape} of {pixels.dtype}.",
        )
    return Image.fromarray(np.ascontiguousarray(values))
