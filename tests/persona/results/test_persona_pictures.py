"""Pictures of a persona: turned as they say, in the light that all photographs have in the mean."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from engine.media.image import read_image
from engine.persona.persona import Persona
from engine.persona.results.face_units import EXPRESSION_UNITS, FaceUnits
from engine.persona.results.pictures import VIEW_YAWS_DEGREES, Studio, angles, average_light, regenerated
from engine.persona.results.writing import GALLERY_COLUMNS, RESULT_PICTURE_SIZE, write_results

GREEN = (0, 200, 0)


@pytest.fixture(scope="module")
def studio(persona: Persona) -> Studio:
    return Studio(persona, (120, 144), GREEN)


def is_face(picture: np.ndarray) -> np.ndarray:
    return np.abs(picture.astype(int) - GREEN).sum(axis=-1) > 60


def test_the_face_looks_where_its_angle_says(studio: Studio) -> None:
    sheet = angles(studio, [])
    assert sheet.shape == (144, 120 * len(VIEW_YAWS_DEGREES), 3)
    tiles = [sheet[:, 120 * k : 120 * (k + 1)] for k in range(len(VIEW_YAWS_DEGREES))]
    areas = [is_face(tile).sum() for tile in tiles]
    assert areas[2] == max(areas) and areas[0] < 0.95 * areas[2] > areas[4]
    mirrored = tiles[0][:, ::-1]
    assert (is_face(mirrored) == is_face(tiles[4])).mean() > 0.95, "one side is as the other"

    def tip(yaw: float) -> float:
        """Where the nose's tip, marked by a texture, is from left to right."""
        texture = np.zeros((*studio.persona.frame.size, 3), np.uint8)
        x, y = np.rint(studio.persona.frame.places[4, :2]).astype(int)
        texture[y - 1 : y + 2, x - 1 : x + 2] = 255
        shown = studio.picture(studio.persona.neutral, texture, yaw)[..., 0].astype(float)
        return float((shown.sum(axis=0) * np.arange(shown.shape[1])).sum() / shown.sum())

    assert tip(-30) < tip(0) - 5 < tip(30) - 10


def test_a_photograph_is_regenerated_in_the_light_of_all(persona: Persona) -> None:
    face = persona.frame.face
    average = persona.synthesis(persona.weights(persona.neutral[None]))[0]
    made = regenerated(persona, 3)
    blurred = [picture[face].mean(axis=0) for picture in (made, average)]
    assert np.abs(blurred[0] - blurred[1]).max() < 8, "grey levels"


def test_photographs_stand_beside_what_is_made_of_them(studio: Studio, units: FaceUnits) -> None:
    sheet = average_light(studio, units)
    first = sheet[:144, :120], sheet[:144, 120:240]
    both = is_face(first[0]) & is_face(first[1])
    assert both.mean() > 0.3 and (is_face(first[0]) == is_face(first[1])).all()


def test_what_is_written_is_told(persona: Persona, tmp_path: Path) -> None:
    average = persona.synthesis(persona.weights(persona.neutral[None]))[0]
    near = write_results(tmp_path, persona, average, GREEN, True)
    told = json.loads((tmp_path / "gallery.json").read_text())
    names = [one["name"] for one in told["shown"]]
    assert names[0] == "neutral" and {*names[1:], *(one["name"] for one in told["left_out"])} == set(EXPRESSION_UNITS)
    assert all(near[name] >= told["photos_needed"] for name in names[1:])
    assert all((one["photos"] < told["photos_needed"]) == (one["why"] == "few") for one in told["left_out"])
    rows = -(-len(names) // GALLERY_COLUMNS)
    assert read_image(tmp_path / "gallery.jpg").rgb.shape[0] == rows * RESULT_PICTURE_SIZE[1]
    assert {f"gallery_{name}.jpg" for name in names[1:]} == {path.name for path in tmp_path.glob("gallery_*.jpg")}
    assert {"puppet.glb", "puppet_textures.jpg", "puppet_textures.json", "angles.jpg", "average_light.jpg"} <= {
        path.name for path in tmp_path.iterdir()
    }
