"""Parts of the body: bones and vertices of the template belong where anyone would count them."""

import numpy as np
import pytest

from engine.body import Template
from engine.body.parts import BODY_PARTS, part_of_bone, vertex_parts
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig


def test_bones_belong_to_parts() -> None:
    assert BODY_PARTS[part_of_bone("LeftHandIndex2")] == "left_arm"
    assert BODY_PARTS[part_of_bone("RightToeBase")] == "right_leg"
    assert BODY_PARTS[part_of_bone("Neck")] == "head"
    assert BODY_PARTS[part_of_bone("LeftShoulder")] == "torso"


@pytest.mark.parametrize("name", ["mixamo", HUMAN_RIG])
def test_vertices_belong_to_parts(template: Template, name: str) -> None:
    part = vertex_parts(load_rig(name))
    body = template.vertices_of("body")
    x, y, _ = template.vertices[body].T
    assert BODY_PARTS[part[body[x.argmax()]]] == "left_arm" and BODY_PARTS[part[body[x.argmin()]]] == "right_arm"
    assert BODY_PARTS[part[body[y.argmax()]]] == "head"
    for foot, side in ((x > 0, "left_leg"), (x < 0, "right_leg")):
        low = body[foot & (y < y.min() + 0.05)]
        assert {BODY_PARTS[one] for one in part[low]} == {side}
    for inner in ("left_eye", "upper_teeth", "lower_teeth", "tongue", "right_upper_lashes"):
        assert set(part[template.vertices_of(inner)]) == {BODY_PARTS.index("head")}
    count = np.bincount(part[body], minlength=len(BODY_PARTS))
    for limb in ("arm", "leg"):
        left, right = (count[BODY_PARTS.index(f"{side}_{limb}")] for side in ("left", "right"))
        assert left == pytest.approx(right, rel=0.01), "the template is symmetric"
