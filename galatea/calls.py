"""The functions: each makes its inputs files, its options a model, and has a job kind's work done."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, TypeAlias, TypeVar, Unpack

from pydantic import BaseModel, ValidationError

from engine import avatar, character, persona, portrait
from engine.allocation import give_back_memory
from engine.delivery import deliver
from engine.errors import InputError
from engine.kind import AUTO_CHOICE, Candidates, Given
from engine.motion.library import CLIPS
from engine.performances import names, video
from engine.run import Progress, Run
from engine.store import StageStore
from engine.unknown_options import with_suggestions
from galatea.inputs import File, Photos, Picture, file, photo_files, picture_file
from galatea.options import AvatarOptions, CharacterOptions, PersonaOptions, PortraitOptions
from galatea.result import Result, result_of
from galatea.silence_libraries import silence_libraries

Folder: TypeAlias = str | os.PathLike[str]
Follower: TypeAlias = Callable[[Progress], object]
Options = TypeVar("Options", bound=BaseModel)


def animate(
    image: Picture,
    driver: File | None,
    out: Folder,
    *,
    progress: Follower | None = None,
    cache: Folder | None = None,
    mark_synthetic: bool = True,
    **options: Unpack[PortraitOptions],
) -> Result:
    """Animate a portrait: it acts out a driving video.

    Parameters
    ----------
    image : the portrait.
    driver : a video, the name of a built-in performance, or `auto`: the performance that fits the picture best (the report
        says why). None is enough for a reactive profile.
    out : folder for the artifacts, made if it is not there. After an error it is as it was.
    progress : called with `Progress(stage, fraction, message)`; the fraction never falls, and is 1.0 once: at the end.
    cache : folder in which analyses are kept, so that the same driver or portrait is quicker next time.
    mark_synthetic : whether the results say of themselves, for machines to read, that they are synthetic.
    options : those of the job kind `portrait`, such as `strength=0.8` or `sound=True`.

    Raises
    ------
    GalateaError : the picture, the video or an option cannot be used; says what to do.
    """
    chosen = _checked(portrait.PortraitOptions, options)
    with TemporaryDirectory(prefix="galatea-") as folder:
        inputs: dict[str, Given] = {"image": picture_file(image, "image", Path(folder))}
        if driver is not None:
            inputs["driver"] = _driver(driver, Path(folder))
        elif not chosen.reactive:
            raise InputError(
                "driver_missing",
                "Name a driver: a video, a built-in performance, or auto; or ask for a reactive profile.",
            )
        with _run(progress, cache, mark_synthetic, Path(folder)) as run:
            made = deliver(portrait.KIND, inputs, chosen, Path(out), run)
    return result_of(made, "profile.json" if chosen.reactive else chosen.animation, run.notices)


def wake_up(
    photo: Picture,
    out: Folder,
    motion: File = "walk",
    *,
    mask: Picture | None = None,
    labels: Picture | None = None,
    progress: Follower | None = None,
    cache: Folder | None = None,
    mark_synthetic: bool = True,
    **options: Unpack[CharacterOptions],
) -> Result:
    """Wake a person up: they become a rigged character, and walk out of their picture.

    Parameters
    ----------
    photo : a picture that shows one person whole.
    out : folder for the artifacts, made if it is not there. After an error it is as it was.
    motion : the name of a built-in motion, or a BVH or GLB file.
    mask : of the picture's size, white where the person is, where that is not found well by itself.
    labels : of the picture's size, in the colours of `labels.png`.
    progress, cache, mark_synthetic : as of `animate`.
    options : those of the job kind `character`, such as `seconds=2` or `vrm=True`.

    Raises
    ------
    GalateaError : the picture, the motion or an option cannot be used; says what to do.
    """
    built_in = isinstance(motion, str) and motion in character.BUILT_IN_MOTIONS and not Path(motion).is_file()
    chosen = _checked(character.CharacterOptions, {**options, **({"motion": motion} if built_in else {})})
    with TemporaryDirectory(prefix="galatea-") as folder:
        inputs: dict[str, Given] = {"photo": picture_file(photo, "photo", Path(folder))}
        if not built_in:
            inputs["motion"] = file(motion, "motion", Path(folder), character.BUILT_IN_MOTIONS)
        for name, painted in (("mask", mask), ("labels", labels)):
            if painted is not None:
                inputs[name] = picture_file(painted, name, Path(folder))
        with _run(progress, cache, mark_synthetic, Path(folder)) as run:
            made = deliver(character.KIND, inputs, chosen, Path(out), run)
    return result_of(made, "character.glb", run.notices)


def make_avatar(
    body: File,
    out: Folder,
    motion: File = "idle",
    *,
    head: File | None = None,
    more: Sequence[File] = (),
    driver: File | None = None,
    progress: Follower | None = None,
    cache: Folder | None = None,
    mark_synthetic: bool = True,
    **options: Unpack[AvatarOptions],
) -> Result:
    """Make an avatar for games of a person who was filmed from all around.

    Parameters
    ----------
    body : a clip of the whole person, who stands still; one slow circle around the upper body, then one around the legs.
    out : folder for the artifacts, made if it is not there. After an error it is as it was.
    motion : the name of a built-in motion, or a BVH or GLB file.
    head : a clip of the same person's head: a slow circle, then the crown, then under the chin.
    more : further clips of the person.
    driver : a video of a face, which the avatar's face follows in the film.
    progress, cache, mark_synthetic : as of `animate`.
    options : those of the job kind `avatar`, such as `height_m=1.8` or `vrm=True`.

    Raises
    ------
    GalateaError : a clip, the motion or an option cannot be used; says what to do.
    """
    built_in = isinstance(motion, str) and motion in CLIPS and not Path(motion).is_file()
    chosen = _checked(avatar.AvatarOptions, {**options, **({"motion": motion} if built_in else {})})
    with TemporaryDirectory(prefix="galatea-") as folder:
        held = Path(folder)
        inputs: dict[str, Given] = {"body": file(body, "body", held)}
        if not built_in:
            inputs["motion"] = file(motion, "motion", held, tuple(CLIPS))
        for name, clip in (("head", head), ("driver", driver)):
            if clip is not None:
                inputs[name] = file(clip, name, held)
        if more:
            inputs["more"] = tuple(file(clip, f"more-{number}", held) for number, clip in enumerate(more))
        with _run(progress, cache, mark_synthetic, held) as run:
            made = deliver(avatar.KIND, inputs, chosen, Path(out), run)
    return result_of(made, "avatar.glb", run.notices)


def make_persona(
    photos: Photos,
    driver: File | None,
    out: Folder,
    *,
    driver_photos: Photos | None = None,
    background_picture: File | None = None,
    progress: Follower | None = None,
    cache: Folder | None = None,
    mark_synthetic: bool = True,
    **options: Unpack[PersonaOptions],
) -> Result:
    """Make a puppet of a person out of their photographs, and let it play what somebody else does.

    Parameters
    ----------
    photos : a folder or an archive of photographs, or a sequence of pictures and archives; fifteen have to be of use. Or the
        path of an earlier call's `persona.npz`, which takes seconds.
    driver : a video of a face, a picture of one, or the name of a built-in performance; None makes the persona alone.
    out : folder for the artifacts, made if it is not there. After an error it is as it was.
    driver_photos : photographs of the driver, which tell what the face is like at rest.
    background_picture : a picture for the puppet to stand before.
    progress, cache, mark_synthetic : as of `animate`.
    options : those of the job kind `persona`, such as `composite="photo"`.

    Raises
    ------
    GalateaError : the photographs, the driver or an option cannot be used; says what to do.
    """
    chosen = _checked(persona.PersonaOptions, options)
    with TemporaryDirectory(prefix="galatea-") as folder:
        held = Path(folder)
        given = photo_files(photos, "photos", held)
        kept = len(given) == 1 and given[0].suffix == ".npz"
        inputs: dict[str, Given] = {"persona": given[0]} if kept else {"photos": given}
        if driver is not None:
            named = isinstance(driver, str) and driver in names() and not Path(driver).is_file()
            inputs["driver"] = video(str(driver)) if named else file(driver, "driver", held, names())
        if driver_photos is not None:
            inputs["driver_photos"] = photo_files(driver_photos, "driver_photos", held)
        if background_picture is not None:
            inputs["background_picture"] = file(background_picture, "background_picture", held)
        with _run(progress, cache, mark_synthetic, held) as run:
            made = deliver(persona.KIND, inputs, chosen, Path(out), run)
    main = next(name for name in ("animation.mp4", "still.png", "persona.npz") if name in {one.name for one in made})
    return result_of(made, main, run.notices)


def _driver(given: File, folder: Path) -> Given:
    """What a driver's name or file stands for."""
    if isinstance(given, str) and not Path(given).is_file():
        if given == AUTO_CHOICE:
            return Candidates({name: video(name) for name in names()})
        if given in names():
            return video(given)
    return file(given, "driver", folder, (*names(), AUTO_CHOICE))


def _checked(model: type[Options], given: Mapping[str, Any]) -> Options:
    """The options as the engine has them. Raises `InputError` `invalid_options`."""
    try:
        return model.model_validate(given)
    except ValidationError as error:
        first = with_suggestions(error.errors(), model)[0]
        place = ".".join(str(part) for part in first["loc"])
        raise InputError("invalid_options", f"{place + ': ' if place else ''}{first['msg']}") from error


@contextmanager
def _run(progress: Follower | None, cache: Folder | None, mark_synthetic: bool, passing: Path) -> Iterator[Run]:
    """A run whose native libraries are not heard; without a cache its stages are kept as long as it lasts."""
    with (
        silence_libraries(),
        Run(
            StageStore(Path(cache) if cache is not None else passing / "stages"),
            on_progress=progress,
            mark_synthetic=mark_synthetic,
            on_stage=lambda name, turn: give_back_memory(),
        ) as run,
    ):
        yield run
