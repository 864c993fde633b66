"""What `make wheel` makes works where there is no checkout: the shell, the service with its page, and what they read."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from running import HERE, ROOT, Running

from engine.body.cache import cache_folder
from engine.character.sample import sample_picture
from engine.media.image import write_image
from engine.media.video import probe_video
from engine.performances import poster

PACKAGES = ("engine", "service", "worker", "shell", "galatea", "galatea_client")
BUILD_FILES = ("pyproject.toml", "setup.py", "MANIFEST.in", "README.md", "LICENSE")
PIP = (sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet")


def run(*command: object, cwd: Path, **settings: str) -> subprocess.CompletedProcess[str]:
    gone = ("GALATEA_", "PYTHONPATH")
    environment = {name: value for name, value in os.environ.items() if not name.startswith(gone)}
    return subprocess.run(
        [str(part) for part in command], cwd=cwd, env=environment | settings, capture_output=True, text=True
    )


def build(folder: Path, page: bool) -> Path:
    """The wheel of this checkout, built in a copy of it."""
    source = folder / "source"
    for name in PACKAGES:
        shutil.copytree(ROOT / name, source / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in BUILD_FILES:
        shutil.copy(ROOT / name, source)
    if page:
        assert (ROOT / "web" / "dist" / "index.html").is_file(), "the page is not built: run `make setup`"
        shutil.copytree(ROOT / "web" / "dist", source / "web" / "dist")
    made = run(*PIP, "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", folder, source, cwd=folder)
    assert made.returncode == 0, made.stdout + made.stderr
    return next(folder.glob("galatea-*.whl"))


class Installed:
    """An environment of its own: the wheel is installed into it, and it borrows this one's other packages."""

    def __init__(self, folder: Path, wheel: Path):
        self.folder, self.data = folder, folder / "data"
        run(sys.executable, "-m", "venv", "--without-pip", folder / "venv", cwd=folder).check_returncode()
        self.python = folder / "venv" / "bin" / "python"
        install = ("--python", self.python, "install", "--no-deps", "--no-index", "--no-compile", wheel)
        run(*PIP, *install, cwd=folder).check_returncode()
        self.packages = next((folder / "venv" / "lib").glob("python*/site-packages"))
        # A path alone: what makes the checkout importable (a .pth file in there) is not looked at.
        (self.packages / "borrowed.pth").write_text(sysconfig.get_paths()["purelib"] + "\n")
        for name in PACKAGES:
            for module in (self.packages / name).rglob("*.py"):
                self._take_over_compiled(module)
        self._take_over_template()
        (folder / "elsewhere").mkdir()

    def _take_over_compiled(self, module: Path) -> None:
        """What was compiled of a module, by Python or by Numba, serves its copy, of the same size and age, too: compiling
        takes minutes."""
        original = ROOT / module.relative_to(self.packages)
        os.utime(module, ns=(original.stat().st_atime_ns, original.stat().st_mtime_ns))
        for kept in (original.parent / "__pycache__").glob(f"{original.stem}.*"):
            (module.parent / "__pycache__").mkdir(exist_ok=True)
            shutil.copy(kept, module.parent / "__pycache__")

    def _take_over_template(self) -> None:
        """What this checkout has made of MakeHuman's files, if it has: reading them takes half a minute, wherever the
        program that reads them lies (`engine.body.cache`)."""
        if (template := cache_folder() / "template").is_dir():
            shutil.copytree(template, self.data / "cache" / "template")

    def galatea(self, *arguments: object, **settings: str) -> subprocess.CompletedProcess[str]:
        settings = {"GALATEA_DATA_DIR": str(self.data), **settings}
        return run(self.python.with_name("galatea"), *arguments, cwd=self.folder / "elsewhere", **settings)


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Installed]:
    folder = tmp_path_factory.mktemp("installed")
    yield Installed(folder, build(folder, page=True))
    shutil.rmtree(folder, ignore_errors=True)


def test_nothing_of_the_checkout_is_seen(installed: Installed) -> None:
    asked = "import engine, service, worker, shell; print(engine.__file__, service.__file__, worker.__file__)"
    said = run(installed.python, "-c", asked, cwd=installed.folder)
    assert all(path.startswith(str(installed.packages)) for path in said.stdout.split()), said.stdout + said.stderr
    assert str(ROOT) not in said.stdout
    said = run(installed.python, "-c", "import galatea; print(galatea.__file__)", cwd=installed.folder)
    assert said.stdout.startswith(str(installed.packages)), said.stderr


def test_the_doctor_finds_it_whole(installed: Installed) -> None:
    found = installed.galatea("doctor")
    assert found.returncode == 0, found.stdout + found.stderr
    assert "warning" not in found.stdout.replace("warning  not so here", ""), found.stdout
    assert str(installed.packages / "service" / "web") in found.stdout


def test_a_portrait_and_a_profile(installed: Installed) -> None:
    out = installed.folder / "portrait"
    done = installed.galatea("portrait", poster("happy"), "--driver", "idle", "--trim", "0,0.3", "-o", out)
    assert done.returncode == 0, done.stdout + done.stderr
    assert probe_video(out / "animation.mp4").frames > 5
    done = installed.galatea("portrait", poster("happy"), "--reactive", "nod", "--size", "160x160", "-o", out)
    assert done.returncode == 0, done.stdout + done.stderr
    assert {"index.html", "reactive-portrait.js"} <= set(zipfile.ZipFile(out / "profile.zip").namelist())


def test_a_character(installed: Installed) -> None:
    write_image(installed.folder / "photo.png", sample_picture(400))
    out = installed.folder / "character"
    options = ("--motion", "wave", "--seconds", "1", "--size", "128x128", "--triangles", "4000")
    done = installed.galatea("character", installed.folder / "photo.png", *options, "-o", out)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (out / "character.glb").stat().st_size > 10_000
    assert json.loads((out / "report.json").read_text())["kind"] == "character"


def test_a_service_with_its_page(installed: Installed) -> None:
    command = [str(installed.python.with_name("galatea"))]
    running = Running(installed.folder / "served", root=HERE, command=command, cwd=installed.folder / "elsewhere")
    try:
        page = running.client.get("/")
        assert page.status_code == 200 and page.content == (ROOT / "web" / "dist" / "index.html").read_bytes()
        job = running.submit(b"\x89PNG\r\n\x1a\n" + bytes(100))
        assert running.until(job["id"], "succeeded", "failed")["status"] == "succeeded"
    finally:
        running.stop()
    assert "not built" not in running.output.read_text()


def test_a_file_that_is_gone_is_no_missing_picture(installed: Installed) -> None:
    file = installed.packages / "engine" / "perception" / "canonical_face.npz"
    hidden = file.rename(file.with_suffix(".hidden"))
    try:
        found = installed.galatea("doctor")
        assert found.returncode == 1 and f"{file} is missing, or not whole" in found.stdout
        done = installed.galatea("portrait", poster("fear"), "--driver", "idle", "--trim", "0,0.3", "-o", "out")
        assert done.returncode == 1 and f"{file} is missing" in done.stderr and "Traceback" not in done.stderr
        assert "galatea doctor" in done.stderr
    finally:
        hidden.rename(file)


def test_a_wheel_without_the_page_says_so(tmp_path: Path) -> None:
    installed = Installed(tmp_path, build(tmp_path, page=False))
    found = installed.galatea("doctor")
    assert found.returncode == 0, found.stdout
    assert "the web page is not built" in found.stdout and "make wheel" in found.stdout
    running = Running(
        tmp_path / "served", root=HERE, command=[str(installed.python.with_name("galatea"))], cwd=tmp_path, worker=False
    )
    try:
        assert "The web page is not built" in running.client.get("/").text
    finally:
        running.stop()
    assert "The web page is not built: `galatea doctor` says what to do." in running.output.read_text()
