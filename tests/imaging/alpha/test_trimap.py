"""What is left open along an outline."""

from __future__ import annotations

import cv2
import numpy as np

from engine.imaging.alpha.trimap import like_plain_background, outline_trimap

HEIGHT, WIDTH = 300, 300


def belief_in_disk(softness: float = 4) -> np.ndarray:
    ys, xs = np.mgrid[:HEIGHT, :WIDTH]
    return (1 / (1 + np.exp((np.hypot(xs - 150, ys - 150) - 70) / softness))).astype(np.float32)


def dark_disk_on_a_wall() -> np.ndarray:
    ys, xs = np.mgrid[:HEIGHT, :WIDTH]
    wall = 180 + np.random.default_rng(0).normal(0, 2, (HEIGHT, WIDTH, 3))
    wall[np.hypot(xs - 150, ys - 150) < 70] = 40
    return wall.astype(np.uint8)


def test_the_band_is_narrow_and_the_rest_is_settled() -> None:
    known = outline_trimap(dark_disk_on_a_wall(), belief_in_disk()).known
    assert known[150, 150] == 1
    assert known[10, 10] == 0
    assert known[150, 220] == 0.5
    assert (known == 0.5).mean() < 0.08


def test_a_strand_that_hangs_on_is_opened_and_a_line_that_runs_on_is_not() -> None:
    picture = dark_disk_on_a_wall()
    cv2.line(picture, (150, 150), (150, 69), (40, 40, 40), 2)  # ends in mid-air: hair
    cv2.line(picture, (150, 250), (299, 250), (40, 40, 40), 2)  # elsewhere
    cv2.line(picture, (150, 150), (299, 150), (40, 40, 40), 2)  # runs on to the border: a wire
    known = outline_trimap(picture, belief_in_disk()).known
    assert known[72, 150] == 0.5
    assert known[150, 240] == 0
    assert known[250, 200] == 0


def test_doubts_inside_are_the_layer() -> None:
    belief = belief_in_disk()
    belief[145:155, 145:155] = 0.5
    known = outline_trimap(dark_disk_on_a_wall(), belief).known
    assert (known[140:160, 140:160] == 1).all()


def test_nothing_believed_in_leaves_nothing_open() -> None:
    known = outline_trimap(dark_disk_on_a_wall(), np.zeros((HEIGHT, WIDTH), np.float32)).known
    assert not known.any()


def test_what_has_the_colours_of_a_plain_wall_is_told_from_what_has_not() -> None:
    rgb = dark_disk_on_a_wall()
    disk = belief_in_disk() > 0.5
    around = cv2.dilate(disk.astype(np.uint8), np.ones((25, 25), np.uint8)) > 0
    within = cv2.erode(disk.astype(np.uint8), np.ones((9, 9), np.uint8)) > 0
    plain = like_plain_background(rgb, ~around)
    assert plain[~around].mean() > 0.99 and not plain[within].any()
    noisy = np.random.default_rng(1).integers(0, 255, rgb.shape, np.uint8)
    assert not like_plain_background(noisy, ~around).any()
