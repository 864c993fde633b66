"""Masks and label maps of one's own: what is taken as it is, what is mended, what is doubted, what is refused."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from engine.body.parts import BODY_PARTS
from engine.character.figure.figure import Choice, Figure, find_figure
from engine.character.figure.silhouette import Silhouette, cut_out
from engine.character.figure.strokes import LABEL_COLOURS, painted, read_labels
from engine.character.fit.template_fit import FittedBody
from engine.character.options import MaskStroke
from engine.character.sample import FLOOR_COLOUR, WALL_COLOUR, sample_picture
from engine.character.stages import build_mesh, fit_template, label
from engine.errors import InputError
from engine.media.image import write_image
from engine.media.limits import Limits

LIMITS = Limits()


HEAD, TORSO, LEFT_ARM, RIGHT_ARM, LEFT_LEG, RIGHT_LEG = range(len(BODY_PARTS))


def quiet(code: str, message: str) -> None:
    """A warning that is not looked at."""


def person_in(rgb: np.ndarray) -> np.ndarray:
    """Where the sample picture (H, W, 3) shows neither wall nor floor, (H, W)."""
    return np.logical_and(*[(rgb != colour).any(-1) for colour in (WALL_COLOUR, FLOOR_COLOUR)])


def written(path: Path, mask: np.ndarray) -> Path:
    write_image(path, np.repeat(mask.astype(np.uint8)[..., None] * 255, 3, 2))
    return path


@pytest.fixture(scope="module")
def figure(tmp_path_factory: pytest.TempPathFactory) -> Figure:
    path = tmp_path_factory.mktemp("photo") / "photo.png"
    write_image(path, sample_picture())
    return find_figure(path, Choice(), False, LIMITS, quiet)


@pytest.fixture(scope="module")
def silhouette(figure: Figure) -> Silhouette:
    return cut_out(figure, None, (), LIMITS, None, None, quiet)


@pytest.fixture(scope="module")
def fitted(figure: Figure, silhouette: Silhouette) -> FittedBody:
    return fit_template(figure, silhouette)


@pytest.fixture(scope="module")
def own(figure: Figure, silhouette: Silhouette, fitted: FittedBody) -> np.ndarray:
    """The labels (H, W) that are found, in the picture."""
    labels = label(figure, silhouette, fitted, None, (), LIMITS, quiet).labels
    back, size = cv2.invertAffineTransform(silhouette.to_grid), figure.rgb.shape[1::-1]
    return cv2.warpAffine(labels, back, size, flags=cv2.INTER_NEAREST, borderValue=(-1,))


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
    parts = np.where(mask[..., None], LABEL_COLOURS[BODY_PARTS.index("torso")], 0).astype(np.uint8)
    write_image(tmp_path / "labels.png", parts)
    found = label(figure, cut, fitted, tmp_path / "labels.png", (), LIMITS, quiet)
    assert (found.labels[cut.mask] == BODY_PARTS.index("torso")).all()


def test_a_ragged_mask_makes_a_surface(
    figure: Figure, silhouette: Silhouette, fitted: FittedBody, tmp_path: Path
) -> None:
    """Three of ten pixels are missing: what is left hangs together by corners, too, over which depth cannot go."""
    holes = np.random.default_rng(0).random(figure.rgb.shape[:2]) > 0.7
    mask = written(tmp_path / "mask.png", (silhouette.alpha > 0.5) & ~holes)
    cut = cut_out(figure, mask, (), LIMITS, None, None, quiet)
    assert cv2.connectedComponents(cut.mask.astype(np.uint8), connectivity=4)[0] == 2
    mesh = build_mesh(figure, cut, fitted, label(figure, cut, fitted, None, (), LIMITS, quiet))
    deep = mesh.vertices[:, 2]
    assert np.isfinite(mesh.vertices).all()
    assert np.ptp(deep) < 0.4 * cut.mask.shape[0], "people are not so thick"


def told_of(figure: Figure, mask: np.ndarray, path: Path) -> list[str]:
    warnings: list[str] = []
    cut_out(figure, written(path, mask), (), LIMITS, None, None, lambda code, message: warnings.append(code))
    return warnings


def test_a_mask_that_is_not_the_persons_is_doubted(figure: Figure, silhouette: Silhouette, tmp_path: Path) -> None:
    path, own = tmp_path / "mask.png", silhouette.alpha > 0.5
    nothing = np.zeros_like(own)
    spot, stripe = nothing.copy(), nothing.copy()
    spot[250:280, 200:240] = stripe[100:500, 224:227] = True
    assert told_of(figure, own, path) == []
    assert told_of(figure, cv2.dilate(own.astype(np.uint8), np.ones((15, 15))) > 0, path) == [], "a wide coat"
    assert told_of(figure, ~nothing, path) == ["mask_too_large"]
    assert "mask_misses_joints" in told_of(figure, ~own, path)
    assert told_of(figure, spot, path) == ["mask_misses_joints"]
    assert told_of(figure, stripe, path) == ["mask_misses_joints"]
    above = own.copy()
    above[round(float(figure.point("LeftHip")[1])) :] = False
    assert told_of(figure, above, path) == ["mask_misses_joints"]


def painted_map(labels: np.ndarray, path: Path) -> Path:
    write_image(path, LABEL_COLOURS[labels.astype(int)])
    return path


def test_a_map_that_shows_no_parts_is_refused(
    figure: Figure, silhouette: Silhouette, fitted: FittedBody, own: np.ndarray, tmp_path: Path
) -> None:
    shape = figure.rgb.shape
    noise = np.random.default_rng(0).integers(0, 256, shape).astype(np.uint8)
    maps = [np.zeros(shape, np.uint8), np.full(shape, 255, np.uint8), noise, figure.rgb]
    maps += [LABEL_COLOURS[np.full(shape[:2], part)] for part in (HEAD, LEFT_ARM)]
    maps += [LABEL_COLOURS[np.where(own == TORSO, HEAD, own).astype(int)]]
    for rgb in maps:
        write_image(tmp_path / "labels.png", rgb)
        with pytest.raises(InputError) as refused:
            label(figure, silhouette, fitted, tmp_path / "labels.png", (), LIMITS, quiet)
        assert (refused.value.code, refused.value.correctable) == ("labels_unreadable", ("labels",))


def test_colours_that_jpeg_changed_are_read_and_those_of_soft_edges_are_not(own: np.ndarray, tmp_path: Path) -> None:
    rgb = LABEL_COLOURS[own.astype(int)]
    write_image(tmp_path / "labels.jpg", rgb, quality=80)
    read = read_labels(tmp_path / "labels.jpg", [rgb.shape[1::-1]], LIMITS)
    inner = cv2.erode((own >= 0).astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    assert (read == own)[inner].mean() > 0.9
    between = np.full((16, 16, 3), LABEL_COLOURS[[TORSO, LEFT_ARM]].mean(0), np.uint8)
    write_image(tmp_path / "between.png", between)
    assert (read_labels(tmp_path / "between.png", [(16, 16)], LIMITS) == -1).all()


def test_a_map_unlike_the_skeleton_is_doubted(
    figure: Figure, silhouette: Silhouette, fitted: FittedBody, own: np.ndarray, tmp_path: Path
) -> None:
    def told(labels: np.ndarray) -> list[tuple[str, str]]:
        warnings: list[tuple[str, str]] = []
        path = painted_map(labels, tmp_path / "labels.png")
        label(figure, silhouette, fitted, path, (), LIMITS, lambda code, message: warnings.append((code, message)))
        return warnings

    assert told(own) == []
    exchanged = own.copy()
    exchanged[own == LEFT_ARM], exchanged[own == RIGHT_ARM] = RIGHT_ARM, LEFT_ARM
    ((code, message),) = told(exchanged)
    assert code == "labels_unlike_joints"
    assert "left arm, right arm" in message and "leg" not in message and "exchanged" in message
    ((code, message),) = told(np.where(own == LEFT_LEG, TORSO, own))
    assert code == "labels_unlike_joints" and "left leg. Paint" in message
    ((_, message),) = told(np.where(own >= 0, TORSO, -1))
    assert all(limb in message for limb in ("left arm", "right arm", "left leg", "right leg"))


def test_an_outline_that_goes_on_beneath_the_feet_is_made_too(figure: Figure, tmp_path: Path) -> None:
    """An ellipse around somebody: round both legs as a skirt is, with an end that is below all of the template's legs."""
    height, width = figure.rgb.shape[:2]
    ellipse = np.zeros((height, width), np.uint8)
    axes = (round(0.28 * width), round(0.435 * height))
    cv2.ellipse(ellipse, (width // 2, round(0.535 * height)), axes, 0, 0, 360, 1, -1)
    own = cut_out(figure, written(tmp_path / "mask.png", ellipse > 0), (), LIMITS, None, None, quiet)
    fitted = fit_template(figure, own)
    labels = label(figure, own, fitted, None, (), LIMITS, quiet)
    assert labels.cloth is not None and labels.cloth.hangs
    mesh = build_mesh(figure, own, fitted, labels)
    covered = mesh.seen_layer((own.mask.shape[0], own.mask.shape[1])) >= 0
    assert (covered & own.mask).sum() > 0.98 * own.mask.sum()
