"""The endpoints of the libraries are the same in each."""

from __future__ import annotations

from running import Running

from service.libraries.library import LIBRARIES


def test_every_library_has_the_same_endpoints(running: Running) -> None:
    paths = running.client.get("/v1/openapi.json").json()["paths"]
    for library in LIBRARIES.values():
        assert set(paths[library.address]) == {"get", "post"}
        assert set(paths[f"{library.address}/{{name}}"]) == {"get", "patch", "delete"}
        inspections = [
            operation["operationId"]
            for path, item in paths.items()
            for operation in item.values()
            if path.startswith(f"{library.address}/{{name}}/") and "202" in operation["responses"]
        ]
        assert len(inspections) == 1 and inspections[0].endswith(f"_{library.noun}")
