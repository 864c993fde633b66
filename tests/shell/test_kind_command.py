"""The commands of job kinds: they run in-process, leave results, and complain in one line.

What is wrong in an order is told before anything is done, by the command alone (`told`); what is done, and what goes
wrong meanwhile, by the program as it is called from a shell (`galatea`).
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import av
import numpy as np
import pytest
from click.testing import CliRunner, Result

from engine.character.sample import sample_picture
from engine.media.image import write_image
from engine.media.video import read_video
from engine.perception.face.faces import find_faces
from engine.perception.face.landmarks import mouth_opening
from engine.performances import video
from service.catalogue.registry import load_kinds
from service.settings import Settings
from shell.kind_command import kind_command

ROOT = Path(__file__).parent.parent.parent
PICTURE = b"\x89PNG\r\n\x1a\n" + bytes(100)


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    kept = {name: value for name, value in os.environ.items() if not name.startswith("GALATEA_")}
    return kept | {
        "GALATEA_DATA_DIR": str(tmp_path / "data"),
        "GALATEA_KINDS": "tiny_kind:KIND",
        "PYTHONPATH": os.pathsep.join([str(ROOT / "tests" / "live_service"), str(ROOT)]),
    }


def galatea(environment: dict[str, str], *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "shell.main", *map(str, arguments)]
    return subprocess.run(command, env=environment, capture_output=True, text=True)


def told(kind: str, *arguments: str | Path) -> Result:
    """What a kind's command says, and ends with, of an order that it does not get to work on."""
    found = load_kinds(["tiny_kind:KIND" if kind == "tiny" else "engine.kinds:KINDS"])[kind]
    return CliRunner().invoke(kind_command(found), list(map(str, arguments)))


def test_results_and_report_are_left(tmp_path: Path, environment: dict[str, str]) -> None:
    (tmp_path / "a.png").write_bytes(PICTURE)
    out = tmp_path / "deep" / "out"
    ended = galatea(environment, "tiny", tmp_path / "a.png", "-o", out, "--options", '{"seconds": 0.1}')
    assert ended.returncode == 0, ended.stderr
    left = ["animation.mp4", "preview.jpg", "report.json", "spectrum.json"]
    assert sorted(path.name for path in out.iterdir()) == left
    assert ended.stdout.split() == [str(out / name) for name in left]
    report = json.loads((out / "report.json").read_text())
    assert report["kind"] == "tiny" and set(report["stages"]) == {"measure", "rest"}


def test_files_that_correct_are_options(tmp_path: Path, environment: dict[str, str]) -> None:
    (tmp_path / "a.png").write_bytes(PICTURE)
    (tmp_path / "mask.png").write_bytes(PICTURE + bytes(7))
    ended = galatea(environment, "tiny", tmp_path / "a.png", "--mask", tmp_path / "mask.png", "-o", tmp_path / "out")
    assert ended.returncode == 0, ended.stderr
    assert json.loads((tmp_path / "out/report.json").read_text())["inputs"]["mask"] == len(PICTURE) + 7
    shown = told("character", "--help").stdout
    assert "--mask IMAGE" in shown and "--labels IMAGE" in shown


def test_help_names_what_is_built_in() -> None:
    driver = " ".join(told("portrait", "--help").stdout.split())
    assert "Built in: idle, idle- strong, happy," in driver or "Built in: idle, idle-strong, happy," in driver
    assert "Built in: idle, walk, run, jump, sit, wave, dance, bow." in " ".join(
        told("character", "--help").stdout.split()
    )


def test_options_are_flags_and_these_count_more(tmp_path: Path, environment: dict[str, str]) -> None:
    (tmp_path / "a.png").write_bytes(PICTURE)
    order = ("tiny", tmp_path / "a.png", "-o", tmp_path / "out", "--options", '{"seconds": 60}')
    assert galatea(environment, *order, "--seconds", "0.1").returncode == 0
    ended = told(*order, "--seconds", "soon")
    assert ended.exit_code == 2 and ended.stderr.startswith("Error: --seconds: "), ended.stderr


@pytest.mark.parametrize(
    ("flag", "said", "complaint"),
    [
        ("--size", "200", "--size: give N,N, such as 300x300"),
        ("--size", "200x", "--size: give N,N, such as 300x300"),
        ("--size", "1x2x3", "--size: give N,N, such as 300x300"),
        ("--size", "20x30", "--size: Input should be greater than or equal to 64"),
        ("--trim", "3", "--trim: give NUMBER,NUMBER, such as 0.5,2"),
        ("--trim", "3,1", "--trim: Value error, the part ends at 1 s, which is not after its start at 3 s"),
        ("--crop", "fac", "--crop: give none|face|bust|NUMBER,NUMBER,NUMBER,NUMBER, such as 10,20,300,400"),
        ("--strength", "much", "--strength: Input should be a valid number, unable to parse string as a number"),
        ("--follow", "noes", "--follow: Input should be 'eyes', 'mouth', 'brows' or 'head'"),
    ],
)
def test_a_flag_of_the_wrong_form_is_told_the_right_one(tmp_path: Path, flag: str, said: str, complaint: str) -> None:
    (tmp_path / "a.png").write_bytes(PICTURE)
    ended = told("portrait", tmp_path / "a.png", "--driver", "wink", "-o", tmp_path / "out", flag, said)
    assert (ended.exit_code, ended.stderr) == (2, f"Error: {complaint}\n")


def test_options_come_from_a_file_too(tmp_path: Path, environment: dict[str, str]) -> None:
    (tmp_path / "a.png").write_bytes(PICTURE)
    (tmp_path / "options.json").write_text('{"crash": "refuse"}')
    options = f"@{tmp_path / 'options.json'}"
    ended = galatea(environment, "tiny", tmp_path / "a.png", "-o", tmp_path / "out", "--options", options)
    assert ended.returncode == 2
    assert ended.stderr == "Error: no_face: No face was found: choose another picture.\n"
    assert not (tmp_path / "out").exists(), "nothing half-made is left"


@pytest.mark.parametrize(
    ("image", "options", "said"),
    [
        ("nothing.png", "{}", "image: there is no file nothing.png"),
        ("a.png", "{", "--options: this is not valid JSON"),
        ("a.png", "[]", "--options: the whole: "),
        ("a.png", "@nothing.json", "--options: nothing.json cannot be read"),
        ("a.png", '{"seconds": "x"}', "--options: seconds: "),
        ("a.png", '{"sceonds": 1}', "--options: sceonds: There is no such option: did you mean seconds?"),
    ],
)
def test_bad_input_ends_with_one_clear_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, image: str, options: str, said: str
) -> None:
    (tmp_path / "a.png").write_bytes(PICTURE)
    monkeypatch.chdir(tmp_path)
    ended = told("tiny", image, "-o", "out", "--options", options)
    assert ended.exit_code == 2
    assert ended.stdout == ""
    (line,) = ended.stderr.splitlines()
    assert line.startswith(f"Error: {said}")


@pytest.mark.parametrize("kind", ["tiny", "portrait", "character"])
def test_ctrl_c_leaves_nothing_half_made(tmp_path: Path, environment: dict[str, str], kind: str) -> None:
    """Whoever stops a command while it works is told so, and finds no folder; the code says that it was the user."""
    picture, out = tmp_path / "picture.png", tmp_path / "out"
    if kind == "tiny":
        picture.write_bytes(PICTURE)
        order = [picture, "--seconds", "60"]
    elif kind == "portrait":
        write_image(picture, next(iter(read_video(video("happy")))).rgb)
        order = [picture, "--driver", "happy"]
    else:
        write_image(picture, sample_picture())
        order = [picture]
    kinds = {} if kind == "tiny" else {"GALATEA_KINDS": "engine.kinds:KINDS"}
    command = [sys.executable, "-m", "shell.main", kind, *order, "-o", out]
    process = subprocess.Popen(command, env=environment | kinds, stderr=subprocess.PIPE, text=True)
    while not list(out.glob(".galatea-*/preview.jpg")):  # the first thing that is made, long before the last
        assert process.poll() is None
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=300)
    assert (process.returncode, said.strip()) == (130, "Stopped.")
    assert not out.exists()


def test_serve_does_not_open_the_service_to_the_network_without_a_key(environment: dict[str, str]) -> None:
    assert all(Settings(host=host).keys_required for host in ("0.0.0.0", "::", "192.168.1.4"))
    ended = galatea(environment, "serve", "--host", "::")
    assert ended.returncode == 2
    (line,) = ended.stderr.splitlines()
    assert "asks for a key" in line and "galatea keys create" in line


def test_settings_that_make_no_sense_are_named(environment: dict[str, str]) -> None:
    for name, value in (("GALATEA_CONCURRENCY", "many"), ("GALATEA_DATABASE_URL", "mysql://x")):
        ended = galatea(environment | {name: value}, "serve")
        assert ended.returncode == 2
        (line,) = ended.stderr.splitlines()
        assert line.startswith(f"Error: {name}: ")


def test_a_portrait_acts_what_a_video_does(tmp_path: Path, environment: dict[str, str], media) -> None:
    """A closed smile, and a driver whose mouth opens: the files, the warning, and a mouth that opens."""
    driver, picture = media("driving/man_mouth_open_d18.mp4"), media("portraits/pair1_smile.png")
    options = '{"trim": [1.9, 2.7], "neutral_frame": 0, "sound": true}'
    ended = galatea(
        environment | {"GALATEA_KINDS": "engine.kinds:KINDS"},
        *("portrait", picture, "--driver", driver, "-o", tmp_path / "out", "--options", options),
    )
    assert ended.returncode == 0, ended.stderr
    names = ["animation.mp4", "landmarks.json", "poster.jpg", "preview.jpg", "report.json", "thumbnail.jpg"]
    assert ended.stdout.split() == [str(tmp_path / "out" / name) for name in names]
    (warning,) = ended.stderr.splitlines()
    assert warning.startswith("target_not_neutral: ")
    with av.open(str(tmp_path / "out" / "animation.mp4")) as container:
        assert len(container.streams.audio) == 1
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    assert [frame.shape for frame in frames] == [(256, 256, 3)] * 24
    first, last = (float(mouth_opening(find_faces(frames[at])[0])) for at in (0, -1))
    assert first < 0.05 and last > 0.3


def test_a_picture_without_a_face_ends_with_one_line(tmp_path: Path, environment: dict[str, str]) -> None:
    write_image(tmp_path / "grey.png", np.full((120, 160, 3), 128, np.uint8))
    kinds = {"GALATEA_KINDS": "engine.kinds:KINDS"}
    ended = galatea(environment | kinds, "portrait", tmp_path / "grey.png", "--driver", "wink", "-o", tmp_path / "out")
    assert (ended.returncode, ended.stdout) == (2, "")
    (line,) = ended.stderr.splitlines()
    assert line.startswith("Error: no_face: ")
    assert not (tmp_path / "out").exists()


def test_the_moments_of_a_video(tmp_path: Path, environment: dict[str, str]) -> None:
    ended = galatea(environment | {"GALATEA_KINDS": "engine.kinds:KINDS"}, "moments", video("wink"), "-o", tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert [Path(line).name for line in ended.stdout.split()] == [
        "moments.json",
        "poster.jpg",
        "report.json",
        "wink.jpg",
    ]
    assert [one["name"] for one in json.loads((tmp_path / "moments.json").read_text())["moments"]] == ["wink"]
    ended = told("moments", "none.mp4", "-o", tmp_path)
    assert (ended.exit_code, ended.stderr) == (2, "Error: driver: there is no file none.mp4\n")


def test_a_motion_may_be_named_or_be_a_file(tmp_path: Path) -> None:
    (tmp_path / "photo.png").write_bytes(b"")
    for motion, said in (
        ("fly", "Input should be 'idle', 'walk'"),
        ("some/where.bvh", "there is no file some/where.bvh"),
    ):
        ended = told("character", tmp_path / "photo.png", "--motion", motion, "-o", tmp_path / "o")
        assert ended.exit_code == 2 and said in ended.stderr
