"""One full-body picture becomes a rigged 3D character that walks out of it.

Source: C.-Y. Weng, B. Curless, I. Kemelmacher-Shlizerman, Photo Wake-Up: 3D Character Animation from a Single Photo,
CVPR 2019. "The paper" in this folder is that one.

from engine.character import wake_up
wake_up("photo.jpg", "out", motion="dance")
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from engine.character.options import CharacterOptions
from engine.kind import Given, Input, Kind
from engine.run import Progress, Run


def _work(inputs: Mapping[str, Given], options: BaseModel, out: Path, run: Run) -> None:
    from engine.character.pipeline import wake_up  # the service reads KIND alone: it stays light

    assert isinstance(options, CharacterOptions)
    wake_up(inputs, options, out, run)


def wake_up(
    photo: str | Path,
    out: str | Path,
    motion_file: str | Path | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    **options: Any,
) -> Path:
    """Wake a person up: leaves `character.glb`, `animation.mp4`, `report.json` and the rest in `out`; returns it.

    Parameters
    ----------
    photo : a picture that shows one person whole.
    motion_file : a BVH or GLB file to move by, in place of the built-in clip that the option `motion` names.
    options : see `engine.character.options.CharacterOptions`.

    Raises
    ------
    engine.errors.InputError : the input cannot be used; its code and sentence say why and what to do.
    pydantic.ValidationError : an option is wrong.
    FileNotFoundError : there is no such picture or motion file.
    """
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    inputs = {"photo": Path(photo)} | ({"motion": Path(motion_file)} if motion_file is not None else {})
    _work(inputs, CharacterOptions.model_validate(options), folder, Run(on_progress=on_progress))
    return folder


def _prepare() -> None:
    from engine.character import pipeline  # noqa: F401 - importing it is half of the preparation
    from engine.character.template_fit import load_human

    load_human()  # a job may not read the user's cache, in which it lies


def _rehearse(folder: Path) -> None:
    from engine.character.sample import sample_picture
    from engine.media.image import write_image

    (folder / "out").mkdir()
    write_image(folder / "photo.png", sample_picture())
    options = CharacterOptions.model_validate({"seconds": 1})
    _work({"photo": folder / "photo.png"}, options, folder / "out", Run())


KIND = Kind(
    name="character",
    summary="A person walks out of their picture as a rigged 3D character.",
    inputs=(
        Input("photo", "image", "A picture that shows one person whole, from the front: photo, painting or cartoon."),
        Input(
            "motion",
            "motion",
            "A motion of one's own: BVH, or a GLB with an animated skeleton.",
            required=False,
            named_by="motion",
            library="motions",
            corrects=True,
        ),
        Input(
            "mask",
            "image",
            "A mask of the picture's size: white where the person is.",
            required=False,
            corrects=True,
        ),
        Input(
            "labels",
            "image",
            "A label map of the picture's size, in the colours of labels.png.",
            required=False,
            corrects=True,
        ),
    ),
    options=CharacterOptions,
    work=_work,
    correctable=(
        *("joints", "person_box", "person_index", "mask_strokes", "label_strokes"),
        *("back_texture", "keep", "pose", "motion_joints", "motion_clip"),
    ),
    prepare=_prepare,
    rehearse=_rehearse,
)
