"""What is logged, and what is not."""

from __future__ import annotations

import json
import logging
from collections.abc import Iterator
from pathlib import Path

import anyio
import httpx
import pytest
import structlog

from service.app import make_app
from service.context import Context
from service.logs import configure
from service.settings import Settings


@pytest.fixture(autouse=True)
def _as_before() -> Iterator[None]:
    root = logging.getLogger()
    handlers, level = root.handlers, root.level
    yield
    root.handlers = handlers
    root.setLevel(level)
    structlog.reset_defaults()


@pytest.mark.parametrize("log_format", ["console", "json"])
def test_an_error_is_logged_with_its_place_and_without_the_values_of_variables(
    log_format: str, capsys: pytest.CaptureFixture[str]
) -> None:
    configure(Settings(log_format=log_format))  # type: ignore[arg-type]
    secret = "gal_" + "s3cret" * 3
    try:
        raise LookupError("nothing there") from ValueError(len(secret))
    except LookupError as error:
        structlog.get_logger().error("unexpected_error", exc_info=error)
        logging.getLogger("some.library").error("library_error", exc_info=error)
    text = capsys.readouterr().err
    assert secret not in text
    assert text.count("nothing there") >= 2 and text.count("LookupError") >= 2 and "test_logs" in text
    if log_format == "json":
        assert [json.loads(line)["event"] for line in text.splitlines()] == ["unexpected_error", "library_error"]


def test_a_fault_of_the_program_is_found_by_its_request(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def broken() -> None:
        logging.getLogger("some.library").warning("library_warning")
        raise ZeroDivisionError

    async def ask() -> httpx.Response:
        transport = httpx.ASGITransport(app, raise_app_exceptions=False)
        async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
            return await client.get("/v1/broken", headers={"X-Request-Id": "order-4711"})

    settings = Settings(data_dir=tmp_path, kinds=[], log_format="json")
    context = Context.open(settings)
    configure(settings)
    app = make_app(context)
    app.router.add_api_route("/v1/broken", broken)
    answer = anyio.run(ask)
    context.close()
    assert answer.status_code == 500
    assert answer.headers["X-Request-Id"] == answer.json()["request_id"] == "order-4711"
    lines = [json.loads(line) for line in capsys.readouterr().err.splitlines()]
    assert [(line["event"], line["request"]) for line in lines] == [
        ("library_warning", "order-4711"),
        ("unexpected_error", "order-4711"),
    ]
