"""The media types of artifacts, by their names' endings."""

from __future__ import annotations

from pathlib import PurePosixPath

CONTENT_TYPES = {
    ".bvh": "text/plain; charset=utf-8",
    ".gif": "image/gif",
    ".glb": "model/gltf-binary",
    ".jpeg": "image/jpeg",
    ".jpg": "image/jpeg",
    ".json": "application/json",
    ".mp4": "video/mp4",
    ".ply": "application/octet-stream",
    ".png": "image/png",
    ".usdz": "model/vnd.usdz+zip",
    ".vrm": "model/gltf-binary",
    ".webm": "video/webm",
    ".webp": "image/webp",
    ".zip": "application/zip",
}


def content_type(name: str) -> str:
    """The media type of an artifact; unknown endings are plain bytes, which no browser tries to show."""
    return CONTENT_TYPES.get(PurePosixPath(name).suffix.lower(), "application/octet-stream")
