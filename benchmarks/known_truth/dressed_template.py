"""The template as people: shapes, standing poses, hair, and clothes that stand off from the body."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.spatial.transform import Rotation

from benchmarks.known_truth.known_person import Person
from engine.body.rest_pose import t_pose
from engine.body.rig import HUMAN_RIG
from engine.body.shape import Phenotype, load_shape_space
from engine.body.template import load_rig, load_template
from engine.geometry.mesh.surface import triangulate, vertex_normals
from engine.geometry.rigging.skinning import bone_transforms, skin
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import Raster

Turns = Mapping[str, tuple[float, float, float]]
"""Degrees about x, y and z, in this order, by joint."""

CLOTH_CENTIMETRES = {
    "Hips": 2.5,
    "Spine": 2.5,
    "Shoulder": 2.0,
    "Arm": 2.0,
    "ForeArm": 2.0,
    "UpLeg": 2.5,
    "Leg": 3.0,
    "Foot": 1.0,
}
"""Centimetres by which cloth or shoe stands off where these joints move it; the rest is bare."""
HAIR_CENTIMETRES = 1.5
"""By which hair stands off from the scalp."""
FOLDS_CENTIMETRES = 1.0
"""By which cloth waves about its distance from the body, each way."""
OFFSET_SMOOTHING_ROUNDS = 12
"""Rounds of smoothing in which offsets become their neighbours' mean."""
EYE_HEIGHT_ABOVE_EYES_METRES, HAIRLINE_ABOVE_EYES_METRES, NAPE_ABOVE_EYES_METRES = 0.0, 0.055, -0.09
"""Metres above the eyes at which the forehead ends, and to which hair hangs behind, on the average body."""
EYE_WHITE_RGB, IRIS_RGB = (225, 220, 215), (70, 50, 40)
"""RGB of the eyes."""


@dataclass(frozen=True)
class Look:
    """Somebody: who, how they stand, what they wear. `clothes`: how much of `CLOTH_CENTIMETRES` it is (0: bare). `pattern`: how much
    of a film's patterns their cloth has; below 1 it has neither stripes nor print."""

    name: str
    phenotype: Phenotype
    turns: Turns
    shirt: tuple[int, int, int]
    trousers: tuple[int, int, int]
    skin: tuple[int, int, int] = (224, 172, 140)
    hair: tuple[int, int, int] = (70, 48, 36)
    shoes: tuple[int, int, int] = (60, 44, 38)
    clothes: float = 1.0
    pattern: float = 1.0


ARMS_DOWN: Turns = {
    "LeftArm": (0, 0, -66),
    "RightArm": (0, 0, 66),
    "LeftForeArm": (0, -14, 0),
    "RightForeArm": (0, 14, 0),
}
HAND_ON_HIP: Turns = {
    **ARMS_DOWN,
    "LeftArm": (65, 0, -50),
    "LeftForeArm": (0, -95, 0),
    "Hips": (0, 0, 3),
    "Spine1": (0, 0, -4),
    "RightUpLeg": (0, 0, -7),
}
WALKING_POSE: Turns = {
    **ARMS_DOWN,
    "LeftUpLeg": (-24, 0, 0),
    "LeftLeg": (8, 0, 0),
    "RightUpLeg": (9, 0, 0),
    "RightLeg": (18, 0, 0),
    "LeftArm": (0, 18, -68),
    "RightArm": (0, 22, 68),
    "RightForeArm": (0, 30, 0),
}
WAVING_POSE: Turns = {**ARMS_DOWN, "RightArm": (0, 0, -10), "RightForeArm": (0, 10, -75), "Head": (0, 0, -5)}
LIMBS_APART_POSE: Turns = {
    "LeftArm": (0, 0, -35),
    "RightArm": (0, 0, 40),
    "LeftUpLeg": (0, 0, 9),
    "RightUpLeg": (0, 0, -9),
    "LeftFoot": (0, 12, 0),
    "RightFoot": (0, -12, 0),
}

DRESSED_LOOKS = (
    Look("average, arms down", Phenotype(gender=0.5), ARMS_DOWN, (70, 110, 170), (60, 58, 66)),
    Look(
        "heavy man, legs apart",
        Phenotype(0.6, 1, 0.5, 0.85),
        LIMBS_APART_POSE,
        (150, 60, 52),
        (70, 84, 110),
        hair=(50, 44, 40),
    ),
    Look("slim woman, hand on hip", Phenotype(0.5, 0, 0.5, 0.3, 0.6), HAND_ON_HIP, (226, 220, 206), (52, 74, 60)),
    Look(
        "tall man, walking",
        Phenotype(0.5, 1, 0.65, 0.45, 0.75),
        WALKING_POSE,
        (58, 62, 72),
        (168, 150, 118),
        (146, 98, 74),
    ),
    Look("child, waving", Phenotype(0.3, 0.4), WAVING_POSE, (214, 170, 60), (60, 84, 140)),
)


def dress(look: Look) -> Person:
    """Shape, pose, dress and paint the template."""
    template, rig = load_template(), load_rig(HUMAN_RIG)
    shape = load_shape_space()
    standing = template.vertices_of("body")
    skeleton, _, rest = t_pose(rig, shape.shape(look.phenotype), standing)
    quads = template.quads[template.faces("body", "left_eye", "right_eye")]
    triangles = triangulate(quads)
    moved = np.array([_kind(name) for name in rig.names])[rig.bones[:, 0]]
    hairy = _hair(rest, template.vertices_of("left_eye"), moved, float(np.ptp(rest[standing, 1])))
    away = _offsets(look, moved, hairy, rest, quads)
    turns = np.broadcast_to(np.eye(3), (len(rig.names), 3, 3)).copy()
    for joint, angles in look.turns.items():
        turns[rig.index(joint)] = Rotation.from_euler("xyz", angles, degrees=True).as_matrix()
    heads = skeleton.heads.astype(np.float64)
    transforms = bone_transforms(rig.parents, heads, turns)
    bare = skin(rest, rig.bones, rig.weights, transforms)
    posed = bare + 0.01 * away[:, None] * vertex_normals(bare, triangles)
    joints = np.einsum("jab,jb->ja", transforms[:, :3, :3], heads) + transforms[:, :3, 3]
    ground = np.array([0.0, float(posed[standing, 1].min()), 0.0])
    colours = _colours(look, moved, hairy, rest)

    def paint(raster: Raster) -> NDArray[np.float32]:
        return interpolate(colours, triangles, raster)

    height = float(np.ptp(rest[standing, 1]))
    return Person(look.name, posed.astype(np.float64) - ground, triangles, height, paint, joints - ground)


def _kind(joint: str) -> str:
    return joint.removeprefix("Left").removeprefix("Right")


def _hair(
    rest: NDArray[np.floating], eye: NDArray[np.integer], moved: NDArray[np.str_], height: float
) -> NDArray[np.bool_]:
    """(V,) the vertices that hair grows on: above the forehead, and behind down to the nape."""
    scale = height / 1.7
    up = (rest[:, 1] - rest[eye, 1].mean()) / scale
    behind = (rest[eye, 2].mean() - rest[:, 2]) / scale
    return (moved == "Head") & ((up > HAIRLINE_ABOVE_EYES_METRES) | ((behind > 0.075) & (up > NAPE_ABOVE_EYES_METRES)))


def _offsets(
    look: Look,
    moved: NDArray[np.str_],
    hairy: NDArray[np.bool_],
    rest: NDArray[np.floating],
    quads: NDArray[np.integer],
) -> NDArray[np.float64]:
    """(V,) centimetres along the normals."""
    away = np.zeros(len(rest))
    for kind, thick in CLOTH_CENTIMETRES.items():
        wave = np.sin(rest @ [23.0, 31.0, 19.0]) + np.sin(rest @ [-17.0, 11.0, 29.0] + 1.0)
        worn = np.char.startswith(moved, kind)
        away[worn] = look.clothes * (thick + (0.5 * FOLDS_CENTIMETRES * wave[worn] if kind != "Foot" else 0))
    away[hairy] = HAIR_CENTIMETRES * (look.clothes > 0)
    ends = np.concatenate([quads, np.roll(quads, -1, 1)], 1).reshape(-1)
    others = np.concatenate([np.roll(quads, -1, 1), quads], 1).reshape(-1)
    beside = coo_array((np.ones(len(ends)), (ends, others)), shape=(len(rest), len(rest))).tocsr()
    count = np.maximum(beside.sum(1), 1)
    for _ in range(OFFSET_SMOOTHING_ROUNDS):
        away = (away + beside @ away / count) / 2
    return away


def _colours(
    look: Look, moved: NDArray[np.str_], hairy: NDArray[np.bool_], rest: NDArray[np.floating]
) -> NDArray[np.float32]:
    """(V, 3) what is worn, and the colours of skin, hair and eyes."""
    colours = np.full((len(rest), 3), look.skin, np.float32)
    for kinds, colour in (
        (("Spine", "Shoulder", "Arm", "ForeArm"), look.shirt),
        (("Hips", "UpLeg", "Leg"), look.trousers),
        (("Foot", "Toe"), look.shoes),
    ):
        for kind in kinds:
            colours[np.char.startswith(moved, kind)] = colour
    colours[hairy] = look.hair
    template = load_template()
    for side in ("left", "right"):
        eye = template.vertices_of(f"{side}_eye")
        middle = rest[eye].mean(0)
        seen = np.hypot(rest[eye, 0] - middle[0], rest[eye, 1] - middle[1]) < 0.45 * np.ptp(rest[eye, 1]) / 2
        colours[eye] = np.where((seen & (rest[eye, 2] > middle[2]))[:, None], IRIS_RGB, EYE_WHITE_RGB)
    return colours
