"""Tests stand where what they test stands: a room without any is found, and a folder of tests without a room."""

from __future__ import annotations

import ast
from collections import Counter
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
ROOT = TESTS.parent
HOUSES = {"engine": TESTS, "service": TESTS / "service", "worker": TESTS / "worker"}
"""Where the tests of each package's rooms stand."""

MAX_FILES_IN_A_ROOM = 20
"""A room with more is cut into several."""


def rooms(package: str) -> list[Path]:
    """The package's folders, by their paths in it."""
    house = ROOT / package
    return sorted(init.parent.relative_to(house) for init in house.rglob("*/__init__.py"))


def files_of_tests(folder: Path) -> list[Path]:
    return sorted(folder.rglob("test_*.py"))


@pytest.mark.parametrize("package", HOUSES)
def test_every_room_has_a_folder_of_tests_or_a_file_of_its_name(package: str) -> None:
    place = HOUSES[package]
    bare = [
        str(room)
        for room in rooms(package)
        if not files_of_tests(place / room) and not (place / room.parent / f"test_{room.name}.py").is_file()
    ]
    assert bare == [], f"no tests of {package} in {[str((place / room).relative_to(ROOT)) for room in bare]}"


@pytest.mark.parametrize(("house", "ending"), [*((house, "*.py") for house in HOUSES), ("web/src", "*.ts*")])
def test_no_room_holds_more_files_than_are_looked_through(house: str, ending: str) -> None:
    files = Counter(file.parent for file in (ROOT / house).rglob(ending) if file.name != "__init__.py")
    assert {str(room.relative_to(ROOT)): count for room, count in files.items() if count > MAX_FILES_IN_A_ROOM} == {}


@pytest.mark.parametrize("package", HOUSES)
def test_every_folder_of_tests_within_a_room_s_is_of_something_within_the_room(package: str) -> None:
    house, place = ROOT / package, HOUSES[package]
    outer = {room.parts[0] for room in rooms(package)}
    folders = {file.parent.relative_to(place) for file in files_of_tests(place)}
    within = [folder for folder in folders if folder.parts and (package != "engine" or folder.parts[0] in outer)]
    strange = [
        str(folder) for folder in within if not (house / folder).is_dir() and not (house / f"{folder}.py").is_file()
    ]
    assert strange == []


@pytest.mark.parametrize(
    ("place", "houses"), [("benchmarks", ["benchmarks"]), ("web/unit", ["web/src", "web"])], ids=["benchmarks", "page"]
)
def test_folders_of_other_tests_are_those_of_what_they_test(place: str, houses: list[str]) -> None:
    folders = {file.parent.relative_to(TESTS / place) for file in (TESTS / place).rglob("*test*.*")}
    folders = {folder for folder in folders if "__pycache__" not in folder.parts}
    assert [str(one) for one in folders if not any((ROOT / house / one).is_dir() for house in houses)] == []


def private_imports(source: str) -> list[str]:
    """What a file takes of another that begins with an underscore, `__future__` and the like aside."""
    taken = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom):
            taken += [*(node.module or "").split("."), *(name.name for name in node.names)]
        elif isinstance(node, ast.Import):
            taken += [part for name in node.names for part in name.name.split(".")]
        elif isinstance(node, ast.Attribute) and not (isinstance(node.value, ast.Name) and node.value.id == "self"):
            taken.append(node.attr)
    allowed = {"_exit", "_replace", "_asdict", "_fields"}  # of Python's own `os` and named tuples
    return [name for name in taken if name.startswith("_") and not name.startswith("__") and name not in allowed]


def test_tests_take_no_private_names() -> None:
    taken = {str(file.relative_to(ROOT)): private_imports(file.read_text()) for file in TESTS.rglob("*.py")}
    assert {file: names for file, names in taken.items() if names} == {}
    assert private_imports("from a._b import c, _d\nimport e\ne._f(self._g)") == ["_b", "_d", "_f"]


def test_no_two_files_of_tests_have_one_name() -> None:
    """They are imported by it, and so is what they share."""
    shared = [file for file in TESTS.rglob("*.py") if file.name not in ("conftest.py", "__init__.py")]
    names = Counter(file.name for file in shared)
    assert [name for name, count in names.items() if count > 1] == []
