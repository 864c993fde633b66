"""Compressed GLBs and streams, decoded by three.js' decoder."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from glb_reader import Glb, validate
from meshopt_reader import decoded
from numpy.typing import NDArray
from template_character import still, template_character, walk

from engine.export.gltf.glb import CharacterModel, write_glb
from engine.export.gltf.meshopt_compression import STEP_EXPONENTS
from engine.geometry.rigging.morph_target import morph_target
from engine.meshopt.attribute_codec import encode_attributes
from engine.meshopt.filters import encode_exponential
from engine.meshopt.index_codec import encode_indices
from engine.meshopt.triangle_codec import encode_triangles
from engine.motion.files.gltf_compression import MESHOPT_EXTENSION
from engine.motion.files.gltf_motion import read_gltf_motion


def through(tmp_path: Path, stream: bytes, count: int, stride: int, mode: str, filter_: str = "NONE") -> bytes:
    """What the decoder makes of a stream."""
    packed = {
        "buffer": 0,
        "byteLength": len(stream),
        "byteStride": stride,
        "count": count,
        "mode": mode,
        "filter": filter_,
    }
    view = {"buffer": 1, "byteLength": count * stride, "extensions": {MESHOPT_EXTENSION: {**packed, "byteOffset": 0}}}
    document = {
        "bufferViews": [view],
        "extensionsUsed": [MESHOPT_EXTENSION],
        "extensionsRequired": [MESHOPT_EXTENSION],
        "nodes": [],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    stream += bytes(-len(stream) % 4)
    sizes = [(28 + len(text) + len(stream)), len(text), len(stream)]
    whole, first, second = (size.to_bytes(4, "little") for size in sizes)
    path = tmp_path / "packed.glb"
    path.write_bytes(b"glTF\2\0\0\0" + whole + first + b"JSON" + text + second + b"BIN\0" + stream)
    glb = Glb(decoded(path, tmp_path / "plain.glb"))
    return glb.view(0)


@pytest.mark.parametrize(("count", "stride"), [(1, 4), (16, 8), (257, 12), (1000, 64), (40, 256)])
def test_rows_come_back_to_the_bit(tmp_path: Path, count: int, stride: int) -> None:
    random = np.random.default_rng(count)
    columns = np.arange(stride) % 4  # bytes that are still, creep, jump, and are noise
    steps = np.stack([random.integers(0, high, (count, stride)) for high in (1, 2, 9, 256)])
    rows = np.cumsum(steps[columns, :, np.arange(stride)].T, axis=0).astype(np.uint8)
    assert through(tmp_path, encode_attributes(rows), count, stride, "ATTRIBUTES") == rows.tobytes()


def turned_to_smallest(triangles: NDArray[np.integer]) -> NDArray[np.integer]:
    """Each beginning at its smallest vertex, with the same winding."""
    first = triangles.argmin(1)
    return np.take_along_axis(triangles, (first[:, None] + np.arange(3)) % 3, 1)


def strips() -> NDArray[np.int64]:
    """A net of squares: neighbours share edges, and new vertices come in their order."""
    corner = (np.arange(20)[:, None] * 31 + np.arange(30)).ravel()[:, None]
    return np.concatenate([np.add(corner, [0, 1, 31]), np.add(corner, [1, 32, 31])], 1).reshape(-1, 3)


@pytest.mark.parametrize("kind", ["net", "noise", "begins again", "degenerate"])
def test_triangles_come_back_with_their_winding(tmp_path: Path, kind: str) -> None:
    noise = np.random.default_rng(3).integers(0, 60000, (500, 3))
    again = np.concatenate([strips(), [[0, 1, 2]], strips()[::-1]])
    triangles = {"net": strips(), "noise": noise, "begins again": again, "degenerate": np.zeros((9, 3), int)}[kind]
    for width in (2, 4):
        stream = encode_triangles(triangles)
        found = np.frombuffer(through(tmp_path, stream, triangles.size, width, "TRIANGLES"), f"<u{width}").reshape(
            -1, 3
        )
        np.testing.assert_array_equal(turned_to_smallest(found), turned_to_smallest(triangles))


def test_triangles_that_share_edges_take_little_more_than_a_byte_each() -> None:
    assert len(encode_triangles(strips())) < 1.2 * len(strips()) + 20


def test_sequences_come_back(tmp_path: Path) -> None:
    indices = np.random.default_rng(5).integers(0, 2**29, 300)
    stream = encode_indices(indices)
    assert through(tmp_path, stream, 300, 4, "INDICES") == indices.astype("<u4").tobytes()


def test_numbers_come_back_as_the_nearest_multiples(tmp_path: Path) -> None:
    numbers = np.random.default_rng(7).normal(0, 1, (200, 3))
    words = encode_exponential(numbers, -12).astype("<i4").view(np.uint8)
    raw = through(tmp_path, encode_attributes(words), 200, 12, "ATTRIBUTES", "EXPONENTIAL")
    found = np.frombuffer(raw, "<f4").reshape(-1, 3)
    assert np.abs(found - numbers).max() <= 2.0**-13
    assert (found * 2**12 == np.rint(found * 2**12)).all()
    with pytest.raises(ValueError, match="too large"):
        encode_exponential(np.array([2048.0]), -12)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, Path]:
    """A character with expressions: as it is, compressed, and that decoded again."""
    mesh = template_character(texture_size=64)
    smile = np.zeros_like(mesh.vertices)
    smile[1000:1400] = np.random.default_rng(1).normal(0, 0.01, (400, 3))
    model = CharacterModel(
        replace(mesh, bones=mesh.bones[:, :4], weights=mesh.weights[:, :4]),
        [walk(mesh.skeleton), still(mesh.skeleton)],
        morphs=[morph_target("smile", smile)],
        unlit=False,
        mixamo=True,
    )
    folder = tmp_path_factory.mktemp("meshopt")
    write_glb(folder / "plain.glb", model)
    write_glb(folder / "small.glb", model, compression="meshopt")
    return folder / "plain.glb", folder / "small.glb", decoded(folder / "small.glb", folder / "again.glb")


def test_a_compressed_character_is_the_same_to_a_hair(files: tuple[Path, Path, Path]) -> None:
    plain, _, again = (Glb(path) for path in files)
    for name in ("POSITION", "NORMAL", "TEXCOORD_0"):
        assert np.abs(again.attribute(name) - plain.attribute(name)).max() <= 2.0 ** (STEP_EXPONENTS[name] - 1), name
    for name in ("JOINTS_0", "WEIGHTS_0"):
        np.testing.assert_array_equal(again.attribute(name), plain.attribute(name))
    np.testing.assert_array_equal(turned_to_smallest(again.triangles()), turned_to_smallest(plain.triangles()))
    for name in ("walk", "pictured"):
        assert np.abs(again.posed(name, 0.4) - plain.posed(name, 0.4)).max() < 5e-4, "metres"
    for name in ("POSITION", "NORMAL"):
        one, other = (glb.array(glb.json["meshes"][0]["primitives"][0]["targets"][0][name]) for glb in (plain, again))
        assert np.abs(one - other).max() <= 2.0 ** (STEP_EXPONENTS[name] - 1), name


def test_what_is_decoded_is_valid_and_its_bounds_are_right(files: tuple[Path, Path, Path]) -> None:
    issues = validate(files[2])["messages"]
    assert [issue for issue in issues if issue["severity"] == 0] == []


def test_it_is_read_here_too(files: tuple[Path, Path, Path]) -> None:
    plain, small, _ = (read_gltf_motion(path, "walk") for path in files)
    assert small.names == plain.names
    assert np.abs(small.rotations - plain.rotations).max() < 2.0 ** STEP_EXPONENTS["rotation"]
    assert np.abs(small.translations - plain.translations).max() < 2.0 ** STEP_EXPONENTS["translation"]


def test_the_extension_is_required_and_pays(files: tuple[Path, Path, Path]) -> None:
    plain, small, _ = files
    assert small.stat().st_size < 0.6 * plain.stat().st_size
    glb = Glb(small)
    assert MESHOPT_EXTENSION in glb.json["extensionsRequired"] and MESHOPT_EXTENSION in glb.json["extensionsUsed"]
    assert [issue for issue in validate(small)["messages"] if issue["severity"] == 0] == []
