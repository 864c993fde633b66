"""The stage store: what goes in comes out, whole or not at all, and without pickle."""

from __future__ import annotations

import json
import os
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.errors import Notice
from engine.store import StageStore, trim


@dataclass(frozen=True)
class Inner:
    points: NDArray[np.float32]
    name: str


@dataclass(frozen=True)
class Outer:
    size: tuple[int, int]
    scale: float
    found: bool
    inner: Inner
    maybe: Inner | None
    nothing: NDArray[np.float32] | None
    several: tuple[Inner, ...]
    names: list[str]
    file: Path


def outer(folder: Path) -> Outer:
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "crops.jpegs"
    file.write_bytes(b"\xff\xd8 pictures")
    one = Inner(np.arange(6, dtype=np.float32).reshape(3, 2), "one")
    two = Inner(np.zeros((0, 2), np.float32), "two")
    return Outer((640, 480), 0.5, True, one, two, None, (one, two), ["a", "ü"], file)


@pytest.fixture
def store(tmp_path: Path) -> StageStore:
    return StageStore(tmp_path / "store")


def test_what_goes_in_comes_out(store: StageStore, tmp_path: Path) -> None:
    given = outer(tmp_path / "work")
    stored = store.save("key", given, [Notice("a_code", "A sentence.")])
    kept = store.load("key", Outer)
    assert kept is not None
    notices, found = kept
    assert notices == [Notice("a_code", "A sentence.")]
    assert stored.file == found.file and stored.inner.points is given.inner.points
    assert (found.size, found.scale, found.found, found.names) == ((640, 480), 0.5, True, ["a", "ü"])
    assert isinstance(found.size, tuple) and isinstance(found.several, tuple)
    np.testing.assert_array_equal(found.inner.points, given.inner.points)
    assert found.inner.points.dtype == np.float32
    assert found.maybe.name == "two" and found.maybe.points.shape == (0, 2)
    assert found.nothing is None
    np.testing.assert_array_equal(found.several[0].points, given.inner.points)
    assert found.file.read_bytes() == b"\xff\xd8 pictures"


@dataclass(frozen=True)
class Named:
    places: Mapping[str, NDArray[np.float64]]
    parts: Mapping[str, Inner]
    empty: Mapping[str, int]


def test_what_has_names_comes_out_under_them(store: StageStore) -> None:
    given = Named({"left": np.arange(3.0), "right": np.zeros(0)}, {"a": Inner(np.ones((1, 2), np.float32), "one")}, {})
    store.save("key", given)
    kept = store.load("key", Named)
    assert kept is not None
    found = kept[1]
    assert list(found.places) == ["left", "right"]
    np.testing.assert_array_equal(found.places["left"], [0, 1, 2])
    assert found.places["right"].shape == (0,)
    assert found.parts["a"].name == "one" and found.parts["a"].points.shape == (1, 2)
    assert found.empty == {}


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (np.arange(4, dtype=np.int64), NDArray[np.int64]),
        (7, int),
        ("word", str),
        (None, None),
        ((1.5, 2.5), tuple[float, float]),
    ],
    ids=["array", "number", "word", "none", "tuple"],
)
def test_outputs_need_not_be_dataclasses(store: StageStore, value, kind) -> None:
    store.save("key", value)
    kept = store.load("key", kind)
    assert kept is not None
    np.testing.assert_array_equal(kept[1], value)


def test_files_are_moved_into_the_store(store: StageStore, tmp_path: Path) -> None:
    given = outer(tmp_path / "work")
    store.save("key", given)
    _, found = store.load("key", Outer)
    assert not given.file.exists()
    assert found.file.parent.parent == store.folder


def test_an_unknown_key_is_none(store: StageStore) -> None:
    assert store.find("nothing") is None
    assert store.load("nothing", Outer) is None


def test_nothing_is_pickled(store: StageStore, tmp_path: Path) -> None:
    store.save("key", outer(tmp_path / "work"))
    names = {p.name for p in (store.folder / "key").iterdir()}
    assert names == {"output.json", "arrays.npz", "crops.jpegs"}
    json.loads((store.folder / "key" / "output.json").read_text())
    with np.load(store.folder / "key" / "arrays.npz", allow_pickle=False) as arrays:
        assert all(arrays[name].dtype != object for name in arrays.files)


@pytest.mark.parametrize(
    "value", [{1, 2}, {"a": 1}, object(), np.array([object()])], ids=["set", "dict", "object", "objects"]
)
def test_what_cannot_be_kept_is_refused_and_leaves_nothing(store: StageStore, value: object) -> None:
    with pytest.raises(TypeError):
        store.save("key", value)
    assert store.find("key") is None
    assert list(store.folder.glob("*")) == []


def test_a_failed_save_leaves_no_draft(store: StageStore, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        store.save("key", tmp_path / "missing.bin")
    assert list(store.folder.iterdir()) == []


def test_two_runs_that_save_the_same_leave_one(store: StageStore) -> None:
    points = np.random.default_rng(0).normal(size=(500, 3))
    errors: list[BaseException] = []

    def save() -> None:
        try:
            store.save("key", points)
        except BaseException as error:
            errors.append(error)

    threads = [threading.Thread(target=save) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert errors == []
    assert [p.name for p in store.folder.iterdir()] == ["key"]
    np.testing.assert_array_equal(store.load("key", NDArray[np.float64])[1], points)


@pytest.mark.parametrize("broken", ["output.json", "arrays.npz"])
@pytest.mark.parametrize("how", ["gone", "empty", "cut"])
def test_an_output_that_cannot_be_read_is_thrown_away(store: StageStore, tmp_path: Path, broken: str, how: str) -> None:
    store.save("key", outer(tmp_path / "work"))
    file = store.folder / "key" / broken
    whole = file.read_bytes()
    if how == "gone":
        file.unlink()
    else:
        file.write_bytes(b"" if how == "empty" else whole[: len(whole) // 2])
    assert store.load("key", Outer) is None
    assert store.find("key") is None


def test_an_output_counts_as_just_used_when_found(store: StageStore) -> None:
    """So that housekeeping can throw away what nobody asked for in a long time."""
    import os

    store.save("key", 1)
    os.utime(store.folder / "key", (1, 1))
    assert store.find("key") is not None
    assert (store.folder / "key").stat().st_mtime > 1_000_000


def test_a_trimmed_store_loses_what_was_not_used_for_longest(tmp_path: Path) -> None:
    store = StageStore(tmp_path)
    for name, hours in (("a", 9), ("b", 7), ("c", 8), ("d", 0.5), (".draft-x", 5)):
        store.save(name, (np.zeros(125_000),))  # a megabyte each
        used = time.time() - 3600 * hours
        os.utime(tmp_path / name, (used, used))
    trim([store.folder], 3.5e6)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["b", "d"]
    trim([store.folder], 0)
    assert [path.name for path in tmp_path.iterdir()] == ["d"], "a running job may be about to read it"
    assert store.find("d") is not None


def test_what_is_no_store_stops_no_trimming(tmp_path: Path) -> None:
    """The human template keeps single files beside the stores of drivers' analyses."""
    kept = tmp_path / "template" / "bodies.npz"
    kept.parent.mkdir()
    kept.write_bytes(bytes(1000))
    store = StageStore(tmp_path / "owner" / "driver")
    store.save("a", (np.zeros(10),))
    os.utime(store.folder / "a", (1, 1))
    trim(tmp_path.glob("*/*"), 0)
    assert kept.exists() and not list(store.folder.iterdir())


def test_a_store_is_trimmed_while_others_publish_and_erase(tmp_path: Path) -> None:
    """Two writers whose outputs and drafts come and go, and two that trim: nobody stumbles, and what is new stays."""
    until, errors, saved = time.time() + 2, [], [0, 0]

    def publish(who: int) -> None:
        store = StageStore(tmp_path)
        while time.time() < until:
            key = f"{who}-{saved[who]}"
            store.save(key, (np.zeros(10),))
            if saved[who] % 2:
                os.utime(tmp_path / key, (1, 1))
            saved[who] += 1

    def erase() -> None:
        try:
            while time.time() < until:
                trim([tmp_path, tmp_path / "gone"], 0)
        except OSError as error:
            errors.append(error)

    threads = [threading.Thread(target=publish, args=(who,)) for who in (0, 1)]
    threads += [threading.Thread(target=erase) for _ in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    trim([tmp_path], 0)
    assert errors == []
    assert {one.name for one in tmp_path.iterdir()} == {f"{who}-{k}" for who in (0, 1) for k in range(0, saved[who], 2)}
    assert min(saved) > 10
