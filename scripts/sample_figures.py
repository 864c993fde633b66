"""Whole figures of the project's own, to begin with: the human template as dressed people, drawn and then painted over.

Nobody is meant, and nobody's work is copied: shapes, poses, clothes, hair and room are described here.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.dressed_template import ARMS_DOWN, Look, dress
from benchmarks.known_person import KnownPicture, Person, draw_into
from engine.body.rig import HUMAN
from engine.body.shape import Phenotype
from engine.body.template import load_rig, load_template
from engine.render.camera import Camera

Colour = tuple[int, int, int]
SIZE = (1920, 1440)
"""Height and width while it is drawn and painted, pixels; then it is made half as large."""
BRUSH, STEPS = 4, 1
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


OPEN = ARMS_DOWN | {"LeftArm": (0, 0, -52), "RightArm": (0, 0, 52), "LeftUpLeg": (0, 0, 4), "RightUpLeg": (0, 0, -4)}

FIGURES = (
    Figure(
        "woman-in-red",
        Look(
            "woman",
            Phenotype(0.45, 0.0, 0.5, 0.27, 0.6),
            OPEN,
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
            OPEN,
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
    camera = draw_into(person, room(figure)).camera
    drawn = draw_into(person, behind(figure, person, camera))
    picture = features(figure, shoes(figure, drawn))
    painted = cv2.xphoto.oilPainting(np.ascontiguousarray(picture[..., ::-1]), BRUSH, STEPS)[..., ::-1]
    (x, y), tall = head(person, camera)
    fine = np.zeros(SIZE, np.float32)  # a small brush for the face
    cv2.ellipse(fine, (round(x), round(y)), (round(0.45 * tall), round(0.6 * tall)), 0, 0, 360, 1.0, -1)
    fine = cv2.GaussianBlur(fine, (0, 0), 0.08 * tall)[..., None]
    whole = np.ascontiguousarray(painted * (1 - fine) + picture * fine, np.float32)
    small = cv2.resize(whole, (SIZE[1] // 2, SIZE[0] // 2), interpolation=cv2.INTER_AREA)
    return canvas(np.asarray(small, np.uint8))


def room(figure: Figure) -> NDArray[np.uint8]:
    """A wall that is lit from the left, and a floor."""
    y, x = np.mgrid[: SIZE[0], : SIZE[1]].astype(np.float32) / SIZE[0]
    light = 0.8 + 0.28 * np.exp(-(((x - 0.3) / 0.45) ** 2 + ((y - 0.35) / 0.5) ** 2))
    wall = light[..., None] * np.array(figure.wall, np.float32)
    depth = np.clip((y - 0.8) / 0.2, 0, 1)
    floor = (0.82 + 0.25 * depth)[..., None] * np.array(figure.floor, np.float32)
    edge = np.clip((y - 0.8) * SIZE[0] / 12 + 0.5, 0, 1)[..., None]
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


def shoes(figure: Figure, drawn: KnownPicture) -> KnownPicture:
    """The picture with shoes over the feet, whose toes would show through the template's."""
    template, rig, picture = load_template(), load_rig(HUMAN), drawn.rgb.copy()
    moved = np.array(rig.names)[rig.bones[:, 0]]
    for side in ("Left", "Right"):
        skin = template.vertices_of("body")  # what else moves with a foot is no part of it
        foot = skin[np.char.startswith(moved[skin], f"{side}Foot") | np.char.startswith(moved[skin], f"{side}Toe")]
        points = drawn.camera.project(drawn.person.vertices[foot])[:, :2]
        outline = cv2.convexHull(np.rint(points).astype(np.int32))
        top, bottom = points[:, 1].min(), points[:, 1].max()
        shape = np.zeros(SIZE, np.uint8)
        cv2.fillPoly(shape, [outline], 255)
        shape = cv2.dilate(shape, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (9, 9)))
        share = np.clip((np.arange(SIZE[0]) - top) / (bottom - top), 0, 1)
        light = np.where(share > 0.9, 0.45, 1.15 - 0.35 * np.abs(share - 0.45))[:, None, None]
        leather = light * np.array(figure.look.shoes, np.float32)
        picture = np.where(shape[..., None] > 0, leather, picture)
    return replace(drawn, rgb=np.clip(picture, 0, 255).astype(np.uint8))


def features(figure: Figure, drawn: KnownPicture) -> NDArray[np.uint8]:
    """The picture with brows and lips, which the template's skin does not have; drawn larger, then made small."""
    template, large = load_template(), 2
    picture = np.asarray(cv2.resize(drawn.rgb, None, fx=large, fy=large, interpolation=cv2.INTER_CUBIC), np.uint8)
    vertices, camera = drawn.person.vertices, drawn.camera.enlarged(large)
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
    return np.asarray(cv2.resize(mixed, SIZE[::-1], interpolation=cv2.INTER_AREA), np.uint8)


def canvas(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The weave of the canvas under the paint, faintly."""
    rng = np.random.default_rng(3)
    grain = cv2.GaussianBlur(rng.normal(0, 1, picture.shape[:2]).astype(np.float32), (0, 0), 0.8)
    y, x = np.mgrid[: picture.shape[0], : picture.shape[1]]
    weave = 0.5 * np.sin(2.1 * x) + 0.5 * np.sin(2.1 * y) + 2.0 * grain
    return np.clip(picture + 1.6 * weave[..., None], 0, 255).astype(np.uint8)


def figure(name: str) -> NDArray[np.uint8]:
    """The figure of that name."""
    return paint_figure(next(one for one in FIGURES if one.name == name))
