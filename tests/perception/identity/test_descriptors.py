"""Descriptors tell people apart, whatever light, size and side of the mirror; a broken set-up says so."""

from __future__ import annotations

import hashlib
from itertools import combinations
from pathlib import Path

import cv2
import numpy as np
import pytest
from missing import missing
from tiny_onnx import brightness_model

from engine.media.image import read_image
from engine.package_data import IncompleteInstallation, package_folder
from engine.perception.face.faces import FaceTracker, find_faces
from engine.perception.identity import dlib_descriptor
from engine.perception.identity.backend import face_descriptor
from engine.perception.models import DESCRIPTOR_SETTING, ModelError

ROOT = Path(__file__).resolve().parents[3]
SAMPLES = ROOT / "web/public/samples"
COLLECTIONS = ROOT.parent / "shared/data/collections"


@pytest.fixture(scope="module")
def pictures() -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Faces of two people, with their meshes; each also mirrored, and small and dark."""
    found = {}
    with FaceTracker(alone=True) as tracker:
        for name in ("eileen-collins", "grace-hopper"):
            rgb = read_image(SAMPLES / f"{name}.jpg").rgb
            for way, seen in {
                "": rgb,
                "mirrored": np.ascontiguousarray(rgb[:, ::-1]),
                "small and dark": (cv2.resize(rgb, None, fx=0.4, fy=0.4, interpolation=cv2.INTER_AREA) * 0.6).astype(
                    np.uint8
                ),
            }.items():
                found[name + way] = seen, tracker(seen)[0]
    return found


def test_one_person_is_near_and_another_far(pictures: dict[str, tuple[np.ndarray, np.ndarray]]) -> None:
    describe = face_descriptor({})
    described = {name: describe(*picture) for name, picture in pictures.items()}
    for one, other in combinations(described, 2):
        apart = float(np.linalg.norm(described[one] - described[other]))
        if one[:5] == other[:5]:
            assert apart < describe.distances.same, (one, other)
        else:
            assert apart > describe.distances.same, (one, other)


def test_collections_of_photographs_part() -> None:
    if not COLLECTIONS.is_dir():
        missing("shared/data/collections is not there")
    describe = face_descriptor({})
    people = []
    for name in ("george_w_bush", "tom_hanks"):
        paths = sorted(path for path in (COLLECTIONS / name).rglob("*") if path.suffix in (".jpg", ".jpeg", ".png"))
        described = []
        for path in paths[:: len(paths) // 7]:
            rgb = read_image(path).rgb
            for mesh in find_faces(rgb, most=1):
                described.append(describe(rgb, mesh))
        people.append(np.array(described))
    bush, hanks = people
    pairs = ((bush, bush), (hanks, hanks), (bush, hanks))
    apart = [np.linalg.norm(one[:, None] - other[None], axis=2) for one, other in pairs]
    for within in apart[:2]:
        assert np.median(within[np.triu_indices(len(within), 1)]) < 0.57
    assert apart[2].min() > describe.distances.same


def test_another_file_in_the_models_place_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert (package_folder("engine.perception.identity") / dlib_descriptor.MODEL_FILE).is_file(), "set-up put it there"
    monkeypatch.setattr(dlib_descriptor, "MODEL_FILE", "__init__.py")
    dlib_descriptor.loaded_network.cache_clear()
    with pytest.raises(IncompleteInstallation, match="not the file that it should be"):
        face_descriptor({})
    monkeypatch.setattr(dlib_descriptor, "MODEL_FILE", "absent.dat")
    with pytest.raises(IncompleteInstallation, match="is missing"):
        face_descriptor({})


def operators(path: Path, **more: str) -> dict[str, str]:
    told = {
        "SHA256": hashlib.sha256(path.read_bytes()).hexdigest(),
        "LICENCE": "MIT",
        "SAME": "0.2",
        "OTHER": "0.4",
    } | more
    return {
        DESCRIPTOR_SETTING: str(path),
        **{f"{DESCRIPTOR_SETTING}_{name}": value for name, value in told.items() if value},
    }


def test_an_operators_network_takes_its_place(
    tmp_path: Path, pictures: dict[str, tuple[np.ndarray, np.ndarray]]
) -> None:
    path = brightness_model(tmp_path / "grey.onnx", side=112)
    describe = face_descriptor(operators(path))
    one, same, other = (
        describe(*pictures[name]) for name in ("eileen-collins", "eileen-collinssmall and dark", "grace-hopper")
    )
    assert one.shape == (112 * 112,) and np.linalg.norm(one) == pytest.approx(1)
    assert np.linalg.norm(one - same) < np.linalg.norm(one - other), "greys of chips are most alike for one picture"
    assert (describe.distances.same, describe.distances.other) == (0.2, 0.4)


@pytest.mark.parametrize(
    ("lacking", "words"), [("SHA256", "needs"), ("LICENCE", "needs"), ("SAME", "_SAME and _OTHER")]
)
def test_what_an_operators_network_needs_is_said(tmp_path: Path, lacking: str, words: str) -> None:
    path = brightness_model(tmp_path / "grey.onnx", side=112)
    with pytest.raises(ModelError, match=words):
        face_descriptor(operators(path, **{lacking: ""}))


def test_a_network_of_other_pictures_is_refused(tmp_path: Path) -> None:
    path = brightness_model(tmp_path / "four.onnx", side=112, channels=4)
    with pytest.raises(ModelError, match="one picture of shape"):
        face_descriptor(operators(path))
