"""Where the face is, so that it does not come to lie on the back of the head."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.character.figure import Figure


def face_ellipse(figure: Figure, to_grid: NDArray[np.float64]) -> NDArray[np.float32] | None:
    """An ellipse around eyes, nose and mouth on the grid: centre x and y, half its width and height, degrees by which it
    is turned. None where no face was seen."""
    if not figure.spatial:
        return None
    named = ("LeftEye", "RightEye", "MouthLeft", "MouthRight", "LeftEar", "RightEar")
    place = {name: to_grid[:, :2] @ figure.point(name) + to_grid[:, 2] for name in named}
    eyes, mouth = (place["LeftEye"] + place["RightEye"]) / 2, (place["MouthLeft"] + place["MouthRight"]) / 2
    up = eyes - mouth
    length = float(np.linalg.norm(up))
    if length < 1:
        return None
    x, y = (eyes + mouth) / 2 + 0.1 * up
    wide = max(1.25 * length, 0.5 * float(np.linalg.norm(place["LeftEar"] - place["RightEar"])))
    return np.array([x, y, wide, 1.9 * length, np.degrees(np.arctan2(up[0], -up[1]))], np.float32)
