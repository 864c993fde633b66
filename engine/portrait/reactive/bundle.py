"""`profile.zip`: a folder that any static host serves: the profile, the script that plays it, and a page."""

from __future__ import annotations

import html
import zipfile
from pathlib import Path

from engine.package_data import package_data
from engine.portrait.reactive.document import Profile

BUNDLE_PACKAGE = "engine.portrait.reactive"
SCRIPT_FILE = "player/reactive-portrait.js"
"""The built web component: `make setup` puts it there from web/reactive."""
PAGE_FILE = "page.html"
"""A page that shows the profile where profiles are at home, with places for what this one is."""


def player() -> Path:
    """The built web component. Raises `IncompleteInstallation` where it is not there."""
    return package_data(BUNDLE_PACKAGE, SCRIPT_FILE)


def write_bundle(path: Path, folder: Path, profile: Profile) -> None:
    """Pack a finished profile, whose files lie in `folder`.

    Raises `IncompleteInstallation` where the component is not built.
    """
    script = player()
    draft = path.with_name(f".{path.name}.draft")
    try:
        with zipfile.ZipFile(draft, "w", zipfile.ZIP_DEFLATED) as bundle:
            bundle.writestr("index.html", demonstration(profile))
            bundle.write(script, script.name)
            bundle.write(folder / "profile.json", "profile.json")
            for name in profile.files():
                bundle.write(folder / name, name, zipfile.ZIP_STORED)
        draft.replace(path)
    finally:
        draft.unlink(missing_ok=True)


def demonstration(profile: Profile) -> str:
    """The page, for this profile's size and states."""
    width, height = profile.size
    buttons = "\n".join(
        f'        <button type="button" data-state="{html.escape(name)}">{html.escape(state.title.split(":")[0])}</button>'
        for name, state in profile.states.items()
        if name != profile.initial
    )
    page = package_data(BUNDLE_PACKAGE, PAGE_FILE).read_text()
    for place, value in (("{{width}}", str(width)), ("{{height}}", str(height)), ("{{buttons}}", buttons)):
        page = page.replace(place, value)
    return page
