"""Built-in libraries, by the names that inputs of kinds give them."""

from __future__ import annotations

import pytest

from engine.media.image import read_image
from engine.media.video import probe_video
from service.catalogue import built_in


def test_every_performance_has_a_video_and_a_picture_and_no_motion_has_either() -> None:
    for name in built_in.names("performances"):
        assert probe_video(built_in.item("performances", name)).frames > 1
        assert read_image(built_in.picture("performances", name)).rgb.size
    assert "walk" in built_in.names("motions")
    with pytest.raises(KeyError):
        built_in.item("motions", "walk")


@pytest.mark.parametrize(("library", "name"), [("performances", "../happy"), ("performances", ""), ("songs", "happy")])
def test_there_is_nothing_else(library: str, name: str) -> None:
    assert name not in built_in.names(library)
    for find in (built_in.item, built_in.picture):
        with pytest.raises(KeyError):
            find(library, name)
