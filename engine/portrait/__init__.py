"""Portraits brought to life: a still face acts out a driving video.

from engine.portrait import animate
animate("portrait.jpg", "driver.mp4", "out")
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from pydantic import BaseModel

from engine.allocation import give_back_memory
from engine.kind import AUTO, Candidates, Given, Input, Kind
from engine.portrait.options import PortraitOptions
from engine.run import Progress, Run
from engine.store import StageStore


def _work(inputs: Mapping[str, Given], options: BaseModel, out: Path, run: Run) -> None:
    assert isinstance(options, PortraitOptions)
    if options.reactive:
        from engine.portrait.reactive.pipeline import make_profile  # the service reads KIND alone: it stays light

        make_profile(inputs, options, out, run)
    else:
        from engine.portrait.target import look_for_face

        image = inputs["image"]
        assert isinstance(image, Path)
        face = look_for_face(image, options, run)
        from engine.portrait.pipeline import animate_portrait  # what draws is loaded while the face is looked for

        animate_portrait(inputs, options, out, run, face)


def _prepare() -> None:
    from engine.portrait import pipeline  # noqa: F401 - importing it is the preparation


def _rehearse(folder: Path) -> None:
    from engine.media.image import write_image
    from engine.media.video import read_video
    from engine.performances import video

    (folder / "out").mkdir()
    for name in ("happy", "surprise"):
        frame = next(iter(read_video(video(name))))
        write_image(folder / f"{name}.png", frame.rgb)
        options = PortraitOptions.model_validate({"trim": (0.0, 0.5)})
        _work({"image": folder / f"{name}.png", "driver": video("idle")}, options, folder / "out", Run())


KIND = Kind(
    name="portrait",
    summary="A portrait acts out a driving video.",
    inputs=(
        Input("image", "image", "The portrait: photo, painting or drawing of a face from the front."),
        Input(
            "driver",
            "video",
            "A video of a face whose performance is carried over.",
            serves_many=True,
            library="performances",
            trimmed_by="trim",
            spared_by="reactive",
        ),
    ),
    options=PortraitOptions,
    work=_work,
    correctable=("landmarks", "neutral_frame", "face_index", "driver_face_index", "trim", "crop", "size"),
    prepare=_prepare,
    rehearse=_rehearse,
)


def animate(
    image: str | Path,
    driver: str | Path | None,
    out: str | Path,
    progress: Callable[[Progress], None] | None = None,
    cache: str | Path | None = None,
    mark_synthetic: bool = True,
    **options: Any,
) -> Path:
    """Animate a portrait; returns the path of the animation.

    Parameters
    ----------
    image : the portrait's file. driver : a video's file, the name of a built-in performance, or `auto`:
    the performance that fits the picture best (`report.json` says why); None is enough for a reactive profile.
    out : folder for the artifacts, made if it is not there.
    progress : called with `Progress(stage, fraction, message)`.
    cache : folder in which analyses are kept, so that the same driver or portrait is quicker next time.
    mark_synthetic : whether the results say of themselves, for machines to read, that they are synthetic.
    options : those of `PortraitOptions`, such as `strength=0.8` or `sound=True`.

    Raises
    ------
    engine.errors.InputError : the picture or the video cannot be used; says what to do.
    pydantic.ValidationError : an option is wrong.
    FileNotFoundError : there is no such picture, or no such video or built-in performance.
    TypeError : there is no driver, and no reactive profile is asked for.
    """
    chosen = PortraitOptions(**options)
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    inputs: dict[str, Given] = {"image": Path(image)}
    if driver is not None:
        inputs["driver"] = _driver(str(driver))
    elif not chosen.reactive:
        raise TypeError("a driver is needed: a video's file, the name of a built-in performance, or auto")
    with (
        TemporaryDirectory(prefix="galatea-") as passing,
        Run(
            StageStore(Path(cache or passing)),
            on_progress=progress,
            mark_synthetic=mark_synthetic,
            on_stage=lambda name, turn: give_back_memory(),
        ) as run,
    ):
        _work(inputs, chosen, folder, run)
    return folder / chosen.animation


def _driver(given: str) -> Given:
    """What a driver's name or path stands for."""
    from engine.performances import names, video

    if given == AUTO:
        return Candidates({name: video(name) for name in names()})
    return video(given) if given in names() else Path(given)


__all__ = ["KIND", "PortraitOptions", "animate"]
