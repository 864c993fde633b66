"""From photographs to a film of the puppet, and again from what was kept."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from engine.errors import InputError
from engine.media.image import read_image, write_image
from engine.media.video import probe_video, read_video
from engine.perception.face.faces import FaceTracker
from engine.perception.face.landmarks import mouth_opening
from engine.performances import video
from engine.persona.animating import with_composite
from engine.persona.composite.framing import framed
from engine.persona.early_average import BACKGROUND_COLOUR
from engine.persona.options import PersonaOptions
from engine.persona.persona import read_persona, write_persona
from engine.persona.pipeline import make_persona
from engine.run import Run
from engine.store import StageStore

Collection = tuple[np.ndarray, list[np.ndarray]]
OPTIONS = PersonaOptions(
    size=(160, 200), trim=(0.5, 1.1), fps=15, background=(200, 20, 20), composite="none", texture_width=97
)


@pytest.fixture(scope="module")
def whole(collection: Collection, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Everything that a run leaves, in `out`; `photos` and `stages` beside it."""
    folder = tmp_path_factory.mktemp("persona")
    (folder / "photos").mkdir()
    for number, picture in enumerate(collection[1]):
        write_image(folder / "photos" / f"{number:02}.jpg", picture)
    (folder / "photos" / "notes.jpg").write_bytes(b"no picture")
    (folder / "out").mkdir()
    photos = tuple(sorted((folder / "photos").iterdir()))
    with Run(StageStore(folder / "stages")) as run:
        make_persona({"photos": photos, "driver": video("happy")}, OPTIONS, folder / "out", run)
    return folder


def test_it_leaves_what_the_contract_names(whole: Path) -> None:
    left = {path.name for path in (whole / "out").iterdir()}
    assert left >= {"persona.npz", "animation.mp4", "average.png", "faces.json", "faces.jpg"}
    assert left >= {"report.json", "preview.jpg", "thumbnail.jpg", "poster.jpg"}
    report = json.loads((whole / "out/report.json").read_text())
    assert report["kind"] == "persona" and report["inputs"]["files_skipped"] == 1
    assert report["inputs"]["photos_used"] >= 15 and report["inputs"]["frames"] == 9
    faces = json.loads((whole / "out/faces.json").read_text())
    assert sum(face["kept"] for face in faces["faces"]) == report["inputs"]["photos_used"]
    assert sum(report["inputs"]["left_out"].values()) == sum(not face["kept"] for face in faces["faces"])
    assert faces["skipped"] == [{"file": "notes.jpg", "code": "not_an_image"}]
    sheet = read_image(whole / "out/faces.jpg").rgb
    assert sheet.shape[1] == faces["tile"] * faces["columns"]


def test_the_average_is_the_face_alone_on_a_plain_background(whole: Path) -> None:
    average = read_image(whole / "out/average.png").rgb
    plain = (average == BACKGROUND_COLOUR).all(axis=-1)
    assert plain[:3].all() and plain[-3:].all() and plain[:, :3].all() and plain[:, -3:].all()
    height, width = plain.shape
    assert not plain[height // 3 : 2 * height // 3, width // 3 : 2 * width // 3].any()


def test_the_film_shows_the_face_on_its_background_and_moving(whole: Path) -> None:
    film = whole / "out/animation.mp4"
    assert (probe_video(film).width, probe_video(film).height) == (160, 200)
    frames = np.array([frame.rgb for frame in read_video(film)]).astype(int)
    assert len(frames) == 9
    corners = frames[:, [2, 2, -3, -3], [2, -3, 2, -3]]
    assert np.abs(corners - (200, 20, 20)).max() < 25
    middle = frames[:, 60:140, 50:110]
    assert (np.abs(middle - (200, 20, 20)).sum(axis=-1) > 60).mean() > 0.95, "skin"
    assert 0.3 < np.abs(np.diff(middle, axis=0)).mean() < 25


def test_the_same_again_is_taken_from_what_was_stored(whole: Path, tmp_path: Path) -> None:
    photos = tuple(sorted((whole / "photos").iterdir()))
    with Run(StageStore(whole / "stages")) as run:
        make_persona({"photos": photos}, OPTIONS, tmp_path, run)
    assert {"read_photos", "find_faces", "learn_persona"} <= set(run.reused)
    assert (tmp_path / "poster.jpg").exists() and not (tmp_path / "animation.mp4").exists()


def test_what_was_kept_is_driven_without_photographs(whole: Path, tmp_path: Path) -> None:
    options = OPTIONS.model_copy(update={"composite": "side_by_side"})
    kept = tmp_path / "kept.npz"
    np.savez(kept, **np.load(whole / "out/persona.npz"))
    with Run() as run:
        make_persona({"persona": kept, "driver": video("happy")}, options, tmp_path, run)
    assert (tmp_path / "persona.npz").read_bytes() == kept.read_bytes(), "it is handed on as it is"
    frames = [frame.rgb for frame in read_video(tmp_path / "animation.mp4")]
    assert len(frames) == 9 and frames[0].shape == (200, 360, 3)
    driver = [frame.rgb for frame in read_video(video("happy"), 15, (0.5, 1.1))]
    for one, filmed in zip(frames, driver, strict=True):
        left = cv2.resize(filmed, (200, 200), interpolation=cv2.INTER_AREA)
        assert np.abs(one[:, :200].astype(int) - left).mean() < 6, "the driver's same instant"
        assert np.abs(one[5:10, 205:210].astype(int) - (200, 20, 20)).max() < 30


def test_left_out_faces_are_not_used(whole: Path, tmp_path: Path) -> None:
    photos = tuple(sorted((whole / "photos").iterdir()))
    options = OPTIONS.model_copy(update={"leave_out": (0, 3)})
    with Run(StageStore(whole / "stages")) as run:
        make_persona({"photos": photos}, options, tmp_path, run)
    faces = json.loads((tmp_path / "faces.json").read_text())["faces"]
    assert [faces[k]["reason"] for k in (0, 3)] == ["left_out", "left_out"]


def test_photos_of_the_driver_tell_what_it_is_like_at_rest(whole: Path, tmp_path: Path) -> None:
    photos = tuple(sorted((whole / "photos").glob("[01]*.jpg")))
    laughing = OPTIONS.model_copy(update={"trim": (1.0, 1.2), "size": (300, 400)})  # a driver that is never at rest
    inputs = {"persona": whole / "out/persona.npz", "driver": video("happy-strong")}
    openings: list[float] = []
    for given in (inputs, inputs | {"driver_photos": photos}):
        out = tmp_path / str(len(openings))
        out.mkdir()
        with Run(StageStore(whole / "stages")) as run:
            make_persona(given, laughing, out, run)
        with FaceTracker(alone=True) as tracker:
            openings.append(float(mouth_opening(tracker(next(iter(read_video(out / "animation.mp4"))).rgb)[0])))
    assert openings[0] < 0.1 < openings[1] - 0.05, "the laugh is played, and not taken for the face at rest"


def test_too_few_photos_of_the_driver_are_refused(whole: Path, tmp_path: Path) -> None:
    photos = tuple(sorted((whole / "photos").glob("0*.jpg")))[:4]
    inputs = {"persona": whole / "out/persona.npz", "driver": video("happy"), "driver_photos": photos}
    with Run() as run, pytest.raises(InputError) as error:
        make_persona(inputs, OPTIONS, tmp_path, run)
    assert error.value.code == "too_few_driver_photos" and error.value.correctable == ("driver_photos",)


def test_a_persona_may_be_driven_where_it_lies(whole: Path, tmp_path: Path) -> None:
    kept = tmp_path / "persona.npz"
    kept.write_bytes((whole / "out/persona.npz").read_bytes())
    with Run() as run:
        make_persona({"persona": kept, "driver": video("happy")}, OPTIONS, tmp_path, run)
    assert (tmp_path / "animation.mp4").exists() and len(read_persona(kept)) > 0


@pytest.mark.parametrize("composite", ["none", "photo"])
def test_a_picture_gives_its_expression(whole: Path, tmp_path: Path, composite: str) -> None:
    openings, persona = [], whole / "out/persona.npz"
    options = PersonaOptions.model_validate({"size": (300, 400), "composite": composite})
    for number in (0, 20):  # at rest, and greatly surprised
        (out := tmp_path / str(number)).mkdir()
        picture = whole / f"photos/{number:02}.jpg"
        with Run() as run:
            make_persona({"persona": persona, "driver": picture}, options, out, run)
        assert {notice.code for notice in run.notices} - {"no_teeth_shown", "head_cut"} == {"driver_rest_estimated"}
        with FaceTracker(alone=True) as tracker:
            openings.append(float(mouth_opening(tracker(read_image(out / "still.png").rgb)[0])))
        assert not (out / "animation.mp4").exists()
    assert openings[0] < 0.1 < openings[1] - 0.1, "shut, and open"


def test_the_puppet_stands_before_a_picture_of_ones_own(whole: Path, tmp_path: Path) -> None:
    sky = tmp_path / "sky.png"
    write_image(sky, np.full((90, 160, 3), (90, 140, 220), np.uint8))
    inputs = {"persona": whole / "out/persona.npz", "driver": whole / "photos/00.jpg", "background_picture": sky}
    with Run() as run:
        make_persona(inputs, OPTIONS.model_copy(update={"composite": "auto", "size": (150, 200)}), tmp_path, run)
    still = read_image(tmp_path / "still.png").rgb
    assert still.shape == (200, 150, 3)
    assert np.abs(still[:8, :8].astype(int) - (90, 140, 220)).max() <= 3
    assert np.abs(still[80:120, 60:90].astype(int) - (90, 140, 220)).mean() > 30, "before it is the puppet"


def test_a_picture_without_a_face_is_refused(whole: Path, tmp_path: Path) -> None:
    write_image(tmp_path / "sky.png", np.full((200, 300, 3), (90, 140, 220), np.uint8))
    inputs = {"persona": whole / "out/persona.npz", "driver": tmp_path / "sky.png"}
    with Run() as run, pytest.raises(InputError) as error:
        make_persona(inputs, OPTIONS, tmp_path, run)
    assert error.value.code == "no_face_in_driver"


def test_a_kept_persona_acts_as_its_photograph_shows_it(whole: Path, tmp_path: Path) -> None:
    options = OPTIONS.model_copy(update={"composite": "photo", "size": (150, 200)})
    with Run() as run:
        make_persona({"persona": whole / "out/persona.npz", "driver": video("happy")}, options, tmp_path, run)
    frames = np.array([frame.rgb for frame in read_video(tmp_path / "animation.mp4")]).astype(int)
    report = json.loads((tmp_path / "report.json").read_text())
    assert frames.shape == (9, *report["inputs"]["size"][::-1], 3)
    portrait = read_persona(whole / "out/persona.npz").portrait
    assert portrait is not None
    target = framed(portrait, (150, 200))
    corner = np.s_[:20, :20]
    assert np.abs(frames[:, *corner] - target.rgb[corner]).mean() < 6, "its own surroundings"
    x, y = np.rint(target.mesh[1, :2]).astype(int)
    middle = np.s_[y - 30 : y + 40, x - 25 : x + 25]
    assert np.abs(frames[report["inputs"]["rest_frame"]][middle] - target.rgb[middle]).mean() < 8
    assert np.abs(np.diff(frames[:, *middle], axis=0)).mean() > 0.2


def test_the_photograph_can_be_chosen(whole: Path, tmp_path: Path) -> None:
    photos = tuple(sorted((whole / "photos").iterdir()))
    used = [n for n, face in enumerate(json.loads((whole / "out/faces.json").read_text())["faces"]) if face["kept"]]
    with Run(StageStore(whole / "stages")) as run:
        make_persona({"photos": photos}, OPTIONS.model_copy(update={"photo": used[3]}), tmp_path, run)
    portrait = read_persona(tmp_path / "persona.npz").portrait
    assert portrait is not None and portrait.number == 3
    for change, code in (({"photo": 999}, "photo_not_used"), ({"photo": 0, "leave_out": (0,)}, "photo_not_used")):
        with Run(StageStore(whole / "stages")) as run, pytest.raises(InputError) as refused:
            make_persona({"photos": photos}, OPTIONS.model_copy(update=change), tmp_path, run)
        assert refused.value.code == code


def test_photographs_are_left_in_the_average_light(whole: Path, tmp_path: Path) -> None:
    photos = tuple(sorted((whole / "photos").iterdir()))
    used = [n for n, face in enumerate(json.loads((whole / "out/faces.json").read_text())["faces"]) if face["kept"]]
    with Run(StageStore(whole / "stages")) as run:
        make_persona(
            {"photos": photos}, OPTIONS.model_copy(update={"average_light": (used[2], used[5])}), tmp_path, run
        )
    left = {path.name for path in tmp_path.glob("average_light_*.png")}
    assert left == {f"average_light_{used[2]}.png", f"average_light_{used[5]}.png"}
    persona = read_persona(tmp_path / "persona.npz")
    write_persona(tmp_path / "kept.npz", persona)
    given: tuple[tuple[dict, str], ...] = (
        ({"photos": photos}, "photo_not_used"),
        ({"persona": tmp_path / "kept.npz"}, "photo_needs_photos"),
    )
    for inputs, code in given:
        with Run(StageStore(whole / "stages")) as run, pytest.raises(InputError) as refused:
            make_persona(inputs, OPTIONS.model_copy(update={"average_light": (999,)}), tmp_path, run)
        assert refused.value.code == code and refused.value.correctable[0] == "average_light"


def test_without_photographs_no_other_one_can_be_chosen(whole: Path, tmp_path: Path) -> None:
    with Run() as run, pytest.raises(InputError) as refused:
        make_persona({"persona": whole / "out/persona.npz"}, OPTIONS.model_copy(update={"photo": 1}), tmp_path, run)
    assert refused.value.code == "photo_needs_photos"


def test_a_persona_whose_photographs_all_cut_the_head_cannot_act_as_one(whole: Path, tmp_path: Path) -> None:
    persona = replace(read_persona(whole / "out/persona.npz"), portrait=None, teeth=None)
    write_persona(tmp_path / "persona.npz", persona)
    given = {"persona": tmp_path / "persona.npz", "driver": video("happy")}
    with Run() as run, pytest.raises(InputError) as refused:
        make_persona(given, OPTIONS.model_copy(update={"composite": "photo"}), tmp_path, run)
    assert refused.value.code == "no_portrait_photo"


def test_by_itself_the_person_is_seen_where_a_photograph_shows_a_head(whole: Path, tmp_path: Path) -> None:
    persona = read_persona(whole / "out/persona.npz")
    auto = OPTIONS.model_copy(update={"composite": "auto"})
    without = replace(persona, portrait=None)
    for shown, behind, expected in ((persona, False, "photo"), (without, False, "none"), (persona, True, "none")):
        with Run() as run:
            assert with_composite(auto, shown, behind, run).composite == expected
        assert [notice.code for notice in run.notices] == (["puppet_alone"] if shown is without else [])
