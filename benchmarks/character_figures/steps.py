"""A picture's character with everything that was found on the way, without files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.shared_media import media
from engine.character.figure.figure import Choice, Figure, find_figure
from engine.character.figure.silhouette import Silhouette, cut_out
from engine.character.fit.template_fit import FittedBody
from engine.character.hybrid.hybrid import make_hybrid
from engine.character.options import CharacterOptions
from engine.character.parts.label_map import Labels
from engine.character.parts.unseen_limbs import with_limbs_hidden
from engine.character.rig.rigging import Character
from engine.character.shell.extremities import with_relaxed_hands
from engine.character.shell.shell import make_shell
from engine.character.stages import (
    build_mesh,
    fit_template,
    label,
    make_character,
    make_hybrid_character,
    make_shell_character,
)
from engine.media.limits import Limits

JOINTS_PLACED_BY_HAND: Mapping[str, Mapping[str, tuple[float, float]]] = {
    "drawing_child_boy": {
        **{"RightShoulder": (200, 220), "RightElbow": (110, 260), "RightWrist": (50, 295), "RightHip": (200, 400)},
        **{"RightKnee": (170, 465), "RightAnkle": (135, 540), "LeftShoulder": (320, 215), "LeftElbow": (390, 240)},
        **{"LeftWrist": (440, 280), "LeftHip": (330, 395), "LeftKnee": (380, 460), "LeftAnkle": (410, 530)},
    }
}
"""The joints of pictures of the test media in which nobody is found, as a person places them, pixels."""


def pictures() -> list[Path]:
    """All people of the test media."""
    return sorted(path for path in media("fullbody").iterdir() if path.suffix in (".jpg", ".png"))


def options_for(photo: Path, options: Mapping[str, Any]) -> CharacterOptions:
    """The options asked for; whoever is cut off is accepted, and joints that nobody else finds are placed."""
    return CharacterOptions.model_validate(
        {"partial": True, "joints": JOINTS_PLACED_BY_HAND.get(photo.stem, {}), **options}
    )


@dataclass(frozen=True)
class Woken:
    figure: Figure
    silhouette: Silhouette
    fitted: FittedBody
    labels: Labels
    character: Character


def wake(photo: Path, options: Mapping[str, Any]) -> Woken:
    """The stages of `engine.character.pipeline` up to the character."""
    asked = options_for(photo, options)
    placed = tuple((name, x, y) for name, (x, y) in sorted(asked.joints.items()))
    index = None if asked.person_index == "all" else asked.person_index
    choice = Choice(asked.person_box, index, placed)
    figure = find_figure(photo, choice, asked.partial, Limits(), lambda code, message: None)
    silhouette = cut_out(figure, None, asked.mask_strokes, Limits(), None, None, lambda code, message: None)
    fitted = fit_template(figure, silhouette)
    labels = label(figure, silhouette, fitted, None, asked.label_strokes, Limits(), lambda code, message: None)
    fitted = with_limbs_hidden(fitted, silhouette.camera(fitted.picture_camera()), labels, lambda code, message: None)
    painted = (asked.triangles, asked.back_texture)
    if asked.surface != "relief":
        fitted = with_relaxed_hands(fitted)
    found = (figure, silhouette, fitted, labels)
    if asked.surface == "shell":
        return Woken(*found, make_shell_character(*found, make_shell(*found), *painted))
    if asked.surface == "hybrid":
        return Woken(*found, make_hybrid_character(*found, make_hybrid(*found), *painted))
    return Woken(*found, make_character(*found, build_mesh(*found), *painted))
