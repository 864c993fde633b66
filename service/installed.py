"""Where the program was installed from: a checkout, or a wheel."""

from __future__ import annotations

from pathlib import Path

from engine.package_data import package_folder


def checkout() -> Path | None:
    """The checkout that the program runs from; None where it does not."""
    folder = package_folder("service").parent
    return folder if (folder / "web" / "package.json").is_file() else None


def page_folder() -> Path:
    """The built web page: a wheel brings it, and in a checkout it lies where its build leaves it."""
    folder = checkout()
    return folder / "web" / "dist" if folder else package_folder("service", "web")
