"""What is known of a person: all photographs of their face laid on one another, and the shape they have in common."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.npz import read_npz
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.texture.appearance_subspace import REFERENCE_WIDTH_PIXELS
from engine.persona.texture.expression_weights import expression_points, expression_weights
from engine.persona.texture.synthesis import TextureSynthesis, texture_synthesis
from engine.persona.texture.texture_frame import TextureFrame, texture_frame

PERSONA_FORMAT_VERSION = 1
MAX_PERSONA_PHOTOS = 2000
MAX_SIDE = 1024
MAX_ARRAYS_BYTES = 3_000_000_000
"""Of a file's arrays together."""
MAX_EYE_DISTANCES = 5.0
"""Nothing of a face is farther from its middle."""


@dataclass(frozen=True)
class Persona:
    """A person's face, of N photographs in a frame (H, W).

    mesh : (478, 3) float64, the frame's face from the front, in eye distances.
    neutral : (478, 3) float64, the same at rest.
    colours : (N, H, W, 3) uint8 sRGB, balanced.
    belief : (N, H, W) uint8, 255 where a pixel can be believed.
    points : (N, 51, 2) float32, what expression each photograph shows, in eye distances.
    depth : (H, W) float32, pixels away from the viewer.
    portrait : the photograph that acts where the person is to be seen as in a photograph; None where none shows a head.
    teeth : the photograph that lends its teeth; None where none shows any.
    """

    mesh: NDArray[np.float64]
    neutral: NDArray[np.float64]
    colours: NDArray[np.uint8]
    belief: NDArray[np.uint8]
    points: NDArray[np.float32]
    depth: NDArray[np.float32]
    portrait: FacePhoto | None = None
    teeth: FacePhoto | None = None

    def __len__(self) -> int:
        return len(self.colours)

    @cached_property
    def frame(self) -> TextureFrame:
        """In which the photographs lie."""
        height, width = self.colours.shape[1:3]
        return texture_frame(self.mesh, (height, width))

    @cached_property
    def synthesis(self) -> TextureSynthesis:
        """What mixes them: half a second for a hundred photographs."""
        return texture_synthesis(self.colours, self.belief / np.float32(255))

    @cached_property
    def average(self) -> NDArray[np.uint8]:
        """(H, W, 3) the texture of the face at rest, of all photographs."""
        return self.synthesis(self.weights(self.neutral[None]))[0]

    def weights(self, faces: NDArray[np.floating], smoothing: float = 0.0) -> NDArray[np.float32]:
        """(F, N) how much each photograph counts for `faces` (F, 478, 3) from the front, in eye distances; `smoothing` as
        `expression_weights` has it."""
        return self.weights_of_points(expression_points(faces), smoothing)

    def weights_of_points(self, points: NDArray[np.floating], smoothing: float = 0.0) -> NDArray[np.float32]:
        """(F, N) the same for faces of which the points of `expression_points` are known, (F, 51, 2)."""
        scale = self.frame.scale * REFERENCE_WIDTH_PIXELS / self.frame.size[1]
        return expression_weights(points * scale, self.points * scale, smoothing)


def write_persona(path: Path, persona: Persona) -> None:
    """Write an npz, whose arrays are those of `Persona` by their names, those of its photographs as `portrait_rgb` and so on, and
    `version`."""
    arrays = {name: getattr(persona, name) for name in _SHAPES}
    for name in _PHOTOS:
        photo: FacePhoto | None = getattr(persona, name)
        if photo is not None:
            arrays |= {f"{name}_rgb": photo.rgb, f"{name}_mesh": photo.mesh, f"{name}_number": np.int64(photo.number)}
    with path.open("wb") as file:
        np.savez_compressed(file, version=np.int64(PERSONA_FORMAT_VERSION), **arrays)


_SHAPES = {
    "mesh": (np.float64, (478, 3)),
    "neutral": (np.float64, (478, 3)),
    "colours": (np.uint8, ("N", "H", "W", 3)),
    "belief": (np.uint8, ("N", "H", "W")),
    "points": (np.float32, ("N", 51, 2)),
    "depth": (np.float32, ("H", "W")),
}
_PHOTOS = ("portrait", "teeth")
MAX_PHOTO_SIDE = 4096


def read_persona(path: Path) -> Persona:
    """A persona that `write_persona` has left.

    Raises
    ------
    InputError : `persona_unreadable`, `persona_too_large`.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            if sum(member.file_size for member in archive.infolist()) > MAX_ARRAYS_BYTES:
                raise InputError("persona_too_large", "The persona's file is larger than any that is made here.")
        arrays = read_npz(path)
        if int(arrays["version"]) != PERSONA_FORMAT_VERSION:
            raise InputError(
                "persona_unreadable", "The persona was made by another release: make it again of its photos."
            )
        found = {name: arrays[name] for name in _SHAPES}
        _require_sound(found)
        photos = {name: _photo(name, arrays, len(found["colours"])) for name in _PHOTOS}
    except (OSError, ValueError, KeyError, TypeError, zipfile.BadZipFile, EOFError, NotImplementedError) as broken:
        raise InputError(
            "persona_unreadable",
            "The file is no `persona.npz` as jobs of personas leave it: give such a file, or the job's id.",
        ) from broken
    return Persona(**found, portrait=photos["portrait"], teeth=photos["teeth"])


def _photo(name: str, arrays: Mapping[str, NDArray[np.generic]], count: int) -> FacePhoto | None:
    """A photograph that was kept; None where none was."""
    if f"{name}_rgb" not in arrays:
        return None
    rgb, mesh, number = arrays[f"{name}_rgb"], arrays[f"{name}_mesh"], int(arrays[f"{name}_number"])
    if rgb.dtype != np.uint8 or rgb.ndim != 3 or rgb.shape[2] != 3 or not 1 <= max(rgb.shape[:2]) <= MAX_PHOTO_SIDE:
        raise ValueError(name)
    if mesh.dtype != np.float32 or mesh.shape != (478, 3) or not 0 <= number < count:
        raise ValueError(name)
    if not np.abs(np.asarray(mesh, np.float64)).max() <= 2 * MAX_PHOTO_SIDE:
        raise ValueError(name)
    return FacePhoto(np.asarray(rgb, np.uint8), np.asarray(mesh, np.float32), number)


def _require_sound(arrays: dict[str, NDArray[np.generic]]) -> None:
    sizes: dict[str, int] = {}
    for name, (kind, shape) in _SHAPES.items():
        array = arrays[name]
        if array.dtype != kind or array.ndim != len(shape):
            raise ValueError(name)
        for side, wanted in zip(array.shape, shape, strict=True):
            if side != (sizes.setdefault(wanted, side) if isinstance(wanted, str) else wanted):
                raise ValueError(name)
        if kind is not np.uint8 and not np.isfinite(np.asarray(array, np.float64)).all():
            raise ValueError(name)
    if (
        not 1 <= sizes["N"] <= MAX_PERSONA_PHOTOS
        or not 32 <= min(sizes["H"], sizes["W"]) <= max(sizes["H"], sizes["W"]) <= MAX_SIDE
    ):
        raise ValueError("size")
    if any(np.abs(np.asarray(arrays[name], np.float64)).max() > MAX_EYE_DISTANCES for name in ("mesh", "neutral")):
        raise ValueError("mesh")
