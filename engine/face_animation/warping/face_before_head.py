"""A face drawn before what it hides of its own head: see `motion_transfer.far_side`."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.face_animation.warping.contour_rings import round_contour
from engine.face_animation.warping.warp_mesh import WarpMesh
from engine.imaging.warping.mesh_warp import UNCOVERED_ORIGIN_PIXELS
from engine.perception.face.landmarks import FACE_OVAL, eye_distance

SKIN_RIM_EYE_DISTANCES = 0.06
"""By which what goes with the face reaches beyond its contour: skin ends a little outside of that, often in a dark line."""
SAMPLES_PER_SIDE = 3
"""Of each pixel along each side, at the edge and where the picture is squeezed before it, which would come as specks."""
SQUEEZED_RIM_WIDTHS = 4
"""Times `SKIN_RIM_EYE_DISTANCES` from the face's edge up to where the picture may be so squeezed."""
MAX_ONE_SAMPLE_SQUEEZE = 2.0
"""Pixels of the picture to one of the result up to which one sample of it is enough."""


class FaceBeforeHead:
    """The cut between the face of a mesh (478, 2 or 3) and what lies beside it, in a picture of `shape` (height, width)."""

    def __init__(self, mesh: NDArray[np.floating], shape: tuple[int, int]):
        contour = round_contour(mesh[list(FACE_OVAL), :2].astype(float))
        inside = np.zeros(shape, np.uint8)
        cv2.fillPoly(inside, [np.rint(contour).astype(np.int32)], (1,))
        within, beyond = (cv2.distanceTransform(one, cv2.DIST_L2, 5) for one in (inside, 1 - inside))
        self._reach = np.float32(SKIN_RIM_EYE_DISTANCES * eye_distance(mesh[:, :2]))
        self._depth = np.asarray(within - beyond + self._reach, np.float32)

    def around(self, mesh: WarpMesh) -> NDArray[np.int32]:
        """(T, 3) the triangles of a picture's mesh that lie around the face: the sheet behind it, on which the face is not."""
        places = np.clip(np.rint(mesh.vertices).astype(int), 0, np.array(self._depth.shape[::-1]) - 1)
        inside = self._depth[places[:, 1], places[:, 0]] > self._reach / 2
        return mesh.triangles[~inside[mesh.triangles].all(axis=1)]

    def draw(
        self,
        layer: NDArray[np.uint8],
        person: NDArray[np.uint8],
        margin: int,
        face: NDArray[np.float32],
        behind: NDArray[np.float32],
    ) -> None:
        """Draw what is seen of the sheet behind, in a part of a layer (h, w, 4) that shows the face's sheet, in place.

        Parameters
        ----------
        person : the picture's layer at twice its size, and carried on by a `margin` beyond its border, pixels of the picture.
        face, behind : (h, w, 2) the inverse maps of both sheets, into the picture at twice its size; where the one behind leaves the
            result to the other it is `UNCOVERED_ORIGIN_PIXELS`.
        """
        _cover(layer, person, np.float32(2 * margin), face, behind, self._depth, self._reach)


@njit(fastmath=True, nogil=True)
def _cover(layer, person, margin, face, behind, depth, reach):  # type: ignore[no-untyped-def]
    """As `FaceBeforeHead.draw`; `depth` (H, W) is how far inside the face's edge the picture lies, pixels, and `reach` over how many it fades."""
    height, width = layer.shape[:2]
    sums, step, back = np.zeros(4, np.float32), np.zeros((4, 2), np.float32), np.zeros((4, 2), np.float32)
    for y in range(height):
        for x in range(width):
            one_sheet = behind[y, x, 0] < UNCOVERED_ORIGIN_PIXELS / 2
            here = _depth_at(depth, face[y, x, 0], face[y, x, 1])
            far = abs(here) > SQUEEZED_RIM_WIDTHS * reach
            if far and (one_sheet or here > 0):
                continue
            squeezed = np.float32(0)
            if not far and (one_sheet or here > 0):
                squeezed = _steps(face, y, x, step)
            if (one_sheet or here > reach + squeezed) and squeezed <= MAX_ONE_SAMPLE_SQUEEZE:
                continue
            count = SAMPLES_PER_SIDE if squeezed > MAX_ONE_SAMPLE_SQUEEZE else 1
            if count > 1 and not one_sheet:
                _steps(behind, y, x, back)
            edge = max(reach, squeezed)
            sums[:] = 0
            for v in range(count):
                for u in range(count):
                    right, down = np.float32((u + 0.5) / count - 0.5), np.float32((v + 0.5) / count - 0.5)
                    beside, below = int(right > 0), 2 + int(down > 0)
                    fx = face[y, x, 0] + abs(right) * step[beside, 0] + abs(down) * step[below, 0]
                    fy = face[y, x, 1] + abs(right) * step[beside, 1] + abs(down) * step[below, 1]
                    before = np.float32(1)
                    if not one_sheet:
                        before = min(max(_depth_at(depth, fx, fy) / edge, np.float32(0)), np.float32(1))
                    if before > 0:
                        before = before * _add(sums, person, fx + margin, fy + margin, before)
                    if before < 1 and not one_sheet:
                        bx = behind[y, x, 0] + abs(right) * back[beside, 0] + abs(down) * back[below, 0]
                        by = behind[y, x, 1] + abs(right) * back[beside, 1] + abs(down) * back[below, 1]
                        _add(sums, person, bx + margin, by + margin, 1 - before)
            if sums[3] > 0:
                for k in range(3):
                    layer[y, x, k] = np.uint8(sums[k] / sums[3] + np.float32(0.5))
            layer[y, x, 3] = np.uint8(255 * sums[3] / count**2 + np.float32(0.5))


@njit(fastmath=True, nogil=True, inline="always")
def _steps(origin, y, x, step):  # type: ignore[no-untyped-def]
    """How an inverse map changes on the way to the neighbours to the left, to the right, above and below, into `step` (4, 2); returns the largest
    change in pixels of the picture. Beyond the map it does not change."""
    largest = np.float32(0)
    for k in range(4):
        row, column = y + (k // 2) * (2 * (k % 2) - 1), x + (1 - k // 2) * (2 * (k % 2) - 1)
        step[k, 0] = step[k, 1] = np.float32(0)
        inside = 0 <= row < origin.shape[0] and 0 <= column < origin.shape[1]
        if inside and origin[row, column, 0] > UNCOVERED_ORIGIN_PIXELS / 2:
            along, across = origin[row, column, 0] - origin[y, x, 0], origin[row, column, 1] - origin[y, x, 1]
            step[k, 0], step[k, 1] = along, across
            largest = max(largest, np.sqrt(along * along + across * across) / 2)
    return largest


@njit(fastmath=True, nogil=True, inline="always")
def _corner(place, end):  # type: ignore[no-untyped-def]
    """The pixel before a place on a row of so many, and how far it lies on the way to the next one; on the row's ends beyond it."""
    held = min(max(place, np.float32(0)), np.float32(end - 1))
    first = min(int(held), end - 2)
    return first, np.float32(held - first)


@njit(fastmath=True, nogil=True, inline="always")
def _depth_at(depth, x, y):  # type: ignore[no-untyped-def]
    """Bilinear, at a place in the picture at twice its size."""
    column, u = _corner((x - np.float32(0.5)) / 2, depth.shape[1])
    row, v = _corner((y - np.float32(0.5)) / 2, depth.shape[0])
    above = (1 - u) * depth[row, column] + u * depth[row, column + 1]
    return (1 - v) * above + v * ((1 - u) * depth[row + 1, column] + u * depth[row + 1, column + 1])


@njit(fastmath=True, nogil=True, inline="always")
def _add(sums, person, x, y, weight):  # type: ignore[no-untyped-def]
    """Add a bilinear sample, weighted by its alpha and a `weight`; returns the alpha."""
    column, u = _corner(x, person.shape[1])
    row, v = _corner(y, person.shape[0])
    a, b, c, d = (1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v
    alpha = a * person[row, column, 3] + b * person[row, column + 1, 3]
    alpha = (alpha + c * person[row + 1, column, 3] + d * person[row + 1, column + 1, 3]) / 255
    for k in range(3):
        colour = a * person[row, column, k] + b * person[row, column + 1, k]
        sums[k] += weight * alpha * (colour + c * person[row + 1, column, k] + d * person[row + 1, column + 1, k])
    sums[3] += weight * alpha
    return alpha
