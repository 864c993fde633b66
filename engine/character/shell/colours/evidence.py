"""What the picture says of points of the shell, and how far it is to be trusted.

Two levels: what the picture shows is painted as it is; what other places are filled from must be surer. A texel at a limb's
outline may be a little of the wall behind it, where it is seen; copied all round the limb it would be a stripe.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.character.figure.silhouette import OPAQUE_ALPHA, Silhouette
from engine.character.parts.label_map import Labels
from engine.character.parts.labels import ARM_LABELS
from engine.character.shell.shell import Shell
from engine.compiled import njit
from engine.geometry.mesh.surface import vertex_normals
from engine.imaging.filling.nearest import nearest_colours, nearest_values
from engine.imaging.masks.mask_distance import distance_inside, distance_to
from engine.render.rasterisation.rasteriser import depth_map

DEPTH_BUFFER_SCALE = 3
"""Pixels of the depth buffer for each of the grid's."""
DEPTH_TOLERANCE_PIXELS, DEPTH_JUMP_PIXELS = 3.0, 16.0
"""Pixels of the grid by which a point may be behind what is nearest at its place, and behind what is nearest around it."""
MIN_SHOWN_COSINE, MIN_SOURCE_COSINE = 0.08, 0.22
"""Cosine to the viewer from which on a point is shown, and is a source."""
MIN_OUTLINE_DISTANCE_PIXELS, SOURCE_OUTLINE_DISTANCE_PIXELS = 1.3, 2.2
"""Pixels of the grid from the outline of the mask."""
ARM_MARGIN_PIXELS, ARM_SOURCE_MARGIN_PIXELS, ARM_OVER_LEG_MARGIN_PIXELS = 2.0, 4.0, 7.0
"""Pixels of the grid from an arm that passes before; a hand's shadow lies on the thigh."""
WALL_MIXED_EDGE_PIXELS = 2.0
"""Pixels of the grid within what is opaque in which colours are mixed with the wall's."""
INNER_RIM_PIXELS, OUTER_WALL_PIXELS = 8.0, 3.0
"""Pixels of the grid from the outline inward in which there may be wall, and outward from which on there surely is."""
WALL_COLOUR_RATIO, MIN_WALL_COLOUR_DISTANCE = 0.5, 15.0
"""How much nearer to the wall's colour than to the person's that of a wall is; CIE Lab distance from which both can be told apart."""
MIN_LABEL_WEIGHT_SHARE = 0.1
"""Share of the parts that may show a label, in what moves a point, from which on the label agrees with it."""

ALLOWED_LABELS = np.eye(len(BODY_PARTS), dtype=np.float32)
"""Which labels (columns) a part (rows) may have: its own; cloth hangs from the trunk over legs and neck, and hair from the head."""
for _part, _labels in {"head": ("torso",), "torso": ("head", "left_leg", "right_leg"), "left_leg": ("torso",), "right_leg": ("torso",)}.items():  # fmt: skip
    ALLOWED_LABELS[BODY_PARTS.index(_part), [BODY_PARTS.index(label) for label in _labels]] = 1


@dataclass(frozen=True)
class Evidence:
    """Of points (...).

    colours : (..., 3) float32, the picture's where it shows them, 0 elsewhere.
    shown : (...) float32, from 0, not at all, to 1.
    source : (...) bool, whether other places may be filled with it.
    """

    colours: NDArray[np.float32]
    shown: NDArray[np.float32]
    source: NDArray[np.bool_]


@dataclass(frozen=True)
class Witness:
    """What the picture can say of a shell.

    attributes : (V, 10) float32 of the shell's vertices: place on the grid (3), cosine to the viewer, and parts (6).
    labels : (2, h, w) uint8 on the grid, which labels there are within one pixel, and within two: a bit for each.
    inside : (h, w) float32, pixels from the mask's outline, and from what is no colour of its part.
    wall : (h, w) bool, what looks like the wall beside it and not like the person within.
    from_arms : (2, h, w) float32, pixels from the left and the right arm.
    nearest : (3, 3 h, 3 w) float32, depth towards the viewer: at each place, the largest close around it, and further around.
    clean : (H, W, 3) uint8 the picture, its person's own colours continued beyond them.
    to_picture : (2, 3) from the grid's pixels to the picture's.
    """

    attributes: NDArray[np.float32]
    labels: NDArray[np.uint8]
    inside: NDArray[np.float32]
    wall: NDArray[np.bool_]
    from_arms: NDArray[np.float32]
    nearest: NDArray[np.float32]
    clean: NDArray[np.uint8]
    to_picture: NDArray[np.float64]

    def of(self, attributes: NDArray[np.float32]) -> Evidence:
        """What it says of points (..., 10), interpolated from its vertices' attributes."""
        flat = np.ascontiguousarray(attributes.reshape(-1, attributes.shape[-1]))
        colours, shown, source = _judged(
            *(
                flat,
                self.labels,
                self.inside,
                self.wall,
                self.from_arms,
                self.nearest,
                self.clean,
                self.to_picture,
                ALLOWED_LABELS,
            )
        )
        shape = attributes.shape[:-1]
        return Evidence(colours.reshape(*shape, 3), shown.reshape(shape), source.reshape(shape))


def witness(
    rgb: NDArray[np.uint8],
    silhouette: Silhouette,
    labels: Labels,
    shell: Shell,
    hides: NDArray[np.int32] | None = None,
    strange: NDArray[np.bool_] | None = None,
) -> Witness:
    """The picture (H, W, 3) as a witness of the shell. `hides` (T, 3) are the triangles that hide others, all unless
    they are given. `strange` (h, w) are pixels that have not the colours of what they are labelled as."""
    normals = vertex_normals(shell.pictured, shell.mesh.triangles)
    towards = -normals[:, 2:]  # y is down, so that the triangles turn the other way
    height, width = silhouette.mask.shape
    screen = (shell.pictured + 0.5) * DEPTH_BUFFER_SCALE - 0.5
    screen[:, 2] = -shell.pictured[:, 2]
    depth = depth_map(
        screen,
        shell.mesh.triangles if hides is None else hides,
        (height * DEPTH_BUFFER_SCALE, width * DEPTH_BUFFER_SCALE),
    )
    near = np.where(np.isfinite(depth), -depth, -1e4).astype(np.float32)
    around = [np.asarray(cv2.dilate(near, np.ones((size, size), np.uint8)), np.float32) for size in (3, 15)]
    inverse = cv2.invertAffineTransform(silhouette.to_grid)
    own = distance_inside(silhouette.alpha > OPAQUE_ALPHA) > WALL_MIXED_EDGE_PIXELS / silhouette.to_grid[0, 0]
    return Witness(
        np.concatenate([shell.pictured, towards, shell.mesh.parts], 1).astype(np.float32),
        np.stack([_labels_around(labels.labels, size) for size in (3, 5)]),
        distance_inside(silhouette.mask if strange is None else silhouette.mask & ~strange),
        _walls(silhouette, labels.labels),
        np.stack([distance_to(labels.labels == arm) for arm in ARM_LABELS]),
        np.stack([near, *around]),
        nearest_colours(rgb, own) if own.any() else rgb,
        np.asarray(inverse, np.float64),
    )


def _walls(silhouette: Silhouette, labels: NDArray[np.integer]) -> NDArray[np.bool_]:
    """The pixels (h, w) near the outline of head and trunk that are like what is beyond it and unlike what is within: where
    the mask takes in some of the wall, between strands of hair above all. Limbs are too thin to have a within."""
    depth, away = distance_inside(silhouette.mask), distance_to(silhouette.mask)
    within, beyond = depth > INNER_RIM_PIXELS, (away > OUTER_WALL_PIXELS) & (away < 3 * INNER_RIM_PIXELS)
    if not within.any() or not beyond.any():
        return np.zeros_like(silhouette.mask)
    lab = cv2.cvtColor(cv2.GaussianBlur(silhouette.rgb, (0, 0), 1).astype(np.float32) / 255, cv2.COLOR_RGB2LAB)
    person, wall = (nearest_values(cv2.blur(lab, (5, 5)), where) for where in (within, beyond))
    like_wall, like_person = (np.linalg.norm(lab - one, axis=-1) for one in (wall, person))
    apart = np.linalg.norm(wall - person, axis=-1) > MIN_WALL_COLOUR_DISTANCE
    big = np.isin(labels, (BODY_PARTS.index("head"), BODY_PARTS.index("torso")))
    return np.asarray(big & (depth <= INNER_RIM_PIXELS) & apart & (like_wall < WALL_COLOUR_RATIO * like_person))


def _labels_around(labels: NDArray[np.integer], size: int) -> NDArray[np.uint8]:
    """Which labels (h, w), -1 where none is, are in a square of so many pixels about each, as bits."""
    found = np.zeros(labels.shape, np.uint8)
    for label in range(len(BODY_PARTS)):
        own = np.asarray(labels == label, np.uint8) << label
        found |= np.asarray(cv2.dilate(own, np.ones((size, size), np.uint8)), np.uint8)
    return found


@njit(parallel=True, boundscheck=False, error_model="numpy")
def _judged(
    points: np.ndarray,
    labels: np.ndarray,
    inside: np.ndarray,
    wall: np.ndarray,
    from_arms: np.ndarray,
    nearest: np.ndarray,
    clean: np.ndarray,
    to_picture: np.ndarray,
    may_show: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    count, (height, width), (rows, columns) = len(points), labels.shape[1:], clean.shape[:2]
    colours = np.zeros((count, 3), np.float32)
    shown, source = np.zeros(count, np.float32), np.zeros(count, np.bool_)
    for i in prange(count):
        x, y, z, towards = points[i, 0], points[i, 1], points[i, 2], points[i, 3]
        column, row = int(np.floor(x + 0.5)), int(np.floor(y + 0.5))
        if towards <= MIN_SHOWN_COSINE or column < 2 or row < 2 or column >= width - 2 or row >= height - 2:
            continue
        if inside[row, column] <= MIN_OUTLINE_DISTANCE_PIXELS:
            continue
        fine_column, fine_row = int((x + 0.5) * DEPTH_BUFFER_SCALE), int((y + 0.5) * DEPTH_BUFFER_SCALE)
        if (
            nearest[0, fine_row, fine_column] - z > DEPTH_TOLERANCE_PIXELS
            or nearest[1, fine_row, fine_column] - z > DEPTH_JUMP_PIXELS
        ):
            continue
        agrees, surely = True, points[i, 4] >= points[i, 5] or not labels[1, row, column] & 1  # hair before a shoulder
        for label in range(may_show.shape[1]):
            if not labels[1, row, column] >> label & 1:
                continue
            likely = np.float32(0)
            for part in range(may_show.shape[0]):
                likely += points[i, 4 + part] * may_show[part, label]
            if likely <= MIN_LABEL_WEIGHT_SHARE:
                surely = False
                agrees &= not labels[0, row, column] >> label & 1
        leg = points[i, 8] + points[i, 9]
        for k in range(2):
            if points[i, 6 + k] < 0.05:
                away = from_arms[k, row, column]
                agrees &= away >= ARM_MARGIN_PIXELS
                surely &= away >= (ARM_OVER_LEG_MARGIN_PIXELS if leg > 0.02 else ARM_SOURCE_MARGIN_PIXELS)
        if not agrees:
            continue
        u = min(max(to_picture[0, 0] * x + to_picture[0, 2], 0.0), columns - 1.0)
        v = min(max(to_picture[1, 1] * y + to_picture[1, 2], 0.0), rows - 1.0)
        left, top = int(u), int(v)
        right, bottom = min(left + 1, columns - 1), min(top + 1, rows - 1)
        fu, fv = np.float32(u - left), np.float32(v - top)
        for k in range(3):
            upper = clean[top, left, k] * (1 - fu) + clean[top, right, k] * fu
            lower = clean[bottom, left, k] * (1 - fu) + clean[bottom, right, k] * fu
            colours[i, k] = upper * (1 - fv) + lower * fv
        shown[i] = min((towards - MIN_SHOWN_COSINE) / (MIN_SOURCE_COSINE - MIN_SHOWN_COSINE), 1.0)
        source[i] = (
            surely
            and not wall[row, column]
            and towards > MIN_SOURCE_COSINE
            and inside[row, column] > SOURCE_OUTLINE_DISTANCE_PIXELS
            and nearest[2, fine_row, fine_column] - z <= DEPTH_JUMP_PIXELS
        )
    return colours, shown, source
