"""The package `galatea`: what it exports, what it takes, what it refuses, and what it leaves of all that."""

from __future__ import annotations

import inspect
import io
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import galatea
from engine.character.sample import sample_picture
from engine.errors import InputError
from engine.export.synthetic import SOURCE_TYPE
from engine.media.video import probe_video
from engine.package_data import IncompleteInstallation
from engine.performances import names, poster, video
from engine.persona.sample import write_sample_photos
from engine.run import Run
from scripts.option_types import OUT_FILE, written

ROOT = Path(__file__).parents[2]
SHORT: dict[str, Any] = {"trim": (0, 0.2), "size": (96, 96), "head_3d": False}


def test_what_is_exported() -> None:
    assert galatea.__all__ == [
        *("AvatarOptions", "CharacterOptions", "GalateaError", "Notice", "PersonaOptions", "PortraitOptions"),
        *("Progress", "Result", "animate", "make_avatar", "make_persona", "wake_up"),
    ]
    assert all(hasattr(galatea, name) for name in galatea.__all__)
    assert {name for name in vars(galatea) if not name.startswith("_")} - {
        *galatea.__all__, "calls", "inputs", "silence_libraries", "options", "result"
    } == set()  # fmt: skip
    assert issubclass(InputError, galatea.GalateaError) and issubclass(IncompleteInstallation, galatea.GalateaError)


def test_the_calls_have_one_manner() -> None:
    """What is no matter of one system alone has the same names, kinds and defaults; options are keywords."""
    shared = ("out", "progress", "cache", "mark_synthetic", "options")
    animate, *others = (
        {name: given for name, given in inspect.signature(call).parameters.items() if name in shared}
        for call in (galatea.animate, galatea.wake_up, galatea.make_avatar, galatea.make_persona)
    )
    assert tuple(animate) == shared
    for other in others:
        assert tuple(other) == shared
        for name in shared:
            assert (animate[name].kind, animate[name].default) == (other[name].kind, other[name].default)
    assert all(animate[name].kind is inspect.Parameter.KEYWORD_ONLY for name in shared[1:4])


def test_the_types_of_the_options_are_those_of_the_engine() -> None:
    assert OUT_FILE.read_text() == written(), "run python -m scripts.option_types"


def pictures() -> dict[str, Any]:
    """One portrait in every form in which it may be given."""
    pixels = np.asarray(Image.open(poster("happy")).convert("RGB"))
    held = io.BytesIO()
    Image.fromarray(pixels).save(held, "PNG")
    return {
        "path": poster("happy"),
        "text": str(poster("happy")),
        "bytes": held.getvalue(),
        "array": pixels,
        "floats": pixels.astype(np.float64) / 255,
        "pillow": Image.fromarray(pixels),
        "turned": _turned(pixels),
        "opaque": Image.fromarray(pixels).convert("RGBA"),
    }


def _turned(pixels: np.ndarray) -> Image.Image:
    """As a phone held sideways stores it: turned, with an EXIF tag that says so."""
    held = io.BytesIO()
    exif = Image.Exif()
    exif[0x0112] = 6
    Image.fromarray(np.rot90(pixels)).save(held, "PNG", exif=exif)
    return Image.open(held)


def test_a_picture_may_be_given_in_every_form(tmp_path: Path) -> None:
    from galatea.inputs import picture_file

    shown = {}
    for name, given in pictures().items():
        folder = tmp_path / name
        folder.mkdir()
        shown[name] = np.asarray(Image.open(picture_file(given, "image", folder)).convert("RGB"))
    exact = shown.pop("array")
    assert shown and all(np.array_equal(exact, one) for one in shown.values())


@pytest.mark.parametrize(
    "wrong",
    [np.zeros((4, 4, 2), np.uint8), np.full((4, 4), 2.0), np.zeros((4, 4), np.int64), np.zeros((0, 4, 3), np.uint8)],
    ids=["channels", "range", "type", "empty"],
)
def test_an_array_that_is_no_picture_is_refused(tmp_path: Path, wrong: np.ndarray) -> None:
    with pytest.raises(galatea.GalateaError) as caught:
        galatea.animate(wrong, "nod", tmp_path / "out")
    assert caught.value.code == "not_an_image" and "uint8" in caught.value.detail


def test_an_animation_of_what_is_in_memory(tmp_path: Path) -> None:
    told: list[galatea.Progress] = []
    result = galatea.animate(
        pictures()["array"], video("nod").read_bytes(), tmp_path / "a" / "b", progress=told.append, **SHORT
    )
    assert result.path == tmp_path / "a" / "b" / "animation.mp4" and probe_video(result.path).frames == 6
    assert set(result.artifacts) == {path.name for path in result.folder.iterdir()}
    assert result.report == json.loads((result.folder / "report.json").read_text())
    assert [(one.code, one.message) for one in result.warnings] == [
        (one["code"], one["message"]) for one in result.report["warnings"]
    ]
    assert os.fspath(result) == str(result.path)
    fractions = [one.fraction for one in told]
    assert fractions == sorted(fractions) and fractions.count(1.0) == 1 and fractions[-1] == 1.0


@pytest.fixture(scope="module")
def woken(tmp_path_factory: pytest.TempPathFactory) -> tuple[galatea.Result, list[galatea.Progress]]:
    told: list[galatea.Progress] = []
    result = galatea.wake_up(
        sample_picture(400),
        tmp_path_factory.mktemp("character") / "out",
        "wave",
        mark_synthetic=False,
        progress=told.append,
        seconds=1,
        size=(96, 96),
        triangles=4000,
    )
    return result, told


def test_a_character_has_the_same_words(woken: tuple[galatea.Result, list[galatea.Progress]]) -> None:
    result, told = woken
    assert result.path.name == "character.glb" and result.report["kind"] == "character"
    assert SOURCE_TYPE.encode() not in result.artifacts["animation.mp4"].read_bytes()
    assert [one.fraction for one in told].count(1.0) == 1 and told[-1].fraction == 1.0


def test_a_painted_mask_is_taken(tmp_path: Path, woken: tuple[galatea.Result, list[galatea.Progress]]) -> None:
    """A mask as an array, of the wrong size: the engine has it, for it says so."""
    with pytest.raises(galatea.GalateaError) as caught:
        galatea.wake_up(sample_picture(400), tmp_path / "out", mask=np.ones((20, 20), bool), seconds=1)
    assert caught.value.code == "mask_size"
    with pytest.raises(galatea.GalateaError) as caught:
        galatea.wake_up(sample_picture(400), tmp_path / "out", labels=np.zeros((20, 20, 3)), seconds=1)
    assert caught.value.code == "labels_size"
    assert list(tmp_path.iterdir()) == []


REFUSALS: dict[str, tuple[dict[str, Any], str, str]] = {
    "option": ({"strenght": 0.8}, "invalid_options", "strenght: There is no such option: did you mean strength?"),
    "value": ({"strength": 9}, "invalid_options", "strength: Input should be less than or equal to 2"),
    "picture": ({"image": "nobody.jpg"}, "file_not_found", "image: there is no file nobody.jpg."),
    "performance": (
        {"driver": "glee"},
        "file_not_found",
        f"nor a built-in one of this name ({', '.join(names())}, auto)",
    ),
    "driver": ({"driver": None}, "driver_missing", "Name a driver"),
    "states": ({"driver": None, "reactive": ("glee",)}, "invalid_options", "there is no performance glee"),
    "nobody": ({"image": np.zeros((64, 64, 3), np.uint8)}, "no_face", ""),
    "late": ({"neutral_frame": 400, **SHORT}, "neutral_frame_out_of_range", ""),
}


@pytest.mark.parametrize("refusal", REFUSALS)
def test_a_refusal_says_what_to_do_and_leaves_nothing(
    tmp_path: Path, refusal: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    changed, code, said = REFUSALS[refusal]
    stages: list[str] = []
    monkeypatch.setattr(Run, "timed", _noted(stages))
    given = {"image": poster("happy"), "driver": "nod", "out": tmp_path / "deep" / "out", **changed}
    told: list[galatea.Progress] = []
    with pytest.raises(galatea.GalateaError) as caught:
        galatea.animate(**given, progress=told.append)
    assert caught.value.code == code and said in caught.value.detail
    assert list(tmp_path.iterdir()) == []
    assert not any(one.fraction == 1.0 for one in told)
    assert bool(stages) == (refusal in ("nobody", "late")), "it is refused before anything is worked out"


def _noted(stages: list[str]) -> Any:
    real = Run.timed

    def timed(self: Run, name: str) -> Any:
        stages.append(name)
        return real(self, name)

    return timed


def test_a_motion_is_a_name_or_a_file(tmp_path: Path) -> None:
    for motion, code, said in (
        ("wavee", "file_not_found", "nor a built-in one of this name (idle, walk, run, jump, sit, wave, dance, bow)"),
        (tmp_path / "no.bvh", "file_not_found", "there is no file"),
        (b"nothing of the kind", "motion_unreadable", ""),
    ):
        with pytest.raises(galatea.GalateaError) as caught:
            galatea.wake_up(sample_picture(400), tmp_path / "out", motion, seconds=1)
        assert said in caught.value.detail, motion
        assert caught.value.code == code
    assert list(tmp_path.iterdir()) == []


def test_what_was_in_the_folder_before_stays(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(galatea.GalateaError):
        galatea.animate(np.zeros((64, 64, 3), np.uint8), "nod", tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]


SCRIPT = """
import os, sys, threading, galatea
from engine.performances import poster
def told(now):
    if now.stage == "animate":  # the networks run by now
        print("animate is heard", file=sys.stderr)
        thread = threading.Thread(target=os.write, args=(2, b"mine\\n"))
        thread.start()
        thread.join()
print("before", file=sys.stderr)
galatea.animate(poster("happy"), "nod", sys.argv[1], trim=(0, 0.2), size=(96, 96), progress=told)
print("after", file=sys.stderr, end="")
"""


def test_lines_are_passed_on_as_they_come(tmp_path: Path) -> None:
    from galatea.silence_libraries import sift

    theirs = b"W0000 00:00:1795655370.648436    1615 a_calculator.cc:114] Feedback manager\n"
    with (tmp_path / "heard").open("wb", 0) as heard:
        rest = b""
        for piece in (
            b"a prom",
            b"pt> ",
            b"\n",
            theirs[:3],
            theirs[3:],
            b"INFO: ",
            b"Created TensorFlow Lite X.",
            b"\n",
            b"Im",
        ):
            rest = sift(rest + piece, heard.fileno())
        assert rest == b"" and (tmp_path / "heard").read_bytes() == b"a prompt> \nIm"


def test_a_script_hears_itself_and_no_library(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(tmp_path / "out")], cwd=ROOT, capture_output=True, text=True, check=True
    )
    heard = done.stderr.split("\n")
    assert set(heard) == {"mine", "before", "animate is heard", "after"}, done.stderr
    assert heard[-1] == "after"


CHILD = """
import subprocess, sys, time
from pathlib import Path
from galatea.silence_libraries import silence_libraries
heard = Path(sys.argv[1])
with silence_libraries():
    print("within", file=sys.stderr)
    child = subprocess.Popen([sys.executable, "-c", "input(); import os; os.write(2, b'child')"], stdin=subprocess.PIPE)
with silence_libraries():
    print("again", file=sys.stderr)
child.communicate(b"go\\n")
print(child.returncode)
deadline = time.monotonic() + 60
while "child" not in heard.read_text() and time.monotonic() < deadline:
    time.sleep(0.01)
"""


def test_a_process_started_meanwhile_is_heard_after_it(tmp_path: Path) -> None:
    """It has inherited the way that standard error took: that does not end under it."""
    heard = tmp_path / "heard"
    with heard.open("w") as file:
        script = [sys.executable, "-c", CHILD, str(heard)]
        done = subprocess.run(script, cwd=ROOT, stdout=subprocess.PIPE, stderr=file, text=True, check=True)
    assert done.stdout == "0\n"
    assert heard.read_text() == "within\nagain\nchild"


USER = """
import numpy as np
import galatea

def tell(now: galatea.Progress) -> None:
    print(f"{now.fraction:4.0%} {now.stage}")

def main() -> None:
    try:
        made = galatea.animate("portrait.jpg", "happy", "out", progress=tell, strength=0.9, follow=["eyes", "mouth"], size=(640, 480))
        galatea.wake_up(np.zeros((9, 9, 3), np.uint8), made.folder, motion="dance", mask=b"", seconds=2, joints={"LeftArm": (1, 2)})
    except galatea.GalateaError as error:
        print(error.code, error.detail, error.correctable)
    else:
        print(made.path, sorted(made.artifacts), made.report["stages"], [one.message for one in made.warnings])
"""


def test_a_users_script_is_checked(tmp_path: Path) -> None:
    (tmp_path / "right.py").write_text(USER)
    (tmp_path / "wrong.py").write_text(
        USER.replace("strength=0.9", "strenght=0.9")
        .replace('motion="dance"', "motion=3")
        .replace('"mouth"]', '"nose"]')
    )
    command = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "--follow-imports=silent"]
    kept = (
        ROOT / ".mypy_cache" / "users"
    )  # what it knows of our packages and of others': it looks whether they have changed
    environment = os.environ | {"MYPYPATH": str(ROOT), "MYPY_CACHE_DIR": str(kept)}
    command += ["right.py", "wrong.py"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    found = [line for line in done.stdout.splitlines() if ": error:" in line]
    assert [line.partition(":")[0] for line in found] == ["wrong.py"] * 3, done.stdout + done.stderr
    assert any("strenght" in line for line in found), found


def test_a_persona_of_pictures_in_memory_plays_again_from_its_file(tmp_path: Path) -> None:
    photos = [Image.open(path).convert("RGB") for path in write_sample_photos(tmp_path)]
    options: dict[str, Any] = {"size": (96, 120), "trim": (0.5, 0.7), "fps": 10}
    first = galatea.make_persona(photos, "happy", tmp_path / "first", **options)
    assert first.path.name == "animation.mp4" and probe_video(first.path).frames == 2
    again = galatea.make_persona(first.artifacts["persona.npz"], poster("happy-strong"), tmp_path / "again", **options)
    assert again.path.name == "still.png"
    assert {one.code for one in again.warnings} == {
        "driver_rest_estimated",
        "no_teeth_shown",
    }  # the photos smile closed
    kept = galatea.make_persona(str(first.artifacts["persona.npz"]), None, tmp_path / "kept")
    assert kept.path.name == "persona.npz"


def test_an_avatar_of_a_clip_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(galatea.GalateaError) as caught:
        galatea.make_avatar(poster("happy"), tmp_path / "out", "walk", texture_size=1024)
    assert caught.value.code == "not_a_video"
