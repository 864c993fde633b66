"""The numbers of a glTF file: accessors, by section 3.6 of the specification of glTF 2.0.

What a file claims is compared with the bytes that it has before anything is made of that size.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.motion.files.gltf_file import GltfFile, Part, natural_number, unreadable
from engine.motion.files.source_motion import MAX_MOTION_FRAMES, MAX_NUMBERS

T = TypeVar("T")

MAX_NUMBERS_READ = 4 * MAX_NUMBERS
"""Numbers that a file may have read in all: many accessors can point to the same bytes, or to none."""

MAX_ZERO_ELEMENTS = 3 * MAX_MOTION_FRAMES
"""Elements of an accessor without bytes: keys with their tangents."""

COMPONENT_TYPES = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
COMPONENT_COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
INDEX_TYPES = (5121, 5123, 5125)


class Accessors:
    """The accessors of a file, each read once."""

    def __init__(self, file: GltfFile):
        self._file = file
        self._found: dict[int, NDArray[np.float64]] = {}
        self._varying: dict[int, bool] = {}
        self._read = 0

    def numbers(self, index: int | None) -> NDArray[np.float64]:
        """(count, width) the numbers of an accessor; integers that stand for fractions become these.

        Raises
        ------
        InputError : `motion_unreadable`, `motion_too_large`, `motion_not_finite`, `motion_extension`.
        """
        part = self._file.part("accessors", index)
        assert index is not None
        count, width = natural_number(part.count), _known(COMPONENT_COUNTS, part.type)
        kind = np.dtype(_known(COMPONENT_TYPES, part.componentType)).newbyteorder("<")
        if count == 0:
            raise unreadable("an accessor is empty")
        as_it_lies = self._dense(part, count, width, kind)
        self._read += count * width
        if self._read > MAX_NUMBERS_READ:
            raise _too_many()
        if index not in self._found:
            self._found[index] = _finite(_fractions(self._changed(as_it_lies, part, count, width, kind), part, kind))
        return self._found[index]

    def varies(self, index: int | None) -> bool:
        """Whether the numbers of an accessor are not the same from first to last."""
        if index is None or index not in self._varying:
            values = self.numbers(index)
            assert index is not None
            self._varying[index] = bool(np.ptp(values, axis=0).max() > 1e-3)
        return self._varying[index]

    def _dense(self, part: Part, count: int, width: int, kind: np.dtype[np.generic]) -> NDArray[np.generic]:
        """The numbers in the accessor's view, or as many zeros where it has none."""
        if part.bufferView is not None:
            return self._table(part.bufferView, natural_number(part.byteOffset, 0), count, width, kind)
        if count > MAX_ZERO_ELEMENTS:
            raise _too_many()
        return np.zeros((count, width), kind)

    def _changed(
        self, table: NDArray[np.generic], part: Part, count: int, width: int, kind: np.dtype[np.generic]
    ) -> NDArray[np.generic]:
        """The numbers with those of a sparse accessor in their places."""
        if part.sparse is None:
            return table
        sparse = part.sparse
        if not all(isinstance(one, Part) for one in (sparse, sparse.get("indices"), sparse.get("values"))):
            raise unreadable("a sparse accessor is broken")
        for one in (sparse, sparse.indices, sparse["values"]):
            self._file.require_known(one)
        changed = natural_number(sparse.count)
        if not 0 < changed <= count or sparse.indices.componentType not in INDEX_TYPES:
            raise unreadable("a sparse accessor is broken")
        places = self._table(
            sparse.indices.bufferView,
            natural_number(sparse.indices.byteOffset, 0),
            changed,
            1,
            np.dtype(COMPONENT_TYPES[sparse.indices.componentType]).newbyteorder("<"),
        )[:, 0].astype(np.int64)
        if places[-1] >= count or (np.diff(places) <= 0).any():
            raise unreadable("a sparse accessor is broken")
        table = table.copy()
        table[places] = self._table(
            sparse["values"].bufferView, natural_number(sparse["values"].byteOffset, 0), changed, width, kind
        )
        return table

    def _table(self, view: int, start: int, count: int, width: int, kind: np.dtype[np.generic]) -> NDArray[np.generic]:
        """(count, width) numbers of a view, as they lie in it."""
        data, said = self._file.view(view)
        row = width * kind.itemsize
        stride = natural_number(said.byteStride, 0) or row
        if stride < row or start + stride * (count - 1) + row > len(data):
            raise unreadable("an accessor points outside its buffer")
        return np.ndarray((count, width), kind, data, start, (stride, kind.itemsize))


def _too_many() -> InputError:
    return InputError("motion_too_large", "The glTF file has too many keys: cut the recording.")


def _known(among: Mapping[Any, T], key: Any) -> T:
    if not isinstance(key, int | str) or key not in among:
        raise unreadable("an accessor is of no known kind")
    return among[key]


def _fractions(table: NDArray[np.generic], part: Part, kind: np.dtype[np.generic]) -> NDArray[np.float64]:
    values = table.astype(np.float64)
    if part.normalized and kind.kind != "f":
        values = np.maximum(values / (2.0 ** (8 * kind.itemsize - (kind.kind == "i")) - 1), -1.0)
    return values


def _finite(values: NDArray[np.float64]) -> NDArray[np.float64]:
    if not np.isfinite(values).all():
        raise InputError("motion_not_finite", "The glTF file holds numbers that are not finite: export it again.")
    return values
