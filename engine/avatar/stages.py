"""The stages of an avatar, each from what was found before to what comes of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.avatar.attachments.attaching import Sighting, attachments, standing_points
from engine.avatar.attachments.standing_off import well_supported
from engine.avatar.capture.cameras import CaptureCameras, ClipCameras, solve_cameras
from engine.avatar.capture.captured_view import CapturedView
from engine.avatar.capture.carved_masks import within_hull
from engine.avatar.capture.chosen_frames import ChosenFrames
from engine.avatar.capture.dense import DenseCloud, dense_cloud
from engine.avatar.capture.foot_masks import FootFrame, feet_of, told_from_floor
from engine.avatar.capture.leg_gaps import without_gaps
from engine.avatar.capture.limb_masks import limbs_of, shown_limbs, with_limbs
from engine.avatar.capture.person_frame import TAKEN_HEIGHT_METRES
from engine.avatar.landmarks.back_projection import back_projected, completed
from engine.avatar.landmarks.detection import spatial_landmarks
from engine.avatar.landmarks.given import GivenLandmark, placed_by_hand
from engine.avatar.landmarks.in_frames import FrameLandmarks, frame_landmarks
from engine.avatar.landmarks.spatial import SpatialLandmarks
from engine.avatar.landmarks.worn_on_face import worn_on_face
from engine.avatar.options import KnownLens
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.head_outline import HEAD_BESIDE_FRAMES, MAX_HEAD_BESIDE_SHARE, beside_share
from engine.avatar.registration.models import HumanModels, load_models
from engine.avatar.registration.part_outlines import Silhouette
from engine.avatar.registration.register import Scan, register
from engine.avatar.texture.avatar_texture import AvatarTexture, avatar_texture
from engine.avatar.texture.template_surface import template_surface
from engine.avatar.texture.views import FrameView
from engine.avatar.worn import Attachments
from engine.geometry.camera import Camera
from engine.geometry.multiview.structure_from_motion.mapping import Lens
from engine.geometry.point_clouds.point_cloud import joined
from engine.geometry.registration.rigid import Similarity
from engine.imaging.resample import enlarged_mask, resized
from engine.perception.solutions import kept_networks

FEATURE_SIDE_PIXELS = 1280
"""Pixels of the longer side of frames in which features are found."""
STEREO_SIDE_PIXELS = 960
"""Pixels of the longer side, at most, of frames between which stereo measures: a millimetre and a half of somebody who
fills them."""
MIN_PIXEL_METRES = 0.001
"""Metres of the person that a pixel of stereo's frames shows at least: clouds are smoothed over eight."""
LANDMARK_SIDE_PIXELS = 1280
"""Pixels of the longer side of frames in which landmarks are found."""
HEAD_VIEW_REACH_RATIO = 1.5
"""How far away frames of the head's clip are asked about the person, in distances of the head: shoes below a chin that sways are
hidden by what the mesh has elsewhere."""

STANDING_OFF_RADIUS_METRES = 0.008
"""Metres around points that stand off the body within which others do."""

Tick = Callable[[float], None]
Warn = Callable[[str, str], None]


@dataclass(frozen=True)
class ClipLandmarks:
    """What was found in those frames of a clip that were placed.

    placed : their numbers.
    seen : the landmarks that each shows, in pixels of the clip's own size.
    masks : (h, w) bool, where the person is, hands and feet included.
    """

    placed: NDArray[np.int64]
    seen: tuple[FrameLandmarks, ...]
    masks: tuple[NDArray[np.bool_], ...]


@dataclass(frozen=True)
class ClipScan:
    """What one clip gave.

    placed : numbers of those of its chosen frames that were placed.
    cameras : theirs, of the clip's own size.
    masks : (h, w) bool, the person there.
    dense : the person's cloud in the cameras' world, metres.
    landmarks : the person's, in the same world.
    """

    placed: NDArray[np.int64]
    cameras: tuple[Camera, ...]
    masks: tuple[NDArray[np.bool_], ...]
    dense: DenseCloud
    landmarks: SpatialLandmarks

    def scan(self) -> Scan:
        """What registration takes of it; both clips' worlds are of one size."""
        return Scan(self.dense.cloud, self.landmarks, True, self.silhouettes)

    @property
    def silhouettes(self) -> tuple[Silhouette, ...]:
        """Where its frames have the person."""
        return tuple(
            Silhouette(mask, _resized(camera, (mask.shape[0], mask.shape[1])))
            for camera, mask in zip(self.cameras, self.masks, strict=True)
        )

    def without(self, off: NDArray[np.floating]) -> ClipScan:
        """All of it but the cloud's points around those that are `off` (M, 3) the body."""
        away = cKDTree(off).query(self.dense.cloud.points, distance_upper_bound=STANDING_OFF_RADIUS_METRES)[0]
        kept = np.flatnonzero(~np.isfinite(away))
        dense = replace(self.dense, cloud=self.dense.cloud[kept], support=self.dense.support[kept])
        return replace(self, dense=dense)

    def moved(self, change: Similarity) -> ClipScan:
        """All of it in another world."""
        cameras = tuple(camera.moved(change) for camera in self.dense.cameras)
        dense = replace(self.dense, cloud=self.dense.cloud.moved(change), cameras=cameras)
        own = tuple(camera.moved(change) for camera in self.cameras)
        return ClipScan(self.placed, own, self.masks, dense, self.landmarks.moved(change))


def find_cameras(
    body: ChosenFrames,
    head: ChosenFrames | None,
    further: tuple[ChosenFrames, ...],
    lenses: tuple[KnownLens | None, KnownLens | None],
    warn: Warn,
    tick: Tick,
) -> CaptureCameras:
    """Where the cameras of both clips, and of `further` ones, stood, around somebody of usual height: section 3.2's first half.
    `lenses` are those of both, where they are known. Raises what `solve_cameras` raises."""
    clips = [
        None if clip is None else [clip.picture(k, FEATURE_SIDE_PIXELS) for k in range(len(clip))]
        for clip in (body, head)
    ]
    assert clips[0] is not None
    known = [
        None if clip is None or lens is None or frames is None else lens_of_frames(lens, clip.size, frames[0].shape[:2])
        for lens, clip, frames in zip(lenses, (body, head), clips, strict=True)
    ]
    others = [[clip.picture(k, FEATURE_SIDE_PIXELS) for k in range(len(clip))] for clip in further]
    return solve_cameras(clips[0], clips[1], warn, tick, (known[0], known[1]), others)


def lens_of_frames(lens: KnownLens, size: tuple[int, int], shrunk: tuple[int, int]) -> Lens:
    """A lens, known in pixels of a clip of a `size` (height, width), as that of its frames that were `shrunk` so."""
    scale = shrunk[0] / size[0]
    middle = ((size[1] - 1) / 2, (size[0] - 1) / 2)
    x, y = lens.centre or middle
    centre = np.array([(x + 0.5) * scale - 0.5, (y + 0.5) * scale - 0.5])
    return Lens(np.array([lens.focal * scale, lens.k1, lens.k2]), centre, known=True)


@kept_networks()
def find_landmarks(chosen: ChosenFrames, found: ClipCameras, whole: bool, warn: Warn, tick: Tick) -> ClipLandmarks:
    """The landmarks that the frames of a clip show (section 3.3), and masks in which, by these, no hand or foot is
    missing. Of a clip of the `whole` person, masks also lose what of the floor they let in between legs, and of the room
    below the shoulders. Warns of what the face wears that is not fitted."""
    placed = placed_frames(found)
    cameras = [_camera_of(found, int(k), chosen.size) for k in placed]
    seen = []
    for number, k in enumerate(placed):
        picture = chosen.picture(int(k), LANDMARK_SIDE_PIXELS)
        seen.append(frame_landmarks(picture).scaled(chosen.size[0] / picture.shape[0]))
        tick(number / len(placed))
    for notice in worn_on_face(seen):
        warn(notice.code, notice.message)
    landmarks = spatial_landmarks(list(zip(cameras, seen, strict=True)))
    frames = [_foot_frame(chosen, found, int(k)) for k in placed]
    believed = [frame.mask for frame in frames]
    limbs = shown_limbs(limbs_of(landmarks), believed, [frame.person for frame in frames])
    with_hands = [replace(one, mask=with_limbs(one.image, one.mask, one.person, limbs)) for one in frames]
    masks = told_from_floor(with_hands, feet_of(landmarks))
    if whole:
        masks = without_gaps([replace(one, mask=mask) for one, mask in zip(frames, masks, strict=True)], landmarks)
    shoulders = [landmarks.body[name][1] for name in ("LeftShoulder", "RightShoulder") if name in landmarks.body]
    if whole and shoulders:
        masks = within_hull(masks, [frame.person for frame in frames], float(np.mean(shoulders)))
    return ClipLandmarks(placed, tuple(seen), tuple(masks))


def _foot_frame(chosen: ChosenFrames, found: ClipCameras, k: int) -> FootFrame:
    """A frame as small as its mask."""
    mask, camera, room = found.masks[k], found.cameras[k], found.room[k]
    assert camera is not None and room is not None
    size = (mask.shape[0], mask.shape[1])
    return FootFrame(resized(chosen.picture(k), size[::-1]), mask, _resized(camera, size), _resized(room, size))


def measure_cloud(chosen: ChosenFrames, found: ClipCameras, landmarks: ClipLandmarks, tick: Tick) -> DenseCloud:
    """The person's cloud from one clip: section 3.2's second half. Raises what `dense_cloud` raises."""
    views = []
    side = stereo_side(found)
    for k, mask in zip(landmarks.placed, landmarks.masks, strict=True):
        image = chosen.picture(int(k), side)
        figure = enlarged_mask(mask, (image.shape[1], image.shape[0]))
        views.append(CapturedView(image, figure, _camera_of(found, int(k), (image.shape[0], image.shape[1]))))
    return dense_cloud(views, told=tick)


def stereo_side(found: ClipCameras) -> int:
    """The longer side, pixels, of the pictures that stereo takes: at the median camera's distance from the person's axis."""
    cameras = [camera for camera in found.cameras if camera is not None]
    shown = [float(np.hypot(camera.eye[0], camera.eye[2])) * max(camera.size) / camera.focal for camera in cameras]
    return min(STEREO_SIDE_PIXELS, round(float(np.median(shown)) / MIN_PIXEL_METRES))


def scan_clip(
    chosen: ChosenFrames, landmarks: ClipLandmarks, dense: DenseCloud, given: tuple[GivenLandmark, ...], whole: bool
) -> ClipScan:
    """The landmarks of the person in space, with all that is known of one clip, which shows the `whole` person or the head from near. The
    person's sway is in the cameras as dense stereo has laid them on the cloud. Those `given` by hand are in pixels of the clip's own
    size.

    Faces that are seen from near are triangulated better than one view and the cloud place them."""
    cameras = tuple(_resized(camera, chosen.size) for camera in dense.cameras)
    seen = list(zip(cameras, landmarks.seen, strict=True))
    found = spatial_landmarks(seen)
    if whole:
        found = completed(found, back_projected(seen, dense.cloud.points))
    by_hand = {one.name: placed_by_hand(one, cameras) for one in given}
    spatial = replace(found, body={**found.body, **by_hand})
    return ClipScan(landmarks.placed, cameras, landmarks.masks, dense, spatial)


def in_metres(height_m: float | None) -> Similarity:
    """From somebody of usual height, as the clips measure everybody, to one of `height_m`."""
    return Similarity((height_m or TAKEN_HEIGHT_METRES) / TAKEN_HEIGHT_METRES * np.eye(3), np.zeros(3))


def fit_template(body: ClipScan, head: ClipScan | None, check: Callable[[], None]) -> FittedTemplate:
    """The template fitted to the clouds: section 3.4. What is found to stand off it is no part of the body, which is fitted once more
    without: under a hat is a head. A head that lies beside what frames have of the person is held by no face, and fitted to their
    outlines; it is noticed where it lies beside them still. Raises what `register` raises."""
    check()
    human = load_models()
    for faced in (True, False):
        fitted = _fitted_without_worn(human, body, head, faced, check)
        if not _head_beside_frames(human, fitted, body):
            return fitted
    return replace(fitted, notices=(*fitted.notices, HEAD_BESIDE_FRAMES))


def _head_beside_frames(human: HumanModels, fitted: FittedTemplate, body: ClipScan) -> bool:
    visible = human.skin.regions["head"] & ~human.skin.regions["inner"]
    own = fitted.vertices[human.skin.vertices[visible]]
    return beside_share(own, body.silhouettes) > MAX_HEAD_BESIDE_SHARE


def _fitted_without_worn(
    human: HumanModels, body: ClipScan, head: ClipScan | None, faced: bool, check: Callable[[], None]
) -> FittedTemplate:
    """The template fitted to the clouds, its head by its face or, not `faced`, by outlines, and once more without what stands off it."""
    fitted = register(human, body.scan(), None if head is None else head.scan(), check, faced)
    off = standing_points(human, fitted.vertices, _sighting(fitted, body, head))
    if not len(off):
        return fitted
    check()
    bare = body.without(off)
    if head is None or fitted.head_to_body is None:
        return register(human, bare.scan(), None if head is None else head.scan(), check, faced)
    return register(human, bare.scan(), head.without(fitted.head_to_body.inverse()(off)).scan(), check, faced)


def find_attachments(
    fitted: FittedTemplate, body: ClipScan, head: ClipScan | None, check: Callable[[], None]
) -> Attachments:
    """What stands off the fitted body: hats' brims, hair, tails of coats."""
    check()
    return attachments(load_models(), fitted.vertices, _sighting(fitted, body, head))


def _sighting(fitted: FittedTemplate, body: ClipScan, head: ClipScan | None) -> Sighting:
    """The clouds and silhouettes of both clips, the head's where registration has placed it, and its cloud only about the head, which it
    shows from near."""
    skin = load_models().skin
    clouds = [body.dense.cloud[well_supported(body.dense.support)]]
    views = list(body.silhouettes)
    if head is not None and fitted.head_to_body is not None:
        near = head.moved(fitted.head_to_body)
        cloud = near.dense.cloud[well_supported(near.dense.support)]
        nearest = cKDTree(fitted.vertices[skin.vertices]).query(cloud.points)[1]
        clouds.append(cloud[skin.regions["head"][nearest]])
        views += near.silhouettes
    masks, cameras = [one.mask for one in views], [one.camera for one in views]
    return Sighting(joined(clouds), masks, cameras, len(views) - len(body.silhouettes))


def stitch_texture(
    fitted: FittedTemplate,
    worn: Attachments,
    clips: Sequence[tuple[ChosenFrames, ClipScan]],
    further: Sequence[tuple[ChosenFrames, ClipScan]],
    size: int,
    check: Callable[[], None],
) -> AvatarTexture:
    """The texture of the fitted template and of what is `worn` off it, `size` texels a side (section 3.5). It comes
    from the frames of the body's clip, of the head's, where registration has placed it, and of `further` ones in the
    body's world."""
    views: list[FrameView] = []
    scans = in_body_s_world([scan for _, scan in clips], fitted)
    placed = [(chosen, scan) for (chosen, _), scan in zip(clips, scans, strict=False)]
    human = load_models()
    head = fitted.vertices[human.skin.vertices[human.skin.regions["head"]]].mean(0)
    for number, (chosen, scan) in enumerate([*placed, *further]):
        of_head = 0 < number < len(placed)
        for k, camera, mask in zip(scan.placed, scan.cameras, scan.masks, strict=True):
            view = _frame_view(chosen, int(k), camera, mask, check)
            away = HEAD_VIEW_REACH_RATIO * float(np.linalg.norm(camera.eye - head))
            views.append(replace(view, farthest=away) if of_head else view)
    surface = template_surface(human.template, human.rig).wearing(worn)
    vertices = np.concatenate([fitted.vertices, worn.vertices])
    return avatar_texture(surface, human.rig, vertices, views, size, fitted.iris)


def in_body_s_world(scans: Sequence[ClipScan], fitted: FittedTemplate) -> list[ClipScan]:
    """What the body's clip gave and, where registration has placed it, the head's, in the world of the body's."""
    return [*scans[:1], *(scan.moved(fitted.head_to_body) for scan in scans[1:] if fitted.head_to_body is not None)]


def placed_frames(found: ClipCameras) -> NDArray[np.int64]:
    """The numbers of the frames whose cameras were found."""
    return np.array([k for k, camera in enumerate(found.cameras) if camera is not None], np.int64)


def _frame_view(
    chosen: ChosenFrames, k: int, camera: Camera, mask: NDArray[np.bool_], check: Callable[[], None]
) -> FrameView:
    height, width = chosen.size

    def picture() -> NDArray[np.uint8]:
        check()
        return chosen.picture(k)

    return FrameView(camera, picture, lambda: enlarged_mask(mask, (width, height)))


def _camera_of(found: ClipCameras, k: int, size: tuple[int, int]) -> Camera:
    camera = found.cameras[k]
    assert camera is not None
    return _resized(camera, size)


def _resized(camera: Camera, size: tuple[int, int]) -> Camera:
    """The camera of the same picture at another size (height, width)."""
    return replace(camera.scaled(size[1] / camera.size[1]), size=size)
