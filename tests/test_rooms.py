"""Tests stand where what they test stands: a room without any is found, and a folder of tests without a room."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
ROOT = TESTS.parent
HOUSES = {"engine": TESTS, "service": TESTS / "service", "worker": TESTS / "worker"}
"""Where the tests of each package's rooms stand."""


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


def test_no_two_files_of_tests_have_one_name() -> None:
    """They are imported by it, and so is what they share."""
    shared = [file for file in TESTS.rglob("*.py") if file.name not in ("conftest.py", "__init__.py")]
    names = Counter(file.name for file in shared)
    assert [name for name, count in names.items() if count > 1] == []
