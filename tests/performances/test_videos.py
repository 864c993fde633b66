"""The shipped videos, looked at as the portrait system looks at them: by the face mesh, frame by frame.

The measures are those on which real drivers were compared with them: openings and distances in units of the
distance between the eyes.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice, pairwise

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.media.image import read_image
from engine.media.video import probe_video, read_video
from engine.perception.face.faces import FaceTracker
from engine.perception.face.head_pose import head_pose
from engine.performances import catalogue, names, performance, poster, video
from engine.performances.catalogue import PERFORMANCE_FPS, POSTER_SIDE_PIXELS
from engine.performances.scores.score import SCORES

MEBIBYTE = 2**20


@dataclass(frozen=True)
class Watched:
    """The mesh found on each frame of a performance (T, 478, 3), and those of the frames (512, 512, 3) that are looked
    at again."""

    name: str
    frames: list[NDArray[np.uint8]]
    mesh: NDArray[np.float32]

    def between(self, a: int, b: int) -> NDArray[np.float32]:
        return np.linalg.norm(self.mesh[:, a, :2] - self.mesh[:, b, :2], axis=1)

    @property
    def eye_distance(self) -> float:
        eyes = (self.mesh[:, [33, 362], :2] + self.mesh[:, [133, 263], :2]) / 2
        return float(np.median(np.linalg.norm(eyes[:, 1] - eyes[:, 0], axis=1)))

    @property
    def mouth_opening(self) -> NDArray[np.float32]:
        return self.between(13, 14) / self.eye_distance

    @property
    def mouth_width(self) -> NDArray[np.float32]:
        return self.between(61, 291) / self.eye_distance

    @property
    def brow_height(self) -> NDArray[np.float32]:
        return (self.between(105, 133) + self.between(334, 362)) / 2 / self.eye_distance

    @property
    def inner_brow_height(self) -> NDArray[np.float32]:
        lids = (self.mesh[:, 133, 1] + self.mesh[:, 362, 1]) / 2
        return (lids - (self.mesh[:, 107, 1] + self.mesh[:, 336, 1]) / 2) / self.eye_distance

    @property
    def corners_up(self) -> NDArray[np.float32]:
        """How far the corners of the mouth lie above its middle."""
        middle = (self.mesh[:, 13, 1] + self.mesh[:, 14, 1]) / 2
        return (middle - (self.mesh[:, 61, 1] + self.mesh[:, 291, 1]) / 2) / self.eye_distance

    @property
    def turned(self) -> NDArray[np.float32]:
        """(T, 2) degrees to the picture's right and downwards."""
        poses = [head_pose(mesh, (512, 512)) for mesh in self.mesh]
        return np.degrees([[pose.yaw, pose.pitch] for pose in poses])

    def at_height(self, values: NDArray[np.float32]) -> float:
        """The median over a third of a second around the poster's frame, against that of the first frame."""
        middle = performance(self.name).poster_frame
        return float(np.median(values[middle - 5 : middle + 6]) - values[0])

    @property
    def eye_openings(self) -> NDArray[np.float32]:
        """(T, 2): lid distance over the eye's width."""
        left = (self.between(386, 374) + self.between(385, 380)) / 2 / self.between(362, 263)
        right = (self.between(159, 145) + self.between(158, 153)) / 2 / self.between(33, 133)
        return np.stack([left, right], 1)


KEPT = ("idle", "idle-strong", "happy", "surprise")
"""Of these every frame is kept; all would fill the memory."""


@pytest.fixture(scope="module")
def watched() -> dict[str, Watched]:
    found = {}
    for name in names():
        meshes, frames = [], []
        with FaceTracker() as tracker:
            for frame in read_video(video(name)):
                meshes.append(tracker(frame.rgb))
                if name in KEPT:
                    frames.append(frame.rgb.copy())
        assert all(len(mesh) == 1 for mesh in meshes), f"{name}: the face was lost or doubled"
        found[name] = Watched(name, frames, np.stack([mesh[0] for mesh in meshes]))
    return found


def test_the_videos_are_what_the_catalogue_says() -> None:
    for entry in catalogue():
        info = probe_video(video(entry.name))
        assert (info.width, info.height, info.fps) == (512, 512, PERFORMANCE_FPS)
        assert info.frames == round(entry.seconds * PERFORMANCE_FPS)
        assert not info.has_sound
    sizes = [video(name).stat().st_size for name in names()]
    assert max(sizes) < MEBIBYTE and sum(sizes) < 8 * MEBIBYTE


@pytest.mark.parametrize("name", names())
def test_the_poster_is_a_frame_of_the_video(name: str) -> None:
    frame = next(islice(read_video(video(name)), performance(name).poster_frame, None)).rgb
    small = cv2.resize(frame, (POSTER_SIDE_PIXELS, POSTER_SIDE_PIXELS), interpolation=cv2.INTER_AREA)
    picture = read_image(poster(name)).rgb
    assert picture.shape == (POSTER_SIDE_PIXELS, POSTER_SIDE_PIXELS, 3)
    assert np.abs(picture.astype(float) - small).mean() < 2.5  # JPEG
    assert poster(name).stat().st_size < 30_000


def test_unknown_performances_are_refused() -> None:
    with pytest.raises(KeyError, match="choose one of idle"):
        video("rage")


@pytest.mark.parametrize("name", names())
def test_the_face_is_large_and_frontal(watched: dict[str, Watched], name: str) -> None:
    mesh = watched[name].mesh
    width = np.ptp(mesh[0, :, 0])
    assert 210 < width < 280
    depth = np.abs(mesh[:, 234, 2] - mesh[:, 454, 2]) / width
    assert depth.max() < (0.36 if performance(name).state == "shake" else 0.25)  # turned by less than ten degrees
    assert mesh[..., :2].min() > 5 and mesh[..., :2].max() < 507


@pytest.mark.parametrize("name", names())
def test_all_start_and_end_in_the_same_neutral_face(watched: dict[str, Watched], name: str) -> None:
    neutral = watched["idle"].mesh[0, :, :2]
    for index in (0, -1):
        away = np.linalg.norm(watched[name].mesh[index, :, :2] - neutral, axis=1)
        assert away.mean() < 2.0
    assert watched[name].mouth_opening[[0, -1]].max() < 0.02
    assert watched[name].eye_openings[[0, -1]].min() > 0.24


@pytest.mark.parametrize("name", names())
def test_blinks_shut_both_eyes(watched: dict[str, Watched], name: str) -> None:
    """Wherever the score shuts both lids the eyes are seen shut, and in every performance they are, but not for long."""
    openings = watched[name].eye_openings
    lids = [SCORES[name](index / PERFORMANCE_FPS).units for index in range(len(openings))]
    scored = np.array([min(units.get("eyeBlinkLeft", 0), units.get("eyeBlinkRight", 0)) > 0.98 for units in lids])
    assert scored.any() and openings[scored].max() < 0.13
    shut = (openings < 0.12).all(1)
    assert shut.sum() < 0.3 * PERFORMANCE_FPS * (np.diff(scored.astype(int)) == 1).sum() + 0.1 * PERFORMANCE_FPS


@pytest.mark.parametrize("name", names())
def test_the_mouth_moves_smoothly(watched: dict[str, Watched], name: str) -> None:
    """The man who grins in a real driver opens his mouth by 0.10 from one frame (of 25) to the next at most; speech
    and astonishment are quicker."""
    quick = performance(name).state in ("talk", "surprise")
    assert np.abs(np.diff(watched[name].mouth_opening)).max() < (0.15 if quick else 0.10)
    assert np.abs(np.diff(watched[name].mouth_width)).max() < 0.10


@pytest.mark.parametrize("name", ["anger", "anger-strong"])
def test_anger_lowers_the_brows_and_turns_down_the_mouth(watched: dict[str, Watched], name: str) -> None:
    one = watched[name]
    assert one.at_height(one.brow_height) < -0.03
    assert one.at_height(one.inner_brow_height) < -0.03
    assert one.at_height(one.corners_up) < -0.01


@pytest.mark.parametrize("name", ["fear", "fear-strong"])
def test_fear_raises_the_inner_brows_and_opens_the_eyes(watched: dict[str, Watched], name: str) -> None:
    one = watched[name]
    assert one.at_height(one.inner_brow_height) > 0.03
    assert one.at_height(one.eye_openings.mean(1)) > 0.03
    assert one.at_height(one.mouth_opening) > 0.01


@pytest.mark.parametrize("name", ["sadness", "sadness-strong"])
def test_sadness_raises_the_inner_brows_and_lowers_the_corners(watched: dict[str, Watched], name: str) -> None:
    one = watched[name]
    assert one.at_height(one.inner_brow_height) > 0.015
    assert one.at_height(one.corners_up) < -0.02
    assert one.at_height(one.turned[:, 1]) > 2


@pytest.mark.parametrize(("name", "axis"), [("shake", 0), ("shake-strong", 0), ("nod", 1), ("nod-strong", 1)])
def test_heads_shake_sideways_and_nod_up_and_down(watched: dict[str, Watched], name: str, axis: int) -> None:
    turned = watched[name].turned - watched[name].turned[0]
    spans = np.ptp(turned, axis=0)
    assert spans[axis] > 5 and spans[axis] > 2 * spans[1 - axis]
    way = turned[:, axis] - (0 if axis == 0 else spans[1] / 3)
    assert (np.diff(np.sign(way[np.abs(way) > 0.15 * spans[axis]])) != 0).sum() >= 2


@pytest.mark.parametrize("name", ["wink", "wink-strong"])
def test_a_wink_is_seen_in_one_eye(watched: dict[str, Watched], name: str) -> None:
    left, right = watched[name].eye_openings.T
    winking = slice(round(0.52 * PERFORMANCE_FPS), round(0.72 * PERFORMANCE_FPS))
    assert left[winking].max() < 0.13 and right[winking].min() > 0.2


@pytest.mark.parametrize("name", [name for name in ("talk", "talk-strong") if name in names()])
def test_talk_opens_and_shuts_the_mouth_at_uneven_times(watched: dict[str, Watched], name: str) -> None:
    opening = watched[name].mouth_opening
    tops = [
        i for i in range(1, len(opening) - 1) if opening[i - 1] < opening[i] >= opening[i + 1] and opening[i] > 0.04
    ]
    assert 5 <= len(tops) <= 22 and np.std(np.diff(tops)) > 1
    assert np.ptp(watched[name].mouth_width) > 0.1


@pytest.mark.parametrize(
    ("state", "measure"),
    [
        ("happy", "mouth_opening"),
        ("surprise", "mouth_opening"),
        ("fear", "mouth_opening"),
        ("anger", "inner_brow_height"),
        ("sadness", "corners_up"),
        ("nod", "turned"),
        ("shake", "turned"),
        ("talk", "brow_height"),
        ("talk", "turned"),
    ],
)
def test_strong_is_stronger(watched: dict[str, Watched], state: str, measure: str) -> None:
    spans = [np.ptp(getattr(watched[name], measure), axis=0).max() for name in (state, f"{state}-strong")]
    assert spans[1] > 1.15 * spans[0]


def test_happy_is_as_broad_as_a_real_grin(watched: dict[str, Watched]) -> None:
    """Real: the mouth grows from 0.80 to 1.15 and opens by 0.10 to 0.26; the eyes narrow by a sixth."""
    happy = watched["happy"]
    apex = slice(round(1.3 * PERFORMANCE_FPS), round(2.2 * PERFORMANCE_FPS))
    assert np.median(happy.mouth_width[apex]) / happy.mouth_width[0] > 1.28
    assert 0.08 < np.median(happy.mouth_opening[apex]) < 0.30
    assert np.median(happy.eye_openings[apex]) < 0.93 * np.median(happy.eye_openings[:6])
    corners = happy.mesh[:, [61, 291], 1].mean(1) - happy.mesh[:, [33, 263], 1].mean(1)
    assert np.median(corners[apex]) < corners[0] - 0.10 * happy.eye_distance


def test_surprise_opens_eyes_and_mouth_and_lifts_the_brows(watched: dict[str, Watched]) -> None:
    """Real: lids from 0.33 to 0.40, mouth 0.28 and more, brows up by 0.06 to 0.10."""
    surprise = watched["surprise"]
    apex = slice(round(0.9 * PERFORMANCE_FPS), round(1.4 * PERFORMANCE_FPS))
    assert np.median(surprise.mouth_opening[apex]) > 0.24
    assert np.median(surprise.eye_openings[apex]) > 1.15 * np.median(surprise.eye_openings[:5])
    assert np.median(surprise.brow_height[apex]) > surprise.brow_height[0] + 0.05


def test_the_eyes_widen_before_the_jaw_drops(watched: dict[str, Watched]) -> None:
    surprise = watched["surprise"]
    lids = surprise.eye_openings.mean(1)
    widened = np.argmax(lids > lids[:5].mean() + 0.5 * (lids.max() - lids[:5].mean()))
    opened = np.argmax(surprise.mouth_opening > 0.5 * surprise.mouth_opening.max())
    assert widened < opened


def test_furrows_come_with_the_brows(watched: dict[str, Watched]) -> None:
    """The forehead of the surprised face has more contrast between its rows than the neutral one's."""
    surprise = watched["surprise"]

    def rows(index: int) -> float:
        left, right = surprise.mesh[index, 105, :2], surprise.mesh[index, 334, :2]
        top = surprise.mesh[index, 10, 1]
        patch = surprise.frames[index][int(top) : int(min(left[1], right[1])) - 6, int(left[0]) : int(right[0])]
        profile = patch.astype(float).mean((1, 2))
        return float(np.abs(np.diff(profile, 2)).mean())

    assert rows(round(1.1 * PERFORMANCE_FPS)) > 1.5 * rows(0)


@pytest.mark.parametrize("name", ["idle", "idle-strong"])
def test_idle_has_no_seam(watched: dict[str, Watched], name: str) -> None:
    frames = watched[name].frames
    steps = [cv2.absdiff(one, following).mean() for one, following in pairwise(frames)]
    seam = cv2.absdiff(frames[0], frames[-1]).mean()
    assert seam <= 1.15 * max(steps)  # the first frame is coded on its own
    assert seam < 3 * np.median(steps)


def test_idle_is_never_quite_still(watched: dict[str, Watched]) -> None:
    mesh = watched["idle"].mesh[..., :2]
    nose = mesh[:, 4]
    assert 2 < np.ptp(nose, axis=0).max() < 25


def test_the_background_holds_still(watched: dict[str, Watched]) -> None:
    corner = np.stack([frame[:40, :40] for frame in watched["surprise"].frames]).astype(float)
    assert corner.std(0).max() < 1.5


def test_skin_is_lit_from_the_sitters_right(watched: dict[str, Watched]) -> None:
    """The key stands at the left of the picture: that cheek is the brighter one."""
    happy = watched["happy"]
    cheeks = happy.mesh[0, [117, 346], :2].astype(int)
    bright, dark = (happy.frames[0][y - 6 : y + 7, x - 6 : x + 7].mean() for x, y in cheeks)
    assert bright > 1.08 * dark
