"""Whole figures of the project's own, to begin with: the human template as dressed people, drawn and then painted over.

Nobody is meant, and nobody's work is copied: shapes, poses, clothes, hair and room are described here.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.known_truth.dressed_template import ARMS_DOWN, Look, dress
from benchmarks.known_truth.known_person import KnownPicture, Person, draw_into
from engine.body.rig import HUMAN_RIG
from engine.body.shape import Phenotype
from engine.body.template import load_rig, load_template
from engine.geometry.camera import Camera

Colour = tuple[int, int, int]
CANVAS_SIZE = (1920, 1440)
"""Height and width while it is drawn and painted, pixels; then it is made half as large."""
SOLE_RGB = (224, 216, 204)
HEM_SHARE, SOLE_SHARE = 0.34, 0.15
"""Shares of a foot's height that trousers cover and that the sole takes."""
BRUSH_PIXELS, TONE_STEP = 4, 1
"""Radius of the brush in pixels, and how finely it tells tones apart (see `cv2.xphoto.oilPainting`)."""


@dataclass(frozen=True)
class Figure:
    """Somebody to be drawn. `locks`: how far the hair hangs down behind, in heights of the head; 0 where it is short."""

    name: str
    look: Look
    wall: Colour
    floor: Colour
    locks: float
    lips: Colour


OPEN_POSE = ARMS_DOWN | {
    "LeftArm": (0, 0, -52),
    "RightArm": (0, 0, 52),
    "LeftUpLeg": (0, 0, 4),
    "RightUpLeg": (0, 0, -4),
}

SAMPLE_FIGURES = (
    Figure(
        "woman-in-red",
        Look(
            "woman",
            Phenotype(0.45, 0.0, 0.5, 0.27, 0.6),
            OPEN_POSE,
            (176, 58, 62),
            (44, 58, 92),
            (226, 178, 148),
            (92, 52, 34),
            (52, 36, 34),
        ),
        (196, 188, 172),
        (146, 116, 88),
        1.25,
        (176, 84, 84),
    ),
    Figure(
        "man-in-green",
        Look(
            "man",
            Phenotype(0.5, 1.0, 0.55, 0.38, 0.65),
            OPEN_POSE,
            (62, 112, 104),
            (92, 82, 70),
            (150, 104, 76),
            (34, 28, 26),
            (70, 46, 34),
        ),
        (172, 186, 196),
        (120, 116, 112),
        0.0,
        (128, 74, 64),
    ),
)


def paint_figure(figure: Figure) -> NDArray[np.uint8]:
    """(H, W, 3) uint8: the figure standing in its room."""
    person = dress(figure.look)
    alone = draw_into(person, room(figure), shadow=False)
    camera = alone.camera
    drawn = draw_into(person, contact(behind(figure, person, camera), alone), shadow=False)
    picture = hairline(figure, replace(drawn, rgb=features(figure, shoes(figure, drawn))))
    painted = cv2.xphoto.oilPainting(np.ascontiguousarray(picture[..., ::-1]), BRUSH_PIXELS, TONE_STEP)[..., ::-1]
    (x, y), tall = head(person, camera)
    fine = np.zeros(CANVAS_SIZE, np.float32)  # a small brush for the face
    cv2.ellipse(fine, (round(x), round(y)), (round(0.45 * tall), round(0.6 * tall)), 0, 0, 360, 1.0, -1)
    fine = cv2.GaussianBlur(fine, (0, 0), 0.08 * tall)[..., None]
    whole = np.ascontiguousarray(painted * (1 - fine) + picture * fine, np.float32)
    small = cv2.resize(whole, (CANVAS_SIZE[1] // 2, CANVAS_SIZE[0] // 2), interpolation=cv2.INTER_AREA)
    return canvas(np.asarray(small, np.uint8))


def room(figure: Figure) -> NDArray[np.uint8]:
    """A wall that is lit from the left, and a floor."""
    y, x = np.mgrid[: CANVAS_SIZE[0], : CANVAS_SIZE[1]].astype(np.float32) / CANVAS_SIZE[0]
    light = 0.8 + 0.28 * np.exp(-(((x - 0.3) / 0.45) ** 2 + ((y - 0.35) / 0.5) ** 2))
    wall = light[..., None] * np.array(figure.wall, np.float32)
    depth = np.clip((y - 0.8) / 0.2, 0, 1)
    floor = (0.82 + 0.25 * depth)[..., None] * np.array(figure.floor, np.float32)
    edge = np.clip((y - 0.8) * CANVAS_SIZE[0] / 12 + 0.5, 0, 1)[..., None]
    return np.clip(wall * (1 - edge) + floor * edge, 0, 255).astype(np.uint8)


def head(person: Person, camera: Camera) -> tuple[NDArray[np.float64], float]:
    """Where the middle of the eyes is in the picture, and how many pixels a head's height is."""
    template = load_template()
    eyes = [person.vertices[template.vertices_of(f"{side}_eye")].mean(0) for side in ("left", "right")]
    pixels = camera.project(np.array(eyes))[:, :2]
    return pixels.mean(0), 3.6 * float(np.linalg.norm(pixels[0] - pixels[1]))


def behind(figure: Figure, person: Person, camera: Camera) -> NDArray[np.uint8]:
    """The room with the hair that hangs behind the shoulders."""
    picture = room(figure)
    if figure.locks:
        (x, y), tall = head(person, camera)
        dark = tuple(int(0.8 * c) for c in figure.look.hair)
        for shift, width, length in ((0, 0.47, 0.0), (-0.16, 0.3, figure.locks), (0.16, 0.3, figure.locks)):
            centre = (round(x + shift * tall), round(y + (0.05 + length / 3) * tall))
            axes = (round(width * tall), round((0.5 + length / 3) * tall))
            cv2.ellipse(picture, centre, axes, 0, 0, 360, dark, -1, cv2.LINE_AA)
    return picture


def feet(drawn: KnownPicture) -> list[NDArray[np.uint8]]:
    """Of each foot what of the picture it covers, as a shoe does that is round in front: (H, W), 0 or 255."""
    template, rig = load_template(), load_rig(HUMAN_RIG)
    moved = np.array(rig.names)[rig.bones[:, 0]]
    shapes = []
    for side in ("Left", "Right"):
        skin = template.vertices_of("body")  # what else moves with a foot is no part of it
        foot = skin[np.char.startswith(moved[skin], f"{side}Foot") | np.char.startswith(moved[skin], f"{side}Toe")]
        outline = cv2.convexHull(np.rint(drawn.camera.project(drawn.person.vertices[foot])[:, :2]).astype(np.int32))
        shape = np.zeros(CANVAS_SIZE, np.uint8)
        cv2.fillPoly(shape, [outline], 255)
        shape = cv2.dilate(shape, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (13, 13)))
        shapes.append(np.where(cv2.GaussianBlur(shape, (0, 0), 7) > 127, 255, 0).astype(np.uint8))
    return shapes


def contact(floor: NDArray[np.uint8], drawn: KnownPicture) -> NDArray[np.uint8]:
    """The room with what light the feet keep from the floor right beside them: no further, so that it goes when they go."""
    under = np.zeros(CANVAS_SIZE, np.uint8)
    for shape in feet(drawn):
        tall = int(np.ptp(np.nonzero(shape.any(1))[0]))
        shape[: int(np.nonzero(shape.any(1))[0].max()) - tall // 4] = 0  # the sole
        under |= shape
    dark = cv2.GaussianBlur(cv2.dilate(under, np.ones((5, 5), np.uint8)), (0, 0), 5).astype(np.float32) / 255
    return np.asarray(floor * (1 - 0.5 * dark[..., None]), np.uint8)


def shoes(figure: Figure, drawn: KnownPicture) -> KnownPicture:
    """The picture with shoes over the feet, whose toes would show through the template's, and trousers that fall on them."""
    picture = drawn.rgb.copy()
    for shape in feet(drawn):
        rows, columns = np.nonzero(shape)
        top, bottom, middle = int(rows.min()), int(rows.max()), round(float(columns.mean()))
        tall, wide = bottom - top, int(np.ptp(columns))
        share = np.clip((np.arange(CANVAS_SIZE[0]) - top) / tall, 0, 1)[:, None, None]
        across = np.clip((np.arange(CANVAS_SIZE[1]) - middle) / (wide / 2), -1, 1)[None, :, None]
        round_light = 1.12 - 0.45 * (across + 0.25) ** 2
        leather = round_light * (1.2 - 0.35 * share) * np.array(figure.look.shoes, np.float32)
        cloth = round_light * (0.95 - 0.5 * share) * np.array(figure.look.trousers, np.float32)
        sole = (0.95 - 0.25 * across**2) * np.array(SOLE_RGB, np.float32)
        parts = np.where(share < HEM_SHARE, cloth, np.where(share > 1 - SOLE_SHARE, sole, leather))
        picture = np.where(shape[..., None] > 0, np.clip(parts, 0, 255), picture).astype(np.uint8)
        seam = (middle, bottom - round(0.1 * tall)), (round(0.36 * wide), round(0.3 * tall))
        cap = tuple(int(0.7 * c) for c in figure.look.shoes)
        cv2.ellipse(picture, *seam, 0, 195, 345, cap, 3, cv2.LINE_AA)
    return replace(drawn, rgb=picture)


def features(figure: Figure, drawn: KnownPicture) -> NDArray[np.uint8]:
    """The picture with brows and lips, which the template's skin does not have; drawn larger, then made small."""
    template, large = load_template(), 2
    picture = np.asarray(cv2.resize(drawn.rgb, None, fx=large, fy=large, interpolation=cv2.INTER_CUBIC), np.uint8)
    vertices, camera = drawn.person.vertices, drawn.camera.scaled(large)
    (x, y), tall = head(drawn.person, camera)
    hem = tuple(int(0.82 * c) for c in figure.look.shirt)
    neck, wide = (round(x), round(y + 0.6 * tall)), (round(0.31 * tall), round(0.16 * tall))
    cv2.ellipse(picture, neck, wide, 0, 2, 178, hem, round(0.1 * tall), cv2.LINE_AA)
    over = picture.copy()
    brow = tuple(int(0.55 * c) for c in figure.look.hair)
    for side, turn in (("left", 4), ("right", -4)):
        x, y = camera.project(vertices[template.vertices_of(f"{side}_eye")].mean(0)[None])[0, :2]
        cv2.ellipse(
            over,
            (round(x), round(y - 0.04 * tall)),
            (round(0.1 * tall), round(0.05 * tall)),
            turn,
            205,
            335,
            brow,
            round(0.022 * tall),
            cv2.LINE_AA,
        )
    teeth = np.concatenate([template.vertices_of("upper_teeth"), template.vertices_of("lower_teeth")])
    x, y = camera.project(vertices[teeth].mean(0)[None])[0, :2]
    mouth = (round(x), round(y + 0.005 * tall))
    cv2.ellipse(over, mouth, (round(0.095 * tall), round(0.034 * tall)), 0, 0, 360, figure.lips, -1, cv2.LINE_AA)
    line = tuple(int(0.5 * c) for c in figure.lips)
    cv2.ellipse(
        over,
        (mouth[0], mouth[1] - round(0.03 * tall)),
        (round(0.1 * tall), round(0.034 * tall)),
        0,
        25,
        155,
        line,
        round(0.008 * tall),
        cv2.LINE_AA,
    )
    mixed = cv2.addWeighted(picture, 0.3, over, 0.7, 0)
    return np.asarray(cv2.resize(mixed, CANVAS_SIZE[::-1], interpolation=cv2.INTER_AREA), np.uint8)


def hairline(figure: Figure, drawn: KnownPicture) -> NDArray[np.uint8]:
    """The picture with hair that is many hairs where it ends at the forehead, and falls beside the face where it is long."""
    rng = np.random.default_rng(5)
    large = 2
    picture = np.asarray(cv2.resize(drawn.rgb, None, fx=large, fy=large, interpolation=cv2.INTER_CUBIC), np.uint8)
    (x, y), tall = head(drawn.person, drawn.camera.scaled(large))

    def hair(places: NDArray[np.float64], wide: float) -> None:
        tone = rng.uniform(0.72, 1.15)
        colour = tuple(int(min(255, tone * c)) for c in figure.look.hair)
        points = np.rint(np.array([x, y]) + places * tall).astype(np.int32)
        cv2.polylines(picture, [points], False, colour, max(1, round(wide * tall)), cv2.LINE_AA)

    for _ in range(420):  # short ones, at the forehead
        side = rng.uniform(-1, 1)
        root = np.array([0.3 * side, -0.25 - 0.03 * rng.random() + 0.03 * abs(side)])
        tip = root + np.array([0.02 * side + rng.normal(0, 0.006), rng.uniform(0.0, 0.035) + 0.02 * side**2])
        hair(np.array([root - [0, 0.05], root, tip]), 0.006)
    if figure.locks:
        for side in (-1, 1):
            for share in np.sort(rng.random(260))[::-1]:  # from outside in, parted in the middle
                out = share + rng.normal(0, 0.03)
                way = np.array(
                    [
                        [0.01, -0.55 + 0.05 * out],
                        [0.14 + 0.12 * out, -0.40 + 0.02 * out],
                        [0.225 + 0.13 * out, -0.16 - 0.06 * out],
                        [0.262 + 0.12 * out, 0.08],
                        [0.27 + 0.12 * out, 0.36],
                        [0.25 + 0.13 * out, 0.50 + 0.2 * rng.random()],
                    ]
                )
                hair(smooth(way) * [side, 1], 0.011)
    return np.asarray(cv2.resize(picture, CANVAS_SIZE[::-1], interpolation=cv2.INTER_AREA), np.uint8)


def smooth(way: NDArray[np.float64], rounds: int = 3) -> NDArray[np.float64]:
    """(N, 2) points of a line whose corners are cut (Chaikin 1974)."""
    for _ in range(rounds):
        cut = np.stack([0.75 * way[:-1] + 0.25 * way[1:], 0.25 * way[:-1] + 0.75 * way[1:]], 1).reshape(-1, 2)
        way = np.concatenate([way[:1], cut, way[-1:]])
    return way


def canvas(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The weave of the canvas under the paint, faintly."""
    rng = np.random.default_rng(3)
    grain = cv2.GaussianBlur(rng.normal(0, 1, picture.shape[:2]).astype(np.float32), (0, 0), 0.8)
    y, x = np.mgrid[: picture.shape[0], : picture.shape[1]]
    weave = 0.5 * np.sin(2.1 * x) + 0.5 * np.sin(2.1 * y) + 2.0 * grain
    return np.clip(picture + 1.6 * weave[..., None], 0, 255).astype(np.uint8)


def figure(name: str) -> NDArray[np.uint8]:
    """The figure of that name."""
    return paint_figure(next(one for one in SAMPLE_FIGURES if one.name == name))
