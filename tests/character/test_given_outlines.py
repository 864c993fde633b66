"""Masks and label maps of one's own: what is taken as it is, what is mended, what is doubted, what is refused."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from engine.body.parts import PARTS
from engine.character.figure import Choice, find_figure
from engine.character.options import MaskStroke
from engine.character.sample import FLOOR, WALL, sample_picture
from engine.character.silhouette import cut_out
from engine.character.stages import fit_template, label
from engine.character.strokes import LABEL_COLOURS, painted
from engine.media.image import write_image
from engine.media.limits import Limits

LIMITS = Limits()


def quiet(code: str, message: str) -> None:
    """A warning that is not looked at."""


def person_in(rgb: np.ndarray) -> np.ndarray:
    """Where the sample picture (H, W, 3) shows neither wall nor floor, (H, W)."""
    return np.logical_and(*[(rgb != colour).any(-1) for colour in (WALL, FLOOR)])


def written(path: Path, mask: np.ndarray) -> Path:
    write_image(path, np.repeat(mask.astype(np.uint8)[..., None] * 255, 3, 2))
    return path


@pytest.fixture(scope="module")
def photo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("photo") / "photo.png"
    write_image(path, sample_picture())
    return path


def test_a_mask_has_the_size_of_a_picture_whose_copy_has_not_its_proportions(tmp_path: Path) -> None:
    """2251 x 3000 is looked at as 1441 x 1920, which taken back by its width would be 2251 x 2999."""
    rgb = cv2.resize(sample_picture(), (2251, 3000), interpolation=cv2.INTER_LINEAR)
    write_image(tmp_path / "photo.png", rgb)
    heel = (1210.0, 2760.0)
    figure = find_figure(tmp_path / "photo.png", Choice(placed=(("LeftHeel", *heel),)), False, LIMITS, quiet)
    assert figure.original == (2251, 3000) and figure.rgb.shape[:2] == (1920, 1441)
    np.testing.assert_allclose((figure.point("LeftHeel") + 0.5) / figure.scale - 0.5, heel, atol=1e-3)
    np.testing.assert_allclose((figure.point("LeftHeel") + 0.5) / [1441, 1920], np.add(heel, 0.5) / [2251, 3000])
    (dot,) = painted((MaskStroke(path=(heel,), radius=30, person=True),), (1920, 1441), figure.scale)
    y, x = np.mgrid[:1920, :1441]
    middle = [(dot * x).sum() / dot.sum(), (dot * y).sum() / dot.sum()]
    np.testing.assert_allclose(middle, figure.point("LeftHeel"), atol=0.1)
    mask = person_in(cv2.resize(sample_picture(), (2251, 3000), interpolation=cv2.INTER_NEAREST))
    cut = cut_out(figure, written(tmp_path / "mask.png", mask), (), LIMITS, None, None, quiet)
    small = cv2.resize(mask.astype(np.float32), (1441, 1920), interpolation=cv2.INTER_AREA)
    assert np.abs(cut.alpha - small).max() < 1e-6
    fitted = fit_template(figure, cut)
    parts = np.where(mask[..., None], LABEL_COLOURS[PARTS.index("torso")], 0).astype(np.uint8)
    write_image(tmp_path / "labels.png", parts)
    found = label(figure, cut, fitted, tmp_path / "labels.png", (), LIMITS)
    assert (found.labels[cut.mask] == PARTS.index("torso")).all()
