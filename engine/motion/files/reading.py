"""Motions from files of any known format."""

from __future__ import annotations

from pathlib import Path

from engine.errors import InputError
from engine.motion.files.bvh import read_bvh
from engine.motion.files.gltf_file import begins_as_gltf
from engine.motion.files.gltf_motion import gltf_clips, read_gltf_motion
from engine.motion.files.source_motion import SourceMotion


def read_motion(path: Path, clip: str | None = None) -> SourceMotion:
    """Read a BVH file, or a GLB or glTF file with an animated skeleton, told apart by their first bytes; of the latter the
    animation named `clip`, or the first in which something moves.

    Raises
    ------
    InputError : see `read_bvh` and `read_gltf_motion`; `motion_clip_unknown` for a clip of a BVH file, too. Where no other
        correction helps, another `motion` does.
    """
    try:
        if _is_gltf(path):
            return read_gltf_motion(path, clip)
        if clip is not None:
            raise InputError(
                "motion_clip_unknown",
                "A BVH file holds one motion without a name: leave motion_clip out.",
                ("motion_clip",),
                {"clips": []},
            )
        return read_bvh(path)
    except InputError as error:
        raise InputError(error.code, error.detail, error.correctable or ("motion",), error.found) from error


def motion_clips(path: Path) -> tuple[str, ...]:
    """The names of a file's animations: none for a BVH file, which holds one without a name.

    Raises
    ------
    InputError : see `gltf_clips`.
    """
    return gltf_clips(path) if _is_gltf(path) else ()


def _is_gltf(path: Path) -> bool:
    with path.open("rb") as file:
        return begins_as_gltf(file.read(64))
