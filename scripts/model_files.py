"""Part of `make setup`: files of networks, taken out of the packages that carry them. The rest of these packages, whose other models are
not free for business, or which are code, is left."""

from __future__ import annotations

import hashlib
import subprocess
import sys
import tarfile
import zipfile
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from engine.package_data import package_folder
from engine.perception.identity import dlib_descriptor
from engine.perception.masks import salience


@dataclass(frozen=True)
class CarriedFile:
    """A file `name` with this SHA-256 (hex), which the engine looks for in its `package`. The package that carries it
    is pinned in `lock`, comes as pip's option `form` says, and is told of as `what`."""

    package: str
    name: str
    sha256: str
    lock: str
    form: str
    what: str


CARRIED_FILES = (
    CarriedFile(
        "engine.perception.identity",
        dlib_descriptor.MODEL_FILE,
        dlib_descriptor.MODEL_SHA256,
        "identity_model.lock",
        "--no-binary",
        "the model that tells people apart (100 MB, of which 22 are kept)",
    ),
    CarriedFile(
        "engine.perception",
        salience.MODEL_FILE,
        salience.MODEL_SHA256,
        "salience_model.lock",
        "--only-binary",
        "the model that sees outlines (4 MB)",
    ),
)


def main() -> None:
    """Put the files where the engine looks for them, unless they are there."""
    for file in CARRIED_FILES:
        target = package_folder(file.package) / file.name
        if not target.is_file() or _sha256(target.read_bytes()) != file.sha256:
            _fetch(file, target)


def _fetch(file: CarriedFile, target: Path) -> None:
    print(f"Fetching {file.what}", file=sys.stderr)
    with TemporaryDirectory() as folder:
        pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet", "download"]
        exact = [
            "--no-deps",
            "--no-build-isolation",
            file.form,
            ":all:",
            "--require-hashes",
            "--requirement",
            str(Path(__file__).with_name(file.lock)),
        ]
        subprocess.run([*pip, *exact, "--dest", folder], check=True)  # noqa: S603 (our own program)
        (archive,) = Path(folder).iterdir()
        content = _member(archive, file.name)
    if _sha256(content) != file.sha256:
        sys.exit(f"setup: {file.name} is not the file that it should be")
    part = target.with_suffix(".part")
    part.write_bytes(content)
    part.replace(target)


def _member(archive: Path, name: str) -> bytes:
    """The file of this name in a source archive or a wheel."""
    if archive.suffix == ".whl":
        with zipfile.ZipFile(archive) as files:
            for one in files.namelist():
                if Path(one).name == name:
                    return files.read(one)
    else:
        with tarfile.open(archive) as members:
            for member in members:
                if member.isfile() and Path(member.name).name == name:
                    content = members.extractfile(member)
                    assert content is not None
                    return content.read()
    sys.exit(f"setup: {archive.name} holds no {name}")


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


if __name__ == "__main__":
    main()
