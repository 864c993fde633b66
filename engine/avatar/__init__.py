"""Two smartphone clips that orbit a person become a game-ready avatar.

Source: S. Wenninger, J. Achenbach, A. Bartl, M. E. Latoschik, M. Botsch, Realistic Virtual Humans from Smartphone Videos,
VRST 2020. "The paper" in this folder is that one.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from pydantic import BaseModel

from engine.avatar.options import AvatarOptions
from engine.kind import Given, Input, Kind, Needs
from engine.run import Run


def _work(inputs: Mapping[str, Given], options: BaseModel, out: Path, run: Run) -> None:
    assert isinstance(options, AvatarOptions)
    # imported here: the service reads KIND alone, which stays light
    if "avatar" in inputs:
        from engine.avatar.animating import animate_avatar

        animate_avatar(inputs, options, out, run)
    else:
        from engine.avatar.pipeline import make_avatar

        make_avatar(inputs, options, out, run)


def _prepare() -> None:
    from engine.avatar import pipeline  # noqa: F401 - importing it is half of the preparation
    from engine.avatar.face_performance import load_face_units
    from engine.avatar.registration.models import load_models

    load_models()  # a job may not read the user's cache, in which they lie: what is loaded here is kept
    load_face_units()


def _rehearse(folder: Path) -> None:
    from engine.avatar.sample import SAMPLE_FRAMES, sample_clip
    from engine.performances import video

    (folder / "out").mkdir()
    frames = {f"{name}_frames": count for name, count in SAMPLE_FRAMES.items()}
    small = {"texture_size": 1024, "size": (96, 160), "fps": 5, "vrm": True, "compression": "meshopt"}
    options = AvatarOptions.model_validate({**frames, **small})
    clips = {"body": sample_clip("body"), "head": sample_clip("head"), "driver": video("idle")}
    with Run() as run:
        _work(clips, options, folder / "out", run)


KIND = Kind(
    name="avatar",
    summary="Two clips of a person become an avatar for games: rigged, with fingers and expressions.",
    inputs=(
        Input(
            "body",
            "video",
            "A clip of the whole person, who stands still with the arms a little away from the body: one slow circle around the"
            " upper body, then one around the legs.",
            spared_by_input="avatar",
            personal=True,
        ),
        Input(
            "head",
            "video",
            "A clip of the same person's head: a slow circle, then the crown, then under the chin. Without it the face is as"
            " coarse as the body's clip shows it.",
            required=False,
            personal=True,
        ),
        Input(
            "more",
            "video",
            "Further clips of the same person in the same place, of arms or the back say: a slow arc around what the clip of the body"
            " shows too little of.",
            required=False,
            many=True,
            personal=True,
        ),
        Input(
            "motion",
            "motion",
            "A motion of one's own for the animation: BVH, or a GLB with an animated skeleton.",
            required=False,
            named_by="motion",
            library="motions",
            corrects=True,
        ),
        Input(
            "driver",
            "video",
            "A video of anybody's face, which the avatar's face follows in the animation.",
            required=False,
            corrects=True,
        ),
        Input(
            "avatar",
            "model",
            "The avatar of an earlier job, instead of clips: that job's id, or its `avatar.glb`. It does what `motion` and `driver`"
            " say, within seconds.",
            required=False,
            artifact="avatar.glb",
        ),
    ),
    options=AvatarOptions,
    work=_work,
    correctable=(
        *("height_m", "body_frames_left_out", "head_frames_left_out", "landmarks"),
        *("motion", "motion_joints", "motion_clip"),
    ),
    prepare=_prepare,
    rehearse=_rehearse,
    needs=Needs(seconds=1200, memory_mb=6000, cores=2),
)

__all__ = ["KIND", "AvatarOptions"]
