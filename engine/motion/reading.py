"""Motions from files of any known format."""

from __future__ import annotations

from pathlib import Path

from engine.motion.bvh import read_bvh
from engine.motion.gltf_motion import read_gltf_motion
from engine.motion.source_motion import SourceMotion


def read_motion(path: Path) -> SourceMotion:
    """Read a BVH file, or a GLB with an animated skeleton, told apart by their first bytes.

    Raises
    ------
    InputError : see `read_bvh` and `read_gltf_motion`.
    """
    with path.open("rb") as file:
        head = file.read(4)
    return read_gltf_motion(path) if head == b"glTF" else read_bvh(path)
