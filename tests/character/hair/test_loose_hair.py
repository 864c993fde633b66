"""Heads beside loose hair: the template's, with a surface of hair around it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from engine.character.film.person import Person
from engine.character.hybrid.head import TRUNK_BEHIND_HEAD_PIXELS
from engine.character.hybrid.hybrid import Hybrid
from engine.character.options import CharacterOptions
from engine.character.parts.labels import HEAD_LABEL, TRUNK_LABEL
from engine.character.pipeline import cut_all_out, find_figures, reconstruct
from engine.character.rig.measures import picture_camera, pose
from engine.imaging.masks.mask_distance import distance_to
from engine.render.scene.character import draw_character, prepare_character
from engine.run import Run


class Recording(Run):
    """A run that remembers its mesh."""

    built: Any = None

    def stage(self, name: str, function: Callable[..., Any], *given: Any, **more: Any) -> Any:
        result = super().stage(name, function, *given, **more)
        if name == "build_mesh":
            self.built = result
        return result


def made(photo: Path) -> tuple[Hybrid, Person]:
    options = CharacterOptions()
    with Recording() as run:
        (figure,), (silhouette,) = cut_all_out(find_figures(photo, options, run), None, options, run)
        person = reconstruct(figure, silhouette, None, options, run)
    assert isinstance(run.built, Hybrid)
    return run.built, person


def test_a_head_with_loose_hair_is_the_template_s_with_a_surface_of_hair(media: Callable[[str], Path]) -> None:
    """A woman with black, straight hair to her shoulders; from before her head is the picture's."""
    found, person = made(media("fullbody/woman_white_dress.png"))
    assert (found.limbs.limb == HEAD_LABEL).any() and not (found.labels.labels == HEAD_LABEL).any()
    (hair,) = (piece for piece in found.shell.pieces if piece.colours is not None)
    assert hair.colours is not None and hair.colours.rgb.mean() < 60, "black all round"
    head = person.labels.labels == HEAD_LABEL
    rows = np.flatnonzero(head.any(1))
    assert abs(hair.vertices[:, 1].min() - rows[0]) < 4 and hair.vertices[:, 1].max() > rows[-1] - 4
    rgb, character = person.figure.rgb, person.character
    camera = picture_camera(character, person.fitted, (rgb.shape[0], rgb.shape[1]))
    plain = np.full_like(rgb, 128)
    drawn = draw_character(
        prepare_character(character.mesh), pose(character, character.pictured), camera, plain, shading=0.0
    ).rgb
    inner = cv2.erode(head.astype(np.uint8), np.ones((5, 5), np.uint8)).astype(np.float32)
    size, flags = (rgb.shape[1], rgb.shape[0]), cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    inside = cv2.warpAffine(inner, person.silhouette.to_grid, size, flags=flags) > 0.99
    off = np.abs(cv2.GaussianBlur(drawn, (0, 0), 2).astype(float) - cv2.GaussianBlur(rgb, (0, 0), 2)).mean(-1)[inside]
    assert off.mean() < 1.2 and np.quantile(off, 0.95) < 5, "levels"


def test_a_scarf_that_stands_up_is_the_trunks(media: Callable[[str], Path]) -> None:
    """A man with short hair, whose olive scarf is labelled as his head up to the chin."""
    found, person = made(media("fullbody/man_green_coat.png"))
    bare = person.labels.bare.labels
    moved = (bare == HEAD_LABEL) & (found.labels.labels == TRUNK_LABEL)
    moved &= distance_to(bare == TRUNK_LABEL) > TRUNK_BEHIND_HEAD_PIXELS + 1
    assert moved.sum() > 300
    green = person.silhouette.rgb[moved, 1]
    assert np.median(green) < 70, "olive; at its upper edge the trunk goes on behind the chin"
    red, green, blue = person.silhouette.rgb.astype(int).transpose(2, 0, 1)
    lining = (bare == HEAD_LABEL) & (red > 120) & (red > 2.5 * np.maximum(green, blue))
    assert lining.sum() > 60 and (found.labels.labels == TRUNK_LABEL)[lining].mean() > 0.95, "red, like nothing below"
