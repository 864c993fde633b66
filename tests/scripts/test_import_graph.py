"""The rooms of the house: no circles, and no arrow that points up."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from scripts.import_graph import (
    PACKAGES,
    PAGE_FOLDER,
    File,
    arrows,
    circles,
    layers,
    loads,
    page_files,
    python_files,
    upward,
)

ROOT = Path(__file__).parents[2]


@cache
def files_of(package: str) -> list[File]:
    return page_files(ROOT / PAGE_FOLDER) if package == "page" else python_files(ROOT, package)


@pytest.mark.parametrize("package", [*PACKAGES, "page"])
def test_no_rooms_form_a_circle(package: str) -> None:
    assert circles(arrows(files_of(package))) == []


@pytest.mark.parametrize("package", ["engine", "service", "worker", "page"])
def test_no_arrow_points_up(package: str) -> None:
    files, order = files_of(package), layers(ROOT, package)
    assert {file.room for file in files} <= {room for rooms, _ in order for room in rooms}
    assert upward(arrows(files), order) == []


def test_no_files_of_the_page_form_a_circle_by_what_comes_with_them() -> None:
    assert circles(loads(files_of("page"))) == []


def test_one_file_alone_of_each_kind_is_known_outside_and_to_the_application_alone() -> None:
    """The list of kinds is handed down by the application: whoever imported it would be a circle through every kind."""
    outside = [file for file in files_of("page") if file.room != "kinds"]
    known = {(file.name, aim) for file in outside for aim in file.imports if aim.startswith("kinds/")}
    assert known == {("app", "kinds/index"), ("main", "kinds/index")}


def test_imports_are_read_as_arrows(tmp_path: Path) -> None:
    house = tmp_path / "house"
    for name, text in {
        "__init__.py": "",
        "cellar/__init__.py": "",
        "cellar/wine.py": "import house.attic\n",
        "kitchen.py": "from house import attic\nfrom house.cellar import wine\nimport json\n",
        "attic.py": "def look() -> None:\n    from house.kitchen import cook\n    cook()\n",
    }.items():
        (house / name).parent.mkdir(parents=True, exist_ok=True)
        (house / name).write_text(text)
    files = python_files(tmp_path, "house")
    found = arrows(files)
    assert found == {
        ("cellar", "attic"): 1,
        ("kitchen", "attic"): 1,
        ("kitchen", "cellar"): 1,
        ("attic", "kitchen"): 1,
    }
    assert circles(found) == [["attic", "cellar", "kitchen"]]
    assert [length for file in files for length in file.functions] == [3]
    order = [(frozenset({"attic"}), True), (frozenset({"kitchen"}), True), (frozenset({"cellar"}), True)]
    assert upward(found, order) == [("cellar", "attic"), ("kitchen", "attic")]
    assert upward({("kitchen", "pantry"): 1}, [(frozenset({"kitchen", "pantry"}), False)]) == [("kitchen", "pantry")]
    assert upward({("kitchen", "pantry"): 1}, [(frozenset({"kitchen", "pantry"}), True)]) == []


def test_import_lines_of_the_page_are_read_as_arrows(tmp_path: Path) -> None:
    (tmp_path / "viewer").mkdir()
    (tmp_path / "viewer" / "view.ts").write_text('import { a } from "../route";\nexport { b } from "three";\n')
    (tmp_path / "route.ts").write_text('const late = () =>\n  import("./viewer/view");\nexport function a() {\n}\n')
    files = page_files(tmp_path)
    assert arrows(files) == {("viewer", "route"): 1, ("route", "viewer"): 1}
    assert [file.functions for file in files] == [(2,), ()]
    assert loads(files) == {("viewer/view", "route"): 1}
