"""The binary part of a GLB: arrays one after the other, and the accessors that describe them."""

from __future__ import annotations

import numpy as np
import pygltflib as gl
from numpy.typing import NDArray

_COMPONENT_TYPES = {"u1": gl.UNSIGNED_BYTE, "u2": gl.UNSIGNED_SHORT, "u4": gl.UNSIGNED_INT, "f4": gl.FLOAT}
_ACCESSOR_TYPES = {(): gl.SCALAR, (2,): gl.VEC2, (3,): gl.VEC3, (4,): gl.VEC4, (4, 4): gl.MAT4}


class Buffer:
    """Collects arrays for a `pygltflib.GLTF2`; `finish` hands them over."""

    def __init__(self, gltf: gl.GLTF2):
        self._gltf = gltf
        self._data = bytearray()
        self._views: dict[str, int] = {}

    def add(
        self,
        array: NDArray[np.generic],
        target: int | None = None,
        bounds: bool = False,
        normalised: bool = False,
        shared: str | None = None,
    ) -> int:
        """An accessor for `array` (N, ...), its index.

        `target`: what the data are to a graphics card (`pygltflib.ARRAY_BUFFER`, ...). `bounds`: state the smallest
        and largest values. Arrays of the same name `shared`, added one right after the other, lie in one buffer view.
        Matrices are given row by row, as NumPy has them, and stored column by column.
        """
        if array.ndim == 3:
            array = array.transpose(0, 2, 1)
        kind = array.dtype.newbyteorder("<")
        raw = np.ascontiguousarray(array, kind).tobytes()
        view, offset = self._place(raw, target, shared)
        flat = array.reshape(len(array), -1)
        self._gltf.accessors.append(
            gl.Accessor(
                bufferView=view,
                byteOffset=offset,
                componentType=_COMPONENT_TYPES[kind.str[1:]],
                count=len(array),
                type=_ACCESSOR_TYPES[array.shape[1:]],
                normalized=normalised,
                min=flat.min(0).tolist() if bounds else None,
                max=flat.max(0).tolist() if bounds else None,
            )
        )
        return len(self._gltf.accessors) - 1

    def add_displacements(
        self, moved: NDArray[np.integer], offsets: NDArray[np.float32], count: int, bounds: bool = False
    ) -> int:
        """An accessor for (`count`, 3) float32 of which only the rows `moved` (M,), rising, are not zero: `offsets` (M, 3). Sparse
        where that is smaller; its index."""
        narrow: type[np.unsignedinteger] = np.uint16 if count <= np.iinfo(np.uint16).max else np.uint32
        if len(moved) * (narrow().itemsize + 12) >= count * 12:
            dense = np.zeros((count, 3), np.float32)
            dense[moved] = offsets
            return self.add(dense, gl.ARRAY_BUFFER, bounds=bounds)
        accessor = gl.Accessor(byteOffset=None, componentType=gl.FLOAT, count=count, type=gl.VEC3, min=None, max=None)
        if bounds:  # what is not named is zero
            accessor.min = np.minimum(offsets.min(0, initial=0), 0).tolist()
            accessor.max = np.maximum(offsets.max(0, initial=0), 0).tolist()
        if len(moved):
            kind = np.dtype(narrow).newbyteorder("<")
            accessor.sparse = gl.Sparse(
                count=len(moved),
                indices=gl.AccessorSparseIndices(
                    bufferView=self._place(np.asarray(moved).astype(kind).tobytes(), None, None)[0],
                    componentType=_COMPONENT_TYPES[kind.str[1:]],
                ),
                values=gl.AccessorSparseValues(
                    bufferView=self._place(np.ascontiguousarray(offsets, "<f4").tobytes(), None, None)[0]
                ),
            )
        self._gltf.accessors.append(accessor)
        return len(self._gltf.accessors) - 1

    def add_file(self, content: bytes) -> int:
        """A buffer view that holds a file, its index."""
        return self._place(content, None, None)[0]

    def finish(self) -> None:
        """Hand everything over; nothing can be added any more."""
        self._gltf.buffers = [gl.Buffer(byteLength=len(self._data))]
        self._gltf.set_binary_blob(bytes(self._data))

    def _place(self, raw: bytes, target: int | None, shared: str | None) -> tuple[int, int]:
        start = len(self._data)
        self._data += raw + bytes(-len(raw) % 4)
        views = self._gltf.bufferViews
        if shared is not None and shared in self._views:
            view = self._views[shared]
            offset = start - views[view].byteOffset
            views[view].byteLength = offset + len(raw)
            return view, offset
        views.append(gl.BufferView(buffer=0, byteOffset=start, byteLength=len(raw), target=target))
        if shared is not None:
            self._views[shared] = len(views) - 1
        return len(views) - 1, 0
