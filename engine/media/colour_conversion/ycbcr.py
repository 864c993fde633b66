"""Between RGB and the 8-bit 4:2:0 planes that video codecs keep (ITU-R BT.601, BT.709, BT.2020).

Every frame that comes in or goes out passes here, so the two loops are ours. At 600x800 they take about 1 ms each on
one core. They round, and have the colour samples where H.264 has them (on the left pixel of a pair, between two rows).
The fast path of swscale takes 0.4 ms but truncates (1 to 1.4 levels too dark), its accurate one takes 2.6 ms and more.
"""

from __future__ import annotations

from dataclasses import dataclass

import av
import numpy as np
from av.video.frame import VideoFrame
from av.video.plane import VideoPlane

from engine.compiled import njit

# Shares of red and blue in the brightness, by FFmpeg's number of the matrix (AVCOL_SPC_*; ITU-T H.273, table 4).
_LUMA_SHARES = {
    1: (0.2126, 0.0722),  # BT.709
    4: (0.30, 0.11),  # FCC
    5: (0.299, 0.114),  # BT.601, 625 lines
    6: (0.299, 0.114),  # BT.601, 525 lines
    7: (0.212, 0.087),  # SMPTE 240M
    9: (0.2627, 0.0593),  # BT.2020, non-constant luminance
    10: (0.2627, 0.0593),
}
MATRICES = frozenset(_LUMA_SHARES)
BT709, BT601, BT2020 = 1, 6, 9
LIMITED_RANGE, FULL_RANGE = 1, 2
"""FFmpeg's numbers of the ranges (AVCOL_RANGE_*): 16..235 and 0..255."""

_FIXED_POINT_ONE = 1 << 16  # fixed-point one; a sum of 8 samples of 8 bits with weights up to 2 stays within 31 bits


@dataclass(frozen=True)
class Coding:
    """How 8-bit code values stand for colours: matrix and range by FFmpeg's numbers."""

    matrix: int
    range: int

    def encode(self) -> np.ndarray:
        """The (3, 4) float64 matrix from RGB (0 to 255, and 1) to code values (Y, Cb, Cr)."""
        red, blue = _LUMA_SHARES[self.matrix]
        brightness = np.array([red, 1 - red - blue, blue])
        rows = [
            brightness,
            (np.array([0, 0, 1]) - brightness) / (2 * (1 - blue)),
            (np.array([1, 0, 0]) - brightness) / (2 * (1 - red)),
        ]
        spans = [255, 255, 255] if self.range == FULL_RANGE else [219, 224, 224]
        base = [0 if self.range == FULL_RANGE else 16, 128, 128]
        return np.column_stack([np.array(rows) * np.array(spans)[:, None] / 255, base])

    def decode(self) -> np.ndarray:
        """The (3, 3) float64 matrix from code values less their base to RGB (0 to 255): the inverse of `encode`."""
        return np.linalg.inv(self.encode()[:, :3])


def rgb_from_frame(frame: VideoFrame, coding: Coding) -> np.ndarray:
    """The RGB uint8 (H, W, 3) of a 4:2:0 frame of 8 bits (`yuv420p`, `yuvj420p`), of any size."""
    brightness, blue, red = (_samples(plane) for plane in frame.planes[:3])
    inverse = coding.decode()
    base = np.int32(0 if coding.range == FULL_RANGE else 16)
    weights = np.array([inverse[0, 0], inverse[0, 2] / 8, -inverse[1, 1] / 8, -inverse[1, 2] / 8, inverse[2, 1] / 8])
    rgb = np.empty((frame.height, frame.width * 3), np.uint8)
    _decode(brightness, blue, red, rgb, base, np.round(weights * _FIXED_POINT_ONE).astype(np.int32))
    return rgb.reshape(frame.height, frame.width, 3)


def frame_from_rgb(rgb: np.ndarray, alpha: np.ndarray | None = None) -> VideoFrame:
    """A 4:2:0 frame, BT.709 in limited range and tagged so, of `rgb` uint8 (H, W, 3); H and W are even.

    With `alpha` float32 (H, W) in [0, 1] the frame is `yuva420p`, else `yuv420p`.
    """
    height, width = rgb.shape[:2]
    frame = av.VideoFrame(width, height, "yuv420p" if alpha is None else "yuva420p")
    brightness, blue, red = (_samples(plane) for plane in frame.planes[:3])
    weights = np.round(Coding(BT709, LIMITED_RANGE).encode() * _FIXED_POINT_ONE)
    weights[1:, 3] *= 8
    weights[:, 3] += [_FIXED_POINT_ONE / 2, _FIXED_POINT_ONE * 4, _FIXED_POINT_ONE * 4]
    _encode(np.ascontiguousarray(rgb).reshape(height, width * 3), brightness, blue, red, weights.astype(np.int32))
    if alpha is not None:
        _samples(frame.planes[3])[:] = np.round(alpha * np.float32(255))
    frame.colorspace = frame.color_primaries = frame.color_trc = BT709
    frame.color_range = LIMITED_RANGE
    return frame


def _samples(plane: VideoPlane) -> np.ndarray:
    return np.frombuffer(memoryview(plane), np.uint8).reshape(plane.height, plane.line_size)[:, : plane.width]


@njit(nogil=True, error_model="numpy")
def _decode(
    brightness: np.ndarray, blue: np.ndarray, red: np.ndarray, rgb: np.ndarray, base: np.int32, weights: np.ndarray
) -> None:
    """Colour samples are interpolated linearly; all sums are 16.16 fixed point, those of colours 8 times as large."""
    height, width = brightness.shape
    rows, columns = blue.shape
    light, red_v, green_u, green_v, blue_u = weights
    u, v = np.empty(columns + 1, np.int32), np.empty(columns + 1, np.int32)
    offsets = np.empty((3, 2 * columns), np.int32)
    channels = np.empty((3, width), np.uint8)
    half, shift, low, high = np.int32(_FIXED_POINT_ONE // 2), np.int32(16), np.int32(0), np.int32(255)
    for y in range(height):
        near = y // 2
        far = max(near - 1, 0) if y % 2 == 0 else min(near + 1, rows - 1)
        for i in range(columns):
            u[i] = np.int32(3) * np.int32(blue[near, i]) + np.int32(blue[far, i]) - np.int32(512)
        for i in range(columns):
            v[i] = np.int32(3) * np.int32(red[near, i]) + np.int32(red[far, i]) - np.int32(512)
        u[columns], v[columns] = u[columns - 1], v[columns - 1]
        for i in range(columns):
            for side in range(2):  # on the sample itself, and midway to the next
                du, dv = u[i] + u[i + side], v[i] + v[i + side]
                offsets[0, 2 * i + side] = red_v * dv
                offsets[1, 2 * i + side] = -(green_u * du + green_v * dv)
                offsets[2, 2 * i + side] = blue_u * du
        for channel in range(3):
            for x in range(width):
                value = (np.int32(brightness[y, x]) - base) * light + half + offsets[channel, x]
                channels[channel, x] = np.uint8(min(max(np.int32(value) >> shift, low), high))
        for x in range(width):
            rgb[y, 3 * x], rgb[y, 3 * x + 1], rgb[y, 3 * x + 2] = channels[0, x], channels[1, x], channels[2, x]


@njit(nogil=True, error_model="numpy")
def _encode(rgb: np.ndarray, brightness: np.ndarray, blue: np.ndarray, red: np.ndarray, weights: np.ndarray) -> None:
    """Colour samples are the mean over two rows, weighted 1 2 1 over the columns about the left one of a pair."""
    height, width = brightness.shape
    sums = np.zeros((3, width + 1), np.int32)
    shift, shift_sum, two = np.int32(16), np.int32(19), np.int32(2)
    yr, yg, yb, y0 = weights[0]
    ur, ug, ub, u0 = weights[1]
    vr, vg, vb, v0 = weights[2]
    for row in range(height // 2):
        for x in range(width):
            r, g, b = (
                np.int32(rgb[2 * row, 3 * x]),
                np.int32(rgb[2 * row, 3 * x + 1]),
                np.int32(rgb[2 * row, 3 * x + 2]),
            )
            brightness[2 * row, x] = np.uint8(np.int32(yr * r + yg * g + yb * b + y0) >> shift)
            sums[0, x + 1], sums[1, x + 1], sums[2, x + 1] = r, g, b
        for x in range(width):
            r, g, b = (
                np.int32(rgb[2 * row + 1, 3 * x]),
                np.int32(rgb[2 * row + 1, 3 * x + 1]),
                np.int32(rgb[2 * row + 1, 3 * x + 2]),
            )
            brightness[2 * row + 1, x] = np.uint8(np.int32(yr * r + yg * g + yb * b + y0) >> shift)
            sums[0, x + 1] += r
            sums[1, x + 1] += g
            sums[2, x + 1] += b
        for channel in range(3):
            sums[channel, 0] = sums[channel, 1]
        for i in range(width // 2):
            r = sums[0, 2 * i] + two * sums[0, 2 * i + 1] + sums[0, 2 * i + 2]
            g = sums[1, 2 * i] + two * sums[1, 2 * i + 1] + sums[1, 2 * i + 2]
            b = sums[2, 2 * i] + two * sums[2, 2 * i + 1] + sums[2, 2 * i + 2]
            blue[row, i] = np.uint8(np.int32(ur * r + ug * g + ub * b + u0) >> shift_sum)
            red[row, i] = np.uint8(np.int32(vr * r + vg * g + vb * b + v0) >> shift_sum)
