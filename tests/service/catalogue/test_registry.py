"""The job kinds on offer, as an operator names them."""

from __future__ import annotations

import subprocess
import sys

import pytest
import tiny_kind

from engine.kinds import KINDS
from service.catalogue.registry import load_kinds, require_known


def test_a_place_holds_one_kind_or_many_and_the_last_of_a_name_counts() -> None:
    kinds = load_kinds(["tiny_kind:KIND", "engine.kinds"])
    assert list(kinds) == ["tiny", *KINDS]
    assert kinds["tiny"] is tiny_kind.KIND and kinds["portrait"] is KINDS["portrait"]


def test_what_is_no_kind_is_refused_by_its_place() -> None:
    with pytest.raises(TypeError, match=r"engine\.store:__dict__"):
        load_kinds(["engine.store:__dict__"])


def test_a_worker_serves_only_kinds_that_there_are() -> None:
    require_known([], KINDS)
    require_known(["portrait"], KINDS)
    with pytest.raises(ValueError, match=r"no job kind sculpture; there are .*portrait"):
        require_known(["portrait", "sculpture"], KINDS)


def test_kinds_are_known_without_the_libraries_that_do_their_work() -> None:
    """A service and a worker start with them: the work's libraries take seconds, and some hundred megabytes."""
    asked = (
        "import sys, service.app, shell.serve, shell.web_server, worker.app\n"
        "from service.catalogue.registry import load_kinds\n"
        "print(len(load_kinds(['engine.kinds:KINDS'])), *sorted({name.partition('.')[0] for name in sys.modules}))"
    )
    said = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True).stdout.split()
    assert int(said[0]) == len(KINDS) and "sqlalchemy" in said
    working = {"av", "cv2", "mediapipe", "numba", "onnxruntime", "PIL", "pxr", "pygltflib", "scipy", "trimesh"}
    assert not working & set(said)
    assert "pg8000" not in said, "nobody has named a PostgreSQL"
