"""Writes the smallest useful ONNX model by hand: alpha is the mean of the three colours.

The protocol buffer's fields are those of onnx.proto3: a message is a list of (field number, payload).
"""

from __future__ import annotations

from pathlib import Path


def brightness_model(path: Path, side: int | None = None, channels: int = 3) -> Path:
    """ReduceMean over the channels of (1, channels, h, w); h and w are `side`, or left open."""
    spatial = [_number(1, side)] * 2 if side else [_text(2, "h"), _text(2, "w")]

    def value(name: str, count: int) -> bytes:
        dimensions = [_number(1, 1), _number(1, count), *spatial]
        shape = b"".join(_message(1, dimension) for dimension in dimensions)
        tensor = _number(1, 1) + _message(2, shape)  # float32
        return _text(1, name) + _message(2, _message(1, tensor))

    axes = _text(1, "axes") + _number(8, 1) + _number(20, 7)
    keep = _text(1, "keepdims") + _number(3, 1) + _number(20, 2)
    node = _text(1, "rgb") + _text(2, "alpha") + _text(4, "ReduceMean") + _message(5, axes) + _message(5, keep)
    graph = _message(1, node) + _text(2, "brightness") + _message(11, value("rgb", channels))
    graph += _message(12, value("alpha", 1))
    path.write_bytes(_number(1, 8) + _message(8, _number(2, 13)) + _message(7, graph))
    return path


def _varint(value: int) -> bytes:
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    return bytes([*out, value])


def _number(field: int, value: int) -> bytes:
    return _varint(field << 3) + _varint(value)


def _message(field: int, payload: bytes) -> bytes:
    return _varint(field << 3 | 2) + _varint(len(payload)) + payload


def _text(field: int, text: str) -> bytes:
    return _message(field, text.encode())
