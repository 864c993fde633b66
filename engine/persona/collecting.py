"""From a collection of photographs to a persona: read, look whose faces they are, keep those of use, learn."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from engine.errors import InputError
from engine.export.still import write_first_impression
from engine.perception.identity.backend import descriptor_distances, descriptor_name
from engine.persona.collection.coverage import rare, shown_expressions, shown_sides
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.collection.face_sheet import write_faces
from engine.persona.collection.photos import Photos, read_photos
from engine.persona.collection.sorting import Choice
from engine.persona.composite.acting_photos import PORTRAIT_REACH, around, with_acting_photos
from engine.persona.early_average import EarlyAverage
from engine.persona.options import PersonaOptions
from engine.persona.persona import Persona
from engine.persona.stages import SortedFaces, find_faces_of_photos, learn, sort_faces, texture_width
from engine.run import Run


class LearntOfPhotos(NamedTuple):
    """The `persona`, what the report says of its photographs (`told`), and those of them that are wanted in the average light (`relit`), by the
    numbers of their faces."""

    persona: Persona
    told: dict[str, object]
    relit: dict[int, FacePhoto]


def learnt_of_photos(paths: Sequence[Path], options: PersonaOptions, out: Path, run: Run) -> LearntOfPhotos:
    """The persona of photographs and archives; leaves `preview.jpg`, `faces.json`, `faces.jpg` and early
    averages in `out` as they come.

    Raises
    ------
    InputError : what the stages raise; then `faces.json` is there, wherever there are faces.
    """
    photos: Photos = run.stage("read_photos", read_photos, tuple(paths), run.limits, run.tick)
    if not len(photos):
        raise InputError(
            "no_photos", "None of the files is a photo: send pictures, or an archive of pictures.", ("photos",)
        )
    for early in write_first_impression(out, photos.picture(0), None, run.mark_synthetic):
        run.publish(early)
    described_by = descriptor_name(os.environ)
    choice = Choice(options.keep, options.leave_out, options.years, options.look)
    early_average = EarlyAverage(out, run.publish, descriptor_distances(os.environ), choice, run.mark_synthetic)
    found = run.stage("find_faces", find_faces_of_photos, photos, described_by, run.tick, early_average.add)
    chosen = sort_faces(found, descriptor_distances(os.environ), choice, options.example)
    _tell_faces(out, photos, chosen, run)  # before anything is refused: its numbers are those of what mends it
    chosen.require_enough()
    if options.photo is not None:
        chosen.place(options.photo)  # refused early where it is left out
    for number in options.average_light:
        chosen.place(number, "average_light")
    width = options.texture_width or texture_width(chosen.kept)
    learnt = run.stage("learn_persona", learn, photos, chosen, options.keep, width, run.tick)
    if not learnt.used.all():
        chosen = chosen.without_covered(learnt.used)
        _tell_faces(out, photos, chosen, run)
        chosen.require_enough()
    expressions, sides = shown_expressions(chosen.kept), shown_sides(chosen.kept)
    if few := rare(expressions):
        run.warn(
            "expressions_rare",
            f"Few photos show: {few}. Where a driver does, what is nearest stands in for it: add photos that show it.",
        )
    told = {
        "photos": len(photos),
        "files_skipped": len(photos.skipped),
        "faces": len(chosen.faces),
        "left_out": chosen.left_out,
    }
    wanted = None if options.photo is None else chosen.place(options.photo)
    faces = chosen.kept
    persona = with_acting_photos(learnt.persona, faces, lambda place: photos.picture(faces[place].photo), wanted)
    relit = {}
    for number in options.average_light:
        place = chosen.place(number, "average_light")
        relit[number] = around(FacePhoto(photos.picture(faces[place].photo), faces[place].mesh, place), PORTRAIT_REACH)
    return LearntOfPhotos(persona, {**told, "expressions": expressions, "sides": sides}, relit)


def _tell_faces(out: Path, photos: Photos, chosen: SortedFaces, run: Run) -> None:
    distances = chosen.whose.distance.tolist()
    for early in write_faces(out, photos, chosen.faces, chosen.reasons, distances, chosen.looks, run.mark_synthetic):
        run.publish(early)
