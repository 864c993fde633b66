"""A foot on a patterned floor, filmed from all around."""

import numpy as np

from engine.avatar.capture.foot_masks import Foot, FootFrame
from engine.geometry.camera import Camera
from engine.render.rasterisation.rasteriser import rasterise

BOX = np.array([[x, y, z] for x in (-0.045, 0.045) for y in (0.0, 0.08) for z in (-0.13, 0.13)])
FACES = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 7, 5], [4, 6, 7], [0, 5, 1], [0, 4, 5]),
        *([2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)
"""A shoe as a box, and a leg of the same, scaled."""
SHOE, LEG = (45, 30, 32), (150, 120, 100)
FOOT = Foot(
    np.array([[0.0, 0.1, -0.07], [0.0, 0.03, -0.1], [0.0, 0.03, 0.11]]),
    np.array([[[0.0, 0.1, -0.07], [0.0, 0.05, 0.03]], [[0.0, 0.1, -0.07], [0.0, 0.3, -0.07]]]),
)


def floor_colours(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """(..., 3) of places: tiles of three colours, one of them dark as the shoe, with grain."""
    tile = (np.floor(x / 0.09) + 2 * np.floor(z / 0.09)).astype(int) % 3
    grain = 14 * np.sin(61 * x + 13 * np.sin(47 * z)) * np.cos(53 * z + 17 * x)
    return np.array([[140, 40, 45], [60, 70, 130], [70, 34, 40]])[tile] + grain[..., None]


def filmed(turn: float, height: float = 0.0, seed: int = 0) -> tuple[FootFrame, np.ndarray]:
    """A frame from one side, without any mask, of the scene lifted by `height`; and the true mask."""
    eye = np.array([1.6 * np.sin(turn), 1.3, 1.6 * np.cos(turn)])
    camera = Camera((0.0, 0.0, 0.0), 380.0, (79.5, 79.5), (160, 160)).aimed(eye, (0.0, 0.1, 0.0))
    y, x = np.indices(camera.size, float)
    rays = camera.rays(np.stack([x, y], -1).reshape(-1, 2))
    at = np.array(camera.eye) + ((height - eye[1]) / rays[:, 1])[:, None] * rays
    image = floor_colours(at[:, 0], at[:, 2]).reshape(160, 160, 3)
    leg = BOX * [0.9, 8, 0.4] + [0, 0.06, -0.07]
    vertices = np.concatenate([BOX, leg]) + np.array([0, height, 0])
    raster = rasterise(camera.project(vertices), np.concatenate([FACES, FACES + 8]), camera.size, perspective=True)
    image[raster.triangle >= 0] = SHOE
    image[raster.triangle >= len(FACES)] = LEG
    image = image * (1 + 0.1 * np.sin(5 * turn)) + np.random.default_rng(seed).normal(0, 3, image.shape)
    nobody = np.zeros(camera.size, np.bool_)
    return FootFrame(image.clip(0, 255).astype(np.uint8), nobody, camera, camera), raster.triangle >= 0
