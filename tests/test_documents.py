"""What the documents and lock files promise, and Python that stands within other files."""

from __future__ import annotations

import json
import re
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
LOCKS = (ROOT / "requirements.lock", ROOT / "requirements-dev.lock")
DOCUMENTS = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
BROWSER_TESTS = sorted((ROOT / "tests" / "web" / "browser").glob("*.ts"))
IMPORTED = re.compile(r"\bfrom ((?:engine|service|worker|shell|galatea|galatea_client)\b[\w.]*) import (\w+(?:, \w+)*)")


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_somewhere(document: Path) -> None:
    links = re.findall(r"\]\((?!https?:|#)([^)#]+)", document.read_text())
    assert [link for link in links if not (document.parent / link).exists()] == []


def test_locks_hold_no_addresses() -> None:
    assert [lock for lock in LOCKS if "://" in lock.read_text()] == []
    packages = json.loads((ROOT / "web" / "package-lock.json").read_text())["packages"]
    assert [name for name, entry in packages.items() if "resolved" in entry] == []


@pytest.mark.parametrize("lock", LOCKS, ids=lambda path: path.name)
def test_every_locked_package_has_a_hash(lock: Path) -> None:
    entries = re.split(r"\n(?=\S)", lock.read_text().strip())
    assert [entry for entry in entries if "--hash=sha256:" not in entry] == []


def test_what_runs_is_locked_without_what_tests_it() -> None:
    from scripts.licences import locked, running

    runs, tests = (locked(lock) for lock in LOCKS)
    assert running() <= set(runs)
    assert running() & set(tests) == set()


def test_every_direct_dependency_is_in_the_list_of_licences() -> None:
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    direct = [*project["dependencies"], *project["optional-dependencies"]["dev"]]
    names = [re.match(r"[\w.-]+", requirement)[0] for requirement in direct]  # type: ignore[index]
    web = json.loads((ROOT / "web" / "package.json").read_text())
    names += [name for name in (web["dependencies"] | web["devDependencies"]) if not name.startswith("@types/")]
    listed = (ROOT / "docs" / "licences.md").read_text().lower()
    assert [name for name in names if not re.search(rf"(?<![\w-]){re.escape(name.lower())}(?![\w-])", listed)] == []


def test_every_package_and_native_library_has_its_licence() -> None:
    from scripts.licences import NATIVE_LICENCES, licence, locked, native, running

    listed = (ROOT / "docs" / "packages.md").read_text()
    names = locked(*LOCKS)
    assert len(names) > 100 and {"av", "numpy", "starlette"} <= running() and "pytest" not in running()
    for name in names:
        assert licence(name) and f"| {name} | " in listed, f"{name}: make licences"
    for package, library in native():
        assert library in NATIVE_LICENCES, (package, library)


@pytest.mark.parametrize("file", [*DOCUMENTS, *BROWSER_TESTS], ids=lambda path: str(path.relative_to(ROOT)))
def test_what_python_in_them_imports_is_there(file: Path) -> None:
    """Python within documents and browser tests, where no other check reads it."""
    names = [(module, name) for module, listed in IMPORTED.findall(file.read_text()) for name in listed.split(", ")]
    assert [f"{module}.{name}" for module, name in names if not hasattr(import_module(module), name)] == []
