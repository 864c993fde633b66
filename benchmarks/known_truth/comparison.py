"""What is made of a picture of a known person, held against the truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.known_truth.known_person import KnownPicture
from benchmarks.known_truth.surface_distance import Distances


@dataclass(frozen=True)
class MadeSurfaces:
    """What is made of a picture, as (vertices, triangles) in metres before the picture's camera."""

    made: tuple[NDArray[np.float64], NDArray[np.int32]]
    by_depth: tuple[NDArray[np.float64], NDArray[np.int32]]
    template: tuple[NDArray[np.float64], NDArray[np.int32]]


@dataclass(frozen=True)
class Comparison:
    """What was found of one picture, against the truth.

    distances : of the character, of the one made by warped depth, and of the template.
    joints : centimetres, None where the truth has none.
    seconds : how long it took.
    """

    known: KnownPicture
    place: str
    iou: float
    distances: tuple[Distances, Distances, Distances]
    joints: tuple[float, float] | None
    reprojection: float
    seconds: float
    aligned: tuple[NDArray[np.float64], NDArray[np.float64]]
    """The vertices of the character and of the template, where they are compared."""
    surfaces: MadeSurfaces
    mask: NDArray[np.float32]
