"""Upper lids and the skin above them stay below the brow, or below the frame of spectacles: a picture has no more room there than it shows.

Who lowers a brow over an open eye folds the skin between under. Carried over as it is the lid goes over the brow, or over a frame that stays with the
skull, and the picture tears there. So the skin gives way up to the brow, and where it cannot any more, the lid stops.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.lips_and_skin import in_order, with_neighbours
from engine.perception.face.landmarks import LEFT_EYE_CORNER_VERTICES, RIGHT_EYE_CORNER_VERTICES

LID_COLUMNS = (
    ((246, 247, 113), (161, 30, 225), (160, 29, 224), (159, 27, 223), (158, 28, 222), (157, 56, 221), (173, 190, 189)),
    ((466, 467, 342), (388, 260, 445), (387, 259, 444), (386, 257, 443), (385, 258, 442), (384, 286, 441), (398, 414, 413)),
)  # fmt: skip
"""Columns across both upper lids, right one first, from the lid's edge up over the skin above it."""
BROW_VERTICES = ((124, 46, 53, 52, 65, 55, 193), (353, 276, 283, 282, 295, 285, 417))
"""What each of them goes on with: the lower edge of the brow."""
MIN_SKIN_ABOVE_LID_SHARE = 0.3
"""Share of its usual breadth that each part of the skin between brow and lid keeps."""
EYE_CORNERS = (RIGHT_EYE_CORNER_VERTICES, LEFT_EYE_CORNER_VERTICES)


def keep_lids_below_brows(
    placed: NDArray[np.floating], rigid: NDArray[np.floating], bare: NDArray[np.floating]
) -> None:
    """Lead upper lids that go over the brows back, in place.

    Parameters
    ----------
    placed : (N, 478, 2) the face, pixels. rigid : (N, 478, 2) where the head alone carries its rest. bare : (478,) how far each vertex may move by
    itself, in [0, 1].
    """
    for columns, brow, corners in zip(LID_COLUMNS, BROW_VERTICES, EYE_CORNERS, strict=True):
        order = np.column_stack([columns, brow])
        across = rigid[:, corners[1]] - rigid[:, corners[0]]
        up = np.stack([across[:, 1], -across[:, 0]], axis=-1)
        up /= np.maximum(np.linalg.norm(up, axis=-1, keepdims=True), 1e-6)
        up *= np.sign(np.einsum("nvd,nd->n", rigid[:, order[:, -1]] - rigid[:, order[:, 0]], up))[:, None]
        along, usual = (np.einsum("nvkd,nd->nvk", one[:, order], up) for one in (placed, rigid))
        breadth = np.diff(usual, axis=-1)
        moved = in_order(along, np.minimum(MIN_SKIN_ABOVE_LID_SHARE * breadth, breadth), bare[order]) - along
        for k in range(moved.shape[-1] - 1):
            moved[..., k] = with_neighbours(moved[..., k])
        placed[:, order] += moved[..., None] * up[:, None, None]
