"""A hand's filmed colours and its painted ones made one: filmed where a frame shows it well, painted in their tone elsewhere.

What differs between the two is solved for over the hand's surface, whose charts are cut and the surface is not: near to what frames
show, and with the least gradient elsewhere (P. Perez, M. Gangnet, A. Blake, Poisson image editing, SIGGRAPH 2003), so that the painted
details stand in the filmed tones. The details themselves then pass from one to the other over a soft rim (P. J. Burt, E. H. Adelson,
A multiresolution spline with application to image mosaics, ACM TOG 2, 1983).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from engine.avatar.texture.template_texture.part_texels import PartTexels
from engine.geometry.deformation.cotangent_laplacian import cotangent_laplacian
from engine.geometry.mesh.surface import triangle_areas
from engine.imaging.histogram_matching import to_lab
from engine.performances.modelling.hands import HandBones
from engine.performances.modelling.skin_tone import like_skin, skin_likeness

FINGER_WIDTH_METRES = 0.016
"""Metres: the width of a finger."""
FINGER_PIXELS = (5.0, 9.0)
"""Pixels across a finger of a frame that shows no detail of hands yet, and of one that shows all that a painted hand has."""
TONE_LENGTH_METRES = 0.008
"""Metres over which the difference of filmed and painted colours is a matter of tone, and not of detail."""
RIM_LENGTH_METRES = 0.004
"""Metres over which details pass from filmed to painted ones."""
SLEEVE_RING_METRES = 0.005
"""Metres along the hand in which it is looked whether a sleeve covers it."""
CUFF_SLANT_METRES = 0.005
"""Metres by which a cuff reaches farther on one side."""
UNSEEN_AREA_WEIGHT = 1e-4
"""Of an area that frames do not show, against one that they do: what holds a tone where they show nothing."""


@dataclass(frozen=True)
class HandSurface:
    """A hand by itself.

    vertices : (V, 3) metres.
    triangles : (T, 3) into these vertices.
    faces : (T,) which of the whole surface's faces they are, ascending.
    along : (T,) metres past the wrist, along the hand.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.intp]
    faces: NDArray[np.intp]
    along: NDArray[np.float64]

    @property
    def areas(self) -> NDArray[np.float64]:
        """(T,) square metres of the triangles."""
        return np.asarray(triangle_areas(self.vertices, self.triangles), np.float64)

    def spread(self, amounts: NDArray[np.float64]) -> NDArray[np.float64]:
        """(V,) what each triangle has, (T,), in equal parts at its corners."""
        return np.bincount(self.triangles.ravel(), amounts.repeat(3) / 3, len(self.vertices)).astype(np.float64)

    @staticmethod
    def of(
        vertices: NDArray[np.floating], triangles: NDArray[np.integer], part: NDArray[np.bool_], bones: HandBones
    ) -> HandSurface:
        """That of the triangles `part` (F,) of a surface's `triangles` (F, 3) into its `vertices` (N, 3)."""
        faces = np.flatnonzero(part)
        used, corners = np.unique(triangles[faces], return_inverse=True)
        own, corners = np.asarray(vertices, np.float64)[used], corners.reshape(-1, 3)
        return HandSurface(own, corners, faces, (own[corners].mean(1) - bones.wrist) @ bones.along)


def joined_hand(
    hand: HandSurface,
    texels: PartTexels,
    filmed: NDArray[np.number],
    painted: NDArray[np.floating],
    resolution: NDArray[np.floating],
    tone: NDArray[np.floating],
) -> NDArray[np.float64]:
    """(N, 3) the colours of a hand's texels.

    Parameters
    ----------
    texels : N of them, of the whole surface's faces.
    filmed, painted : (N, 3) 0 to 255.
    resolution : (F,) pixels per metre at which the frame that each face of the whole surface took shows it; 0 where none does.
    tone : (3,) CIELAB, of the person's skin: what is shown of another colour is no hand, but a sleeve or what lies behind.
    """
    number = np.searchsorted(hand.faces, texels.triangles)
    shown = resolution[hand.faces] > 0
    skin = shown & like_skin(to_lab(_means(filmed, number, len(hand.faces))), tone)
    sleeve = shown & ~skin & (hand.along < _sleeve_length(hand, shown, skin))
    few, enough = FINGER_PIXELS
    sharp = np.clip((resolution[hand.faces] * FINGER_WIDTH_METRES - few) / (enough - few), 0, 1)
    stiff = cotangent_laplacian(hand.vertices, hand.triangles)
    detail = _details(hand, stiff, skin | sleeve, np.where(sleeve, 1.0, sharp))
    whole = hand.spread(hand.areas)
    cover = _smooth(
        stiff,
        hand.spread(hand.areas * shown) + UNSEEN_AREA_WEIGHT * whole,
        hand.spread(hand.areas * sleeve),
        RIM_LENGTH_METRES,
    )
    like = skin_likeness(to_lab(filmed), tone) * skin[number]
    change = _change_of_tone(hand, stiff, texels, number, np.asarray(filmed, np.float64) - painted, like)

    corners = hand.triangles[number]
    toned = painted + np.einsum("nk,nkc->nc", texels.shares, change[corners])
    share, covered = (np.einsum("nk,nk->n", texels.shares, field[corners]) for field in (detail, cover))
    share = np.maximum(like * share, np.clip(4 * covered - 1, 0, 1))[:, None]
    return np.asarray(toned + share * (filmed - toned))


def _change_of_tone(
    hand: HandSurface,
    laplacian: sp.csr_array,
    texels: PartTexels,
    number: NDArray[np.intp],
    off: NDArray[np.float64],
    like: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(V, 3) what takes painted colours to filmed ones: close to what texels, of the faces `number` (N,), are `off` (N, 3) where these
    are `like` (N,) skin, and harmonic between."""
    areas = hand.areas
    corners, size = hand.triangles[number], len(hand.vertices)
    each = areas / np.maximum(np.bincount(number, minlength=len(areas)), 1)
    told = texels.shares * (like * each[number])[:, None]
    mass = np.bincount(corners.ravel(), told.ravel(), size)
    pulls = np.stack([np.bincount(corners.ravel(), (told * off[:, [k]]).ravel(), size) for k in range(3)], 1)
    return _smooth(
        laplacian, mass + UNSEEN_AREA_WEIGHT * hand.spread(areas), np.asarray(pulls, np.float64), TONE_LENGTH_METRES
    )


def _details(
    hand: HandSurface, laplacian: sp.csr_array, trusted: NDArray[np.bool_], sharp: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(V,) the share of filmed details: none at the rim of what is `trusted` (T,), and where frames are not `sharp` (T,)."""
    areas = hand.areas
    whole = hand.spread(areas)
    inside = _smooth(laplacian, whole, hand.spread(areas * trusted), RIM_LENGTH_METRES)
    return np.clip(2 * inside - 1, 0, 1) * _smooth(laplacian, whole, hand.spread(areas * sharp), RIM_LENGTH_METRES)


def _means(colours: NDArray[np.number], number: NDArray[np.intp], count: int) -> NDArray[np.float64]:
    """(T, 3) the mean of the colours (N, 3) of each of `count` faces, by their `number` (N,); black of those without."""
    total = np.maximum(np.bincount(number, minlength=count), 1)
    return np.stack([np.bincount(number, colours[:, k], count) / total for k in range(3)], 1)


def _sleeve_length(hand: HandSurface, shown: NDArray[np.bool_], skin: NDArray[np.bool_]) -> float:
    """Metres past the wrist to where a sleeve, or a glove, may reach: it goes all around, so most of what frames have `shown` (T,) up to
    there is no `skin` (T,), ring for ring."""
    ring = np.maximum(hand.along / SLEEVE_RING_METRES, 0).astype(np.intp)
    seen = np.bincount(ring, hand.areas * shown)
    bare = np.flatnonzero((np.bincount(ring, hand.areas * skin) >= seen / 2) & (seen > 0))
    return float(SLEEVE_RING_METRES * (bare[0] if len(bare) else len(seen)) + CUFF_SLANT_METRES)


def _smooth(
    laplacian: sp.csr_array, mass: NDArray[np.float64], pulls: NDArray[np.float64], length: float
) -> NDArray[np.float64]:
    """(V,) or (V, C): what is near to `pulls` over `mass` (V,), square metres, and smooth over a `length` in metres."""
    return np.asarray(splu(sp.csc_array(sp.diags_array(mass) + length**2 * laplacian)).solve(pulls))
