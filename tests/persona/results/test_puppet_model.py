"""The puppet's GLB, judged by Khronos' validator and read back; and the textures that go with it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from glb_reader import Glb, validate

from engine.body import FACE_UNITS
from engine.media.image import read_image
from engine.persona.persona import Persona
from engine.persona.puppet import Puppet
from engine.persona.results.behind_skin import BehindSkin
from engine.persona.results.expression_textures import (
    TEXTURED_EXPRESSIONS,
    expression_textures,
    write_expression_textures,
)
from engine.persona.results.face_units import EXPRESSION_UNITS, FaceUnits
from engine.persona.results.inner_parts import inner_parts
from engine.persona.results.inside_atlas import inside_atlas
from engine.persona.results.puppet_model import EYE_DISTANCE, write_puppet
from engine.render.rasterisation.attributes import sample_texture


@pytest.fixture(scope="module")
def path(persona: Persona, units: FaceUnits, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("puppet") / "puppet.glb"
    write_puppet(path, persona, units, persona.synthesis(persona.weights(persona.neutral[None]))[0], True)
    return path


def test_the_validator_finds_nothing_but_a_texture_of_the_personas_own_size(path: Path) -> None:
    assert {message["code"] for message in validate(path)["messages"]} <= {"IMAGE_NPOT_DIMENSIONS"}
    assert path.stat().st_size < 6_000_000


def test_its_units_are_morph_targets_of_a_face_in_metres(path: Path, persona: Persona, units: FaceUnits) -> None:
    glb = Glb(path)
    mesh = glb.json["meshes"][0]
    names = mesh["extras"]["targetNames"]
    assert names == list(FACE_UNITS) and len(names) == 52, "all that ARKit names"
    primitive = mesh["primitives"][0]
    places, normals = (glb.array(primitive["attributes"][name]) for name in ("POSITION", "NORMAL"))
    eyes = (places[33] + places[133]) / 2, (places[263] + places[362]) / 2
    assert np.linalg.norm(eyes[0] - eyes[1]) == pytest.approx(EYE_DISTANCE, rel=0.03)
    assert eyes[0][0] < eyes[1][0], "its right eye is at -x"
    nose, forehead, chin = places[4], places[10], places[152]
    assert nose[2] > chin[2] and forehead[1] > chin[1], "y up, facing +z"
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-4)
    assert normals[:, 2].mean() > 0.5, "seen from before"
    jaw = glb.array(primitive["targets"][names.index("jawOpen")]["POSITION"])
    wanted = Puppet(persona, openings=True).finer(units.doing({"jawOpen": 1})) * EYE_DISTANCE * (1, -1, -1)
    np.testing.assert_allclose(jaw[: len(wanted)], wanted, atol=2e-4)


def test_behind_its_skin_are_eyes_and_a_mouth(path: Path, persona: Persona, units: FaceUnits) -> None:
    glb = Glb(path)
    primitives = glb.json["meshes"][0]["primitives"]
    assert [glb.json["materials"][one["material"]]["name"] for one in primitives] == ["skin", "inside"]
    assert glb.json["materials"][1]["alphaMode"] == "MASK", "teeth end where their photograph's do"
    places = glb.array(primitives[0]["attributes"]["POSITION"])
    targets = glb.json["meshes"][0]["extras"]["targetNames"]
    puppet = Puppet(persona, openings=True)
    parts = inner_parts(puppet, units)
    starts = np.cumsum([len(puppet.surface.uv), *(len(part.vertices) for part in parts)])
    spans = {
        part.name: np.arange(start, start + len(part.vertices)) for part, start in zip(parts, starts, strict=False)
    }
    assert set(spans) > {"left_eye", "right_eye", "upper_teeth", "lower_teeth", "tongue", "mouth"}
    assert len(places) == starts[-1]

    def moved(part: str, unit: str) -> np.ndarray:
        return glb.array(primitives[0]["targets"][targets.index(unit)]["POSITION"])[spans[part]]

    assert moved("lower_teeth", "jawOpen")[:, 1].max() < -0.004, "the lower row goes down with the jaw"
    assert not moved("upper_teeth", "jawOpen").any(), "and the upper one stays"
    assert moved("tongue", "tongueOut")[:, 2].max() > 0.02 and not moved("lower_teeth", "tongueOut").any()
    for side, away in (("left", 1), ("right", -1)):
        front = spans[f"{side}_eye"]
        iris = front[places[front, 2].argmax()]
        for way, axis, sign in (("In", 0, -away), ("Out", 0, away), ("Up", 1, 1), ("Down", 1, -1)):
            unit = f"eyeLook{way}{side.capitalize()}"
            there = glb.array(primitives[0]["targets"][targets.index(unit)]["POSITION"])[iris]
            assert sign * there[axis] > 0.002, f"{unit} turns the eye"
        assert not moved(f"{side}_eye", f"eyeBlink{side.capitalize()}").any()


def test_the_skin_covers_what_is_behind_it_whatever_it_does(persona: Persona, units: FaceUnits) -> None:
    puppet = Puppet(persona, openings=True)
    skin = BehindSkin(puppet, units)
    for part in inner_parts(puppet, units):
        if part.name.endswith("teeth") or part.name == "tongue":
            moves = {unit: moved for unit, moved in part.moved.items() if unit != "tongueOut"}
            assert skin.needed(part.vertices, moves).max() < 0.005, part.name
    far = np.array([[0.0, 1.0, -5.0]])
    assert skin.needed(far, {})[0] > 3, "what is before the face has to go far back"


def test_what_both_sides_move_together_is_covered_too(persona: Persona, units: FaceUnits) -> None:
    """A place that each side alone leaves behind the skin, and both bring before it."""
    skin = BehindSkin(Puppet(persona, openings=True), units)
    clear = skin.needed(np.array([[0.0, 0.0, -5.0]]), {})[0] - 5
    place = np.array([[0.0, 0.0, clear + 1]])
    ahead = {f"mouthSmile{side}": np.array([[0.0, 0.0, -0.8]]) for side in ("Left", "Right")}
    one = {"mouthSmileLeft": ahead["mouthSmileLeft"]}
    assert skin.needed(place, one)[0] < 0.05
    assert skin.needed(place, ahead)[0] > 0.5


def test_textures_of_expressions_lie_side_by_side(persona: Persona, units: FaceUnits, tmp_path: Path) -> None:
    textures = expression_textures(persona, units)
    picture, document = write_expression_textures(tmp_path, textures, True)
    told = json.loads(document.read_text())
    assert [one["name"] for one in told["textures"]] == ["neutral", *TEXTURED_EXPRESSIONS]
    assert told["textures"][1]["units"] == EXPRESSION_UNITS[TEXTURED_EXPRESSIONS[0]]
    width, height = told["size"]
    sheet = read_image(picture).rgb
    assert sheet.shape == (height, width * len(told["textures"]), 3) and picture.stat().st_size < 3_000_000
    for number, texture in enumerate(textures):
        kept = sheet[:, number * width : (number + 1) * width]
        assert np.abs(kept.astype(int) - texture)[persona.frame.face].mean() < 4
    apart = np.abs(textures[1].astype(int) - textures[0])[persona.frame.face]
    assert apart.mean() > 0.5, "a smile has another texture"


def test_textures_lie_below_one_another_in_one_picture(persona: Persona, units: FaceUnits) -> None:
    parts = inner_parts(Puppet(persona, openings=True), units)
    atlas, places = inside_atlas(parts)
    assert atlas.shape[2] == 4 and atlas.shape[0] < 1200
    for part, at in zip(parts, places, strict=True):
        assert at.shape == part.uv.shape and at.min() > 0 and at.max() < 1
        own, there = (
            sample_texture(texture, uv[None], np.ones((1, len(uv)), np.bool_))[0, :, :3]
            for texture, uv in ((part.texture, part.uv), (atlas, at))
        )
        assert np.abs(own - there).mean() < 6, part.name
