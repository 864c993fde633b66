"""Three people made of the template, the third in plain dark cloth: every vertex of theirs is known by its number, every joint by its name.

Their skin and clothes have detail at all scales that a film can show: cloth with noise, seams and print, skin with spots, lips,
brows and lids.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from benchmarks.known_truth.dressed_template import EYE_WHITE_RGB, IRIS_RGB, Look, Turns, dress
from benchmarks.known_truth.known_person import Person
from benchmarks.scan_studio.camera.noise import space_noise
from benchmarks.scan_studio.people.subject import Arm, Subject, room_light
from engine.body.body_space import load_body_space
from engine.body.face.face_points import face_points
from engine.body.makehuman import read_mask
from engine.body.rig import HUMAN_RIG
from engine.body.shape import Phenotype
from engine.body.template import Template, load_rig, load_template
from engine.geometry.mesh.surface import triangulate, vertex_normals
from engine.geometry.texture_charts.texture_atlas import atlas_from_uv
from engine.imaging.filling.nearest import nearest_colours
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import Raster
from engine.render.textures.texture_bake import texel_raster

TEXTURE_SIZE_TEXELS = 2048
DRAWN_PARTS = ("body", "left_eye", "right_eye")
"""Of the template, that are drawn."""
A_POSE: Turns = {
    "LeftArm": (0, 0, -50),
    "RightArm": (0, 0, 50),
    "LeftForeArm": (0, -8, 0),
    "RightForeArm": (0, 8, 0),
    "LeftUpLeg": (0, 0, 8),
    "RightUpLeg": (0, 0, -8),
    "LeftFoot": (0, 8, -8),
    "RightFoot": (0, -8, 8),
}
TEMPLATE_LOOKS = {
    "template-a": Look(
        "template-a", Phenotype(0.5, 1, 0.6, 0.5, 0.55), A_POSE, (92, 118, 168), (94, 88, 84), clothes=0.0
    ),
    "template-b": Look(
        "template-b",
        Phenotype(0.45, 0.1, 0.5, 0.55, 0.5),
        A_POSE,
        (176, 84, 70),
        (70, 92, 84),
        skin=(198, 146, 116),
        hair=(96, 64, 42),
        shoes=(88, 76, 70),
        clothes=0.5,
    ),
    "template-dark": Look(
        "template-dark",
        Phenotype(0.5, 1, 0.6, 0.5, 0.55),
        A_POSE,
        (34, 34, 38),
        (26, 26, 30),
        shoes=(24, 22, 22),
        hair=(30, 24, 22),
        clothes=0.5,
        pattern=0.3,
    ),
}
CLOTH_CELL_METRES = (0.004, 0.009, 0.022, 0.06)
"""Metres of the cells of cloth's noise."""
CLOTH_SPREAD_SHARE = 0.22
"""Share of its colour by which cloth is lighter or darker."""
SKIN_CELL_METRES = (0.0025, 0.006, 0.015)
"""Metres of the cells of skin's spots."""
SKIN_SPREAD_SHARE = 0.06
"""Share of its colour by which skin is lighter or darker."""
PRINT_WORDS = ("GALATEA", "No 25", "* & ?")
"""What is printed on chest and back."""
PRINT_METRES = (0.26, 0.2)
"""Width and height of what is printed on chest and back."""
BROW_FACE_POINTS = (range(17, 22), range(22, 27))
"""Of the 68 face points."""
LID_FACE_POINTS = (range(36, 42), range(42, 48))
"""Of the 68 face points."""
BROW_METRES = 0.004
"""Half the height of a brow."""
LID_METRES = 0.001
"""Half the width of a lid's dark rim."""
EYE_METRES = 0.025
"""From an eye's middle, beyond which nothing belongs to it."""
IRIS_METRES = 0.0058
"""Radius."""
PUPIL_METRES = 0.0022
"""Radius."""
LIP_RGB = (176, 92, 88)
NAIL_RGB = (232, 196, 184)
MOUTH_RGB = (90, 34, 36)
BROW_RGB = (58, 42, 34)
LID_RGB = (60, 40, 36)
PUPIL_RGB = (18, 14, 14)


@dataclass(frozen=True)
class _Texels:
    """What lies on the N texels of the texture that show anything."""

    points: NDArray[np.float32]
    """(N, 3) metres, on the body."""
    normals: NDArray[np.float32]
    """(N, 3)."""
    colours: NDArray[np.float32]
    """(N, 3) of what is worn there."""

    def worn(self, colour: tuple[int, int, int]) -> NDArray[np.bool_]:
        """(N,) where something of this colour is."""
        return np.asarray((self.colours == np.array(colour, np.float32)).all(1))


def template_subject(name: str, texels: int = TEXTURE_SIZE_TEXELS) -> Subject:
    """One of `TEMPLATE_LOOKS`, with a texture of so many texels along its side."""
    look, template = TEMPLATE_LOOKS[name], load_template()
    person = dress(look)
    uv_triangles = triangulate(template.uv_quads[template.faces(*DRAWN_PARTS)])
    normals = vertex_normals(person.vertices, person.triangles)
    rig = load_rig(HUMAN_RIG)
    joints = {} if person.joints is None else dict(zip(rig.names, person.joints, strict=True))
    arms = tuple(
        Arm(
            rig.weights_below(f"{side}Arm"),
            joints[f"{side}Arm"],
            float(np.linalg.norm(joints[f"{side}Hand"] - joints[f"{side}Arm"])),
        )
        for side in ("Left", "Right")
    )
    raster = texel_raster(atlas_from_uv(np.clip(template.uv, 0, 1), uv_triangles), texels)
    texture = _painted(look, person, normals, template, raster)
    return Subject(
        name,
        person.vertices,
        person.triangles,
        np.clip(template.uv, 0, 1).astype(np.float32),
        uv_triangles,
        texture,
        room_light(normals),
        joints,
        arms,
        template=True,
    )


def _painted(
    look: Look, person: Person, normals: NDArray[np.float32], template: Template, raster: Raster
) -> NDArray[np.uint8]:
    """The texture (S, S, 3), of whose texels a `raster` (S, S) tells what they show."""
    on = raster.triangle >= 0
    worn, kinds = np.unique(_vertex_colours(person), axis=0, return_inverse=True)
    shares = interpolate(np.eye(len(worn))[kinds.ravel()], person.triangles, raster)[on]
    texels = _Texels(
        interpolate(person.vertices, person.triangles, raster)[on],
        interpolate(normals, person.triangles, raster)[on],
        worn[shares.argmax(1)],
    )
    random = np.random.default_rng(sum(map(ord, look.name)))
    colours = texels.colours.copy()
    _weave(colours, texels, look, random)
    _print(colours, texels, look, person)
    _make_up(colours, texels, look, random, on)
    _draw_eyes(colours, texels, person, template, random)
    _draw_face(colours, texels, look, person, template)
    texture = np.zeros((*on.shape, 3), np.uint8)
    texture[on] = np.clip(colours + 0.5, 0, 255).astype(np.uint8)
    return nearest_colours(texture, on)


def _vertex_colours(person: Person) -> NDArray[np.float32]:
    """(V, 3) what the person is painted with at each vertex; zero at those of no triangle."""
    count = len(person.vertices)
    first = np.full(count, -1, np.int32)
    corner = np.zeros(count, np.int64)
    for k in range(3):
        first[person.triangles[:, k]], corner[person.triangles[:, k]] = np.arange(len(person.triangles)), k
    weights = np.eye(3, dtype=np.float32)[corner][None]
    return person.paint(Raster(first[None], weights, np.zeros((1, count), np.float32)))[0]


def _weave(colours: NDArray[np.float32], texels: _Texels, look: Look, random: np.random.Generator) -> None:
    """Cloth, leather and hair: noise of all sizes; stripes on the shirt."""
    for colour, spread in ((look.shirt, 1.0), (look.trousers, 1.1), (look.shoes, 0.9), (look.hair, 1.3)):
        here = texels.worn(colour)
        noise = space_noise(texels.points[here], CLOTH_CELL_METRES, random)
        colours[here] *= np.clip(1 + spread * look.pattern * CLOTH_SPREAD_SHARE * noise, 0.2, 1.8)[:, None]
    if look.pattern < 1:
        return
    shirt = np.flatnonzero(texels.worn(look.shirt))
    height = texels.points[shirt, 1]
    colours[shirt[np.mod(height, 0.06) < 0.012]] *= np.float32(0.62)
    colours[shirt[np.mod(height + 0.02, 0.12) < 0.008]] = (224, 214, 190)


def _print(colours: NDArray[np.float32], texels: _Texels, look: Look, person: Person) -> None:
    """Words on chest and back, pressed on from before and behind."""
    rig = load_rig(HUMAN_RIG)
    if person.joints is None or look.pattern < 1:
        return
    middle = person.joints[rig.index("Spine2")]
    rows, columns = (round(metres * 1500) for metres in PRINT_METRES[::-1])
    words = np.zeros((rows, columns), np.uint8)
    for k, word in enumerate(PRINT_WORDS):
        place = (12, round((k + 0.8) * rows / len(PRINT_WORDS)))
        cv2.putText(words, word, place, cv2.FONT_HERSHEY_DUPLEX, 2.6, 255, 9, cv2.LINE_AA)
    for side in (1.0, -1.0):
        here = np.flatnonzero(texels.worn(look.shirt) & (side * texels.normals[:, 2] > 0.35))
        away = (texels.points[here] - middle).astype(np.float32)
        x = (side * away[:, 0] / PRINT_METRES[0] + 0.5) * columns - 0.5
        y = (0.5 - away[:, 1] / PRINT_METRES[1]) * rows - 0.5
        inked = np.zeros(len(here), np.float32)
        inside = np.flatnonzero((x > 0) & (x < columns - 1) & (y > 0) & (y < rows - 1))
        inked[inside] = words[y[inside].round().astype(int), x[inside].round().astype(int)] / np.float32(255)
        colours[here] += inked[:, None] * (np.array((240, 236, 224), np.float32) - colours[here])


def _make_up(
    colours: NDArray[np.float32],
    texels: _Texels,
    look: Look,
    random: np.random.Generator,
    on: NDArray[np.bool_],
) -> None:
    """Skin: spots and blotches; lips, nails and the inside of the mouth by MakeHuman's masks of the texture."""
    here = texels.worn(look.skin)
    tone = SKIN_SPREAD_SHARE * space_noise(texels.points[here], SKIN_CELL_METRES, random)
    blotches = 0.04 * space_noise(texels.points[here], (0.03, 0.07), random)
    colours[here] *= 1 + np.stack([tone + 0.5 * blotches, tone - blotches, tone - blotches], 1)
    for mask, colour in (("lips", LIP_RGB), ("fingernails", NAIL_RGB), ("inside-mouth", MOUTH_RGB)):
        size = (on.shape[1], on.shape[0])
        share = cv2.resize(read_mask(mask), size, interpolation=cv2.INTER_AREA)[on] * here
        colours += share[:, None] * (np.array(colour, np.float32) - colours) * np.float32(0.85)


def _draw_eyes(
    colours: NDArray[np.float32], texels: _Texels, person: Person, template: Template, random: np.random.Generator
) -> None:
    """White, iris and pupil, round about the way in which the eyes look: straight ahead."""
    eyes = np.flatnonzero(texels.worn(EYE_WHITE_RGB) | texels.worn(IRIS_RGB))
    for side in ("left", "right"):
        middle = person.vertices[template.vertices_of(f"{side}_eye")].mean(0)
        away = texels.points[eyes] - middle
        own = np.linalg.norm(away, axis=1) < EYE_METRES
        here, out = eyes[own], np.where(away[own, 2] > 0, np.hypot(away[own, 0], away[own, 1]), np.inf)
        grain = 1 + 0.05 * space_noise(texels.points[here], (0.001, 0.003), random)
        rings = [out < PUPIL_METRES, out < IRIS_METRES]
        shown = np.select([ring[:, None] for ring in rings], [np.array(PUPIL_RGB), np.array(IRIS_RGB)], EYE_WHITE_RGB)
        colours[here] = shown * grain[:, None]


def _draw_face(colours: NDArray[np.float32], texels: _Texels, look: Look, person: Person, template: Template) -> None:
    """Brows, and the dark rims of the lids."""
    points = person.vertices[face_points(template, load_body_space())]
    skin = np.flatnonzero(texels.worn(look.skin))
    near = skin[np.linalg.norm(texels.points[skin] - points[27], axis=1) < 0.1]
    for lines, metres, colour, closed in (
        (BROW_FACE_POINTS, BROW_METRES, BROW_RGB, False),
        (LID_FACE_POINTS, LID_METRES, LID_RGB, True),
    ):
        for line in lines:
            stroke = points[list(line)]
            stroke = np.concatenate([stroke, stroke[:1]]) if closed else stroke
            share = np.linspace(0, 1, 40, endpoint=False)[:, None]
            dense = np.concatenate([a + share * (b - a) for a, b in pairwise(stroke)])
            away, _ = cKDTree(dense).query(texels.points[near], distance_upper_bound=2 * metres)
            ink = np.clip(1.5 - away / metres, 0, 0.9)[:, None].astype(np.float32)
            colours[near] += ink * (np.array(colour, np.float32) - colours[near])
