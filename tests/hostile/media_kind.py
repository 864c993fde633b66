"""A job kind that opens its input as the engine's systems do, every frame of it, and does nothing else."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from pydantic import BaseModel

from engine.kind import Input, Kind
from engine.media.image import read_image
from engine.media.video import probe_video, read_video
from engine.run import Run


class NoOptions(BaseModel):
    """None."""


def work(inputs: Mapping[str, Path | tuple[Path, ...]], options: BaseModel, out: Path, run: Run) -> None:
    image, video = inputs.get("image"), inputs.get("video")
    seen: dict[str, object] = {}
    if isinstance(image, Path):
        seen["picture"] = read_image(image, run.limits).rgb.shape
    if isinstance(video, Path):
        seen["info"] = str(probe_video(video, run.limits))
        seen["frames"] = sum(1 for _ in read_video(video, limits=run.limits, longest_side=640))
    (out / "seen.json").write_text(json.dumps(seen))


def prepare() -> None:
    """What opens files is imported already."""


KIND = Kind(
    name="media",
    summary="Opens media.",
    inputs=(
        Input("image", "image", "a picture", required=False),
        Input("video", "video", "a video", required=False),
    ),
    options=NoOptions,
    work=work,
    prepare=prepare,
)
