"""How large a file may be by what it is, and which declarations are no lies."""

from __future__ import annotations

from pathlib import Path

import pytest

from service.files.admission import largest_mb, recognise
from service.problems import Problem
from service.settings import Settings

GIF = b"GIF89a\x01\x00\x01\x00\x80\x00\x00\x00\x00\x00\xff\xff\xff,"


@pytest.mark.parametrize(
    ("content_type", "megabytes"),
    [
        ("image/jpeg", 3),
        ("video/mp4", 70),
        ("image/gif", 70),
        ("image/webp", 70),
        ("model/gltf-binary", 70),
        ("application/zip", 70),
        ("", 70),
    ],
)
def test_what_may_be_a_film_may_be_as_large_as_one(tmp_path: Path, content_type: str, megabytes: float) -> None:
    settings = Settings(data_dir=tmp_path, image_mb=3, video_mb=70)
    assert largest_mb(settings, content_type) == megabytes


def test_the_most_of_all_is_that_of_pictures_where_these_may_be_larger(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path, image_mb=90, video_mb=70)
    assert (largest_mb(settings), largest_mb(settings, "image/png"), largest_mb(settings, "image/gif")) == (90, 90, 70)


def test_a_gif_is_a_picture_or_a_film_and_nothing_else() -> None:
    for declared in ("image/gif", "video/mp4", "application/octet-stream", ""):
        assert recognise(GIF, "a.gif", declared) == "image/gif"
    for head, declared in ((b"\x89PNG\r\n\x1a\n" + bytes(100), "video/mp4"), (b"no media", "image/gif")):
        with pytest.raises(Problem) as refused:
            recognise(head, "a", declared)
        assert refused.value.status == 415
