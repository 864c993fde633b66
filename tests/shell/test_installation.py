"""What ships beside the modules is known: a file that is not in the lists is in no wheel, and no doctor misses it."""

from __future__ import annotations

import tomllib
from fnmatch import fnmatch
from pathlib import Path

import pytest

from engine.package_data import IncompleteInstallation, package_data, package_folder
from shell import installation

ROOT = Path(__file__).parents[2]
PACKAGES = ("engine", "service", "worker", "shell", "galatea", "galatea_client")
NOT_SHIPPED = {"galatea_client/pyproject.toml"}


def shipped() -> set[str]:
    """The files in the packages' folders that are no modules."""
    found = {
        path.relative_to(ROOT).as_posix()
        for package in PACKAGES
        for path in (ROOT / package).rglob("*")
        if path.is_file() and path.suffix != ".py" and "__pycache__" not in path.parts
    }
    return found - NOT_SHIPPED


def test_the_doctor_knows_every_file() -> None:
    known = {
        f"{package.replace('.', '/')}/{name}" for package, names in installation.data_files().items() for name in names
    }
    assert known == {path for path in shipped() if not path.endswith("py.typed")}
    assert list(installation.missing_files()) == []


def test_a_wheel_has_every_file() -> None:
    patterns = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]
    for path in shipped():
        assert any(
            fnmatch(path, f"{'*' if package == '*' else package.replace('.', '/')}/{pattern}")
            for package, some in patterns.items()
            for pattern in some
        ), path


def test_a_file_that_is_gone_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(installation, "data_files", lambda: {"engine.perception": ("canonical_face.npz", "gone.npz")})
    assert list(installation.missing_files()) == [package_folder("engine.perception") / "gone.npz"]
    with pytest.raises(IncompleteInstallation, match=r"gone\.npz is missing.*galatea doctor"):
        package_data("engine.perception", "gone.npz")
