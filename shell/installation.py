"""Whether the installation is whole: the files that ship with the packages, by the packages that read them."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

from engine.package_data import package_folder
from engine.perception.identity.dlib_descriptor import MODEL_FILE
from engine.perception.masks import salience
from engine.performances.catalogue import scored
from service.installed import checkout


def install_anew() -> str:
    """What to do about what is missing."""
    if checkout():
        return "run `make setup` in the checkout"
    return "install Galatea anew, from a wheel that `make wheel` has made in a checkout"


def data_files() -> dict[str, tuple[str, ...]]:
    """All files that are no modules, by the package that they belong to; the web page's, which have no fixed names, apart."""
    performances = [f"videos/{one.name}.{ending}" for one in scored() for ending in ("mp4", "jpg")]
    return {
        "engine.avatar.sample": ("body.mp4", "head.mp4"),
        "engine.perception": ("canonical_face.npz", salience.MODEL_FILE),
        "engine.perception.identity": (MODEL_FILE,),
        "engine.performances": ("videos/appearances.json", *performances),
        "engine.portrait.reactive": ("page.html", "player/reactive-portrait.js"),
        "service.migrations": ("script.py.mako",),
    }


def missing_files() -> Iterator[Path]:
    """The files that are not there, or empty; and whatever else was installed and is gone."""
    expected = [package_folder(package) / name for package, names in data_files().items() for name in names]
    gone = [path for path in expected if not path.is_file() or not path.stat().st_size]
    yield from gone
    for path, size in _installed():
        if path not in gone and (not path.is_file() or (size is not None and path.stat().st_size != size)):
            yield path


def _installed() -> Iterator[tuple[Path, int | None]]:
    """The packages' files as an installer wrote them down, and how large they were: a wheel's, none of a checkout's."""
    try:
        recorded = distribution("galatea").files or []
    except PackageNotFoundError:  # run from the checkout, without an installation
        return
    for one in recorded:
        if one.parts[0].isidentifier() and len(one.parts) > 1 and one.suffix != ".pyc":
            yield Path(str(one.locate())), one.size
