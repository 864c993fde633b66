"""A reactive profile, made once of a real portrait: its clips, its bridges, its document and its bundle."""

from __future__ import annotations

import json
import sys
import zipfile
from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import av
import jsonschema
import numpy as np
import pytest
from made_clip import OPENS, read_frames
from numpy.typing import NDArray

from engine.errors import Canceled, InputError
from engine.media.image import read_image
from engine.package_data import package_folder
from engine.performances import performance, video
from engine.portrait import KIND, PortraitOptions
from engine.portrait.reactive.bundle import BUNDLE_PACKAGE, SCRIPT_FILE
from engine.portrait.reactive.document import Profile, schema
from engine.portrait.reactive.states import choose_states
from engine.run import Progress, Run

pytestmark = pytest.mark.timeout(900)  # one profile is made for all

NOISE_GREY_LEVELS = 2.0
"""Grey levels, in the mean: two codings of one picture differ by less."""
CODE = "options_without_effect"

Frames = list[NDArray[np.float32]]


@dataclass
class Made:
    """What the run left, all videos decoded to brightness."""

    out: Path
    profile: Profile
    clips: dict[str, Frames]
    bridges: dict[str, Frames]
    progress: list[Progress]

    @property
    def rest(self) -> NDArray[np.float32]:
        return self.clips["idle"][0]


def brightness(path: Path) -> Frames:
    """The luma of all frames, full range."""
    with av.open(str(path)) as container:
        frames = [frame.to_ndarray()[: frame.height, : frame.width] for frame in container.decode(video=0)]
    return [(frame.astype(np.float32) - 16) * (255 / 219) for frame in frames]


@pytest.fixture(scope="module")
def made(small, media, tmp_path_factory) -> Made:
    """The idle state, and a driver of the user's own, 24 frames in which a mouth opens."""
    if not (package_folder(BUNDLE_PACKAGE) / SCRIPT_FILE).is_file():
        pytest.fail("the player is not built: run `make setup`")
    out = tmp_path_factory.mktemp("profile")
    progress: list[Progress] = []
    options = PortraitOptions(reactive=("idle",), trim=OPENS, neutral_frame=0)
    inputs = {"image": small("photo_woman_outdoor.jpg", 240), "driver": media("driving/man_mouth_open_d18.mp4")}
    with Run(on_progress=progress.append) as run:
        KIND.work(inputs, options, out, run)
    profile = Profile.model_validate_json((out / "profile.json").read_text())
    clips = {name: brightness(out / state.clip) for name, state in profile.states.items()}
    bridges = {name: brightness(out / one.bridges) for name, one in profile.transitions.items() if one.bridges}
    return Made(out, profile, clips, bridges, progress)


def apart(one: NDArray, other: NDArray) -> float:
    return float(np.abs(one - other).mean())


def energy(frame: NDArray[np.float32]) -> float:
    """Mean squared gradient: what blur takes away."""
    return float((np.diff(frame, axis=0) ** 2).mean() + (np.diff(frame, axis=1) ** 2).mean())


def test_every_clip_leaves_from_and_returns_to_the_same_rest(made: Made) -> None:
    picture = read_image(made.out / "poster.jpg").rgb.astype(np.float32) @ np.array([0.2126, 0.7152, 0.0722])
    assert apart(made.rest, picture) < 2 * NOISE_GREY_LEVELS  # a JPEG against a video, both with coarser colours
    for name, clip in made.clips.items():
        assert apart(clip[0], made.rest) < 0.01, name  # the same picture, coded in the same way
        if not made.profile.states[name].loops:
            assert apart(clip[-1], made.rest) < NOISE_GREY_LEVELS, name
        assert max(apart(frame, made.rest) for frame in clip) > 2 * NOISE_GREY_LEVELS, "and it does move between"


def test_the_idle_clip_loops_without_a_jump(made: Made) -> None:
    """Its last frame is its first, coded as one of many instead of as the first of all; and nothing in it jumps either."""
    steps = [apart(one, other) for one, other in pairwise(made.clips["idle"])]
    assert made.profile.states["idle"].loops
    assert max(apart(made.clips["idle"][-1], made.rest), *steps) < NOISE_GREY_LEVELS


def test_no_transition_jumps_or_blurs(made: Made) -> None:
    """At every frame of every clip: on to its bridge, along it to rest, and into the clip that follows. No step is larger
    than the largest inside clips by more than a fiftieth, which coding may add, and no frame has less than 95 % of its
    neighbours' gradient energy."""
    largest = 1.02 * max(apart(one, other) for clip in made.clips.values() for one, other in pairwise(clip))
    crossed = 0
    for name, clip in made.clips.items():
        way = made.profile.transitions[name]
        assert len(way.at) == len(clip) == made.profile.states[name].frames
        for frame, exit_ in enumerate(way.at):
            path = [clip[frame]]
            if exit_ >= 0:
                start, length = way.segments[exit_]
                path += made.bridges[name][start : start + length + 1]
            path.append(made.rest)
            assert max(apart(one, other) for one, other in pairwise(path)) <= largest, (name, frame)
            energies = [energy(one) for one in path]
            for before, here, after in zip(energies, energies[1:], energies[2:], strict=False):
                assert here >= 0.95 * min(before, after), (name, frame)
            crossed += exit_ >= 0
    assert crossed > 100, "most frames of a clip need a bridge"


def test_bridges_lead_to_rest_within_four_tenths_of_a_second(made: Made) -> None:
    for name, way in made.profile.transitions.items():
        for start, length in way.segments:
            assert 1 <= length <= 0.4 * made.profile.fps
            assert apart(made.bridges[name][start + length], made.rest) < NOISE_GREY_LEVELS


def test_the_document_is_what_its_schema_says(made: Made) -> None:
    document = json.loads((made.out / "profile.json").read_text())
    jsonschema.validate(document, json.loads(schema()))
    assert list(document["states"]) == ["idle", "driver"] and document["initial"] == "idle"
    assert {one["state"] for one in document["triggers"]} == {"driver"}
    assert {one["on"] for one in document["triggers"]} == {"hover", "click", "key"}
    assert tuple(document["size"]) == read_frames(made.out / "clip-idle.mp4")[0].shape[1::-1]


def test_the_published_schema_is_this_one() -> None:
    """If it is not: python -c "from engine.portrait.reactive.document import schema; print(schema(), end='')"."""
    published = Path(__file__).parents[3] / "web" / "reactive" / "profile.schema.json"
    assert published.read_text() == schema()


def test_the_bundle_holds_all_that_a_page_needs(made: Made) -> None:
    with zipfile.ZipFile(made.out / "profile.zip") as bundle:
        assert bundle.testzip() is None
        assert set(bundle.namelist()) == {
            "index.html",
            "reactive-portrait.js",
            "profile.json",
            "poster.jpg",
            *(f"{part}-{name}.mp4" for part in ("clip", "bridges") for name in made.profile.states),
        }
        assert bundle.read("clip-idle.mp4") == (made.out / "clip-idle.mp4").read_bytes()
        page = bundle.read("index.html").decode()
    assert "{{" not in page and 'data-state="driver"' in page


def test_it_is_one_run_with_one_progress(made: Made) -> None:
    fractions = [one.fraction for one in made.progress]
    assert fractions == sorted(fractions) and 0.9 < fractions[-1] <= 1
    report = json.loads((made.out / "report.json").read_text())
    assert report["inputs"]["states"] == {name: len(clip) for name, clip in made.clips.items()}
    assert sum(stage == "find_face" for stage in report["stages"]) == 1
    whole = read_frames(made.out / "animation.mp4")
    assert len(whole) == sum(map(len, made.clips.values())), "all clips one after another"


def test_by_default_there_is_one_state_of_each_kind_that_is_installed() -> None:
    states = choose_states(PortraitOptions(reactive=True), None)
    assert states[0].name == "idle" and states[0].loops
    assert {"happy", "surprise"} <= {state.name for state in states} and len(states) <= 6
    kinds = [performance(state.name).state for state in states]
    assert len(set(kinds)) == len(kinds)
    assert all(state.video.is_file() for state in states)


def test_a_built_in_driver_is_the_state_of_its_name() -> None:
    states = choose_states(PortraitOptions(reactive=("happy",)), video("surprise"))
    assert [state.name for state in states] == ["idle", "happy", "surprise"]


def test_a_performance_without_a_video_is_refused(monkeypatch, tmp_path: Path) -> None:
    options = PortraitOptions(reactive=("happy",))
    monkeypatch.setattr(sys.modules["engine.performances.catalogue"], "VIDEO_FOLDER", tmp_path)
    with pytest.raises(InputError) as caught:
        choose_states(options, None)
    assert caught.value.code == "performance_not_installed"


def test_options_of_one_s_own_driver_count_with_one_alone(made: Made, woman: Path, tmp_path: Path) -> None:
    """Of a profile without one, those that were chosen are told, before it is made; of one that has it, none was warned of."""
    options = PortraitOptions.model_validate(
        {
            "reactive": ["idle"],
            "size": [128, 128],
            "loop": True,
            "trim": [0, 1],
            "neutral_frame": 3,
            "driver_face_index": 2,
        }
    )
    begun: list[str] = []
    with Run(canceled=lambda: bool(begun), on_stage=lambda name, turn: begun.append(name)) as run, suppress(Canceled):
        KIND.work({"image": woman}, options, tmp_path, run)
    without = [notice.message for notice in run.notices if notice.code == CODE]
    assert without == ["A profile like this has no use for loop, neutral_frame, trim, driver_face_index."]
    warned = [one["code"] for one in json.loads((made.out / "report.json").read_text())["warnings"]]
    assert CODE not in warned
    told = json.loads((made.out / "landmarks.json").read_text())
    assert (told["neutral_frame"], told["frames"]) == (0, 24), "they count the driver's own frames"


@pytest.mark.parametrize(
    "options",
    [{"reactive": ["nobody"]}, {"reactive": []}, {"reactive": True, "format": "webm"}],
    ids=["unknown state", "no state", "other format"],
)
def test_options_that_make_no_profile_are_refused(options: dict) -> None:
    with pytest.raises(ValueError, match=r"there is no performance nobody|list of states is empty|made of MP4"):
        PortraitOptions.model_validate(options)
