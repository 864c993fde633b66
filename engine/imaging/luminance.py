"""How light a colour is to the eye."""

from __future__ import annotations

import numpy as np

LUMINANCE_WEIGHTS = np.array([0.299, 0.587, 0.114], np.float32)
"""Of red, green and blue, sRGB (ITU-R BT.601)."""
