"""What schemathesis cannot know of the service: how pictures and videos look, and what a job of the tiny kind takes.

Loaded by the process that `test_schemathesis.py` starts. Only requests that are meant to be right are touched: those
that are meant to be wrong are sent as schemathesis made them.
"""

from __future__ import annotations

import os
from io import BytesIO
from typing import Any

import numpy as np
import schemathesis
from hypothesis import strategies as st
from made_motion import bvh
from PIL import Image

UNKNOWN = "x-schemathesis-unknown-property"
UNKNOWN_ID = "01a00000-0000-7000-8000-000000000000"


def picture(seed: int) -> bytes:
    """A small PNG file."""
    file = BytesIO()
    Image.fromarray(np.random.default_rng(seed).integers(0, 256, (4, 6, 3), np.uint8)).save(file, "PNG")
    return file.getvalue()


def video(length: int) -> bytes:
    """The first bytes of an MP4 file: enough for the door, which decodes nothing."""
    return b"\x00\x00\x00\x18ftypisom\x00\x00\x02\x00isomiso2" + bytes(length)


schemathesis.openapi.media_type("image/png", st.integers(0, 9).map(picture))
schemathesis.openapi.media_type("video/mp4", st.integers(8, 40).map(video))
schemathesis.openapi.media_type("text/x-bvh", st.integers(1, 9).map(lambda frames: bvh(frames=frames)))
schemathesis.openapi.media_type("model/gltf-binary", st.integers(8, 40).map(lambda length: b"glTF" + bytes(length)))
schemathesis.openapi.media_type("model/gltf+json", st.integers(0, 9).map(lambda n: b'{"asset":{}}' + b" " * n))
schemathesis.serializer.alias(["application/offset+octet-stream"], "application/octet-stream")


@schemathesis.hook
def filter_case(context: schemathesis.HookContext, case: schemathesis.Case) -> bool:
    """A header that no document names is no fault of a request, nor is a number or a truth value in a form: there all that is no
    file is text."""
    form = case.media_type == "multipart/form-data" and isinstance(case.body, dict)
    return UNKNOWN not in case.headers and not (form and any(isinstance(v, int | float) for v in case.body.values()))


@schemathesis.hook
def before_call(context: schemathesis.HookContext, case: schemathesis.Case, kwargs: dict[str, Any]) -> None:
    if (
        case.method != "GET"
    ):  # the key that all requests are sent with stays, and so does the job that keeps the file of all
        kept = os.environ["GALATEA_TEST_KEPT"].split()
        case.path_parameters.update({name: UNKNOWN_ID for name, given in case.path_parameters.items() if given in kept})
    if case.meta is None or not case.meta.generation.mode.is_positive:
        return
    case.headers.pop("idempotency-key", None)  # a key belongs to one request, and these are many
    match case.operation.definition.raw.get("operationId"):
        case "create_job" if isinstance(case.body, dict):
            metadata = case.body.get("metadata", {})
            case.body = {"kind": "tiny", "inputs": {"image": os.environ["GALATEA_TEST_FILE_ID"]}, "metadata": metadata}
        case "revise_job" if isinstance(case.body, dict):
            kept = {name: case.body[name] for name in ("metadata", "priority") if name in case.body}
            case.body = {**kept, "options": {"seconds": 0.1}, "corrections": {"level": 2}}
        case "create_live" if isinstance(case.body, dict):
            case.body = {"image": UNKNOWN_ID}  # which starts nothing
        case "create_webhook" | "change_webhook" if isinstance(case.body, dict):
            case.body = {**case.body, "url": "http://127.0.0.1:9/told"}
