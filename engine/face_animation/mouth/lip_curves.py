"""Lips constructed as curves between the corners of the mouth, so that none is missing, and none has an angle.

A tracker's points of an open mouth are a slanted polygon, and what is carried over to another face, corrected and kept inside its contour is
one even more. So their opening is told by four things alone: both corners, how far lips meet above or below the line between these, and how far they
part. The line on which they meet is a parabola. Their gap is a parabola, too, of a mouth that parts, and half of an ellipse of one
that says O. Each lip lies beside its edge as in the picture, as thick along it as there, times the driver's change.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.lips_and_skin import LIP_COLUMNS
from engine.face_animation.mouth.skin_around_lips import with_lips
from engine.face_animation.mouth.smile_curve import CORNER_VERTICES
from engine.face_animation.smoothstep import smoothstep
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import INNER_MOUTH_CORNER_VERTICES, MOUTH_CORNER_VERTICES, mouth_opening

MIDDLE_COLUMNS = slice(2, 7)
"""Of a lip's nine columns, those by which its thickness and the opening are told: beside the corners they are too small to be measured."""
ELLIPTIC_OPENINGS = (0.25, 0.75)
"""Openings of a mouth, its gap over its width, up to which its gap is a parabola, and from which on an ellipse: the corners of one are sharp, of the other round."""
SIDES = np.array([-1.0, 1.0])
"""Ways down a face from the opening to the upper and the lower lip."""
THICKNESS_SHARES = (0.85, 1.0)
"""Shares of what they have by their volume, between which lips are thick."""
VOLUME_SHARES = (0.8, 1.25)
"""Of its thickness at rest, what a lip has by its volume: the more, the narrower the mouth is."""
TOUCHING_THICKNESS_SHARES = (0.55, 1.4)
"""Shares of their thickness at rest, between which lips are thick that touch: they are rolled in as they are pressed, and out as they pout. A tracker's points follow
their red there (correlation with what colours tell of its height 0.92 to 0.96 on nine of fourteen clips); of parted lips it takes a part for the opening."""
LIPS_PART_OPENINGS = (0.03, 0.08)
"""Openings of a mouth up to which lips touch, and from which on they are parted."""


def thickness_shares(faces: NDArray[np.floating], neutral: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N, 2) what share of its thickness on a `neutral` face (478, 2 or 3) the upper and the lower lip have on others (N, 478, 2
    or 3) of the same scale: within `THICKNESS_SHARES` of what their volume leaves them where they are parted, else within `TOUCHING_THICKNESS_SHARES`."""
    now, rest = _thickness(faces), _thickness(neutral[None])
    share = now[..., MIDDLE_COLUMNS].mean(axis=-1) / np.maximum(rest[..., MIDDLE_COLUMNS].mean(axis=-1), 1e-6)
    width, usual = (
        np.linalg.norm(
            one[..., MOUTH_CORNER_VERTICES[1], :2] - one[..., MOUTH_CORNER_VERTICES[0], :2].astype(float), axis=-1
        )
        for one in (faces, neutral)
    )
    volume = np.clip(usual / np.maximum(width, 1e-6), *VOLUME_SHARES)[:, None]
    parted = smoothstep(mouth_opening(faces), *LIPS_PART_OPENINGS)[:, None]
    least, most = (
        touching + parted * (apart * volume - touching)
        for touching, apart in zip(TOUCHING_THICKNESS_SHARES, THICKNESS_SHARES, strict=True)
    )
    return np.asarray(np.clip(share, least, most))


def construct_lips(placed: NDArray[np.floating], rigid: NDArray[np.floating], shares: NDArray[np.floating]) -> None:
    """Put lips on curves, in place, and the skin around them with them. What is as at rest stays.

    Parameters
    ----------
    placed : (N, 478, 2) the face, pixels. rigid : (N, 478, 2) where the head alone carries its rest. shares : (N, 2) of their thickness at rest, that the
        upper and the lower lip have, from `thickness_shares`.
    """
    columns, corners = np.array(LIP_COLUMNS), np.reshape(CORNER_VERTICES, (2, -1))
    face = placed.astype(float)
    face[:, corners] = placed[:, corners[:, -1:]] + rigid[:, corners] - rigid[:, corners[:, -1:]]
    now, rest = _Opening(face), _Opening(rigid)
    thickness = rest.thickness(rigid)
    beside = rigid[:, columns] - rest.lips(thickness)
    beside[..., -2, :] = _with_gap(beside[..., -2, :], now.gap / np.maximum(rest.gap, 1e-6))
    face[:, columns] = now.lips(shares * thickness) + beside
    vertices = [*columns.ravel(), *corners.ravel()]
    placed += np.einsum("vl,nld->nvd", _influence(), face[:, vertices] - placed[:, vertices])


class _Opening:
    """The mouths of faces (N, 478, 2) as curves, beside the lines from corner to corner of lips' edges and of their borders. `gap` : (N,) by how much
    lips part in the middle, pixels."""

    def __init__(self, faces: NDArray[np.floating]):
        self._edges, self._borders = (
            _Line(faces, corners) for corners in (INNER_MOUTH_CORNER_VERTICES, MOUTH_CORNER_VERTICES)
        )
        upper, lower = (faces[:, np.array(lip)[:, -2], :2].astype(float) for lip in LIP_COLUMNS)
        places = _places()
        bend = _bend(places)
        self._meeting = np.einsum("k,nkd->nd", bend, (upper + lower) / 2 - self._edges.at(places[None])) / (bend @ bend)
        self._down = self._edges.down
        apart = np.maximum(np.einsum("nkd,nd->nk", lower - upper, self._down), 0)[:, MIDDLE_COLUMNS]
        self._round = smoothstep(apart[:, apart.shape[1] // 2] / self._edges.width, *ELLIPTIC_OPENINGS)
        shape = self._shape(places[None])[:, MIDDLE_COLUMNS]
        self.gap = (apart * shape).sum(axis=1) / (shape**2).sum(axis=1)

    def thickness(self, faces: NDArray[np.floating]) -> NDArray[np.float64]:
        """(N, 2) of both lips in their middle, as their borders tell along their whole length."""
        borders, places = faces[:, np.array(LIP_COLUMNS)[..., -1], :2], _places()[None]
        shape = self._shape(places)
        line = self._borders.at(places) + _bend(places)[..., None] * self._middle()[:, None]
        heights = np.einsum("nlkd,nd,nk->nl", borders - line[:, None], self._down, shape)
        return np.asarray(SIDES * heights / (shape**2).sum(axis=1)[:, None] - self.gap[:, None] / 2)

    def lips(self, thickness: NDArray[np.floating]) -> NDArray[np.float64]:
        """(N, 2, 9, 4, 2) `LIP_COLUMNS` on their curves, of lips as thick in their middle as `thickness` (N, 2) says."""
        along = _places() + self._round[:, None] * (_around() - _places())
        bend, shape = _bend(along)[..., None], self._shape(along)[..., None]
        line = self._edges.at(along) + bend * self._meeting[:, None]
        border = self._borders.at(along) + bend * self._middle()[:, None]
        columns = []
        for lip, side in enumerate(SIDES):
            edge = line + shape * (side * self.gap / 2)[:, None, None] * self._down[:, None]
            rim = border + shape * (side * (self.gap / 2 + thickness[:, lip]))[:, None, None] * self._down[:, None]
            columns.append(edge[:, :, None] + _across()[lip][..., None] * (rim - edge)[:, :, None])
        return np.stack(columns, axis=1)

    def _middle(self) -> NDArray[np.float64]:
        """(N, 2) where lips meet in the middle, beside that of the line between the corners of their borders."""
        return np.asarray(self._edges.middle + self._meeting - self._borders.middle)

    def _shape(self, along: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, 9) of the gap at places `along` (N or 1, 9) from -1 to 1, as shares of what it is in the middle."""
        return np.asarray(_bend(along) ** (1 - self._round / 2)[:, None])


class _Line:
    """From corner to corner of the mouths of faces (N, 478, 2): its `middle` (N, 2), its `width` (N,), and the way `down` (N, 2) from it."""

    def __init__(self, faces: NDArray[np.floating], corners: tuple[int, int]):
        right, left = (faces[:, corner, :2].astype(float) for corner in corners)
        self.middle, self._half = (right + left) / 2, (left - right) / 2
        self.width = np.maximum(np.linalg.norm(left - right, axis=1), 1e-6)
        self.down = np.stack([-self._half[:, 1], self._half[:, 0]], axis=1) / (self.width / 2)[:, None]

    def at(self, along: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N, K, 2) its points at places `along` (N or 1, K) from -1 to 1."""
        return np.asarray(self.middle[:, None] + along[..., None] * self._half[:, None])


def _with_gap(beside: NDArray[np.float64], share: NDArray[np.float64]) -> NDArray[np.float64]:
    """What edges of lips (N, 2, 9, 2) have beside their curves, without more of what parts them than a `share` (N,) of it."""
    middle, half = beside.mean(axis=1), np.minimum(share, 1)[:, None, None] * np.diff(beside, axis=1)[:, 0] / 2
    return np.stack([middle - half, middle + half], axis=1)


def _bend(along: NDArray[np.float64]) -> NDArray[np.float64]:
    """A parabola at places `along` from -1 to 1: 1 in the middle, 0 at the corners."""
    return np.asarray(1 - along**2)


@cache
def _places() -> NDArray[np.float64]:
    """(9,) where a lip's columns are between the corners of a mouth, from -1 to 1."""
    face = canonical_face()[:, 0].astype(float)
    inner = np.array(LIP_COLUMNS)[..., -2]
    return np.asarray(face[inner].mean(axis=0) / face[INNER_MOUTH_CORNER_VERTICES[1]])


def _around() -> NDArray[np.float64]:
    """(9,) where they are along a round opening: evenly around it, the outermost ones half as far from the corners."""
    count = len(_places())
    return np.asarray(np.sin(np.linspace(-1, 1, count) * np.pi / 2 * (count - 1) / count))


@cache
def _across() -> NDArray[np.float64]:
    """(2, 9, 4) how far across a lip the vertices of its columns are, from 0 at its edge to 1 at its border."""
    columns = canonical_face()[np.array(LIP_COLUMNS)].astype(float)
    away = np.linalg.norm(columns - columns[:, :, -2:-1], axis=-1)
    return np.asarray(np.minimum(away / away[..., -1:], 1))


@cache
def _influence() -> NDArray[np.float64]:
    """(478, 80) how much a vertex goes along with each of those of both lips' columns and of the corners."""
    vertices = np.array([*np.ravel(LIP_COLUMNS), *CORNER_VERTICES])
    return with_lips(vertices, np.eye(len(vertices)))


def _thickness(faces: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N, 2, 9) of the columns of both lips of faces (N, 478, 2 or 3), the upper one first."""
    columns = np.array(LIP_COLUMNS)
    return np.asarray(np.linalg.norm(faces[:, columns[..., -1], :2] - faces[:, columns[..., -2], :2], axis=-1), float)
