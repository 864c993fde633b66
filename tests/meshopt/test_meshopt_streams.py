"""Compressed buffer views, against what meshoptimizer writes and reads; broken and boastful ones end in an error."""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from glb_reader import ROOT
from hypothesis import given
from hypothesis import strategies as st
from missing import missing

from engine.meshopt.attribute_codec import decode_attributes, encode_attributes
from engine.meshopt.index_codec import decode_indices, encode_indices
from engine.meshopt.triangle_codec import decode_triangles, encode_triangles
from engine.motion.files.gltf_compression import decompressed


@pytest.fixture(scope="module")
def streams() -> list[dict[str, str | int]]:
    """Of every mode and filter. Skips where meshoptimizer is not installed, fails where it must be."""
    if shutil.which("node") is None or not (ROOT / "web/node_modules/meshoptimizer").exists():
        missing("meshoptimizer is not installed (make setup installs it)")
    script = Path(__file__).parents[1] / "encode_meshopt.mjs"
    told = subprocess.run(["node", script], check=True, timeout=60, capture_output=True, text=True).stdout
    return [json.loads(line) for line in told.splitlines()]


def test_what_meshoptimizer_writes_is_read_as_it_reads_it(streams: list[dict[str, str | int]]) -> None:
    assert {(s["mode"], s["filter"]) for s in streams} == {
        *((mode, "NONE") for mode in ("ATTRIBUTES", "TRIANGLES", "INDICES")),
        *(("ATTRIBUTES", name) for name in ("OCTAHEDRAL", "QUATERNION", "EXPONENTIAL")),
    }
    for s in streams:
        stream, expected = (base64.b64decode(str(s[key])) for key in ("stream", "decoded"))
        found = decompressed(stream, int(s["count"]), int(s["stride"]), s["mode"], s["filter"])
        if s["filter"] in ("OCTAHEDRAL", "QUATERNION"):  # which the specification asks for to the last place
            kind = np.int8 if s["stride"] == 4 else np.int16
            apart = np.frombuffer(found, kind).astype(int) - np.frombuffer(expected, kind)
            assert np.abs(apart).max() <= 1, s["filter"]
        else:
            assert found == expected, (s["mode"], s["stride"])


def test_a_group_is_read_as_the_specification_has_it() -> None:
    codes = bytes.fromhex("175ff0bc77a9210034b5")
    stream = (
        b"\xa0" + b"\x02" + codes + bytes(3) + bytes(32)
    )  # the first byte of rows of four; the others do not change
    rows = decode_attributes(stream, 16, 4)
    deltas = [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0]
    np.testing.assert_array_equal(rows[:, 0], np.cumsum(deltas).astype(np.uint8))
    assert not rows[:, 1:].any()


@given(st.binary(max_size=400), st.integers(0, 60), st.sampled_from([2, 4, 8, 12, 256]))
def test_any_bytes_are_rows_or_an_error(noise: bytes, count: int, stride: int) -> None:
    for mode, head in (("ATTRIBUTES", b"\xa0"), ("TRIANGLES", b"\xe1"), ("INDICES", b"\xd1")):
        try:
            found = decompressed(head + noise, count, stride, mode, "NONE")
        except ValueError:
            continue
        assert len(found) == count * stride


@given(st.integers(0, 10**6), st.integers(1, 255))
def test_a_broken_stream_is_rows_or_an_error(place: int, change: int) -> None:
    random = np.random.default_rng(place)
    rows = random.integers(0, 7, (200, 8)).astype(np.uint8)
    triangles = random.integers(0, 40, (100, 3))
    for stream, decode in (
        (encode_attributes(rows), lambda data: decode_attributes(data, 200, 8)),
        (encode_triangles(triangles), lambda data: decode_triangles(data, 100)),
        (encode_indices(triangles.ravel()), lambda data: decode_indices(data, 300)),
    ):
        at = place % len(stream)
        for broken in (stream[:at], stream[:at] + bytes([stream[at] ^ change]) + stream[at + 1 :], stream + b"\0"):
            with suppress(ValueError):
                assert decode(broken).size


@pytest.mark.parametrize("mode", ["ATTRIBUTES", "TRIANGLES", "INDICES"])
def test_no_stream_claims_more_than_it_can_hold(mode: str) -> None:
    head = {"ATTRIBUTES": b"\xa0", "TRIANGLES": b"\xe1", "INDICES": b"\xd1"}[mode]
    with pytest.raises(ValueError, match="no stream of"):
        decompressed(head + bytes(1000), 3 << 40, 4, mode, None)


@pytest.mark.parametrize(
    ("mode", "filter_", "stride"),
    [
        ("TRIANGLES", "EXPONENTIAL", 4),
        ("ATTRIBUTES", "QUATERNION", 12),
        ("ATTRIBUTES", "OCTAHEDRAL", 16),
        ("X", None, 4),
    ],
)
def test_what_the_extension_does_not_allow_is_refused(mode: str, filter_: str, stride: int) -> None:
    stream = encode_attributes(np.zeros((3, stride), np.uint8)) if mode == "ATTRIBUTES" else b"\xe1" + bytes(20)
    with pytest.raises(ValueError, match="no known way"):
        decompressed(stream, 3, stride, mode, filter_)
