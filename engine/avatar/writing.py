"""The avatar's files: GLB, USDZ and VRM, its texture, and where the cameras stood."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from engine.avatar.acting import Scene, built_in_clips
from engine.avatar.avatar import Avatar, coarser
from engine.avatar.options import AvatarOptions
from engine.export.gltf.glb import CharacterModel, write_glb
from engine.export.gltf.vrm import VrmMeta, write_vrm
from engine.export.gltf.vrm_expressions import arkit_expressions
from engine.export.still import write_still
from engine.export.usdz import write_usdz
from engine.geometry.camera import Camera
from engine.run import Run

MAX_AVATAR_GLB_BYTES = 40_000_000
"""Of the GLB, with a texture of 4096 pixels."""


@dataclass(frozen=True)
class WrittenCameras:
    """The cameras of the frames that were chosen of a clip: which `frames` of it, at what `seconds`."""

    clip: str
    frames: Sequence[int]
    seconds: Sequence[float]
    cameras: Sequence[Camera]


def write_avatar(out: Path, avatar: Avatar, scene: Scene, options: AvatarOptions, run: Run) -> None:
    """Write `avatar.glb` with all clips, the scene's first, `avatar.usdz` with the scene's, `texture.png`, and `avatar.vrm` where
    it is wanted."""
    marked = run.mark_synthetic
    others = [clip for clip in built_in_clips(avatar.mesh, 30.0) if clip.name != scene.clip.name]
    model = CharacterModel(
        avatar.mesh,
        [scene.clip, avatar.filmed, *others],
        unlit=False,
        levels=coarser(avatar, options.levels),
        morphs=avatar.morphs,
        expressions={} if scene.expressions is None else {scene.clip.name: scene.expressions},
        mixamo=True,
    )
    written = write_glb(
        out / "avatar.glb",
        model,
        name="avatar",
        synthetic=marked,
        most=MAX_AVATAR_GLB_BYTES,
        compression=options.compression,
        check=run.check,
    )
    if written.size > MAX_AVATAR_GLB_BYTES:
        run.warn(
            "glb_too_large",
            f"avatar.glb has {written.size / 1e6:.1f} MB; a smaller texture helps, or fewer triangles.",
        )
    write_usdz(out / "avatar.usdz", avatar.mesh, scene.clip, name="avatar", synthetic=marked)
    write_still(out / "texture.png", avatar.mesh.texture, marked)
    if options.vrm:
        names = [morph.name for morph in avatar.morphs]
        write_vrm(
            out / "avatar.vrm",
            CharacterModel(avatar.mesh, morphs=avatar.morphs, unlit=False),
            VrmMeta(name="avatar", authors=(options.vrm_author,)),
            expressions=arkit_expressions(names),
            synthetic=marked,
        )


def write_cameras(path: Path, clips: Sequence[WrittenCameras]) -> None:
    """Write the cameras as JSON: intrinsics K, rotation R and translation t of each, and the lens's distortion, in
    OpenCV's order. A point p of the avatar's world, metres, is seen at K (R p + t)."""
    document: dict[str, Any] = {
        one.clip: [
            {
                "frame": int(frame),
                "second": round(float(second), 4),
                "size": [camera.size[1], camera.size[0]],
                "intrinsics": np.round(camera.intrinsics, 3).tolist(),
                "rotation": np.round(camera.rotation, 7).tolist(),
                "translation": np.round(camera.translation, 6).tolist(),
                "distortion": [round(k, 7) for k in camera.distortion],
            }
            for frame, second, camera in zip(one.frames, one.seconds, one.cameras, strict=True)
        ]
        for one in clips
    }
    path.write_text(json.dumps(document) + "\n")
