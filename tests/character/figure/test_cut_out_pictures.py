"""Pictures that are cut out: what their alpha hides is in nothing that is made of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from engine.character.figure.figure import Choice, Figure, find_figure
from engine.character.figure.silhouette import Silhouette, cut_out
from engine.character.figure.strokes import read_mask
from engine.character.film.background import fill_background
from engine.character.sample import FLOOR_COLOUR, WALL_COLOUR, sample_picture
from engine.media.image import write_image
from engine.media.limits import Limits

Found = tuple[Figure, Silhouette]


def nobody(rgb: np.ndarray) -> np.ndarray:
    """Where the sample picture shows wall and floor (h, w)."""
    apart = np.min([np.abs(rgb.astype(int) - colour).sum(-1) for colour in (WALL_COLOUR, FLOOR_COLOUR)], axis=0)
    return cv2.morphologyEx((apart < 3).astype(np.uint8), cv2.MORPH_OPEN, np.ones((3, 3))) > 0


def woken(path: Path) -> Found:
    told: list[str] = []
    figure = find_figure(path, Choice(None, None, ()), False, Limits(), lambda code, message: told.append(code))
    return figure, cut_out(figure, None, (), Limits(), None, None, lambda code, message: told.append(code))


@pytest.fixture(scope="module")
def cut(tmp_path_factory: pytest.TempPathFactory) -> Found:
    """The sample picture cut out by its alpha, magenta beneath."""
    rgb = sample_picture(400)
    hidden = nobody(rgb)
    rgb[hidden] = (255, 0, 255)
    path = tmp_path_factory.mktemp("cut") / "cut.png"
    write_image(path, rgb, 1 - hidden.astype(np.float32))
    return woken(path)


def magenta(rgb: np.ndarray) -> float:
    return float((np.abs(rgb.astype(int) - (255, 0, 255)).sum(-1) < 200).mean())


def test_the_person_is_what_the_alpha_shows(cut: Found) -> None:
    figure, silhouette = cut
    assert figure.alpha is not None and np.abs(silhouette.alpha - figure.alpha).mean() < 0.003
    assert magenta(figure.rgb) == magenta(silhouette.rgb) == 0


def test_behind_a_cut_out_person_there_is_white(cut: Found) -> None:
    figure, silhouette = cut
    background = fill_background(figure, (silhouette,))
    assert background.empty and background.rgb.min() >= 250


def test_a_hole_cut_into_a_picture_stays_one(tmp_path: Path) -> None:
    """A corner is cut off, the person stands before the rest: the corner is white, the rest is filled in, and the film is
    no cut-out."""
    rgb, alpha = sample_picture(400), np.ones((400, 300), np.float32)
    rgb[:80, :80], alpha[:80, :80] = (255, 0, 255), 0
    write_image(tmp_path / "cut.png", rgb, alpha)
    person = (~nobody(rgb)).astype(np.float32)
    person[:100] = 0
    write_image(tmp_path / "mask.png", np.repeat((255 * person).astype(np.uint8)[..., None], 3, 2))
    warn: Callable[[str, str], None] = lambda code, message: None  # noqa: E731
    figure = find_figure(tmp_path / "cut.png", Choice(None, None, ()), False, Limits(), warn)
    silhouette = cut_out(figure, tmp_path / "mask.png", (), Limits(), None, None, warn)
    background = fill_background(figure, (silhouette,))
    assert magenta(background.rgb) == 0 and background.rgb[:70, :70].min() >= 250
    assert not background.empty and np.abs(background.rgb[200, 20].astype(int) - WALL_COLOUR).max() < 4


def test_a_mask_may_be_the_alpha_of_a_picture(tmp_path: Path) -> None:
    alpha = np.linspace(0, 1, 64, dtype=np.float32)[None].repeat(48, 0)
    write_image(tmp_path / "mask.png", np.full((48, 64, 3), 90, np.uint8), alpha)
    assert read_mask(tmp_path / "mask.png", [(64, 48)], Limits()) == pytest.approx(alpha, abs=0.003)
