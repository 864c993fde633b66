"""Portraits brought to life: a still face acts out a driving video.

from engine.portrait import animate
animate("portrait.jpg", "driver.mp4", "out")
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from engine.kind import Input, Kind
from engine.portrait.options import PortraitOptions
from engine.run import Progress, Run
from engine.store import StageStore


def _work(inputs: Mapping[str, Path | tuple[Path, ...]], options: BaseModel, out: Path, run: Run) -> None:
    from engine.portrait.pipeline import animate_portrait  # the service reads KIND alone: it stays light

    assert isinstance(options, PortraitOptions)
    animate_portrait(inputs, options, out, run)


def _prepare() -> None:
    from engine.portrait import pipeline  # noqa: F401 - importing it is the preparation


KIND = Kind(
    name="portrait",
    summary="A portrait acts out a driving video.",
    inputs=(
        Input("image", "image", "The portrait: photo, painting or drawing of a face from the front."),
        Input("driver", "video", "A video of a face whose performance is carried over.", library="performances"),
    ),
    options=PortraitOptions,
    work=_work,
    prepare=_prepare,
)


def animate(
    image: str | Path,
    driver: str | Path,
    out: str | Path,
    progress: Callable[[Progress], None] | None = None,
    cache: str | Path | None = None,
    **options: Any,
) -> Path:
    """Animate a portrait; returns the path of the animation.

    Parameters
    ----------
    image : the portrait's file. driver : a video's file, or the name of a built-in performance.
    out : folder for the artifacts, made if it is not there.
    progress : called with `Progress(stage, fraction, message)`.
    cache : folder in which analyses are kept, so that the same driver or portrait is quicker next time.
    options : those of `PortraitOptions`, such as `strength=0.8` or `sound=True`.

    Raises
    ------
    engine.errors.InputError : the picture, the video or an option cannot be used; says what to do.
    """
    from engine.performances import names, video

    chosen = PortraitOptions(**options)
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    file = video(str(driver)) if str(driver) in names() else Path(driver)
    store = StageStore(Path(cache)) if cache is not None else None
    _work({"image": Path(image), "driver": file}, chosen, folder, Run(store=store, on_progress=progress))
    return next(folder.glob("animation.*"))


__all__ = ["KIND", "PortraitOptions", "animate"]
