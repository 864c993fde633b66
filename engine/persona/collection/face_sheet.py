"""The faces of a collection for people to look at: each as a small picture, and what became of it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.export.still import write_still
from engine.persona.collection.photo_face import PhotoFace
from engine.persona.collection.photos import Photos

TILE_PIXELS = 96
"""Pixels of a face's picture."""
FACE_SHEET_COLUMNS = 16
FACE_MARGIN = 1.3
"""Of a face's larger side that is shown."""


def write_faces(
    folder: Path,
    photos: Photos,
    faces: Sequence[PhotoFace],
    reasons: Sequence[str | None],
    distances: Sequence[float],
    looks: Sequence[int | None],
    synthetic: bool,
) -> list[Path]:
    """Leave `faces.json`, a list of all faces by their numbers, and `faces.jpg`, their pictures in rows of `FACE_SHEET_COLUMNS`."""
    rows = max(-(-len(faces) // FACE_SHEET_COLUMNS), 1)
    sheet = np.full((rows * TILE_PIXELS, FACE_SHEET_COLUMNS * TILE_PIXELS, 3), 255, np.uint8)
    told = []
    for number, (face, reason, distance, look) in enumerate(zip(faces, reasons, distances, looks, strict=True)):
        row, column = divmod(number, FACE_SHEET_COLUMNS)
        sheet[row * TILE_PIXELS : (row + 1) * TILE_PIXELS, column * TILE_PIXELS : (column + 1) * TILE_PIXELS] = (
            _picture(photos.picture(face.photo), face.mesh)
        )
        told.append(
            {
                "photo": photos.names[face.photo],
                "kept": reason is None,
                "reason": reason,
                "distance": round(distance, 3),
                "look": look,
                "year": face.year,
                "eye_distance": round(face.eye_distance, 1),
                "yaw": round(face.yaw, 1),
                "pitch": round(face.pitch, 1),
                "blur": round(face.blur, 3),
            }
        )
    skipped = [{"file": one.name, "code": one.code} for one in photos.skipped]
    document = {"tile": TILE_PIXELS, "columns": FACE_SHEET_COLUMNS, "faces": told, "skipped": skipped}
    (folder / "faces.json").write_text(json.dumps(document) + "\n")
    write_still(folder / "faces.jpg", sheet, synthetic)
    return [folder / "faces.json", folder / "faces.jpg"]


def _picture(rgb: NDArray[np.uint8], mesh: NDArray[np.float32]) -> NDArray[np.uint8]:
    low, high = mesh[:, :2].min(axis=0), mesh[:, :2].max(axis=0)
    scale = TILE_PIXELS / (FACE_MARGIN * float((high - low).max()))
    shift = (TILE_PIXELS - 1) / 2 - scale * (low + high) / 2
    matrix = np.array([[scale, 0, shift[0]], [0, scale, shift[1]]])
    flags = cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR
    found = cv2.warpAffine(rgb, matrix, (TILE_PIXELS, TILE_PIXELS), flags=flags, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(found, np.uint8)
