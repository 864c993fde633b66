"""What is known of people before any cloud is: the template, its spaces and rig, loaded once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

from engine.avatar.registration.body_model import BodyModel
from engine.avatar.registration.coarse import COARSE_SHAPE_COEFFICIENTS
from engine.avatar.registration.footwear import Feet, load_feet
from engine.avatar.registration.template_skin.skin import Skin, load_skin
from engine.body.body_space import BodySpace, load_body_space
from engine.body.face.head_space import HeadSpace, load_head_space
from engine.body.hands import HandModel, hand_model
from engine.body.landmarks import LandmarkModel, landmark_model
from engine.body.rig import HUMAN_RIG, Rig
from engine.body.template import Template, load_rig, load_template


@dataclass(frozen=True)
class HumanModels:
    """The template with its rig, the spaces of bodies and of heads, its landmarks, its skin, that skin posed, its feet, and its
    hands by their side."""

    template: Template
    rig: Rig
    space: BodySpace
    heads: HeadSpace
    landmarks: LandmarkModel
    skin: Skin
    body: BodyModel
    feet: Feet
    hands: Mapping[str, HandModel]


@cache
def load_models() -> HumanModels:
    """Load them, once; the first time of all, everything that is made once is made (some minutes)."""
    template, space, rig = load_template(), load_body_space(), load_rig(HUMAN_RIG)
    skin = load_skin(template, space, rig)
    body = BodyModel(space, skin, COARSE_SHAPE_COEFFICIENTS)
    feet = load_feet(skin, space.mean[skin.vertices])
    left, right = hand_model(template, space, rig, "Left"), hand_model(template, space, rig, "Right")
    hands = {"Left": left, "Right": right}
    landmarks = landmark_model(template, space, rig)
    return HumanModels(template, rig, space, load_head_space(), landmarks, skin, body, feet, hands)
