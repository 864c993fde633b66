"""Expressions of a VRM: named mixtures of morph targets, which applications call by VRM's own names.

Specification: VRM Consortium, VRMC_vrm-1.0, expressions and lookAt.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

PRESET_NAMES = (
    *("happy", "angry", "sad", "relaxed", "surprised", "aa", "ih", "ou", "ee", "oh"),
    *("blink", "blinkLeft", "blinkRight", "lookUp", "lookDown", "lookLeft", "lookRight", "neutral"),
)
"""VRM's own names; every other is one of the character's."""

LOOK_EXPRESSIONS = ("lookUp", "lookDown", "lookLeft", "lookRight")
"""VRM's names of the expressions by which a character looks about that has no joints of its eyes."""

Override = Literal["none", "block", "blend"]


@dataclass(frozen=True)
class Expression:
    """`targets`: morph targets by name, and how far each goes, 0 to 1, when the expression is whole. `binary`: it is whole or not at
    all. The others say what becomes of blinking, looking about and speaking meanwhile: nothing, ended, or lessened by as much
    as the expression has."""

    targets: Mapping[str, float]
    binary: bool = False
    blinking: Override = "none"
    looking: Override = "none"
    speaking: Override = "none"


def both_sides(unit: str, weight: float = 1.0) -> dict[str, float]:
    """A face unit on both sides of the face."""
    return {f"{unit}Left": weight, f"{unit}Right": weight}


ARKIT_MIXTURES: Mapping[str, Expression] = {
    "happy": Expression(
        {**both_sides("mouthSmile", 0.8), **both_sides("cheekSquint", 0.6), **both_sides("eyeSquint", 0.3)},
        blinking="blend",
    ),
    "angry": Expression(
        {
            **both_sides("browDown"),
            **both_sides("noseSneer", 0.4),
            **both_sides("mouthPress", 0.5),
            **both_sides("eyeSquint", 0.4),
        }
    ),
    "sad": Expression(
        {"browInnerUp": 0.9, **both_sides("mouthFrown", 0.8), "mouthShrugLower": 0.3, **both_sides("eyeBlink", 0.15)}
    ),
    "relaxed": Expression({**both_sides("mouthSmile", 0.3), **both_sides("eyeBlink", 0.25)}),
    "surprised": Expression(
        {"browInnerUp": 0.9, **both_sides("browOuterUp", 0.9), **both_sides("eyeWide", 0.8), "jawOpen": 0.3}
    ),
    "aa": Expression({"jawOpen": 0.5, **both_sides("mouthLowerDown", 0.2), **both_sides("mouthUpperUp", 0.1)}),
    "ih": Expression({"jawOpen": 0.15, **both_sides("mouthStretch", 0.4), **both_sides("mouthLowerDown", 0.3)}),
    "ou": Expression({"mouthPucker": 0.8, "mouthFunnel": 0.3, "jawOpen": 0.1}),
    "ee": Expression(
        {
            "jawOpen": 0.1,
            **both_sides("mouthSmile", 0.3),
            **both_sides("mouthStretch", 0.3),
            **both_sides("mouthLowerDown", 0.3),
        }
    ),
    "oh": Expression({"jawOpen": 0.3, "mouthFunnel": 0.7}),
    "blink": Expression(both_sides("eyeBlink")),
    "blinkLeft": Expression({"eyeBlinkLeft": 1.0}),
    "blinkRight": Expression({"eyeBlinkRight": 1.0}),
    "lookUp": Expression(both_sides("eyeLookUp")),
    "lookDown": Expression(both_sides("eyeLookDown")),
    "lookLeft": Expression({"eyeLookOutLeft": 1.0, "eyeLookInRight": 1.0}),
    "lookRight": Expression({"eyeLookInLeft": 1.0, "eyeLookOutRight": 1.0}),
    "neutral": Expression({}),
}
"""VRM's own expressions out of ARKit's face units."""


def arkit_expressions(names: Sequence[str]) -> dict[str, Expression]:
    """VRM's own expressions as far as the morph targets `names` have ARKit's face units for them, and each target as an
    expression of its own by its own name."""
    there = set(names)
    own = {name: Expression({name: 1.0}) for name in names if name not in PRESET_NAMES}
    return {name: mixed for name, mixed in ARKIT_MIXTURES.items() if set(mixed.targets) <= there} | own


def expressions_document(
    expressions: Mapping[str, Expression], morphs: Sequence[str], node: int
) -> dict[str, dict[str, Any]]:
    """`VRMC_vrm.expressions` for a mesh at a node, whose morph targets have these names.

    Raises ValueError where an expression names a target that is not there, or a weight is not within 0 and 1.
    """
    found: dict[str, dict[str, Any]] = {"preset": {}, "custom": {}}
    for name, expression in expressions.items():
        binds = []
        for target, weight in expression.targets.items():
            if target not in morphs:
                raise ValueError(f"the expression {name} names no morph target of the mesh: {target}")
            if not 0 <= weight <= 1:
                raise ValueError(f"the expression {name} asks for {weight} of {target}: 0 to 1")
            binds.append({"node": node, "index": list(morphs).index(target), "weight": float(weight)})
        said: dict[str, Any] = {"morphTargetBinds": binds} if binds else {}
        said |= {"isBinary": expression.binary, "overrideBlink": expression.blinking}
        said |= {"overrideLookAt": expression.looking, "overrideMouth": expression.speaking}
        found["preset" if name in PRESET_NAMES else "custom"][name] = said
    return {kind: named for kind, named in found.items() if named}
