"""Job kinds as the API shows them: enough to draw a form."""

from __future__ import annotations

from running import Running

from service.catalogue.registry import load_kinds
from service.kinds.schemas import KindOut
from service.settings import Settings


def test_kinds_describe_their_inputs_and_options(running: Running) -> None:
    kinds = {kind["name"]: kind for kind in running.client.get("/v1/kinds").json()["items"]}
    assert set(kinds) == {"tiny"}
    assert kinds["tiny"]["inputs_schema"]["required"] == ["image"]
    assert kinds["tiny"]["correctable"] == ["level", "mask"]
    assert kinds["tiny"]["options_schema"]["properties"]["seconds"]["minimum"] == 0


def test_the_engines_kinds_have_the_names_and_inputs_of_the_contract() -> None:
    offered = {kind.name: KindOut.of(kind, Settings()) for kind in load_kinds(Settings().kinds).values()}
    assert [item.name for item in offered["portrait"].inputs][:2] == ["image", "driver"]
    fixed = {"size", "fps", "format", "strength", "follow", "crop", "loop", "sound", "neutral_frame", "face_index"}
    assert set(offered["portrait"].options_schema["properties"]) >= fixed
