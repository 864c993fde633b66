"""Which photographs of a collection act, and lend their teeth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from engine.perception.face.landmarks import eye_distance, mouth_opening
from engine.persona.collection.photo_face import PhotoFace
from engine.persona.composite.portrait_selection import head_share, portrait_photo
from engine.persona.mouth.teeth_selection import teeth_photo

Collection = tuple[np.ndarray, list[np.ndarray]]
NO_DESCRIPTOR, NO_CHIP = np.zeros(128, np.float32), np.zeros((8, 8), np.uint8)


def as_faces(meshes: Sequence[np.ndarray], **changed: float) -> list[PhotoFace]:
    told = {"yaw": 0.0, "pitch": 0.0, "blur": 0.3, **changed}
    return [
        PhotoFace(
            number,
            np.asarray(mesh, np.float32),
            float(eye_distance(mesh[:, :2])),
            size_share=1.0,
            descriptor=NO_DESCRIPTOR,
            chip=NO_CHIP,
            **told,
        )
        for number, mesh in enumerate(meshes)
    ]


def test_a_calm_face_acts_and_one_with_teeth_lends_them(collection: Collection) -> None:
    meshes, photos = collection
    faces = as_faces(meshes)
    portrait = portrait_photo(faces, np.ones(len(faces)), lambda number: photos[number])
    teeth = teeth_photo(faces, lambda number: photos[number])
    assert portrait is not None and teeth is not None
    assert float(mouth_opening(portrait.mesh)) < 0.04 < 0.1 <= float(mouth_opening(teeth.mesh))
    np.testing.assert_array_equal(portrait.rgb, photos[portrait.number])


def test_the_larger_and_the_barer_of_two_acts(collection: Collection) -> None:
    mesh, photo = collection[0][0], collection[1][0]
    half = mesh / 2
    small = photo[::2, ::2]
    chosen = portrait_photo(as_faces([half, mesh]), np.ones(2), lambda number: (small, photo)[number])
    assert chosen is not None and chosen.number == 1
    hidden = portrait_photo(as_faces([half, mesh]), np.array([0.9, 0.5]), lambda number: (small, photo)[number])
    assert hidden is not None and hidden.number == 0


def test_one_who_is_alone_acts_rather_than_one_of_two(collection: Collection) -> None:
    mesh, photo = collection[0][0], collection[1][0]
    both, alone = as_faces([mesh, mesh])
    chosen = portrait_photo([replace(both, beside=1), alone], np.array([1.0, 0.95]), lambda number: photo)
    assert chosen is not None and chosen.number == 1


@pytest.mark.parametrize(("coloured", "chosen"), [(1, 0), (2, 1)])
def test_black_and_white_acts_only_where_most_are_so(collection: Collection, coloured: int, chosen: int) -> None:
    """Of three photographs, the first the barest, and in black and white."""
    mesh, photo = collection[0][0], collection[1][0]
    grey = np.repeat(photo.mean(axis=2, keepdims=True), 3, 2).astype(np.uint8)
    photos = [grey, *[photo] * coloured, *[grey] * (2 - coloured)]
    found = portrait_photo(as_faces([mesh] * 3), np.array([1.0, 0.95, 0.9]), lambda number: photos[number])
    assert found is not None and found.number == chosen


def test_photographs_that_cut_the_head_do_not_act(collection: Collection) -> None:
    mesh, photo = collection[0][0].copy(), collection[1][0]
    x, y = np.rint(mesh[1, :2]).astype(int)
    width = int(np.ptp(mesh[:, 0]) / 3)
    mesh[:, :2] -= (x - width, y - width)
    cut = photo[y - width : y + width, x - width : x + width]
    assert portrait_photo(as_faces([mesh]), np.ones(1), lambda number: cut) is None


def test_shares_of_heads(collection: Collection) -> None:
    found = portrait_photo(as_faces(collection[0][:1]), np.ones(1), lambda number: collection[1][0])
    assert found is not None
    whole = head_share(found)
    middle = int(found.mesh[:, 0].mean())
    halved = found.cut(np.array([middle, 0]), np.array(found.rgb.shape[1::-1]))
    assert whole > 0.95 and head_share(halved) == pytest.approx(whole / 2, abs=0.06)


def test_where_no_mouth_is_open_nobody_lends_teeth(collection: Collection) -> None:
    shut = [k for k, mesh in enumerate(collection[0]) if float(mouth_opening(mesh)) < 0.05]
    faces = as_faces(collection[0][shut])
    assert teeth_photo(faces, lambda number: collection[1][shut[number]]) is None


def test_teeth_of_faces_that_are_small_are_left_to_the_driver(collection: Collection) -> None:
    meshes, photos = collection
    small = [photo[::4, ::4] for photo in photos]
    assert float(np.median([eye_distance(mesh[:, :2]) for mesh in meshes])) / 4 < 40, "pixels"
    assert teeth_photo(as_faces([mesh / 4 for mesh in meshes]), lambda number: small[number]) is None
