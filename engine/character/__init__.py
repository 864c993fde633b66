"""One full-body picture becomes a rigged 3D character that walks out of it.

Source: C.-Y. Weng, B. Curless, I. Kemelmacher-Shlizerman, Photo Wake-Up: 3D Character Animation from a Single Photo,
CVPR 2019. "The paper" in this folder is that one. In Python it is `galatea.wake_up`.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from pydantic import BaseModel

from engine.character.options import BUILT_IN_MOTIONS, CharacterOptions
from engine.kind import Given, Input, Kind
from engine.run import Run


def _work(inputs: Mapping[str, Given], options: BaseModel, out: Path, run: Run) -> None:
    from engine.character.pipeline import wake_up  # the service reads KIND alone: it stays light

    assert isinstance(options, CharacterOptions)
    wake_up(inputs, options, out, run)


def _prepare() -> None:
    from engine.character import pipeline  # noqa: F401 - importing it is half of the preparation
    from engine.character.fit.template_fit import load_human
    from engine.character.shell.colours.bare_skin import hands_of_the_template
    from engine.character.shell.extremities import shoe_shapes

    load_human()  # a job may not read the user's cache, in which it lies
    hands_of_the_template()
    shoe_shapes()


def _rehearse(folder: Path) -> None:
    from engine.character.sample import sample_picture
    from engine.media.image import write_image

    (folder / "out").mkdir()
    write_image(folder / "photo.png", sample_picture(400))
    options = CharacterOptions.model_validate({"seconds": 1, "fps": 12, "triangles": 15_000})
    with Run() as run:
        _work({"photo": folder / "photo.png"}, options, folder / "out", run)


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

__all__ = ["BUILT_IN_MOTIONS", "KIND", "CharacterOptions"]
