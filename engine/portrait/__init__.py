"""Portraits brought to life: a still face acts out a driving video. In Python it is `galatea.animate`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from pydantic import BaseModel

from engine.kind import Given, Input, Kind
from engine.portrait.options import PortraitOptions
from engine.run import Run


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
    from engine.body import load_template
    from engine.portrait import pipeline  # noqa: F401 - importing it is half of the preparation

    load_template()  # the mouth's; a job may not read the user's cache, in which it lies: what is loaded here is kept


def _rehearse(folder: Path) -> None:
    from engine.media.image import write_image
    from engine.media.video import read_video
    from engine.performances import video

    (folder / "out").mkdir()
    for name in ("happy", "surprise"):
        frame = next(iter(read_video(video(name))))
        write_image(folder / f"{name}.png", frame.rgb)
        options = PortraitOptions.model_validate({"trim": (0.0, 0.5)})
        with Run() as run:
            _work({"image": folder / f"{name}.png", "driver": video("idle")}, options, folder / "out", run)


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


__all__ = ["KIND", "PortraitOptions"]
