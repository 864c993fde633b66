"""A persona of an actor's photographs: sharp where one average is blurred, the expression that is asked for, kept in a file."""

from __future__ import annotations

import zipfile
from pathlib import Path

import cv2
import numpy as np
import pytest

from engine.errors import InputError
from engine.perception.expression.features import frontalise
from engine.perception.face.landmarks import mouth_opening
from engine.persona.collection.rest import at_rest
from engine.persona.learning import learn_persona
from engine.persona.persona import Persona, read_persona, write_persona
from engine.persona.texture.expression_weights import expression_weights
from engine.persona.texture.template_shape import template_shape

SIZE = (244, 194)
Collection = tuple[np.ndarray, list[np.ndarray]]


@pytest.fixture(scope="module")
def persona(collection: Collection) -> Persona:
    meshes, photos = collection
    return learn_persona(meshes, lambda number: photos[number], SIZE).persona


def textures(persona: Persona, numbers: list[int]) -> np.ndarray:
    scale = persona.frame.scale
    weights = expression_weights(persona.points[numbers] * scale, persona.points * scale)
    return persona.synthesis(weights)


def detail(picture: np.ndarray, face: np.ndarray) -> float:
    grey = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY).astype(np.float32)
    inner = cv2.erode(face.astype(np.uint8), np.ones((15, 15))) > 0
    return float((grey - cv2.GaussianBlur(grey, (0, 0), 1.5))[inner].std())


def test_it_has_all_photographs_in_one_frame(collection: Collection, persona: Persona) -> None:
    count = len(collection[0])
    assert len(persona) == count and persona.colours.shape == (count, *SIZE, 3)
    assert mouth_opening(persona.mesh) > mouth_opening(persona.neutral)
    face = persona.frame.face
    spread = persona.colours[:, face].astype(float).std(axis=0).mean()
    assert spread < 22, "grey levels: eyes lie on eyes, and lips on lips"
    assert persona.belief[:, face].mean() > 0.75 * 255


def test_what_is_covered_is_left_out_unless_somebody_insists(collection: Collection) -> None:
    meshes, photos = collection
    covered = [photo.copy() for photo in photos]
    low, high = meshes[4, :, :2].min(axis=0), meshes[4, :, :2].max(axis=0)
    noise = np.random.default_rng(1).integers(0, 256, (16, 12, 3), np.uint8)
    hand = cv2.resize(noise, (int(high[0] - low[0]), int(0.75 * (high[1] - low[1]))), interpolation=cv2.INTER_NEAREST)
    top, left = int(low[1] + 0.25 * (high[1] - low[1])), int(low[0])
    covered[4][top : top + hand.shape[0], left : left + hand.shape[1]] = hand
    learnt = learn_persona(meshes, lambda number: covered[number], SIZE)
    assert np.flatnonzero(~learnt.used).tolist() == [4] and len(learnt.persona) == len(photos) - 1
    assert learn_persona(meshes, lambda number: covered[number], SIZE, insisted=[4]).used.all()


def test_textures_are_as_sharp_as_photographs(persona: Persona) -> None:
    face = persona.frame.face
    average = np.rint(persona.colours.mean(axis=0)).astype(np.uint8)
    photos = np.median([detail(photo, face) for photo in persona.colours])
    for texture in textures(persona, [0, 9, 15]):
        assert detail(average, face) < detail(texture, face) < 1.6 * photos


def test_textures_show_the_expression_that_is_asked_for(persona: Persona) -> None:
    numbers = list(range(0, len(persona), 3))
    found = textures(persona, numbers).astype(np.float32)
    face = cv2.erode(persona.frame.face.astype(np.uint8), np.ones((9, 9))) > 0

    def bands(pictures: np.ndarray) -> np.ndarray:
        low = np.array([cv2.GaussianBlur(one, (0, 0), 6) for one in pictures])
        rows = (pictures - low)[:, face].reshape(len(pictures), -1)
        rows -= rows.mean(axis=0)
        return rows / np.linalg.norm(rows, axis=1, keepdims=True)

    alike = bands(found) @ bands(persona.colours[numbers].astype(np.float32)).T
    others = alike[~np.eye(len(numbers), dtype=bool)]
    assert np.diag(alike).mean() > others.mean() + 0.2, "each is most like the photograph whose expression it has"


def test_the_shape_is_a_face(persona: Persona) -> None:
    depth, frame = persona.depth, persona.frame
    nose, cheek, jaw = (frame.places[vertex, :2].round().astype(int) for vertex in (4, 50, 172))
    assert depth[nose[1], nose[0]] < depth[cheek[1], cheek[0]] < depth[jaw[1], jaw[0]], "away from the viewer"
    assert np.isfinite(depth).all()


def test_depth_that_photographs_tell_is_in_the_face_at_rest_too(collection: Collection, persona: Persona) -> None:
    front = frontalise(collection[0])
    in_frame, rest = persona.mesh - template_shape(collection[0]), persona.neutral - at_rest(front)
    np.testing.assert_allclose(in_frame, rest, atol=1e-12)
    assert not in_frame[:, :2].any() and 0.005 < in_frame[:, 2].std() < 0.1


def test_it_is_kept_in_a_file(persona: Persona, tmp_path: Path) -> None:
    write_persona(tmp_path / "persona.npz", persona)
    assert (tmp_path / "persona.npz").stat().st_size < 0.5e6 * len(persona), "bytes: under 100 MB for 200 photographs"
    found = read_persona(tmp_path / "persona.npz")
    for name in ("mesh", "neutral", "colours", "belief", "points", "depth"):
        np.testing.assert_array_equal(getattr(found, name), getattr(persona, name))


def test_other_files_are_refused(persona: Persona, tmp_path: Path) -> None:
    path = tmp_path / "persona.npz"

    def refused() -> str:
        with pytest.raises(InputError) as error:
            read_persona(path)
        return error.value.code

    path.write_bytes(b"PK\x03\x04 nothing")
    assert refused() == "persona_unreadable"
    write_persona(path, persona)
    path.write_bytes(path.read_bytes()[:-5000])
    assert refused() == "persona_unreadable"
    arrays = {name: getattr(persona, name) for name in ("mesh", "neutral", "colours", "belief", "points", "depth")}
    for change in (
        {"belief": persona.belief[:-1]},
        {"depth": persona.depth * np.nan},
        {"mesh": persona.mesh * 100},
        {"colours": persona.colours.astype(np.float32)},
        {"points": np.array([{}], object)},
        {"version": np.int64(99)},
    ):
        np.savez(path, **({"version": np.int64(1)} | arrays | change))  # type: ignore[arg-type]
        assert refused() == "persona_unreadable", list(change)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("mesh.npy", b"")
    assert refused() == "persona_unreadable"
