"""What results are called when they are saved."""

from __future__ import annotations

import pytest

from service.artifacts.naming import download_name

DRIVER = "0198c1d2-7b1a-7c3e-9c6d-0a1b2c3d4e5f"


@pytest.mark.parametrize(
    ("artifact", "metadata", "inputs", "options", "name"),
    [
        ("animation.mp4", {"portrait": "Grace hopper", "performance": "Happy"}, {}, {}, "grace-hopper-happy.mp4"),
        ("poster.jpg", {"portrait": "Grace hopper"}, {"driver": "happy"}, {}, "grace-hopper-happy-poster.jpg"),
        ("character.glb", {"photo": "Ann"}, {}, {"motion": "walk"}, "ann-walk-character.glb"),
        ("animation.webm", {"photo": "Ann", "motion": "Long_walk"}, {"motion": DRIVER}, {}, "ann-long-walk.webm"),
        ("animation.mp4", {"portrait": "Ann"}, {"driver": DRIVER}, {}, "ann.mp4"),
        ("animation.mp4", {"portrait": "Ann"}, {"driver": "https://host/a.mp4?key=secret"}, {}, "ann.mp4"),
        ("animation.mp4", {"portrait": "Ann"}, {"driver": "me/happy-2"}, {}, "ann-me-happy-2.mp4"),
        ("animation.mp4", {"portrait": "Žofie Ångström"}, {}, {}, "žofie-ångström.mp4"),
        ("animation.mp4", {"portrait": '../../etc/passwd"; rm -rf ~\r\nX: y'}, {}, {}, "etc-passwd-rm-rf-x-y.mp4"),
        ("animation.mp4", {"portrait": "a" * 500}, {}, {}, "a" * 60 + ".mp4"),
        ("animation.mp4", {"portrait": "...", "performance": "Happy"}, {}, {}, "animation.mp4"),
        ("animation.mp4", {"portrait": 7}, {"driver": 7}, {}, "animation.mp4"),
        ("report.json", {}, {}, {}, "report.json"),
    ],
)
def test_results_are_named_after_the_picture_and_what_it_does(
    artifact: str, metadata: dict, inputs: dict, options: dict, name: str
) -> None:
    assert download_name(artifact, metadata, inputs, options) == name
