"""How good the avatar's texture is on films of known people, with their true shape and cameras: the texture stage alone.

    python -m benchmarks.avatar_figures.texture FOLDER [--size 4096] [--body 75] [--head 50] [--sheet OUT.png]

FOLDER is what `python -m benchmarks.scan_studio` made of a subject. The cameras are those of the person: the sway of
the body is taken out, that of the arms, motion blur, exposure and balance are not. Prints CIELAB root mean square
errors of the textured person, drawn without light, against the frames, each in its own exposure. Also the energies of
labels and of best views, how well gains undo the exposure, seconds and peak memory. The sheet shows eight sides, the
face from near, and frames.
"""

from __future__ import annotations

import argparse
import resource
import time
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.presentation.contact_sheet import Row, contact_sheet, write_sheet
from benchmarks.scan_studio.truth import Truth, read_truth
from engine.avatar.texture.avatar_texture import AvatarTexture, avatar_texture
from engine.avatar.texture.stitching import StitchedTexture, stitch_texture
from engine.avatar.texture.template_surface import template_surface
from engine.avatar.texture.views import ChartedSurface, FrameView
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig, load_template
from engine.geometry.camera import Camera
from engine.geometry.texture_charts.texture_atlas import unwrap
from engine.imaging.histogram_matching import to_lab
from engine.media.colour_conversion.tone_mapping import srgb_code, srgb_light
from engine.media.video import read_video
from engine.render.rasterisation.attributes import interpolate, sample_texture
from engine.render.rasterisation.rasteriser import rasterise
from engine.render.textures.texture_bake import charts_of, pad_charts

PERSON_SUPERSAMPLING = 2
"""Along a side of a pixel, when the textured person is drawn."""
UNCOMPARED_OUTLINE_PIXELS = 5
"""Across the outline that is left out of the errors: frames are blurred there with the room behind."""
COMPARED_FRAME_STEP = 5
"""Each so many frames are compared."""
BACKGROUND_GREY_LEVEL = 110
SHEET_FOCAL_PIXELS = 900


def spread_frames(truth: Truth, counts: Mapping[str, int]) -> dict[str, list[int]]:
    """Evenly spread frames of the films, so many of each."""
    return {
        film: np.linspace(0, len(truth.films[film].cameras), count, endpoint=False).astype(int).tolist()
        for film, count in counts.items()
    }


def film_views(
    folder: Path, truth: Truth, surface: ChartedSurface, frames: Mapping[str, Collection[int]]
) -> list[FrameView]:
    """Frames of the films, by the person's own cameras, with masks of the true silhouette."""
    views = []
    for film, chosen in frames.items():
        for k, frame in enumerate(read_video(folder / f"{film}.mp4")):
            if k in chosen:
                camera, rgb = truth.person_camera(film, k), frame.rgb.copy()
                covered = (
                    rasterise(camera.project(surface.vertices), surface.triangles, camera.size, True).triangle >= 0
                )
                views.append(FrameView(camera, partial(np.asarray, rgb), partial(np.asarray, covered)))
    return views


def drawn(surface: ChartedSurface, texture: NDArray[np.uint8], camera: Camera) -> tuple[NDArray, NDArray[np.bool_]]:
    """The textured person without light, (H, W, 3) float32, and which pixels it covers."""
    fine = camera.scaled(PERSON_SUPERSAMPLING)
    raster = rasterise(fine.project(surface.vertices), surface.triangles, fine.size, perspective=True)
    covered = raster.triangle >= 0
    uv = interpolate(surface.atlas.uv, surface.atlas.corners, raster)
    picture = np.where(covered[..., None], sample_texture(texture, uv, covered), np.float32(BACKGROUND_GREY_LEVEL))
    size = camera.size[::-1]
    mean = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    share = cv2.resize(covered.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    return mean, share == 1


def errors(surface: ChartedSurface, texture: NDArray[np.uint8], views: list[FrameView], gains: NDArray) -> float:
    """CIELAB root mean square over pixels of the person, mean square over frames."""
    small = cv2.resize(texture, (2048, 2048), interpolation=cv2.INTER_AREA) if len(texture) > 2048 else texture
    squares = []
    for view, gain in list(zip(views, gains, strict=True))[::COMPARED_FRAME_STEP]:
        picture, covered = drawn(surface, np.asarray(small), view.camera)
        inner = (
            cv2.erode(
                covered.astype(np.uint8), np.ones((UNCOMPARED_OUTLINE_PIXELS, UNCOMPARED_OUTLINE_PIXELS), np.uint8)
            )
            > 0
        )
        away = to_lab(np.clip(picture / gain, 0, 255)[inner]) - to_lab(view.picture()[inner].astype(np.float32))
        squares.append(float((away**2).sum(1).mean()))
    return float(np.sqrt(np.mean(squares)))


def true_gains(truth: Truth, frames: Mapping[str, Sequence[int]]) -> NDArray[np.float64]:
    """(N, 3) what the chosen frames' colours would be multiplied by, of mid grey, of mean 1 in logarithms."""
    light = np.concatenate([truth.films[film].gains[chosen] for film, chosen in frames.items()])
    grey = srgb_light(np.array(0.5))
    return np.asarray(0.5 / srgb_code(np.clip(light * grey, 0, 1)))


def spread(gains: NDArray[np.floating]) -> float:
    """Root mean square of logarithms about their mean."""
    logs = np.log(gains)
    return float((logs - logs.mean(0)).std())


def sheet_of(surface: ChartedSurface, texture: NDArray[np.uint8], views: list[FrameView]) -> NDArray[np.uint8]:
    """Eight sides, the face from near, frames."""
    small = cv2.resize(texture, (2048, 2048), interpolation=cv2.INTER_AREA) if len(texture) > 2048 else texture
    height = float(surface.vertices[np.unique(surface.triangles), 1].max())
    lens = Camera((0, 0, 1), SHEET_FOCAL_PIXELS, (179.5, 329.5), (660, 360))

    def seen(distance: float, at: float, turn: float, lens: Camera) -> NDArray[np.uint8]:
        camera = lens.aimed([distance * np.sin(turn), at, distance * np.cos(turn)], [0, at, 0])
        return np.clip(drawn(surface, np.asarray(small), camera)[0], 0, 255).astype(np.uint8)

    turns = np.arange(8) * np.pi / 4
    near = Camera((0, 0, 1), SHEET_FOCAL_PIXELS, (219.5, 219.5), (440, 440))
    return contact_sheet(
        [
            Row([seen(2.7, height / 2, turn, lens) for turn in turns], "eight sides"),
            Row([seen(0.65, height - 0.13, turn, near) for turn in (-0.8, 0.0, 0.8, 1.6, np.pi)], "head"),
            Row([view.picture() for view in views[:: max(len(views) // 8, 1)]][:8], "frames"),
        ]
    )


@dataclass(frozen=True)
class TexturedTruth:
    """The person's true shape with the texture that the stage makes of `views`; `stage` tells how."""

    surface: ChartedSurface
    texture: NDArray[np.uint8]
    views: list[FrameView]
    stage: AvatarTexture | StitchedTexture
    seconds: float


def textured_truth(folder: Path, truth: Truth, frames: Mapping[str, Collection[int]], size: int) -> TexturedTruth:
    """The texture stage with true shape and cameras: as for avatars, where the person is one of the template's."""
    subject = truth.subject
    if subject.template:
        rig = load_rig(HUMAN_RIG)
        template = template_surface(load_template(), rig)
        surface = template.fitted(subject.vertices)
        views = film_views(folder, truth, surface, frames)
        began = time.perf_counter()
        whole = avatar_texture(template, rig, subject.vertices, views, size)
        return TexturedTruth(surface, whole.texture, views, whole, time.perf_counter() - began)
    atlas, _ = unwrap(subject.vertices, subject.triangles, size)
    surface = ChartedSurface(subject.vertices, subject.triangles, atlas, np.ones(len(subject.triangles), np.bool_))
    views = film_views(folder, truth, surface, frames)
    began = time.perf_counter()
    skin = stitch_texture(surface, views, size)
    charts = charts_of(atlas, skin.raster)
    texture = pad_charts(skin.texture, charts >= 0, charts)
    return TexturedTruth(surface, texture, views, skin, time.perf_counter() - began)


def main() -> None:
    """Measure and print."""
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("--size", type=int, default=4096)
    arguments.add_argument("--body", type=int, default=75)
    arguments.add_argument("--head", type=int, default=50)
    arguments.add_argument("--sheet", type=Path)
    asked = arguments.parse_args()
    truth = read_truth(asked.folder)
    frames = spread_frames(truth, {"body": asked.body, "head": asked.head})
    made = textured_truth(asked.folder, truth, frames, asked.size)
    surface, texture, views, found = made.surface, made.texture, made.views, made.stage
    if isinstance(found, AvatarTexture):
        print(f"seen: {found.seen_share:.1%} of the skin; eyes {'seen' if found.eyes_seen else 'not seen'}")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"{len(views)} frames, {asked.size} texels: {made.seconds:.1f} s, peak {peak:.0f} MB with all frames in memory"
    )
    true = true_gains(truth, frames)
    print(f"exposure: {spread(true):.4f} before, {spread(found.gains / true):.4f} after (of mid grey, logarithms)")
    for name, labels in (("best view", found.best), ("stitched", found.labels)):
        print(f"{name}: data {labels.data:.1f}, seams {labels.seams:.1f}, {labels.patches} patches")
    print(f"CIELAB RMSE over frames: {errors(surface, texture, views, found.gains):.2f}")
    if asked.sheet:
        write_sheet(asked.sheet, sheet_of(surface, texture, views))


if __name__ == "__main__":
    main()
