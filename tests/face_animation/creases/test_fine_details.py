"""Ratio images: what they are, how they are tuned down and steadied, and where they land."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from made_face import SKIN, driver, in_crop, painted, placed, smiling
from numpy.typing import NDArray

from engine.face_animation.creases.fine_details import (
    BRIGHTENING_FACTOR,
    MIN_RATIO,
    RATIO_FLOOR_GREY_LEVELS,
    RATIO_QUANTUM,
    TEMPORAL_WINDOW_FRAMES,
    DetailRegion,
    RatioImages,
    detail_region,
    face_region,
    keep_ratio_images,
    luminance,
    most_expressive,
    shade,
)
from engine.perception.face.landmarks import FACE_OVAL, LEFT_EYE, LIPS_INNER, RIGHT_EYE
from engine.perception.face_track.face_crop import CROP_SHAPE
from engine.perception.face_track.track import FaceTrack

FACE = placed(70, (100, 100))
LEVEL = 120
CHEEK = (slice(150, 190), slice(60, 100))
"""A place in the crop that lies on the cheek, away from eyes, mouth and rim."""


def plain(level: float) -> NDArray[np.uint8]:
    return np.full((*CROP_SHAPE, 3), level, np.uint8)


def with_crease(depth: float) -> NDArray[np.uint8]:
    """A narrow dark line down the cheek, of `depth` times the skin's brightness."""
    picture = plain(LEVEL)
    picture[CHEEK[0], 78:82] = round(LEVEL * depth)
    return picture


def track_of(folder: Path, pictures: list[NDArray[np.uint8]], meshes: list[NDArray] | None = None) -> FaceTrack:
    return driver(folder, meshes or [FACE] * len(pictures), pictures)


def ratios(track: FaceTrack, outliers: bool = False, refined: bool = True) -> RatioImages:
    return RatioImages(track, 0, outliers, refined)


def inside() -> NDArray[np.bool_]:
    """Pixels of the crop well within the face."""
    mask = np.zeros(CROP_SHAPE, np.uint8)
    cv2.fillPoly(mask, [in_crop(FACE)[list(FACE_OVAL), :2].round().astype(np.int32)], 1)
    return np.asarray(cv2.erode(mask, np.ones((25, 25))) > 0)


def test_a_face_that_does_not_change_has_ratio_one(tmp_path: Path) -> None:
    face = painted(in_crop(FACE), CROP_SHAPE[::-1])
    track = track_of(tmp_path, [face] * 3)
    for refined in (False, True):
        np.testing.assert_allclose(ratios(track, refined=refined).single(2), 1, atol=1e-4)


def test_the_ratio_is_that_of_luminances(tmp_path: Path) -> None:
    """Equation 2, with a floor on both sides against noise in the dark."""
    track = track_of(tmp_path, [plain(LEVEL), plain(90)])
    expected = (90 + RATIO_FLOOR_GREY_LEVELS) / (LEVEL + RATIO_FLOOR_GREY_LEVELS)
    np.testing.assert_allclose(ratios(track, refined=False).single(1)[inside()], expected, atol=0.01)


def test_luminance_is_of_the_colours() -> None:
    red = np.zeros((20, 20, 3), np.uint8)
    red[..., 0] = 200
    assert luminance(red)[10, 10] == pytest.approx(0.299 * 200, abs=1)


@pytest.mark.parametrize("depth", [0.9, 0.75])
def test_a_crease_darkens_by_its_ratio(tmp_path: Path, depth: float) -> None:
    track = track_of(tmp_path, [plain(LEVEL), with_crease(depth)])
    found = ratios(track).single(1)
    raw = ratios(track, refined=False).single(1)
    line = found[160:180, 79:81]
    assert line.max() < 1 - 0.6 * (1 - depth)
    assert line.min() > depth - 0.05
    np.testing.assert_allclose(line, raw[160:180, 79:81], atol=0.04)
    assert np.abs(found[160:180, 110:150] - 1).max() < 0.02


def test_brightening_is_tuned_down_to_a_hundredth(tmp_path: Path) -> None:
    """Section 6: for R > 1, 1 + 0.01 (R - 1)."""
    track = track_of(tmp_path, [plain(LEVEL), with_crease(1.5)])
    raw = ratios(track, refined=False).single(1)
    assert raw[170, 80] > 1.25
    assert 1 < ratios(track).single(1)[170, 80] <= 1 + BRIGHTENING_FACTOR * (raw.max() - 1) + 1e-4
    assert ratios(track).single(1).max() <= 1 + BRIGHTENING_FACTOR * (raw.max() - 1) + 1e-4


def test_nothing_darkens_beyond_the_bound(tmp_path: Path) -> None:
    track = track_of(tmp_path, [plain(LEVEL), with_crease(0.6)])
    assert ratios(track, refined=False).single(1)[170, 80] < MIN_RATIO - 0.02
    assert ratios(track).single(1).min() == pytest.approx(MIN_RATIO, abs=1e-4)


def test_shading_of_a_head_that_turns_in_fixed_light_is_no_expression(tmp_path: Path) -> None:
    """The whole cheek darkens as the head turns away: hardly a trace is left; a crease in it stays."""
    shaded = np.clip(plain(LEVEL) * np.linspace(0.6, 1.0, CROP_SHAPE[1])[None, :, None], 0, 255).astype(np.uint8)
    shaded[CHEEK[0], 78:82] = (shaded[CHEEK[0], 78:82] * 0.75).astype(np.uint8)
    track = track_of(tmp_path, [plain(LEVEL), shaded], [FACE, placed(70, (100, 100), yaw=15)])
    found = ratios(track).single(1)
    beside = found[155:185, 95:120]
    assert np.abs(beside - 1).max() < 0.12
    assert found[165:175, 60:95].min() < beside.min() - 0.08


def test_creases_fade_as_the_head_turns(tmp_path: Path) -> None:
    """What a turned head shows are the driver's shadows: half of it at 14 degrees of turn, nothing beyond 20."""
    turned = [FACE, *(placed(70, (100, 100), yaw=yaw) for yaw in (5, 14, 23))]
    track = track_of(tmp_path, [plain(LEVEL)] + [with_crease(0.75)] * 3, turned)
    darker = [1 - ratios(track).single(k)[155:185, 50:140].min() for k in (1, 2, 3)]
    assert darker[0] > 0.15
    assert 0.3 * darker[0] < darker[1] < 0.7 * darker[0]
    assert darker[2] == pytest.approx(0, abs=1e-5)


def test_ratios_are_taken_where_the_skin_went(tmp_path: Path) -> None:
    """A mole that moves with the face is in both pictures: no ratio where the mesh says it is the same skin."""
    moved = smiling(FACE, 0.15)
    rest, acted = in_crop(FACE), in_crop(moved)
    pictures = []
    for mesh in (rest, acted):
        picture = plain(LEVEL)
        cv2.circle(picture, np.round(mesh[205, :2] * 16).astype(int).tolist(), 5 * 16, (60, 60, 60), -1, cv2.LINE_AA, 4)
        pictures.append(picture)
    assert np.linalg.norm(rest[205, :2] - acted[205, :2]) > 4
    track = track_of(tmp_path, pictures, [FACE, moved])
    found = ratios(track, refined=False).single(1)
    unaligned = (luminance(pictures[1]) + RATIO_FLOOR_GREY_LEVELS) / (luminance(pictures[0]) + RATIO_FLOOR_GREY_LEVELS)
    assert np.abs(found[inside()] - 1).max() < 0.4 * np.abs(unaligned[inside()] - 1).max()


def test_in_time_a_gaussian_of_21_frames(tmp_path: Path) -> None:
    """A crease of one frame spreads evenly to both sides, within ten frames, and keeps its sum."""
    pictures = [plain(LEVEL)] * 41
    pictures[20] = with_crease(0.75)
    track = track_of(tmp_path, pictures)
    images = ratios(track)
    whole = 1 - float(images.single(20)[170, 80])
    seen = np.array([1 - float(r[170, 80]) for r in images])
    assert seen.argmax() == 20
    np.testing.assert_allclose(seen, seen[::-1], atol=1e-3)
    assert seen.sum() == pytest.approx(whole, rel=0.05)
    half = TEMPORAL_WINDOW_FRAMES // 2
    assert np.abs(seen[: 20 - half]).max() < 1e-3 and np.abs(seen[21 + half :]).max() < 1e-3
    assert (np.diff(seen[20 - half : 21]) >= -1e-4).all()


def test_there_is_a_ratio_for_every_frame_and_a_lasting_crease_is_whole(tmp_path: Path) -> None:
    for count in (2, 5, 30):
        track = track_of(tmp_path / str(count), [plain(LEVEL)] + [with_crease(0.75)] * (count - 1))
        images = ratios(track)
        given = [r[170, 80] for r in images]
        assert len(given) == count
        if count == 30:
            assert given[20] == pytest.approx(images.single(20)[170, 80], abs=0.01)


def test_kept_ratio_images_are_those_that_were_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """To a few steps of what is kept; where nothing changes they stay one exactly, and no file is left behind."""
    track = track_of(tmp_path, [plain(LEVEL)] + [with_crease(0.8), with_crease(0.9)] * 3)
    (own := tmp_path / "own").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(own))
    kept = keep_ratio_images(track, 0)
    assert list(own.iterdir()) == [kept.images.file]
    for image, expected in zip(kept, RatioImages(track, 0), strict=True):
        np.testing.assert_allclose(image, expected, atol=5 * RATIO_QUANTUM)
        assert (image[CHEEK[0], 120:150] == 1).all()
    kept.images.file.unlink()


def test_the_most_expressive_frame_is_furthest_from_neutral_after_a_similarity(tmp_path: Path) -> None:
    """However far the head went: that is no expression."""
    far = (1.4 * FACE + (50, 30, 0)).astype(np.float32)
    meshes = [FACE, far, smiling(FACE, 0.1), smiling(far, 0.25), smiling(FACE, 0.15)]
    track = track_of(tmp_path, [plain(LEVEL)] * 5, meshes)
    assert most_expressive(track, 0) == 3


SIZE = (260, 280)
TARGET = placed(60, (130, 110))


@pytest.fixture(scope="module")
def picture() -> NDArray[np.uint8]:
    """A drawn face with dark hair, on a plain background."""
    drawn = painted(TARGET, SIZE)
    hair = np.zeros(drawn.shape[:2], np.uint8)
    top = TARGET[10, :2].round().astype(int)
    cv2.ellipse(hair, (int(top[0]), int(top[1])), (110, 50), 0, 180, 360, 1, -1)
    drawn[hair > 0] = (40, 30, 25)
    noise = np.random.default_rng(0).normal(0, 3, drawn.shape)
    return np.clip(drawn + noise, 0, 255).astype(np.uint8)


def test_the_face_s_region_has_the_forehead_and_no_background(picture: NDArray) -> None:
    region = face_region(picture, TARGET)
    assert region.shape == picture.shape[:2] and region.min() >= 0 and region.max() <= 1
    for vertex in (151, 9, 50, 280, 5, 199):  # forehead, cheeks, nose, chin
        x, y = TARGET[vertex, :2].round().astype(int)
        assert region[y, x] > 0.9
    background = np.linalg.norm(picture.astype(float) - (120, 140, 160), axis=2) < 20
    away = cv2.erode(background.astype(np.uint8), np.ones((21, 21))) > 0
    assert region[away].max() < 0.02
    top = TARGET[10, :2].round().astype(int)
    assert region[top[1] - 25, top[0]] < 0.1  # the hair


def test_a_real_face_s_region(media: Callable[[str], Path]) -> None:
    from engine.media.image import read_image
    from engine.perception.face.faces import find_faces

    rgb = read_image(media("portraits/photo_woman_white.png")).rgb
    scale = 400 / max(rgb.shape[:2])
    small = cv2.resize(rgb, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    mesh = find_faces(small)[0]
    region = face_region(small, mesh)
    skin = [region[tuple(mesh[v, 1::-1].round().astype(int))] for v in (151, 9, 50, 280, 5)]
    assert min(skin) > 0.8
    reach = np.linalg.norm(mesh[10, :2] - mesh[152, :2])
    ys, xs = np.mgrid[: small.shape[0], : small.shape[1]]
    far = np.hypot(xs - mesh[4, 0], ys - mesh[4, 1]) > 0.85 * reach
    assert region[far].max() < 0.05


def identity(scale: float = 1.0) -> NDArray[np.float32]:
    ys, xs = np.mgrid[: SIZE[1], : SIZE[0]].astype(np.float32)
    return np.stack([xs, ys], axis=-1) * np.float32(scale) + np.float32(0.5 * scale - 0.5)


def shade_from(frame: NDArray, region: DetailRegion, ratio: NDArray, origin: NDArray[np.float32], scale: float) -> None:
    """Shade by a ratio image of the driver whose neutral crop is that of `FACE`."""
    shade(frame, region, region.origin(in_crop(FACE)), ratio, origin, scale)


def test_ratio_one_changes_nothing(picture: NDArray) -> None:
    frame = picture.copy()
    shade_from(frame, detail_region(picture, TARGET), np.ones(CROP_SHAPE, np.float32), identity(), 1)
    np.testing.assert_array_equal(frame, picture)


def test_a_ratio_multiplies_the_skin_and_spares_eyes_mouth_and_background(picture: NDArray) -> None:
    """Equation 3."""
    frame = picture.copy()
    details = replace(detail_region(picture, TARGET), slopes=np.ones(3, np.float32))
    shade_from(frame, details, np.full(CROP_SHAPE, 0.5, np.float32), identity(), 1)
    factor = frame.astype(float).sum(axis=2) / picture.astype(float).sum(axis=2)
    x, y = TARGET[50, :2].round().astype(int)
    x0, y0 = details.box[:2]
    expected = 1 - 0.5 * details.weight[y - y0, x - x0]
    assert factor[y, x] == pytest.approx(expected, abs=0.02)
    x, y = TARGET[5, :2].round().astype(int)
    assert 0.7 < factor[y, x] < 0.95, "the nose is mostly spared"
    for contour in (LEFT_EYE, RIGHT_EYE, LIPS_INNER):
        x, y = TARGET[list(contour), :2].mean(axis=0).round().astype(int)
        assert factor[y, x] > 0.9
    oval = np.zeros(picture.shape[:2], np.uint8)
    cv2.fillPoly(oval, [TARGET[list(FACE_OVAL), :2].round().astype(np.int32)], 1)
    np.testing.assert_array_equal(
        frame[cv2.dilate(oval, np.ones((3, 3))) == 0], picture[cv2.dilate(oval, np.ones((3, 3))) == 0]
    )


def test_ratios_land_on_the_same_part_of_the_face(picture: NDArray) -> None:
    """A dark spot at a vertex of the driver's face darkens the target there."""
    crop = in_crop(FACE)
    details = detail_region(picture, TARGET)
    for vertex in (50, 280, 151):
        spot = np.ones(CROP_SHAPE, np.float32)
        cv2.circle(spot, crop[vertex, :2].round().astype(int).tolist(), 4, 0.5, -1)
        frame = picture.copy()
        shade_from(frame, details, spot, identity(), 1)
        drop = np.clip(picture.astype(float).sum(axis=2) - frame.astype(float).sum(axis=2), 0, None)
        ys, xs = np.mgrid[: SIZE[1], : SIZE[0]]
        centre = np.array([(xs * drop).sum(), (ys * drop).sum()]) / drop.sum()
        np.testing.assert_allclose(centre, TARGET[vertex, :2], atol=1.5)


def test_ratios_move_with_the_warp(picture: NDArray) -> None:
    """Through an inverse map that shifts, in pixels of the picture or of one twice as large."""
    details = detail_region(picture, TARGET)
    ratio = np.ones(CROP_SHAPE, np.float32)
    cv2.circle(ratio, in_crop(FACE)[50, :2].round().astype(int).tolist(), 6, 0.6, -1)
    still = np.full_like(picture, 200)
    shade_from(still, details, ratio, identity(), 1)
    for scale in (1, 2):
        moved = np.full_like(picture, 200)
        shade_from(moved, details, ratio, identity(scale) - scale * np.array([7, -5], np.float32), scale)
        np.testing.assert_allclose(
            np.roll(still, (-5, 7), axis=(0, 1))[20:-20, 20:-20].astype(int), moved[20:-20, 20:-20].astype(int), atol=1
        )


@pytest.mark.parametrize("slopes", [(1, 1, 1), (0.7, 1.1, 1.3)], ids=["hue is kept", "redder in the shade"])
def test_each_channel_darkens_by_its_slope(picture: NDArray, slopes: tuple[float, ...]) -> None:
    flat = np.empty_like(picture)
    flat[:] = SKIN
    details = replace(detail_region(picture, TARGET), slopes=np.array(slopes, np.float32))
    shade_from(flat, details, np.full(CROP_SHAPE, 0.7, np.float32), identity(), 1)
    x, y = TARGET[50, :2].round().astype(int)
    x0, y0 = details.box[:2]
    expected = 1 - 0.3 * details.weight[y - y0, x - x0] * details.slopes
    assert expected.max() < 0.9
    np.testing.assert_allclose(flat[y, x] / np.array(SKIN), expected, atol=0.01)
