"""What every command has in common: a wrong name, and Ctrl-C."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import psutil


def galatea(folder: Path, *arguments: str) -> subprocess.Popen[str]:
    kept = {name: value for name, value in os.environ.items() if not name.startswith("GALATEA_")}
    return subprocess.Popen(
        [sys.executable, "-m", "shell.main", *arguments],
        env=kept | {"GALATEA_DATA_DIR": str(folder / "data"), "COLUMNS": "40"},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def test_a_wrong_command_is_told_with_the_nearest(tmp_path: Path) -> None:
    for arguments, near in ((["potrait"], "portrait"), (["keys", "lst"], "list")):
        process = galatea(tmp_path, *arguments)
        _, said = process.communicate(timeout=300)
        assert process.returncode == 2 and f"Did you mean {near}?" in said, said


def test_an_id_is_never_wrapped(tmp_path: Path) -> None:
    made = galatea(tmp_path, "keys", "create", "a name that is rather long", "--scope", "read")
    key = made.communicate(timeout=300)[1].split()[1]
    listed, _ = galatea(tmp_path, "keys", "list").communicate(timeout=300)
    assert key in listed


def test_ctrl_c_ends_a_service_with_130_and_all_that_it_started(tmp_path: Path) -> None:
    process = galatea(tmp_path, "serve", "--port", "0")
    assert process.stdout is not None and process.stderr is not None
    while "serves at" not in process.stdout.readline():
        assert process.poll() is None
    children = psutil.Process(process.pid).children(recursive=True)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=300)
    assert process.returncode == 130
    assert said.splitlines()[-1] == "Stopped." and "Traceback" not in said
    _, alive = psutil.wait_procs(children, timeout=60)
    assert children and not alive


def test_names_are_completed(tmp_path: Path) -> None:
    words = {
        "galatea por": "plain,portrait",
        "galatea portrait face.jpg --driver surp": "plain,surprise",
        "galatea character me.jpg --motion da": "plain,dance",
    }
    for line, offered in words.items():
        asked = {"_GALATEA_COMPLETE": "bash_complete", "COMP_WORDS": line, "COMP_CWORD": str(len(line.split()) - 1)}
        kept = {name: value for name, value in os.environ.items() if not name.startswith("GALATEA_")}
        command = [Path(sys.executable).with_name("galatea")]
        done = subprocess.run(command, env=kept | asked, capture_output=True, text=True)
        assert offered in done.stdout.splitlines(), done.stdout + done.stderr
