"""What Makes Tom Hanks Look Like Tom Hanks (Suwajanakorn, Seitz, Kemelmacher-Shlizerman; ICCV 2015), stage by stage."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from shutil import copyfile

import numpy as np

from engine.errors import InputError
from engine.export.still import write_still
from engine.kind import Given
from engine.persona.animating import animate_persona, is_picture, with_composite
from engine.persona.collecting import learnt_of_photos
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.composite.photo_performance import PHOTO_STAGES, STILL_STAGES
from engine.persona.early_average import BACKGROUND_COLOUR
from engine.persona.light.relighting import MIN_STRENGTH, in_light
from engine.persona.options import PersonaOptions
from engine.persona.persona import read_persona, write_persona
from engine.persona.results.in_average_light import in_average_light
from engine.persona.results.pictures import Studio
from engine.persona.results.writing import write_results
from engine.run import Run
from engine.run_report import write_report

LEARNING_STAGES = {"read_photos": 1.0, "find_faces": 12.0, "learn_persona": 8.0}
PERSONA_ANIMATING_STAGES = {"find_driver_at_rest": 4.0, "track_driver": 1.0, "perform": 2.0, "animate": 2.0}
"""The stages and their usual share of the time."""


def make_persona(inputs: Mapping[str, Given], options: PersonaOptions, out: Path, run: Run) -> None:
    """Make a persona of `inputs["photos"]`, or take that of `inputs["persona"]`, and let it play `inputs["driver"]` where there is
    one; leaves the artifacts of the contract in `out`."""
    photos, kept, driver = inputs.get("photos", ()), inputs.get("persona"), inputs.get("driver")
    run.plan(_plan(inputs, options))
    told: dict[str, object] = {}
    relit: dict[int, FacePhoto] = {}
    if isinstance(kept, Path):
        if options.photo is not None:
            raise InputError(
                "photo_needs_photos",
                "A persona that was kept has its photo: send the photos to choose another.",
                ("photo",),
            )
        if options.average_light:
            raise InputError(
                "photo_needs_photos",
                "A persona that was kept has two of its photos alone: send the photos to have them in the average light.",
                ("average_light",),
            )
        persona = read_persona(kept)
    else:
        assert isinstance(photos, tuple)
        persona, told, relit = learnt_of_photos(photos, options, out, run)
    with run.timed("write_persona"):
        if not isinstance(kept, Path):
            write_persona(out / "persona.npz", persona)
        elif kept.resolve() != (out / "persona.npz").resolve():
            copyfile(kept, out / "persona.npz")
        average = persona.average
        alone = np.where(persona.frame.face[..., None], average, np.array(BACKGROUND_COLOUR, np.uint8))
        write_still(out / "average.png", alone, run.mark_synthetic)
        if not isinstance(driver, Path):
            at_rest = Studio(persona, options.size, options.background).picture(persona.neutral, average)
            write_still(out / "poster.jpg", at_rest, run.mark_synthetic)
    if not (isinstance(kept, Path) and isinstance(driver, Path)):  # an earlier job has left them
        with run.timed("write_results"):
            told["photos_near"] = write_results(out, persona, average, options.background, run.mark_synthetic)
            for number, photo in relit.items():
                write_still(out / f"average_light_{number}.png", in_average_light(persona, photo), run.mark_synthetic)
    if isinstance(driver, Path):
        options = with_composite(options, persona, "background_picture" in inputs, run)
        run.plan(_plan(inputs, options))
        if options.light != "own":
            persona, strength = in_light(persona, options.light)
            if strength < MIN_STRENGTH:
                run.warn("light_rare", "Hardly any photo is lit from that side: the light is nearly the mean of all.")
        told |= animate_persona(persona, inputs, options, out, run)
    write_report(
        out / "report.json",
        "persona",
        run,
        inputs={"photos_used": len(persona), "texture_size": list(persona.frame.size[::-1]), **told},
        quality={"belief": float(persona.belief[:, persona.frame.face].mean() / 255)},
    )


def _plan(inputs: Mapping[str, Given], options: PersonaOptions) -> dict[str, float]:
    stages = {**({} if "persona" in inputs else LEARNING_STAGES), "write_persona": 1.0}
    if not {"persona", "driver"} <= {*inputs}:
        stages["write_results"] = 2.0
    if "driver" in inputs:
        driver = inputs["driver"]
        acts, still = options.composite in ("photo", "auto"), isinstance(driver, Path) and is_picture(driver)
        photo = {name: share for name, share in PHOTO_STAGES.items() if name in STILL_STAGES or not still}
        stages |= PERSONA_ANIMATING_STAGES | (photo if acts else {})
        if "driver_photos" not in inputs or (acts and not still):
            del stages["find_driver_at_rest"]
    return stages
