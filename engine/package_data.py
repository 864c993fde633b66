"""The files that ship with a package: looked for where the package is, and nowhere else."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from engine.errors import GalateaError


class IncompleteInstallation(GalateaError):
    """A file of the program's own is not there. Nothing is wrong with what a user gave."""


def package_folder(package: str, name: str = "") -> Path:
    """The folder of a package, or one within it that holds nothing but data."""
    return Path(str(files(package).joinpath(name)))


def package_data(package: str, name: str) -> Path:
    """A file that ships with a package.

    Raises
    ------
    IncompleteInstallation : it is not there.
    """
    path = package_folder(package, name)
    if not path.is_file():
        raise IncompleteInstallation(
            "installation_incomplete",
            f"{path} is missing: the installation is not whole. `galatea doctor` says what else is, and how to mend it.",
        )
    return path
