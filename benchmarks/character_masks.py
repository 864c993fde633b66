"""Masks of people against known alpha.

    python -m benchmarks.character_masks [--only WORD]

The cut-outs of the test media are laid into places in which nobody is, on white paper, and before a plain wall on which
they cast a shadow. Scanned, rigged and dressed people are drawn into the same places. What is found as of any user's
picture is held against the true alpha above one half. "F" is the boundary F-score (Perazzi and others, A Benchmark
Dataset and Evaluation Methodology for Video Object Segmentation, CVPR 2016), with a tolerance of 0.4% of the person's
height. "Gaps" is how much is found of what of the background the limbs enclose or nearly enclose, and "shadow" how much
of the cast shadow was taken for the person.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from benchmarks.character_truth import people
from benchmarks.known_truth.known_person import PERSON_PICTURE_SIZE, draw_into
from benchmarks.known_truth.known_places import places
from benchmarks.presentation.tables import machine, table
from benchmarks.shared_media import media
from engine.character.figure.figure import Choice, find_figure
from engine.character.figure.silhouette import cut_out
from engine.errors import InputError
from engine.imaging.masks.mask_pieces import bounding_box, mask_height
from engine.media.image import is_cut_out, read_image
from engine.media.limits import Limits

PERSON_SHARE = 0.85
"""Share of the picture's height, or width, that a cut-out takes."""
BOUNDARY_TOLERANCE_SHARE = 0.004
"""Of the boundary, as a share of the person's height."""
GAP_HALF_WIDTH_SHARE = 0.035
"""Half the width of gaps, as a share of the person's height: what a disk of this radius closes."""
MIN_GAP_HALF_WIDTH_SHARE = 0.004
"""Half the width of the narrowest gaps that count."""
PICTURE_PAPER_GREY_LEVEL, WALL_RGB = 250, (196, 190, 180)
SHADOW_OFFSET_SHARES, SHADOW_SIGMA_SHARE, SHADOW_BRIGHTNESS = (0.06, 0.015), 0.012, 0.5
"""A cast shadow: how far it lies from the person along x and y and how soft it is, as shares of the picture's height, and what of
the light is missing."""


@dataclass(frozen=True)
class KnownMask:
    """`rgb` (H, W, 3) shows somebody whose coverage is `alpha` (H, W); `shadow` (H, W): where their shadow falls, or nothing."""

    name: str
    place: str
    rgb: NDArray[np.uint8]
    alpha: NDArray[np.float32]
    shadow: NDArray[np.bool_]


@dataclass(frozen=True)
class MaskScore:
    """Shares of one: of union, of the boundaries, of gaps, of the shadow; NaN of what is not there."""

    iou: float
    boundary: float
    gaps: float
    shadow: float


def cut_outs() -> Iterator[tuple[str, NDArray[np.uint8], NDArray[np.float32]]]:
    """Names, colours (H, W, 3) and alpha (H, W) of the pictures that are cut out, no more than the person."""
    for path in sorted(media("fullbody").glob("*.png")):
        picture = read_image(path, Limits())
        if picture.alpha is None or not is_cut_out(picture.alpha) or picture.alpha.mean() > 0.5:
            continue
        box = bounding_box(picture.alpha > 0.02)
        yield path.stem, np.ascontiguousarray(picture.rgb[box]), np.ascontiguousarray(picture.alpha[box])


def known_masks() -> Iterator[KnownMask]:
    """All pictures: each cut-out in three of the places, and the people of `character_truth` where they stand."""
    rooms = places(PERSON_PICTURE_SIZE)
    plain = np.full((*PERSON_PICTURE_SIZE, 3), PICTURE_PAPER_GREY_LEVEL, np.uint8)
    wall = np.broadcast_to(np.array(WALL_RGB, np.uint8), plain.shape).copy()
    grounds = [*rooms.items(), ("paper", plain), ("wall, shadow", wall)]
    for k, (name, rgb, alpha) in enumerate(cut_outs()):
        for j in range(3):
            place, ground = grounds[(k + 2 * j) % len(grounds)]
            yield lay_into(name, rgb, alpha, place, ground)
        if k % 2:
            yield lay_into(name, rgb, alpha, *grounds[-1])
    for person, place in people():
        drawn = draw_into(person, rooms[place])
        yield KnownMask(person.name, place, drawn.rgb, drawn.alpha, np.zeros(drawn.alpha.shape, np.bool_))


def lay_into(
    name: str, rgb: NDArray[np.uint8], alpha: NDArray[np.float32], place: str, ground: NDArray[np.uint8]
) -> KnownMask:
    """A cut-out in the middle of a place, low in it; before a wall with its shadow."""
    height, width = ground.shape[:2]
    scale = PERSON_SHARE * min(height / rgb.shape[0], width / rgb.shape[1])
    size = (round(rgb.shape[1] * scale), round(rgb.shape[0] * scale))
    how = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
    colour = cv2.resize(rgb.astype(np.float32) * alpha[..., None], size, interpolation=how)
    cover = cv2.resize(alpha, size, interpolation=how)
    left, top = (width - size[0]) // 2, round(0.96 * height) - size[1]
    whole, shown = np.zeros((height, width), np.float32), np.zeros(ground.shape, np.float32)
    whole[top : top + size[1], left : left + size[0]] = np.clip(cover, 0, 1)
    shown[top : top + size[1], left : left + size[0]] = colour
    lit = np.ones((height, width, 1), np.float32)
    if "shadow" in place:
        move = np.array(
            [[1, 0, SHADOW_OFFSET_SHARES[0] * height], [0, 1, SHADOW_OFFSET_SHARES[1] * height]], np.float32
        )
        cast = cv2.GaussianBlur(cv2.warpAffine(whole, move, (width, height)), (0, 0), SHADOW_SIGMA_SHARE * height)
        lit = 1 - SHADOW_BRIGHTNESS * cast[..., None]
    picture = shown + (1 - whole[..., None]) * ground * lit
    dark = (lit[..., 0] < 1 - SHADOW_BRIGHTNESS / 2) & (whole < 0.02)
    return KnownMask(name, place, np.clip(picture + 0.5, 0, 255).astype(np.uint8), whole, dark)


def score(found: NDArray[np.bool_], known: KnownMask) -> MaskScore:
    """What of a mask (H, W) is right."""
    true = known.alpha > 0.5
    gaps = enclosed(true)
    return MaskScore(
        iou=float((found & true).sum() / (found | true).sum()),
        boundary=boundary_score(found, true, BOUNDARY_TOLERANCE_SHARE * mask_height(true)),
        gaps=float((~found)[gaps].mean()) if gaps.any() else float("nan"),
        shadow=float(found[known.shadow].mean()) if known.shadow.any() else float("nan"),
    )


def boundary_score(found: NDArray[np.bool_], true: NDArray[np.bool_], tolerance: float) -> float:
    """The F-score of two masks' boundaries, which count as met within a tolerance, pixels."""
    inner = [mask & ~cv2.erode(mask.astype(np.uint8), np.ones((3, 3), np.uint8)).astype(bool) for mask in (found, true)]
    away = [cv2.distanceTransform((~edge).astype(np.uint8), cv2.DIST_L2, 5) for edge in inner]
    if not inner[0].any():
        return 0.0
    precision = float((away[1][inner[0]] <= tolerance).mean())
    recall = float((away[0][inner[1]] <= tolerance).mean())
    return 2 * precision * recall / max(precision + recall, 1e-9)


def enclosed(true: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The gaps (H, W) between somebody's limbs: background that closing takes in, and that is no crease."""
    tall = mask_height(true)
    closed = cv2.morphologyEx(true.astype(np.uint8), cv2.MORPH_CLOSE, _disk(GAP_HALF_WIDTH_SHARE * tall)) > 0
    return np.asarray(
        cv2.morphologyEx((closed & ~true).astype(np.uint8), cv2.MORPH_OPEN, _disk(MIN_GAP_HALF_WIDTH_SHARE * tall)) > 0
    )


def _disk(radius: float) -> NDArray[np.uint8]:
    reach = max(1, round(radius))
    return np.asarray(cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1, 2 * reach + 1)), np.uint8)


def find_mask(rgb: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """The mask (H, W) of somebody in a picture, as it is found for a user. Raises `InputError` where nobody is."""
    with tempfile.TemporaryDirectory() as folder:
        photo = Path(folder) / "photo.png"
        Image.fromarray(rgb).save(photo)
        figure = find_figure(photo, Choice(), True, Limits(), lambda code, message: None)
    return cut_out(figure, None, (), Limits(), None, None, lambda code, message: None).alpha > 0.5


def tables(results: Sequence[tuple[KnownMask, MaskScore]]) -> str:
    """All scores, and their means by place."""

    def row(scores: Sequence[MaskScore]) -> list[str]:
        columns = np.array([[one.iou, one.boundary, one.gaps, one.shadow] for one in scores]).T
        return [f"{np.nanmean(column):.3f}" if not np.isnan(column).all() else "" for column in columns]

    head = ["IoU", "F", "gaps", "shadow"]
    by_place = {known.place: [s for k, s in results if k.place == known.place] for known, _ in results}
    means = [[place, str(len(scores)), *row(scores)] for place, scores in by_place.items()]
    means.append(["all", str(len(results)), *row([one for _, one in results])])
    return "\n".join([
        table("Masks", ["person", "place", *head], [[k.name, k.place, *row([s])] for k, s in results]),
        table("Means by place", ["place", "pictures", *head], means),
    ])  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="people whose name contains this")
    asked = parser.parse_args()
    results = []
    for known in known_masks():
        if asked.only not in known.name:
            continue
        try:
            results.append((known, score(find_mask(known.rgb), known)))
        except InputError as error:
            print(f"{known.name}, {known.place}: {error.code}, left out of the means")
    if not results:
        raise SystemExit("nobody to measure")
    print(machine())
    print(tables(results))


if __name__ == "__main__":
    main()
