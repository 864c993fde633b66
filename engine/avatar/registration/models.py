"""What is known of people before any cloud is: the template, its spaces and rig, loaded once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.body_model import BodyModel
from engine.avatar.registration.coarse import SHAPE_COEFFICIENTS
from engine.avatar.registration.footwear import Feet, load_feet
from engine.avatar.registration.skin import Skin, load_skin
from engine.body.body_space import BodySpace, load_body_space
from engine.body.landmarks import LandmarkModel, landmark_model
from engine.body.rig import HUMAN_RIG, Rig
from engine.body.template import Template, load_rig, load_template
from engine.geometry.skinning import skin as blend


@dataclass(frozen=True)
class HumanModels:
    """The template with its rig, the space of bodies, its landmarks, its skin, that skin posed, and its feet."""

    template: Template
    rig: Rig
    space: BodySpace
    landmarks: LandmarkModel
    skin: Skin
    body: BodyModel
    feet: Feet

    def whole(self, parameters: NDArray[np.float64]) -> NDArray[np.float64]:
        """(V, 3) all the template's vertices, eyes and teeth too, for the parameters of `body`, metres."""
        transforms = self.body.transforms(parameters[None])[0]
        shaped = self.space.vertices(parameters[-self.body.coefficients :])
        return blend(shaped, self.rig.bones, self.rig.weights, transforms).astype(np.float64)


def load_models() -> HumanModels:
    """Load them; the first time, everything that is made once is made (some minutes)."""
    template, space, rig = load_template(), load_body_space(), load_rig(HUMAN_RIG)
    skin = load_skin(template, space, rig)
    body = BodyModel(space, skin, SHAPE_COEFFICIENTS)
    feet = load_feet(skin, space.mean[skin.vertices])
    return HumanModels(template, rig, space, landmark_model(template, space, rig), skin, body, feet)
