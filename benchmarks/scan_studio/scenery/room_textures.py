"""What the surfaces of a furnished room look like, drawn by rules and chance, with detail at every scale."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.scan_studio.camera.noise import picture_noise

Texture = NDArray[np.float32]
"""(H, W, 3) sRGB from 0 to 255."""
POSTER_COLOURS = (
    (196, 62, 48),
    (44, 92, 150),
    (226, 176, 60),
    (58, 128, 92),
    (120, 70, 130),
    (230, 226, 214),
    (40, 42, 50),
)


def plaster(size: tuple[int, int], random: np.random.Generator, colour: tuple[int, int, int]) -> Texture:
    """A wall (height, width) that was painted by hand, and got stains."""
    grain = picture_noise(size, (2, 5, 13, 40, 160), random)
    return np.array(colour, np.float32) * (1 + 0.07 * grain)


def wood(size: tuple[int, int], random: np.random.Generator, board: int) -> Texture:
    """Boards along the rows, `board` texels wide, each with a grain and a hue of its own."""
    height, width = size
    base = np.array((150, 108, 70), np.float32)
    picture = np.empty((*size, 3), np.float32)
    for top in range(0, height, board):
        rows = min(board, height - top)
        fibres = (
            cv2.resize(random.standard_normal((rows, max(2, width // 24))).astype(np.float32), (width, rows))
            + 0.7 * picture_noise((rows, width), (3, 30), random)[..., 0]
        )
        picture[top : top + rows] = base * random.uniform(0.75, 1.2) * (1 + 0.12 * fibres[..., None])
        picture[top] *= 0.45
        for joint in range(int(random.integers(0, 4 * board)), width, 9 * board):
            picture[top : top + rows, joint : joint + 2] *= 0.5
    return picture


def carpet(size: tuple[int, int], random: np.random.Generator) -> Texture:
    """A rug of coloured diamonds in a border, of thick wool."""
    height, width = size
    rows, columns = np.mgrid[:height, :width] / np.float32(min(size) / 8)
    diamond = np.floor(rows + columns).astype(int) * 5 + np.floor(rows - columns).astype(int) * 3
    colours = np.array(((132, 44, 40), (176, 140, 92), (52, 62, 92), (94, 40, 52)), np.float32)
    picture = colours[diamond % len(colours)]
    edge = np.minimum.reduce([rows, columns, rows[::-1], columns[:, ::-1]])
    picture[edge < 0.5] = (72, 36, 34)
    picture[(edge > 0.3) & (edge < 0.4)] = (198, 170, 120)
    return picture * (1 + 0.2 * picture_noise(size, (2, 4, 9), random))


def books(size: tuple[int, int], random: np.random.Generator, boards: int) -> Texture:
    """Shelves full of books, one above the other."""
    height, width = size
    picture = np.full((*size, 3), 30, np.float32)
    step = height // boards
    for shelf in range(boards):
        floor, x = (shelf + 1) * step - max(2, step // 16), max(2, step // 16)
        while x < width - step // 8:
            thick, tall = int(random.integers(step // 14, step // 5) + 2), int(step * random.uniform(0.6, 0.88))
            right = min(x + thick, width - 2)
            picture[floor - tall : floor, x:right] = random.uniform(20, 225, 3)
            picture[floor - tall : floor, x] *= 0.5
            for _ in range(int(random.integers(1, 4))):
                band = floor - int(tall * random.uniform(0.1, 0.95))
                picture[band : band + max(1, step // 30), x + 1 : right - 1] = random.uniform(60, 250, 3)
            x = right + int(random.random() < 0.15) * step // 8
        picture[floor : floor + max(2, step // 16)] = (146, 104, 66)
    return picture * (1 + 0.06 * picture_noise(size, (2, 6), random))


def fabric(size: tuple[int, int], random: np.random.Generator, colour: tuple[int, int, int]) -> Texture:
    """Coarse upholstery."""
    return np.array(colour, np.float32) * (1 + 0.16 * picture_noise(size, (2, 3, 8, 30), random))


def poster(size: tuple[int, int], random: np.random.Generator) -> Texture:
    """Shapes and words at all scales, printed in few colours on paper."""
    height, width = size
    colours = [POSTER_COLOURS[k] for k in random.permutation(len(POSTER_COLOURS))]
    picture = np.full((*size, 3), colours[0], np.uint8)
    for k in range(60):
        reach = max(2, int(min(size) * 0.32 / (1 + 0.12 * k)))
        x, y = int(random.integers(0, width)), int(random.integers(0, height))
        colour = colours[1 + k % (len(colours) - 1)]
        kind = k % 3
        if kind == 0:
            cv2.circle(picture, (x, y), reach // 2, colour, -1 if k % 2 else max(1, reach // 8), cv2.LINE_AA)
        elif kind == 1:
            corners = np.array([x, y]) + random.integers(-reach, reach + 1, (4, 2))
            cv2.fillPoly(picture, [cv2.convexHull(corners.astype(np.int32))], colour, cv2.LINE_AA)
        else:
            word = "".join(chr(65 + int(random.integers(26))) for _ in range(int(random.integers(3, 8))))
            cv2.putText(
                picture,
                word,
                (x - reach, y),
                cv2.FONT_HERSHEY_DUPLEX,
                reach / 45,
                colour,
                max(1, reach // 24),
                cv2.LINE_AA,
            )
    cv2.rectangle(picture, (0, 0), (width - 1, height - 1), (238, 236, 230), max(2, min(size) // 30))
    return picture * (1 + 0.03 * picture_noise(size, (2, 20), random))
