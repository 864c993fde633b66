"""The skin about a closed mouth, on which its face units are made."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.body.lip_sides import lip_rims


@dataclass(frozen=True)
class MouthSkin:
    """A skin about a closed mouth.

    vertices : (S, 3) metres, x across, the middle of the face at 0, and y up.
    triangles : (T, 3) int, counter-clockwise from outside.
    inside : (T,) which are the mouth's inside.
    jaw : (S,) what the jaw's bone weighs.
    lips : (S,) which are lips.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.integer]
    inside: NDArray[np.bool_]
    jaw: NDArray[np.floating]
    lips: NDArray[np.bool_]

    def within(self) -> NDArray[np.bool_]:
        """(S,) what is of the mouth's inside, its rims too."""
        found = np.zeros(len(self.vertices), np.bool_)
        found[self.triangles[self.inside]] = True
        return found

    def rims(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """The vertices of the rim of the upper and of the lower lip (`engine.body.lip_sides`)."""
        return lip_rims(self.vertices, self.triangles, self.inside)
