"""A collection of photographs of one person becomes a puppet that another person's video plays.

Source: S. Suwajanakorn, S. M. Seitz, I. Kemelmacher-Shlizerman, What Makes Tom Hanks Look Like Tom Hanks, ICCV 2015. "The paper" in
this folder is that one.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from pydantic import BaseModel

from engine.kind import Given, Input, Kind, Needs
from engine.persona.options import PersonaOptions
from engine.run import Run


def _work(inputs: Mapping[str, Given], options: BaseModel, out: Path, run: Run) -> None:
    assert isinstance(options, PersonaOptions)
    from engine.persona.pipeline import make_persona  # the service reads KIND alone, which stays light

    make_persona(inputs, options, out, run)


def _prepare() -> None:
    from engine.body import load_template
    from engine.body.body_space import load_body_space
    from engine.perception.identity.dlib_descriptor import loaded_network
    from engine.persona import pipeline  # noqa: F401 - importing it is half of the preparation

    loaded_network()
    load_template()  # a job may not read the user's cache, in which it lies: what is loaded here is kept
    load_body_space()


def _rehearse(folder: Path) -> None:
    from engine.performances import video
    from engine.persona.sample import write_sample_photos

    for name in ("photos", "out"):
        (folder / name).mkdir()
    photos = write_sample_photos(folder / "photos")
    options = PersonaOptions.model_validate({"size": (160, 200), "trim": (0.0, 0.5), "texture_width": 97})
    with Run() as run:
        _work({"photos": photos, "driver": video("happy")}, options, folder / "out", run)


KIND = Kind(
    name="persona",
    summary="Photos of a person become a puppet that another person's video plays.",
    inputs=(
        Input(
            "photos",
            "photos",
            "Photos of one person, fifteen at least and better a hundred, as they come: of any size, of several years, with others in"
            " them; or an archive (ZIP or TAR) of them.",
            many=True,
            spared_by_input="persona",
            personal=True,
        ),
        Input(
            "persona",
            "persona",
            "The persona of an earlier job, instead of photos: that job's id, or its `persona.npz`.",
            required=False,
            artifact="persona.npz",
            erased_together=True,
        ),
        Input(
            "driver",
            "performance",
            "A video of anybody's face, whose performance the puppet plays; or a picture, whose expression it takes on.",
            required=False,
            library="performances",
            offers_auto=False,
            trimmed_by="trim",
            serves_many=True,
            corrects=True,
        ),
        Input(
            "driver_photos",
            "photos",
            "Photos of the driver, eight at least: they tell what the face is like at rest better than a short video does.",
            required=False,
            many=True,
            personal=True,
        ),
        Input(
            "background_picture",
            "image",
            "A picture for the puppet to stand before, instead of a plain colour. It is made to cover the film.",
            required=False,
        ),
    ),
    options=PersonaOptions,
    work=_work,
    correctable=("keep", "leave_out", "example", "years", "look", "texture_width", "driver_face_index", "trim", "size"),
    prepare=_prepare,
    rehearse=_rehearse,
    needs=Needs(seconds=1800, memory_mb=4000, cores=2),
)

__all__ = ["KIND", "PersonaOptions"]
