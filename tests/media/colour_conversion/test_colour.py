"""Colours of clips: matrices, ranges, HDR and wide gamut, against charts whose colours are known."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import av
import numpy as np
import pytest
from footage import write_clip

from engine.media.colour_conversion.tone_mapping import pq_code, srgb_light, tone_map
from engine.media.colour_conversion.ycbcr import (
    BT601,
    BT709,
    BT2020,
    FULL_RANGE,
    LIMITED_RANGE,
    Coding,
    frame_from_rgb,
    rgb_from_frame,
)
from engine.media.video import probe_video, read_video

CHART = np.array(
    [
        [(0, 0, 0), (64, 64, 64), (128, 128, 128), (192, 192, 192), (255, 255, 255)],
        [(224, 172, 138), (141, 85, 54), (250, 214, 190), (96, 60, 44), (200, 130, 100)],
        [(200, 40, 40), (40, 160, 60), (40, 60, 200), (220, 200, 40), (40, 180, 190)],
    ],
    np.uint8,
)
CELL = 32


def chart() -> np.ndarray:
    return np.repeat(np.repeat(CHART, CELL, 0), CELL, 1)


def cells(rgb: np.ndarray) -> np.ndarray:
    """The mean colour in the middle of each cell, (3, 5, 3)."""
    rows, columns = CHART.shape[:2]
    blocks = rgb.reshape(rows, CELL, columns, CELL, 3)[:, CELL // 4 : -CELL // 4, :, CELL // 4 : -CELL // 4]
    return blocks.mean(axis=(1, 3))


def planar(matrix: int, full: bool, bits: int, layout: str) -> Callable[[np.ndarray], av.VideoFrame]:
    """What makes a frame of a picture by the textbook's formulas, in floating point (8 or 10 bits)."""
    red, blue = {BT709: (0.2126, 0.0722), BT601: (0.299, 0.114), BT2020: (0.2627, 0.0593)}[matrix]

    def make(picture: np.ndarray) -> av.VideoFrame:
        r, g, b = np.moveaxis(picture.astype(float) / (255 if picture.dtype == np.uint8 else 1), -1, 0)
        y = red * r + (1 - red - blue) * g + blue * b
        cb, cr = (b - y) / (2 - 2 * blue), (r - y) / (2 - 2 * red)
        unit = 2 ** (bits - 8)
        scales, base = ((255, 255, 255), 0) if full else ((219, 224, 224), 16)
        codes = [y * scales[0] + base, cb * scales[1] + 128, cr * scales[2] + 128]
        kind = np.uint8 if bits == 8 else np.uint16
        step = 1 if "444" in layout else 2
        planes = [codes[0], codes[1][::step, ::step], codes[2][::step, ::step]]
        frame = av.VideoFrame(picture.shape[1], picture.shape[0], layout)
        for plane, values in zip(frame.planes, planes, strict=True):
            view = np.frombuffer(memoryview(plane), kind).reshape(plane.height, -1)[:, : plane.width]
            view[:] = np.clip(np.round(values * unit), 0, 2**bits - 1)
        return frame

    return make


def tagged(matrix: int | None, range_: int | None, transfer: int = 2, primaries: int = 2) -> Callable:
    def dress(stream: av.VideoStream) -> None:
        context = stream.codec_context
        context.colorspace, context.color_range = matrix or 2, range_ or 0
        context.color_trc, context.color_primaries = transfer, primaries

    return dress


@pytest.mark.parametrize("layout", ["yuv420p", "yuv444p", "yuv420p10le"])
@pytest.mark.parametrize(("matrix", "tag"), [(BT709, 1), (BT601, 6), (BT601, 5), (BT2020, 9), (BT601, None)])
@pytest.mark.parametrize("full", [False, True])
def test_matrix_and_range_tags_are_respected(
    tmp_path: Path, layout: str, matrix: int, tag: int | None, full: bool
) -> None:
    path = write_clip(
        tmp_path / "clip.mp4",
        [chart()] * 2,
        layout=layout,
        options={"crf": "1"},
        dress=tagged(tag, FULL_RANGE if full else None),
        convert=planar(matrix, full, 10 if "10" in layout else 8, layout),
    )
    for frame in read_video(path):
        assert np.abs(cells(frame.rgb) - CHART).max() <= 3


def test_untagged_high_definition_is_bt709(tmp_path: Path) -> None:
    picture = np.tile(chart(), (8, 8, 1))[: CELL * 18 + 160, : CELL * 40]
    path = write_clip(
        tmp_path / "clip.mkv",
        [picture] * 2,
        options={"preset": "ultrafast", "crf": "4"},
        dress=tagged(None, None),
        convert=planar(BT709, False, 8, "yuv420p"),
    )
    rgb = next(read_video(path)).rgb
    assert np.abs(cells(rgb[: 3 * CELL, : 5 * CELL]) - CHART).max() <= 3


def in_bt2020(linear: np.ndarray) -> np.ndarray:
    """Linear BT.709 to linear BT.2020 (BT.2087, table 2)."""
    matrix = [[0.6274, 0.3293, 0.0433], [0.0691, 0.9195, 0.0114], [0.0164, 0.0880, 0.8956]]
    return linear @ np.array(matrix).T


def hlg(linear: np.ndarray) -> np.ndarray:
    """HLG code values of linear BT.2020 light whose white is at 203 cd/m2 (BT.2100, table 5, OOTF inverted)."""
    nits = linear * 203 / 1000
    luminance = np.maximum(nits @ [0.2627, 0.6780, 0.0593], 1e-9)
    scene = nits * luminance[..., None] ** (-0.2 / 1.2)
    high = 0.17883277 * np.log(np.maximum(12 * scene - 0.28466892, 1e-9)) + 0.55991073
    return np.where(scene <= 1 / 12, np.sqrt(3 * np.maximum(scene, 0)), high)


def pq(linear: np.ndarray) -> np.ndarray:
    """PQ code values of linear BT.2020 light whose white is at 203 cd/m2 (BT.2100, table 4, the inverse EOTF)."""
    m1, m2, c1, c2, c3 = 0.1593017578125, 78.84375, 0.8359375, 18.8515625, 18.6875
    power = (np.maximum(linear, 0) * 203 / 10000) ** m1
    return ((c1 + c2 * power) / (1 + c3 * power)) ** m2


@pytest.fixture
def usual_scheduling() -> Iterator[None]:
    """The AV1 encoder leaves the thread that opened it, if it is root's, at real-time priority: everything that the tests
    started from then on would keep the machine's cores from all others."""
    yield
    os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


@pytest.mark.usefixtures("usual_scheduling")
@pytest.mark.parametrize(
    ("name", "codec", "ending"),
    [
        ("hlg", "libx265", "mov"),  # as phones write it
        ("hlg", "libsvtav1", "mp4"),
        ("pq", "libx265", "mkv"),
        ("pq", "libsvtav1", "webm"),
    ],
)
def test_hdr_keeps_faces_and_rolls_off_highlights(tmp_path: Path, name: str, codec: str, ending: str) -> None:
    encode, transfer = {"hlg": (hlg, 18), "pq": (pq, 16)}[name]
    linear = srgb_light(chart() / 255.0)
    path = write_clip(
        tmp_path / f"clip.{ending}",
        [encode(in_bt2020(linear))] * 2,
        codec=codec,
        layout="yuv420p10le",
        options={"crf": "2", "x265-params": "log-level=error:frame-threads=1:bframes=0"}
        if codec == "libx265"
        else {"crf": "4", "preset": "8"},
        dress=tagged(9, LIMITED_RANGE, transfer, 9),
        convert=planar(BT2020, False, 10, "yuv420p10le"),
    )
    assert probe_video(path).hdr == name
    found = cells(next(read_video(path)).rgb)
    below_the_knee = srgb_light(CHART / 255.0) @ [0.2126, 0.7152, 0.0722] < 0.43
    assert below_the_knee.sum() == 10
    assert np.abs(found - CHART)[below_the_knee].max() <= 4
    # Diffuse white is left below the top, so that the highlights above it still show.
    assert 220 < found[0, 4].mean() < 240


def test_reference_levels_are_those_of_the_report() -> None:
    """BT.2408, table 1: diffuse white, 203 cd/m2, has 75 % in HLG and 58 % in PQ; and an 18 % grey card 26 cd/m2, 38 % in
    both. Below the knee, light that is a share of diffuse white is that share of sRGB's."""
    for transfer, encode, white, card in (("hlg", hlg, 0.75, 0.38), ("pq", pq, 0.58, 0.38)):
        grey = np.ones((1, 3))
        assert encode(grey)[0, 1] == pytest.approx(white, abs=0.005)
        assert encode(grey * 26 / 203)[0, 1] == pytest.approx(card, abs=0.007)
        for share in (0.01, 0.05, 26 / 203, 0.3, 0.4):
            code = np.round(encode(grey * share) * 65535).astype(np.uint16)[None]
            level = 255 * (1.055 * share ** (1 / 2.4) - 0.055)
            assert np.abs(tone_map(transfer, "bt2020").apply(code)[0, 0] - level).max() <= 1  # type: ignore[arg-type]


def test_highlights_keep_their_order() -> None:
    nits = np.geomspace(1, 1000, 400)
    codes = np.round(pq_code(nits) * 65535).astype(np.uint16)[None, :, None].repeat(3, -1)
    levels = tone_map("pq", "bt2020").apply(codes)[0].astype(int)
    assert np.all(np.diff(levels[:, 0]) >= 0) and levels[-1, 0] == 255
    assert np.ptp(levels, axis=1).max() <= 1, "grey stays grey"


def test_wide_gamut_of_ordinary_range(tmp_path: Path) -> None:
    linear = srgb_light(chart() / 255.0)
    # Linear sRGB to linear Display P3.
    matrix = np.array([[0.8225, 0.1774, 0.0], [0.0332, 0.9669, 0.0], [0.0171, 0.0724, 0.9108]])
    light = linear @ matrix.T
    code = np.where(light <= 0.0031308, light * 12.92, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)
    path = write_clip(
        tmp_path / "clip.mp4",
        [np.clip(code, 0, 1)] * 2,
        options={"crf": "1"},
        dress=tagged(1, LIMITED_RANGE, 13, 12),
        convert=planar(BT709, False, 8, "yuv420p"),
    )
    assert probe_video(path).hdr is None
    assert np.abs(cells(next(read_video(path)).rgb) - CHART).max() <= 4


@pytest.mark.parametrize("matrix", [BT601, BT709, BT2020])
@pytest.mark.parametrize("range_", [LIMITED_RANGE, FULL_RANGE])
def test_coding_inverts(matrix: int, range_: int) -> None:
    coding = Coding(matrix, range_)
    rgb = np.random.default_rng(0).uniform(0, 255, (100, 3))
    encode = coding.encode()
    codes = rgb @ encode[:, :3].T
    assert codes @ coding.decode().T == pytest.approx(rgb)
    assert (encode @ [255, 255, 255, 1])[0] == pytest.approx(235 if range_ == LIMITED_RANGE else 255)


def test_our_frames_come_back() -> None:
    picture = chart()
    frame = frame_from_rgb(picture)
    assert (frame.colorspace, frame.color_range, frame.format.name) == (1, 1, "yuv420p")
    assert np.abs(cells(rgb_from_frame(frame, Coding(BT709, LIMITED_RANGE))) - CHART).max() <= 2


def test_our_frames_are_what_swscale_reads() -> None:
    """FFmpeg's own accurate conversion back agrees, and the colours are not shifted against the brightness."""
    y, x = np.mgrid[0:96, 0:128]
    smooth = np.stack([128 + 100 * np.sin(x / 9), 128 + 90 * np.cos(y / 7), 128 + 80 * np.sin((x + y) / 11)], -1)
    picture = np.round(smooth).astype(np.uint8)
    flags = av.video.reformatter.Interpolation
    back = (
        frame_from_rgb(picture)
        .reformat(
            format="rgb24",
            src_colorspace=1,
            dst_color_range=2,
            interpolation=flags.BICUBIC | flags.ACCURATE_RND | flags.FULL_CHR_H_INT,
        )
        .to_ndarray()
    )
    difference = back.astype(int) - picture
    assert np.abs(difference.mean(axis=(0, 1))).max() < 0.4
    assert np.abs(difference).mean() < 2
    ours = rgb_from_frame(frame_from_rgb(picture), Coding(BT709, LIMITED_RANGE)).astype(int)
    assert np.abs(ours - picture).mean() < 2


def test_transparent_gif_is_laid_over_white(tmp_path: Path) -> None:
    from PIL import Image

    frames = []
    for k in range(3):
        picture = np.zeros((40, 40, 4), np.uint8)
        picture[:, 20:] = (200, 30, 30 + k * 40, 255)
        frames.append(Image.fromarray(picture))
    frames[0].save(tmp_path / "clip.gif", save_all=True, append_images=frames[1:], duration=100, disposal=2)
    for frame in read_video(tmp_path / "clip.gif"):
        assert frame.rgb[20, 5].tolist() == [255, 255, 255]
        assert np.abs(frame.rgb[20, 30, :2].astype(int) - [200, 30]).max() < 20
