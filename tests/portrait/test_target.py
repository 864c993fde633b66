"""The target: which face, at which size, and when it cannot be used."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from made_face import placed
from numpy.typing import NDArray

from engine.errors import InputError
from engine.face_animation.warping.layers import separate_layers
from engine.media.image import read_image, write_image
from engine.media.limits import Limits
from engine.perception.expression.features import measure_expression
from engine.perception.face.faces import find_faces
from engine.perception.face.landmarks import eye_distance, eye_opening, fiducials, mouth_opening
from engine.portrait.options import PortraitOptions
from engine.portrait.target import (
    MAX_PICTURE_SIDE_PIXELS,
    MAX_TARGET_TURN_DEGREES,
    MIN_TARGET_EYE_DISTANCE_PIXELS,
    TargetFace,
    find_target_face,
    share_inside,
)

Small = Callable[[str, int], Path]


def find(path: Path, codes: list[str] | None = None, **options: object) -> TargetFace:
    seen = codes if codes is not None else []
    return find_target_face(path, PortraitOptions(**options), Limits(), lambda code, message: seen.append(code))


def refusal(path: Path, **options: object) -> InputError:
    with pytest.raises(InputError) as caught:
        find(path, **options)
    return caught.value


@pytest.fixture(scope="module")
def woman(small: Small) -> Path:
    return small("photo_woman_outdoor.jpg", 320)


@pytest.fixture(scope="module")
def whole(woman: Path) -> TargetFace:
    return find(woman)


@pytest.fixture(scope="module")
def scan(media):
    from benchmarks.known_truth.head_scan import read_head_scan

    return read_head_scan(media("scans3d/head_lee_perry_smith/head.obj").parent)


def apart(a: NDArray, b: NDArray) -> float:
    return float(np.linalg.norm(fiducials(a)[:, :2] - fiducials(b)[:, :2], axis=1).mean())


def test_a_portrait_has_its_own_size_and_one_face(whole: TargetFace, woman: Path) -> None:
    picture = read_image(woman).rgb
    np.testing.assert_array_equal(whole.rgb, picture)
    assert whole.original_size == picture.shape[1::-1]
    assert whole.faces.shape == (1, 4)
    x, y, w, h = whole.faces[0]
    assert (np.abs(whole.mesh[:, 0] - x - w / 2) <= w / 2 + 0.01).all()
    assert (np.abs(whole.mesh[:, 1] - y - h / 2) <= h / 2 + 0.01).all()
    assert whole.alpha is None


def test_no_face_is_refused_and_says_what_helps(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    blotches = cv2.GaussianBlur(rng.normal(128, 400, (240, 200, 3)), (0, 0), 8)
    write_image(tmp_path / "blotches.png", np.clip(blotches, 0, 255).astype(np.uint8))
    error = refusal(tmp_path / "blotches.png")
    assert error.code == "no_face"
    assert error.correctable == ("landmarks", "crop")
    assert "landmarks" in error.detail and "crop" in error.detail


@pytest.mark.parametrize("yaw", [-90, 180])
def test_in_profile_or_from_behind_no_face_is_found(scan, yaw: int, tmp_path: Path) -> None:
    from benchmarks.known_truth.head_scan import render_head

    picture, _ = render_head(scan, yaw, (240, 288), zoom=1.5, shoulders=True)
    write_image(tmp_path / "head.png", picture)
    assert refusal(tmp_path / "head.png").code == "no_face"


@pytest.mark.parametrize("yaw", [-55, 50])
def test_a_face_turned_too_far_is_refused_with_its_angle(scan, yaw: int, tmp_path: Path) -> None:
    from benchmarks.known_truth.head_scan import render_head

    picture, _ = render_head(scan, yaw, (240, 288), zoom=1.5, shoulders=True)
    write_image(tmp_path / "head.png", picture)
    error = refusal(tmp_path / "head.png")
    assert error.code == "face_too_turned"
    assert any(str(a) in error.detail for a in range(int(MAX_TARGET_TURN_DEGREES[0]), 75))


@pytest.mark.parametrize(("yaw", "warned"), [(0, False), (-22, True), (25, True)])
def test_a_slightly_turned_face_is_taken_with_a_warning(scan, yaw: int, warned: bool, tmp_path: Path) -> None:
    from benchmarks.known_truth.head_scan import render_head

    picture, _ = render_head(scan, yaw, (240, 288), zoom=1.5, shoulders=True)
    write_image(tmp_path / "head.png", picture)
    codes: list[str] = []
    find(tmp_path / "head.png", codes)
    assert codes == [*["target_not_neutral"] * warned, "eyes_shut"]  # the scanned man's are


@pytest.mark.parametrize(
    ("name", "smiles"),
    [
        ("pair1_smile.png", True),
        ("photo_man_suit.png", True),
        ("pair1_neutral.png", False),
        ("photo_bw_dylan.jpg", False),
        ("painting_man_cap.png", False),
        ("drawing_young_man.png", False),
        ("cartoon_boy_3d.jpg", False),
    ],
)
def test_a_smile_is_told_with_open_or_closed_lips(small: Small, name: str, smiles: bool) -> None:
    codes: list[str] = []
    find(small(name, 320), codes)
    assert codes == (["target_not_neutral"] if smiles else [])


def test_a_turn_does_not_change_the_measured_smile(small: Small) -> None:
    (mesh,) = find_faces(read_image(small("pair1_smile.png", 320)).rgb)
    straight, turned = measure_expression(
        np.stack([mesh, mesh @ cv2.Rodrigues(np.array([0.3, -0.5, 0.2]))[0].astype("f4")])
    )
    np.testing.assert_allclose(turned[1:5], straight[1:5], atol=1e-4)  # lengths, in eye distances


def test_a_mouth_open_too_wide_is_refused_unless_placed_by_hand(clip, tmp_path: Path) -> None:
    shout = clip("man_mouth_open_d18.mp4", 2.7, 2.8)[0]
    write_image(tmp_path / "shout.png", shout)
    error = refusal(tmp_path / "shout.png")
    assert error.code == "mouth_too_open" and "landmarks" in error.correctable
    (mesh,) = find_faces(shout)
    assert mouth_opening(mesh) > 0.7
    placed_by_hand = [tuple(map(float, point)) for point in fiducials(mesh)[:, :2]]
    assert find(tmp_path / "shout.png", landmarks=placed_by_hand).rgb.shape == shout.shape


def test_shut_eyes_are_told(clip, tmp_path: Path) -> None:
    frames = clip("woman_talk_aoc.mp4", 1.9, 2.4)
    opening = [eye_opening(find_faces(frame)[0]).min() for frame in frames]
    for name, frame in (("blink", frames[int(np.argmin(opening))]), ("open", frames[int(np.argmax(opening))])):
        write_image(tmp_path / f"{name}.png", frame)
        codes: list[str] = []
        find(tmp_path / f"{name}.png", codes)
        assert ("eyes_shut" in codes) == (name == "blink")


def test_a_laugh_is_not_too_wide(small: Small) -> None:
    codes: list[str] = []
    laugh = find(small("photo_woman_smile_450.jpg", 320), codes)
    assert mouth_opening(laugh.mesh) > 0.1 and codes == ["target_not_neutral"]


def test_a_tiny_face_is_refused(woman: Path, tmp_path: Path) -> None:
    picture = read_image(woman).rgb
    tiny = cv2.resize(picture, (46, 46), interpolation=cv2.INTER_AREA)
    wide = np.full((400, 500, 3), 120, np.uint8)
    wide[150:196, 200:246] = tiny
    write_image(tmp_path / "tiny.png", wide)
    assert refusal(tmp_path / "tiny.png").code == "no_face", "too small to be found at all"
    small = cv2.resize(picture, (72, 72), interpolation=cv2.INTER_AREA)
    write_image(tmp_path / "small.png", small)
    assert refusal(tmp_path / "small.png", size=(64, 64)).code == "face_too_small"


def test_the_least_face_is_measured_in_the_result(woman: Path, whole: TargetFace) -> None:
    """A face large enough in the picture is too small if the result is."""
    unit = float(eye_distance(whole.mesh[:, :2]))
    side = round(320 * MIN_TARGET_EYE_DISTANCE_PIXELS / unit)
    assert refusal(woman, size=(side - 8, side - 8)).code == "face_too_small"
    assert find(woman, size=(side + 8, side + 8)).mesh.shape == (478, 3)


@pytest.fixture(scope="module")
def couple(small: Small, tmp_path_factory) -> Path:
    """Two faces: the left one larger."""
    left, right = (
        read_image(small(n, s)).rgb for n, s in (("photo_woman_outdoor.jpg", 320), ("photo_bw_einstein.jpg", 240))
    )
    both = np.full((320, 320 + right.shape[1], 3), 128, np.uint8)
    both[:, :320] = left
    both[: right.shape[0], 320:] = right
    path = tmp_path_factory.mktemp("target") / "couple.png"
    write_image(path, both)
    return path


def test_of_several_faces_the_largest_is_taken_and_all_are_listed(couple: Path) -> None:
    target = find(couple)
    assert len(target.faces) == 2
    assert np.prod(target.faces[0, 2:]) > np.prod(target.faces[1, 2:])
    assert target.mesh[4, 0] < 320


def test_face_index_chooses(couple: Path) -> None:
    assert find(couple, face_index=1).mesh[4, 0] > 320
    error = refusal(couple, face_index=2)
    assert error.code == "face_index_out_of_range" and "2 face" in error.detail
    (x, y, width, height), _ = error.found["faces"]
    middle = find(couple).mesh[4]
    assert x < middle[0] < x + width and y < middle[1] < y + height


def test_size_scales_the_picture_to_fit(whole: TargetFace, woman: Path) -> None:
    target = find(woman, size=(200, 160))
    assert target.rgb.shape == (160, 160, 3)
    np.testing.assert_allclose((target.mesh[:, :2] + 0.5) * 2, whole.mesh[:, :2] + 0.5, atol=1e-2)
    expected = cv2.resize(whole.rgb, (160, 160), interpolation=cv2.INTER_AREA)
    assert np.abs(target.rgb.astype(int) - expected).mean() < 2


def test_a_large_picture_is_brought_to_the_default_limit_with_even_sides(woman: Path, tmp_path: Path) -> None:
    picture = cv2.resize(read_image(woman).rgb, (2401, 2001), interpolation=cv2.INTER_LINEAR)
    write_image(tmp_path / "large.jpg", picture)
    target = find(tmp_path / "large.jpg")
    assert target.rgb.shape == (1600, MAX_PICTURE_SIDE_PIXELS, 3)


@pytest.mark.parametrize(("side", "even"), [((321, 301), (320, 300)), ((320, 299), (320, 300))])
def test_odd_sides_become_even(woman: Path, tmp_path: Path, side: tuple[int, int], even: tuple[int, int]) -> None:
    write_image(tmp_path / "odd.png", cv2.resize(read_image(woman).rgb, side))
    shape = find(tmp_path / "odd.png").rgb.shape
    assert (shape[1] % 2, shape[0] % 2) == (0, 0)
    assert abs(shape[1] - even[0]) <= 2 and abs(shape[0] - even[1]) <= 2


def test_a_crop_by_numbers_is_that_part(whole: TargetFace, woman: Path) -> None:
    x, y, w, h = 40, 20, 220, 260
    target = find(woman, crop=(x, y, w, h))
    np.testing.assert_array_equal(target.rgb, whole.rgb[y : y + h, x : x + w])
    np.testing.assert_allclose(target.mesh[:, :2] + (x, y), whole.mesh[:, :2], atol=1e-3)


def test_a_crop_reaching_out_is_cut_at_the_picture(woman: Path, whole: TargetFace) -> None:
    target = find(woman, crop=(-50, -50, 350, 350))
    np.testing.assert_array_equal(target.rgb, whole.rgb[:300, :300])


@pytest.mark.parametrize("crop", [(1000, 0, 100, 100), (0, 0, 5, 300), (319, 319, 80, 80)])
def test_a_crop_outside_is_refused(woman: Path, crop: tuple[float, ...]) -> None:
    assert refusal(woman, crop=crop).code == "crop_outside"


@pytest.mark.parametrize("crop", [(0, 300, 320, 20), (0, 0, 40, 40)])
def test_a_crop_without_the_face_is_refused(woman: Path, crop: tuple[float, ...]) -> None:
    error = refusal(woman, crop=crop)
    assert (error.code, error.correctable) == ("crop_outside", ("crop",))


def test_landmarks_by_hand_say_whose_face_it_is(couple: Path) -> None:
    """A revision of a job that chose the second face may place landmarks; that another one is meant is told."""
    second = fiducials(find(couple, face_index=1).mesh[:, :2])
    landmarks = tuple(map(tuple, second.tolist()))
    for index, told in ((0, []), (1, []), (2, ["face_index_ignored"])):
        codes: list[str] = []
        placed = find(couple, codes, face_index=index, landmarks=landmarks)
        np.testing.assert_allclose(fiducials(placed.mesh[:, :2]), second, atol=2)
        assert [code for code in codes if code != "target_not_neutral"] == told


def test_others_are_listed_beside_the_placed_face(couple: Path) -> None:
    """In their order: the placed one where it was found, or last where nothing was found."""
    found = find(couple)
    for index in (0, 1):
        placed = fiducials(find(couple, face_index=index).mesh[:, :2])
        target = find(couple, landmarks=tuple(map(tuple, placed.tolist())))
        np.testing.assert_allclose(target.faces, found.faces, atol=12)  # the forehead has no landmarks
    nowhere = fiducials(found.mesh[:, :2])
    nowhere = (nowhere - nowhere.mean(axis=0)) * 0.3 + (470, 285)
    target = find(couple, landmarks=tuple(map(tuple, nowhere.tolist())))
    np.testing.assert_array_equal(target.faces[:2], found.faces)
    own, others = target.face_boxes()
    assert len(target.faces) == 3 and len(others) == 2
    np.testing.assert_allclose(own, target.faces[2], atol=1e-3)


@pytest.fixture(scope="module")
def crowd(small: Small, tmp_path_factory) -> Path:
    """4000 x 3000 pixels: a large face on the left, and one on the right of 30 pixels."""
    picture = np.full((3000, 4000, 3), 128, np.uint8)
    large = cv2.resize(read_image(small("photo_man_suit.png", 640)).rgb, None, fx=4, fy=4)
    tiny = read_image(small("photo_woman_white.png", 100)).rgb
    picture[300 : 300 + large.shape[0], 100 : 100 + large.shape[1]] = large
    picture[1300 : 1300 + tiny.shape[0], 3300 : 3300 + tiny.shape[1]] = tiny
    path = tmp_path_factory.mktemp("target") / "crowd.png"
    write_image(path, picture)
    return path


def test_a_crop_finds_who_is_tiny_in_the_picture(crowd: Path) -> None:
    """The crop's own size counts, and what lies beside it does not."""
    whole = find(crowd)
    assert len(whole.faces) == 1 and whole.faces[0, 0] < 2000
    crop = (3260, 1260, 200, 200)
    target = find(crowd, crop=crop, size=(400, 400))
    (box,) = target.faces
    assert 3300 < box[0] < 3400 and 1300 < box[1] < 1400 and 25 < box[2] < 40
    np.testing.assert_allclose(target.face_boxes()[0], [*(box[:2] - crop[:2]) * 2, *box[2:] * 2], atol=6)


def test_a_crop_around_the_second_person_means_that_one(couple: Path) -> None:
    second = find(couple, face_index=1)
    target = find(couple, crop=(320, 0, 240, 240))
    assert len(target.faces) == 1
    assert apart(target.mesh + np.array([320, 0, 0]), second.mesh) < 1.0
    error = refusal(couple, crop=(320, 0, 240, 240), face_index=1)
    assert (
        error.code == "face_index_out_of_range" and "crop shows 1 face" in error.detail and "crop" in error.correctable
    )


def test_named_crops_hold_the_face_and_differ(woman: Path) -> None:
    face, bust = find(woman, crop="face"), find(woman, crop="bust")
    for target in (face, bust):
        height, width = target.rgb.shape[:2]
        assert ((target.mesh[:, :2] >= 0) & (target.mesh[:, :2] < (width, height))).all()
        assert target.rgb.shape[0] % 2 == target.rgb.shape[1] % 2 == 0
    share = [float(np.ptp(t.mesh[:, 1])) / t.rgb.shape[0] for t in (face, bust)]
    assert share[0] > share[1]


def emoji() -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """A yellow disk with two eyes and a mouth, and where its 68 landmarks are."""
    picture = np.full((300, 300, 3), 255, np.uint8)
    cv2.circle(picture, (150, 150), 120, (255, 205, 60), -1, cv2.LINE_AA)
    landmarks = fiducials(placed(80, (150, 118)))[:, :2].astype(float)
    for eye in (slice(36, 42), slice(42, 48)):
        centre = landmarks[eye].mean(axis=0).round().astype(int)
        cv2.ellipse(picture, centre.tolist(), (14, 22), 0, 0, 360, (70, 40, 10), -1, cv2.LINE_AA)
        landmarks[eye, 1] = centre[1] + (landmarks[eye, 1] - centre[1]) * 2.5
    cv2.ellipse(picture, (150, 200), (50, 12), 0, 0, 360, (90, 40, 20), -1, cv2.LINE_AA)
    return picture, landmarks


def test_a_drawn_emoji_is_taken_by_placed_landmarks(tmp_path: Path) -> None:
    picture, landmarks = emoji()
    write_image(tmp_path / "emoji.png", picture)
    assert refusal(tmp_path / "emoji.png").code == "no_face"
    target = find(tmp_path / "emoji.png", landmarks=tuple(map(tuple, landmarks)))
    assert np.abs(fiducials(target.mesh)[:, :2] - landmarks).max() < 1.0
    half = find(tmp_path / "emoji.png", landmarks=tuple(map(tuple, landmarks)), size=(150, 150))
    assert np.abs((fiducials(half.mesh)[:, :2] + 0.5) * 2 - 0.5 - landmarks).max() < 2.0


def test_placed_landmarks_win_over_detected_ones(woman: Path, whole: TargetFace) -> None:
    moved = fiducials(whole.mesh)[:, :2] + np.array([6.0, -4.0])
    target = find(woman, landmarks=tuple(map(tuple, moved.tolist())))
    assert apart(target.mesh, whole.mesh + np.array([6, -4, 0])) < 1.0


def test_landmarks_that_are_no_face_are_refused(woman: Path) -> None:
    error = refusal(woman, landmarks=((5.0, 5.0),) * 68)
    assert error.code == "landmarks_invalid" and error.correctable == ("landmarks",)


@pytest.mark.parametrize(("scale", "shift"), [(1, (2000, 0)), (1, (-300, -300)), (20, (0, 0)), (1, (0, -220))], ids=str)
def test_landmarks_beside_the_picture_are_refused(
    woman: Path, whole: TargetFace, scale: float, shift: tuple[float, float]
) -> None:
    points = fiducials(whole.mesh[:, :2])
    points = (points - points.mean(axis=0)) * scale + points.mean(axis=0) + shift
    error = refusal(woman, landmarks=tuple(map(tuple, points.tolist())))
    assert error.code == "landmarks_invalid" and error.correctable == ("landmarks",)
    assert "outside of the picture" in error.detail


def test_how_much_of_a_face_is_inside() -> None:
    mesh = placed(60, (150, 118))
    (left, top), (right, bottom) = mesh[:, :2].min(axis=0), mesh[:, :2].max(axis=0)
    middle = (float((left + right) / 2), float((top + bottom) / 2))
    assert share_inside(mesh, (300, 300)) == pytest.approx(1)
    assert share_inside(mesh, (round(middle[0]), 300)) == pytest.approx(0.5, abs=0.02)
    assert share_inside(mesh - [middle[0], 0, 0], (300, 300)) == pytest.approx(0.5, abs=0.02)
    assert share_inside(mesh - [1000, 0, 0], (300, 300)) == 0
    assert share_inside(20 * mesh, (300, 300)) < 0.05


@pytest.mark.parametrize(("part", "told"), [(1.0, False), (0.75, True), (0.6, True)])
def test_a_face_that_the_picture_cuts_is_told(
    woman: Path, whole: TargetFace, part: float, told: bool, tmp_path: Path
) -> None:
    """So is one that a crop cuts: what moves in from there is not known."""
    left, right = float(whole.mesh[:, 0].min()), float(whole.mesh[:, 0].max())
    width = round(left + part * (right - left)) + 4
    write_image(tmp_path / "cut.png", np.ascontiguousarray(read_image(woman).rgb[:, :width]))
    codes: list[str] = []
    find(tmp_path / "cut.png", codes)
    assert ("face_cut" in codes) == told
    codes.clear()
    find(woman, codes, crop=(0, 0, width, 320))
    assert ("face_cut" in codes) == told


def test_a_cut_out_keeps_its_alpha(woman: Path, tmp_path: Path) -> None:
    rgb = read_image(woman).rgb
    alpha = np.zeros(rgb.shape[:2], np.float32)
    cv2.ellipse(alpha, (160, 180), (120, 140), 0, 0, 360, 1.0, -1, cv2.LINE_AA)
    garbage = rgb.copy()
    garbage[alpha == 0] = (255, 0, 255)
    write_image(tmp_path / "cut.png", garbage, alpha)
    target = find(tmp_path / "cut.png")
    assert target.alpha is not None
    np.testing.assert_allclose(target.alpha, alpha, atol=0.01)
    layers = separate_layers(target)
    np.testing.assert_allclose(layers.person[..., 3] / 255, alpha, atol=0.02)
    assert layers.transparent


def test_layers_put_together_are_the_picture(whole: TargetFace) -> None:
    """The person over the plate is what was there: nothing is lost or doubled at hair and shoulders."""
    layers = separate_layers(whole)
    alpha = layers.person[..., 3:].astype(float) / 255
    again = alpha * layers.person[..., :3] + (1 - alpha) * layers.plate
    assert np.abs(again - whole.rgb).mean() < 1.0
    assert np.quantile(np.abs(again - whole.rgb), 0.99) < 20  # single strands of hair
    x, y = whole.mesh[4, :2].round().astype(int)
    assert alpha[y, x] == 1
    background = cv2.erode((alpha[..., 0] == 0).astype(np.uint8), np.ones((5, 5))) > 0
    np.testing.assert_array_equal(layers.plate[background], whole.rgb[background])
    assert not layers.transparent


def test_people_are_looked_for_in_whole_pictures_alone(whole: TargetFace, woman: Path) -> None:
    """What was believed beforehand gives the mask that it gives when it is asked for later."""
    assert whole.people is not None and find(woman, crop="face").people is None
    asked = separate_layers(replace(whole, people=None))
    np.testing.assert_array_equal(asked.person, separate_layers(whole).person)


@pytest.mark.parametrize(
    ("content", "code"),
    [(b"", "file_empty"), (b"no picture at all" * 20, "not_an_image"), (b"\x89PNG\r\n\x1a\n" + b"\0" * 40, None)],
)
def test_broken_files_are_refused(tmp_path: Path, content: bytes, code: str | None) -> None:
    (tmp_path / "broken.png").write_bytes(content)
    error = refusal(tmp_path / "broken.png")
    assert code is None or error.code == code
