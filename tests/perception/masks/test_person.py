"""Person masks against known alphas, and against faces on every portrait."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from engine.imaging.alpha.matting import estimate_foreground
from engine.perception.face.faces import find_faces
from engine.perception.masks.person import person_mask

Media = Callable[[str], Path]

PORTRAITS = (
    *("cartoon_boy_3d.jpg", "drawing_young_man.png", "painting_man_cap.png", "painting_mona_lisa.jpg"),
    *("painting_woman_black_dress.jpg", "pair1_neutral.png", "photo_biden.jpg", "photo_bw_dylan.jpg"),
    *("photo_bw_einstein.jpg", "photo_man_suit.png", "photo_woman_outdoor.jpg", "photo_woman_white.png"),
)


def read(path: Path) -> np.ndarray:
    return cv2.imread(str(path))[..., ::-1].copy()


def overlap(mask: np.ndarray, truth: np.ndarray) -> float:
    """Intersection over union of where both exceed a half."""
    found, true = mask > 0.5, truth > 0.5
    return float((found & true).sum() / (found | true).sum())


def landscape(height: int, width: int) -> np.ndarray:
    """A made-up background: sky, hills, grass and a fence."""
    rng = np.random.default_rng(5)
    ys, xs = np.mgrid[:height, :width].astype(np.float32)
    scene = np.stack([150 - 0.1 * ys, 180 - 0.1 * ys, 220 - 0.05 * ys], -1)
    texture = cv2.GaussianBlur(rng.normal(size=(height, width)).astype(np.float32), (0, 0), 2)
    hills = ys > height * (0.5 + 0.1 * np.sin(xs * 6 / width))
    scene[hills] = np.float32([90, 120, 60]) + 90 * texture[hills, None]
    scene[np.abs(ys - 0.6 * height) < 4] = (120, 90, 60)
    scene[(xs % 90 < 6) & (ys > 0.55 * height) & (ys < 0.7 * height)] = (120, 90, 60)
    return scene


def test_man_from_a_turntable_in_front_of_a_landscape(media: Media) -> None:
    picture = read(media("orbit/turntable_man/frames/0000.png")).astype(np.float32)
    parts = cv2.imread(str(media("orbit/turntable_man/segmentations/0000.png"))).max(axis=2) > 0
    parts = cv2.morphologyEx(parts.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((5, 5), np.uint8))
    truth = cv2.GaussianBlur(parts.astype(np.float32), (0, 0), 0.8)
    front = estimate_foreground(picture, cv2.erode(parts.astype(np.float32), np.ones((3, 3))))
    composed = truth[..., None] * front + (1 - truth[..., None]) * landscape(*truth.shape)
    mask = person_mask(composed.astype(np.uint8))
    assert overlap(mask, truth) > 0.98
    assert np.abs(mask - truth).sum() < 0.025 * truth.sum()


def test_head_from_a_green_screen_in_front_of_a_landscape(media: Media) -> None:
    video = cv2.VideoCapture(str(media("driving/man_grimace_d0.mp4")))
    frame = video.read()[1][:484, :, ::-1].astype(np.float32)
    video.release()
    screen = np.median(frame[:60].reshape(-1, 3), axis=0)
    excess = frame[..., 1] - np.maximum(frame[..., 0], frame[..., 2])
    full = screen[1] - max(screen[0], screen[2])
    truth = 1 - np.clip((excess - 0.1 * full) / (0.8 * full), 0, 1)
    front = (frame - (1 - truth[..., None]) * screen) / np.maximum(truth, 0.15)[..., None]
    front[..., 1] = np.minimum(front[..., 1], np.maximum(front[..., 0], front[..., 2]))
    composed = truth[..., None] * front + (1 - truth[..., None]) * landscape(*truth.shape)
    mask = person_mask(np.clip(composed, 0, 255).astype(np.uint8))
    assert overlap(mask, truth) > 0.98
    assert np.abs(mask - truth).sum() < 0.025 * truth.sum()


@pytest.mark.parametrize("name", ["scan_render_corey_wave.jpg", "scan_render_lee_suit.jpg"])
def test_rendered_people_on_plain_grey(media: Media, name: str) -> None:
    picture = read(media(f"fullbody/{name}"))
    differs = (np.abs(picture.astype(int) - picture[5, 5].astype(int)).max(axis=2) > 10).astype(np.uint8)
    closed = cv2.morphologyEx(differs, cv2.MORPH_CLOSE, np.ones((7, 7), np.uint8))
    outlines, _ = cv2.findContours(closed, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    truth = cv2.drawContours(np.zeros_like(closed), [max(outlines, key=cv2.contourArea)], -1, 1, -1)
    assert overlap(person_mask(picture), truth) > 0.97


@pytest.mark.parametrize("name", PORTRAITS)
def test_no_portraits_face_is_chopped_and_the_corners_above_stay_free(media: Media, name: str) -> None:
    picture = read(media(f"portraits/{name}"))
    mask = person_mask(picture)
    assert mask.shape == picture.shape[:2]
    assert mask.dtype == np.float32
    mesh = find_faces(picture)[0][:, :2]
    hull = cv2.convexHull(np.round(mesh).astype(np.int32))
    face = cv2.fillConvexPoly(np.zeros(mask.shape, np.uint8), hull, 1) > 0
    assert mask[face].mean() > 0.995
    assert (mask[face] > 0.9).mean() > 0.99
    assert min(mask[:3, :3].mean(), mask[:3, -3:].mean()) < 0.02


def test_own_alpha_is_the_truth_but_an_opaque_one_says_nothing(media: Media) -> None:
    picture = read(media("portraits/pair1_neutral.png"))
    height, width = picture.shape[:2]
    cut = np.zeros((height, width), np.uint8)
    cut[50:200, 60:180] = 255
    np.testing.assert_array_equal(person_mask(picture, alpha=cut), cut / np.float32(255))
    opaque = np.full((height, width), 255, np.uint8)
    np.testing.assert_array_equal(person_mask(picture, alpha=opaque), person_mask(picture))


def test_child_drawing_is_filled_to_its_outline(media: Media) -> None:
    """Looked at: head, both arms, belly and both legs are in, the paper between the legs is out."""
    mask = person_mask(read(media("fullbody/drawing_child_boy.png")))
    for inside in ((240, 130), (250, 300), (120, 500), (400, 480), (60, 280), (440, 250)):
        assert mask[inside[1], inside[0]] > 0.9, inside
    for outside in ((250, 500), (40, 100), (460, 100), (20, 580), (480, 580)):
        assert mask[outside[1], outside[0]] < 0.1, outside


def test_seed_brings_in_what_the_networks_miss() -> None:
    """A disk that no network takes for a person, on grey paper, is cut along its edge once it is seeded."""
    ys, xs = np.mgrid[:200, :240]
    away = np.hypot(xs - 120, ys - 100)
    picture = np.where((away < 60)[..., None], np.uint8([230, 200, 60]), np.uint8([120, 130, 140])).astype(np.uint8)
    seed = (away < 45).astype(np.float32)
    mask = person_mask(picture, seed=seed)
    assert (mask[away < 40] > 0.95).all()
    assert mask[away > 75].max() < 0.05


def test_nobody_there() -> None:
    assert person_mask(landscape(240, 320).astype(np.uint8)).max() < 0.05


def test_large_pictures_get_fine_edges(media: Media) -> None:
    """At three times the size, beyond the working size, the mask is that of the small picture, enlarged."""
    picture = read(media("portraits/photo_man_suit.png"))
    large = cv2.resize(picture, None, fx=2, fy=2, interpolation=cv2.INTER_CUBIC)
    mask, large_mask = person_mask(picture), person_mask(large)
    assert large_mask.shape == large.shape[:2]
    enlarged = cv2.resize(mask, large.shape[1::-1], interpolation=cv2.INTER_LINEAR)
    assert overlap(large_mask, enlarged) > 0.985


def test_what_is_known_to_be_the_persons_is_in_the_mask(media: Media) -> None:
    """A line through the background, narrower than the band along the outline."""
    picture = read(media("fullbody/man_sweater_boots.png"))
    seed = np.zeros(picture.shape[:2], np.float32)
    height, width = seed.shape
    rows, columns = slice(height // 2, height // 2 + 8), slice(0, width // 3)
    seed[rows, columns] = 1
    mask = person_mask(picture, seed=seed)
    assert mask[rows, columns][2:-2].mean() > 0.9


def test_a_drawn_face_on_plain_paper_is_cut_out_whole_where_it_is_known_to_be_one() -> None:
    """A disk with an outline, in which networks see nobody: the face's middle was placed by hand."""
    y, x = np.mgrid[:400, :400]
    away = np.hypot(y - 200, x - 200)
    drawn = np.full((400, 400, 3), 255, np.uint8)
    drawn[away < 140] = (120, 80, 0)
    drawn[away < 135] = (255, 210, 40)
    for eye in (160, 240):
        drawn[np.hypot(y - 170, x - eye) < 14] = (60, 30, 10)
    assert not (person_mask(drawn) > 0.5).any()
    disk = away < 140
    found = person_mask(drawn, seed=(away < 90).astype(np.float32)) > 0.5
    assert (found & disk).sum() / (found | disk).sum() > 0.985
