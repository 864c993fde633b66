"""The template as a person: what textures are made for and what is exported."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.errors import Notice
from engine.geometry.registration.rigid import Similarity
from engine.geometry.rigging.skeleton import Skeleton


@dataclass(frozen=True)
class FittedTemplate:
    """A person.

    vertices : (V, 3) all the template's vertices as the person stood, metres, in the world of the body's clip.
    rest : (V, 3) the same in T-pose, metres, feet on the ground.
    skeleton : the joints of `engine.body.rig.HUMAN_RIG` in T-pose.
    joints : (J, 3) where they are as the person stood.
    rotations : (J, 3, 3) how their axes are turned there from the T-pose, in the world.
    iris : metres, the radius of the irises.
    expressions : displacements (V, 3) of `rest`, metres, by name: the face units and the visemes.
    head_to_body : from the world of the head's clip to that of the body's; None without such a clip.
    coefficients : (K,) of the space of bodies, in standard deviations.
    notices : what the user should know.
    """

    vertices: NDArray[np.float64]
    rest: NDArray[np.float32]
    skeleton: Skeleton
    joints: NDArray[np.float64]
    rotations: NDArray[np.float64]
    iris: float
    expressions: Mapping[str, NDArray[np.float32]]
    head_to_body: Similarity | None
    coefficients: NDArray[np.float64]
    notices: tuple[Notice, ...]
