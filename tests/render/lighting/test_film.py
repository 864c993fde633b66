"""From light to a picture: tones and the mean of finer pixels."""

import numpy as np

from engine.render.lighting.film import box_downsample, develop


def test_film_keeps_middle_tones_and_rolls_off_highlights() -> None:
    steps = np.linspace(0, 8, 400, dtype=np.float32)
    shown = develop(np.repeat(steps[None, :, None], 3, 2), exposure=1.0)[0, :, 0].astype(int)
    assert (np.diff(shown) >= 0).all()
    assert shown[0] == 0 and 250 <= shown[-1] <= 255
    middle = develop(np.full((1, 1, 3), 0.2140, np.float32), exposure=1.0)
    assert (middle == 127).all() or (middle == 128).all()  # half of sRGB's range


def test_shrinking_takes_the_mean() -> None:
    picture = np.arange(16, dtype=np.float32).reshape(4, 4)
    np.testing.assert_allclose(box_downsample(picture, 2), [[2.5, 4.5], [10.5, 12.5]])
