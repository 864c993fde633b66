"""Floating-point numbers as whole ones times a power of two, which differ in fewer bytes from row to row.

Specification: Khronos, EXT_meshopt_compression, "Filter 3: exponential".
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

MANTISSA_BITS = 24


def encode_exponential(numbers: NDArray[np.floating], exponent: int) -> NDArray[np.int32]:
    """Words of the filter for numbers, of the same shape: each the nearest multiple of 2 to the power of `exponent`.

    Raises ValueError where a number is too large for it: 2^(23 + exponent) or more.
    """
    whole = np.rint(np.asarray(numbers, np.float64) * 2.0**-exponent)
    if np.abs(whole).max(initial=0) >= 1 << (MANTISSA_BITS - 1):
        raise ValueError(f"a number is too large for steps of 2^{exponent}")
    mantissa = whole.astype(np.int64) & ((1 << MANTISSA_BITS) - 1)
    return (mantissa | (exponent & 0xFF) << MANTISSA_BITS).astype(np.uint32).view(np.int32)


def rounded(numbers: NDArray[np.floating], exponent: int) -> NDArray[np.float64]:
    """What a decoder makes of them."""
    return np.asarray(np.rint(np.asarray(numbers, np.float64) * 2.0**-exponent) * 2.0**exponent)
