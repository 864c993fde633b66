"""A collection as people have it: files, an archive, a broken picture, a stranger."""

from __future__ import annotations

import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from engine.errors import InputError
from engine.media.image import write_image
from engine.media.limits import Limits
from engine.perception.identity.descriptor import IdentityDistances
from engine.perception.identity.dlib_descriptor import IDENTITY_DISTANCES
from engine.persona.collection.photo_face import PhotoFace
from engine.persona.collection.photos import Photos, read_photos
from engine.persona.collection.sorting import Choice
from engine.persona.stages import (
    MIN_PERSONA_PHOTOS,
    PhotoFaces,
    find_faces_of_photos,
    learn,
    sort_faces,
    texture_width,
)

STRANGER = Path(__file__).resolve().parents[2] / "web/public/samples/eileen-collins.jpg"
Collection = tuple[np.ndarray, list[np.ndarray]]


@pytest.fixture(scope="module")
def photos(collection: Collection, tmp_path_factory: pytest.TempPathFactory) -> Photos:
    folder = tmp_path_factory.mktemp("photos")
    paths = []
    for number, picture in enumerate(collection[1]):
        paths.append(folder / f"{number:02}.jpg")
        write_image(paths[-1], picture)
    with zipfile.ZipFile(folder / "half.zip", "w") as archive:
        for path in paths[12:]:
            archive.write(path, f"album/{path.name}")
        archive.writestr("album/notes.txt", "nothing to see")
    (folder / "broken.jpg").write_bytes(paths[0].read_bytes()[:3000])
    (folder / "empty.jpg").write_bytes(b"")
    given = [*paths[:12], STRANGER, folder / "broken.jpg", folder / "empty.jpg", folder / "half.zip"]
    return read_photos(given, Limits())


@pytest.fixture(scope="module")
def found(photos: Photos) -> PhotoFaces:
    return find_faces_of_photos(photos, "dlib", lambda fraction: None)


def test_what_is_no_photograph_is_skipped_and_listed(collection: Collection, photos: Photos) -> None:
    assert len(photos) == len(collection[1]) + 1
    assert {one.name: one.code for one in photos.skipped} == {
        "broken.jpg": "image_truncated",
        "empty.jpg": "file_empty",
        "notes.txt": "not_an_image",
    }
    assert photos.names[12] == "eileen-collins.jpg" and photos.names[13] == "12.jpg"
    assert np.abs(photos.picture(3).astype(int) - collection[1][3]).mean() < 3


def test_the_stranger_is_told_and_the_person_is_kept(photos: Photos, found: PhotoFaces) -> None:
    sorted_ = sort_faces(found, IDENTITY_DISTANCES, Choice(), None)
    reasons = dict(zip((face.photo for face in sorted_.faces), sorted_.reasons, strict=True))
    assert reasons[12] == "somebody_else"
    assert len(sorted_.kept) >= MIN_PERSONA_PHOTOS
    learnt = learn(photos, sorted_, (), 194, lambda fraction: None)
    assert learnt.used.all() and learnt.persona.colours.shape == (len(sorted_.kept), 244, 194, 3)


def test_an_example_chooses_whose_persona_it_is(found: PhotoFaces) -> None:
    stranger = [face.photo for face in found.faces].index(12)
    with pytest.raises(InputError) as error:
        sort_faces(found, IDENTITY_DISTANCES, Choice(), stranger)
    assert error.value.code == "no_common_person", "she is there once"


def test_too_few_say_how_many_more_and_why(found: PhotoFaces) -> None:
    leave_out = set(range(len(found.faces) - 9))
    with pytest.raises(InputError) as error:
        sort_faces(found, IDENTITY_DISTANCES, Choice(leave_out=leave_out), None).require_enough()
    assert error.value.code == "too_few_photos"
    assert "were left out" in error.value.detail and "more" in error.value.detail


def test_a_collection_in_profile_is_told_so(found: PhotoFaces) -> None:
    sides = [65.0 if number % 2 else -50.0 for number in range(len(found.faces))]
    turned = [replace(face, yaw=yaw) for face, yaw in zip(found.faces, sides, strict=True)]
    chosen = sort_faces(PhotoFaces(tuple(turned)), IDENTITY_DISTANCES, Choice(), None)
    assert not chosen.kept and chosen.left_out["turned"] >= MIN_PERSONA_PHOTOS
    with pytest.raises(InputError) as error:
        chosen.require_enough()
    assert error.value.code == "too_few_photos"
    assert "15 more, from before" in error.value.detail
    assert f"{chosen.left_out['turned']} are turned too far aside, up or down" in error.value.detail


def test_what_is_left_out_is_counted_by_its_reason(found: PhotoFaces) -> None:
    chosen = sort_faces(found, IDENTITY_DISTANCES, Choice(leave_out={0, 1}), None)
    assert chosen.left_out["left_out"] == 2 and chosen.left_out["somebody_else"] == 1
    assert sum(chosen.left_out.values()) + len(chosen.kept) == len(chosen.faces)


def test_what_lacks_is_told(found: PhotoFaces) -> None:
    leave_out = set(range(len(found.faces) - 9))
    with pytest.raises(InputError, match=r"show little of: .*pursed lips \(none\)"):
        sort_faces(found, IDENTITY_DISTANCES, Choice(leave_out=leave_out), None).require_enough()


def test_a_look_that_is_not_there_is_refused(found: PhotoFaces) -> None:
    assert sort_faces(found, IDENTITY_DISTANCES, Choice(look=0), None).reasons.count("other_look") == 0
    with pytest.raises(InputError) as error:
        sort_faces(found, IDENTITY_DISTANCES, Choice(look=1), None)
    assert (error.value.code, error.value.correctable) == ("look_unknown", ("look",))


def test_of_two_looks_one_is_used(found: PhotoFaces) -> None:
    random = np.random.default_rng(2)

    def another(face: PhotoFace, copy: int) -> PhotoFace:
        elsewhere = face.descriptor + 0.45 * (copy % 2) * np.eye(len(face.descriptor), dtype=np.float32)[0]
        chip = random.integers(0, 255, face.chip.shape).astype(np.uint8)
        return replace(face, photo=100 * copy + face.photo, descriptor=elsewhere, chip=chip)

    both = PhotoFaces(tuple(another(face, copy) for copy in range(4) for face in found.faces))
    chosen = sort_faces(both, IdentityDistances(0.8, 1.2), Choice(look=0), None)
    assert {0, 1} <= set(chosen.looks) and "other_look" in chosen.reasons
    used = {look for look, reason in zip(chosen.looks, chosen.reasons, strict=True) if reason is None}
    assert used == {0}


def test_faces_that_were_not_used_are_covered(found: PhotoFaces) -> None:
    chosen = sort_faces(found, IDENTITY_DISTANCES, Choice(), None)
    used = np.arange(len(chosen.kept)) != 2
    after = chosen.without_covered(used)
    assert after.kept == [face for face, one in zip(chosen.kept, used, strict=True) if one]
    assert after.reasons.count("covered") == 1


def test_textures_are_as_large_as_photographs_ask_for(found: PhotoFaces) -> None:
    widths = [texture_width([replace(found.faces[0], eye_distance=eyes)] * 5) for eyes in (20.0, 60.0, 300.0)]
    assert widths == [194, pytest.approx(278, abs=2), 400]


def test_photos_without_anybody_are_refused(tmp_path: Path) -> None:
    write_image(tmp_path / "sky.png", np.full((200, 300, 3), (90, 140, 220), np.uint8))
    nobody = find_faces_of_photos(read_photos([tmp_path / "sky.png"], Limits()), "dlib", lambda fraction: None)
    with pytest.raises(InputError) as error:
        sort_faces(nobody, IDENTITY_DISTANCES, Choice(), None)
    assert error.value.code == "no_common_person"
