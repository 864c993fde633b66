"""The segments of a driver: what is there is found, and what is not there is not."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from made_clip import write_frames
from numpy.typing import NDArray

from benchmarks.driver_segments import Stretch, Tally, is_right, join, judge, labels
from engine.errors import InputError
from engine.export.still import THUMBNAIL_BYTES
from engine.media.image import read_image
from engine.perception.expression.measures import MEASURES, measure
from engine.perception.face.faces import find_faces
from engine.perception.face.head_pose import canonical_face, mirror_vertices
from engine.performances import PERFORMANCE_STATES
from engine.portrait.driver_segments import find_segments
from engine.portrait.driver_segments.gestures import swings
from engine.portrait.driver_segments.pipeline import DriverSegment, named_segments, work
from engine.portrait.driver_segments.rest import distance_from_rest, own_rest
from engine.portrait.driver_segments.segments import MAX_UNREST, Segment, detect_segments
from engine.portrait.driver_segments.watching import WATCHED_FPS, FaceMeasurements, measure_video_face
from engine.run import Run
from engine.store import StageStore

Mesh = NDArray[np.floating]

UPPER_LIDS = {"right": [159, 158, 160], "left": [386, 385, 387]}
LOWER_LIDS = {"right": [145, 153, 144], "left": [374, 380, 373]}


@pytest.fixture(scope="module")
def joined(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Stretch]]:
    """A clip that shows something of everything, and what it holds."""
    path = tmp_path_factory.mktemp("joined") / "clip.mp4"
    order = ["sadness", "idle", "wink", "surprise", "talk", "fear", "nod", "anger", "happy", "shake", "anger-strong"]
    return path, join(order, path)


@pytest.fixture(scope="module")
def stages(tmp_path_factory: pytest.TempPathFactory) -> StageStore:
    """Where it is kept what was seen of the joined clip: it is watched once."""
    return StageStore(tmp_path_factory.mktemp("stages"))


@pytest.fixture(scope="module")
def watched(joined: tuple[Path, list[Stretch]], stages: StageStore) -> FaceMeasurements:
    with Run(store=stages) as run:
        return run.stage("watch", measure_video_face, joined[0], run.limits, run.tick)


@pytest.fixture(scope="module")
def found(watched: FaceMeasurements) -> tuple[DriverSegment, ...]:
    return named_segments(watched).segments


def test_everything_that_was_joined_is_found_and_nothing_else(
    joined: tuple[Path, list[Stretch]], found: tuple[DriverSegment, ...]
) -> None:
    assert judge({state: Tally() for state in PERFORMANCE_STATES}, found, joined[1]) == []
    assert [segment.name for segment in found if segment.state == "anger"] == ["anger", "anger-2"]
    strong = next(one for one in joined[1][::-1] if one.state == "anger")
    best = next(segment for segment in found if segment.name == "anger")
    assert is_right(best, strong) and best.apex > strong.start, "the clearer one comes first"


def test_segments_begin_and_end_at_rest_and_do_not_overlap(
    watched: FaceMeasurements, found: tuple[DriverSegment, ...]
) -> None:
    unresting = distance_from_rest(watched.values - own_rest(watched.values[watched.found]))
    for segment in found:
        first, last = round(segment.start * WATCHED_FPS), round(segment.end * WATCHED_FPS) - 1
        assert max(unresting[first], unresting[min(last, len(unresting) - 1)]) <= 1, segment
        assert segment.start <= segment.apex <= segment.end <= watched.seconds
        assert segment.seconds == pytest.approx(segment.end - segment.start) and 0 < segment.score <= 1
        others = [one for one in found if one.state == segment.state and one is not segment]
        assert all(one.end <= segment.start or one.start >= segment.end for one in others)
    assert len({segment.name for segment in found}) == len(found)
    assert [PERFORMANCE_STATES.index(segment.state) for segment in found] == sorted(
        PERFORMANCE_STATES.index(segment.state) for segment in found
    )


def test_a_mirrored_clip_has_the_same_segments(tmp_path: Path) -> None:
    order = ["wink", "happy"]  # one eye, and both corners of the mouth
    plain, mirrored = tmp_path / "plain.mp4", tmp_path / "mirrored.mp4"
    join(order, plain)
    join(order, mirrored, mirrored=True)
    one, other = find_segments(plain).segments, find_segments(mirrored).segments
    assert [segment.name for segment in one] == [segment.name for segment in other]
    for a, b in zip(one, other, strict=True):
        assert a.start == pytest.approx(b.start, abs=0.3) and a.end == pytest.approx(b.end, abs=0.3)


@pytest.mark.parametrize("clip", ["man_smile_d9.mp4", "woman_frown_surprise_d3.mp4"])
def test_real_people_are_understood(media: Callable[[str], Path], clip: str) -> None:
    must, may = labels()[clip]
    segments = find_segments(media(f"driving/{clip}")).segments
    assert judge({state: Tally() for state in PERFORMANCE_STATES}, segments, must, may) == []


def test_artifacts(
    joined: tuple[Path, list[Stretch]], found: tuple[DriverSegment, ...], stages: StageStore, tmp_path: Path
) -> None:
    with Run(store=stages) as run:
        work({"driver": joined[0]}, tmp_path, run)
    assert run.reused == ["watch"]
    document = json.loads((tmp_path / "moments.json").read_text())
    assert {one["state"] for one in document["moments"]} == set(PERFORMANCE_STATES)
    assert [(one["name"], one["start"]) for one in document["moments"]] == [(one.name, one.start) for one in found]
    for one in document["moments"]:
        assert read_image(tmp_path / one["poster"]).rgb.shape == (256, 256, 3)
        assert (tmp_path / one["poster"]).stat().st_size <= THUMBNAIL_BYTES, "the page shows many of them"
    rest = read_image(tmp_path / "poster.jpg").rgb
    happy = read_image(tmp_path / "happy.jpg").rgb
    quiet, smiling = (measure(find_faces(rgb)[0][None])[0] for rgb in (rest, happy))
    assert (smiling - quiet)[MEASURES.index("right_corner_up")] > 0.08, "the picture shows the smile at its height"
    assert json.loads((tmp_path / "report.json").read_text())["quality"] == {"driver_face_share": 1.0}


def test_a_video_without_a_face_is_refused(tmp_path: Path) -> None:
    frames = [np.full((128, 128, 3), shade, np.uint8) for shade in range(30)]
    with pytest.raises(InputError) as refused:
        find_segments(write_frames(tmp_path / "grey.mp4", frames))
    assert refused.value.code == "no_face_in_driver"


# Hand-made faces: the canonical one, whose vertices are moved by known lengths.


def moved(mesh: Mesh, vertices: list[int], right: float = 0.0, down: float = 0.0) -> Mesh:
    """With some vertices elsewhere, in eye distances."""
    mesh = mesh.copy()
    mesh[vertices, 0] += right
    mesh[vertices, 1] += down
    return mesh


def lids(mesh: Mesh, side: str, share: float) -> Mesh:
    """An eye opened by a share of how far it is open; -1 shuts it."""
    gap = (mesh[LOWER_LIDS[side], 1] - mesh[UPPER_LIDS[side], 1]).mean()
    return moved(mesh, UPPER_LIDS[side], down=-share * gap)


def smile(mesh: Mesh, much: float) -> Mesh:
    return moved(moved(mesh, [61], -0.08 * much, -0.14 * much), [291], 0.08 * much, -0.14 * much)


def startle(mesh: Mesh, much: float) -> Mesh:
    mesh = moved(moved(mesh, [107, 336, 70, 300], down=-0.08 * much), [14], down=0.3 * much)
    mesh = moved(mesh, [61, 291], down=0.075 * much)  # where a jaw that drops takes them
    return lids(lids(mesh, "right", 0.35 * much), "left", 0.35 * much)


def frown(mesh: Mesh, much: float) -> Mesh:
    mesh = moved(mesh, [107, 336, 70, 300], down=0.08 * much)
    return moved(moved(mesh, [55], right=0.02 * much), [285], right=-0.02 * much)


def mourn(mesh: Mesh, much: float) -> Mesh:
    mesh = moved(moved(mesh, [107, 336], down=-0.07 * much), [61, 291], down=0.07 * much)
    return lids(lids(mesh, "right", -0.25 * much), "left", -0.25 * much)


def dread(mesh: Mesh, much: float) -> Mesh:
    mesh = moved(moved(mesh, [107, 336], down=-0.06 * much), [61, 291], down=0.02 * much)
    mesh = moved(moved(mesh, [61], right=-0.03 * much), [291], right=0.03 * much)
    return lids(lids(mesh, "right", 0.4 * much), "left", 0.4 * much)


def wink(mesh: Mesh, much: float) -> Mesh:
    return lids(mesh, "left", -0.95 * much)


def blink(mesh: Mesh, much: float) -> Mesh:
    return lids(wink(mesh, much), "right", -0.95 * much)


def turned(mesh: Mesh, yaw: float = 0.0, pitch: float = 0.0) -> Mesh:
    c, s, cp, sp = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch)
    about_y = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])
    about_x = np.array([[1, 0, 0], [0, cp, sp], [0, -sp, cp]])
    return mesh @ (about_y @ about_x).T


def film(acting: Callable[[Mesh, float], Mesh], seconds: float, height: float = 1.0, noise: float = 0.0) -> Mesh:
    """Two seconds of rest, something that comes and goes within `seconds`, two seconds of rest: (N, 478, 3) pixels."""
    rest = canonical_face().astype(float)
    frames = int(seconds * WATCHED_FPS)
    course = [
        *[0.0] * int(2 * WATCHED_FPS),
        *(height * np.sin(np.pi * np.arange(frames) / frames)),
        *[0.0] * int(2 * WATCHED_FPS),
    ]
    meshes = np.array([acting(rest, float(much)) for much in course]) * 80 + (200, 220, 0)
    return meshes + noise * np.random.default_rng(5).normal(size=meshes.shape)


def told(meshes: Mesh) -> list[Segment]:
    values = measure(meshes)
    return detect_segments(values, np.ones(len(values), bool), own_rest(values), WATCHED_FPS)


ACTED = {"happy": smile, "surprise": startle, "anger": frown, "sadness": mourn, "fear": dread, "wink": wink}


@pytest.mark.parametrize("state", ACTED)
def test_a_movement_by_known_lengths_is_told(state: str) -> None:
    meshes = film(ACTED[state], 1.5)
    found = [one for one in told(meshes) if one.state != "idle"]
    assert [one.state for one in found] == [state]
    assert found[0].first / WATCHED_FPS == pytest.approx(2.0, abs=0.4) and found[0].last / WATCHED_FPS == pytest.approx(
        3.5, abs=0.4
    )
    assert found[0].apex / WATCHED_FPS == pytest.approx(2.75, abs=0.3)
    mirrored = meshes[:, mirror_vertices()] * (-1, 1, 1)
    assert [(o.state, o.first, o.last) for o in told(mirrored)] == [(o.state, o.first, o.last) for o in told(meshes)]


@pytest.mark.parametrize("state", ACTED)
def test_a_third_of_it_is_nothing(state: str) -> None:
    assert [one.state for one in told(film(ACTED[state], 1.5, height=0.33)) if one.state != "idle"] == []


def test_a_blink_is_no_wink_and_a_jaw_that_drops_no_sadness() -> None:
    assert [one.state for one in told(film(blink, 0.4)) if one.state != "idle"] == []
    yawn = film(lambda mesh, much: moved(moved(mesh, [14], down=0.5 * much), [61, 291], down=0.12 * much), 2.0)
    assert [one.state for one in told(yawn) if one.state != "idle"] == []


@pytest.mark.parametrize(("state", "axis"), [("nod", "pitch"), ("shake", "yaw")])
def test_to_and_fro_three_times_is_a_gesture_and_once_slowly_is_none(state: str, axis: str) -> None:
    def sway(times: float, seconds: float) -> list[str]:
        frames = int(seconds * WATCHED_FPS)
        angle = [*[0.0] * 24, *(0.16 * np.sin(2 * np.pi * times * np.arange(frames) / frames)), *[0.0] * 24]
        meshes = np.array([turned(canonical_face().astype(float), **{axis: one}) for one in angle]) * 80
        return [one.state for one in told(meshes) if one.state != "idle"]

    assert sway(2, 1.6) == [state]
    assert sway(0.5, 2.0) == [] and sway(1, 4.0) == []


def test_rest_is_what_the_face_comes_back_to_though_it_smiles_for_longer() -> None:
    quiet = film(lambda mesh, much: mesh, 2.0, noise=0.15)
    smiling = film(lambda mesh, much: smile(mesh, 1.0), 4.0, noise=0.15)
    values = measure(np.concatenate([quiet, smiling]))
    assert distance_from_rest((values - own_rest(values))[: len(quiet)]).max() <= 1


def test_a_segment_ends_where_the_face_is_lost() -> None:
    values = measure(film(smile, 1.5, height=1.4))
    seen = np.ones(len(values), bool)
    seen[int(3.9 * WATCHED_FPS) : int(4.3 * WATCHED_FPS)] = False
    (found,) = (one for one in detect_segments(values, seen, own_rest(values), WATCHED_FPS) if one.state == "happy")
    assert seen[found.first : found.last + 1].all()
    seen[int(2.9 * WATCHED_FPS) : int(4.3 * WATCHED_FPS)] = False
    assert [
        one.state for one in detect_segments(values, seen, own_rest(values), WATCHED_FPS) if one.state == "happy"
    ] == []


def test_swings_of_a_known_curve() -> None:
    curve = np.concatenate([np.zeros(10), np.linspace(0, 1, 6), np.linspace(1, -1, 11)[1:], np.full(8, -1.0)])
    to, fro = swings(curve, 0.5)
    assert (to.size, fro.size) == (1, 2)
    assert 9 <= to.first <= 10 and to.last in (14, 15) and 15 <= fro.first <= 16 and 23 <= fro.last <= 25


def test_a_segment_may_end_less_calmly_at_a_lower_score() -> None:
    calm, uneasy = (Segment("happy", 0, 20, 9, 2.0, rests) for rests in (0.4, MAX_UNREST))
    assert calm.score == 1 and uneasy.score == pytest.approx(1 / MAX_UNREST)
