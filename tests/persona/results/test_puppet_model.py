"""The puppet's GLB, judged by Khronos' validator and read back; and the textures that go with it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from glb_reader import Glb, validate

from engine.media.image import read_image
from engine.persona.persona import Persona
from engine.persona.puppet import Puppet
from engine.persona.results.expression_textures import NAMES, expression_textures, write_expression_textures
from engine.persona.results.face_units import EXPRESSIONS, FaceUnits
from engine.persona.results.puppet_model import EYE_DISTANCE, write_puppet


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
    assert mesh["extras"]["targetNames"] == list(units.names)
    primitive = mesh["primitives"][0]
    places, normals = (glb.array(primitive["attributes"][name]) for name in ("POSITION", "NORMAL"))
    eyes = (places[33] + places[133]) / 2, (places[263] + places[362]) / 2
    assert np.linalg.norm(eyes[0] - eyes[1]) == pytest.approx(EYE_DISTANCE, rel=0.03)
    assert eyes[0][0] < eyes[1][0], "its right eye is at -x"
    nose, forehead, chin = places[4], places[10], places[152]
    assert nose[2] > chin[2] and forehead[1] > chin[1], "y up, facing +z"
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-4)
    assert normals[:, 2].mean() > 0.5, "seen from before"
    jaw = glb.array(primitive["targets"][units.names.index("jawOpen")]["POSITION"])
    wanted = Puppet(persona).finer(units.doing({"jawOpen": 1})) * EYE_DISTANCE * (1, -1, -1)
    np.testing.assert_allclose(jaw, wanted, atol=2e-4)


def test_textures_of_expressions_lie_side_by_side(persona: Persona, units: FaceUnits, tmp_path: Path) -> None:
    textures = expression_textures(persona, units)
    picture, document = write_expression_textures(tmp_path, textures, True)
    told = json.loads(document.read_text())
    assert [one["name"] for one in told["textures"]] == ["neutral", *NAMES]
    assert told["textures"][1]["units"] == EXPRESSIONS[NAMES[0]]
    width, height = told["size"]
    sheet = read_image(picture).rgb
    assert sheet.shape == (height, width * len(told["textures"]), 3) and picture.stat().st_size < 3_000_000
    for number, texture in enumerate(textures):
        kept = sheet[:, number * width : (number + 1) * width]
        assert np.abs(kept.astype(int) - texture)[persona.frame.face].mean() < 4
    apart = np.abs(textures[1].astype(int) - textures[0])[persona.frame.face]
    assert apart.mean() > 0.5, "a smile has another texture"
