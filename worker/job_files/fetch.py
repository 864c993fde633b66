"""Fetching an input from the address that a user gave.

Every hop goes through `service.outbound`: public addresses only (or networks that the operator allows), looked up once
and pinned. What comes is judged as an upload is, by its first bytes and its size, while it streams to disk. Nothing is
decoded, and nothing that is compressed for the transport is expanded.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote, urlsplit

import httpx

from service.disk import require_space
from service.files.admission import SNIFFED_BYTES, largest_mb, recognise, shown_name
from service.outbound.address import AddressRefused, require_callable
from service.outbound.client import client
from service.problems import Problem
from service.settings import BYTES_PER_MEGABYTE, Settings

MAX_REDIRECTS = 5
FETCH_CONNECT_SECONDS = 10.0
STALL_SECONDS = 20.0
"""How long a host may send nothing."""

ACCEPT_HEADERS = {"Accept": "image/*, video/*"}


class FetchFailed(Exception):
    """The input cannot be had; ends the job."""

    def __init__(self, code: str, detail: str):
        super().__init__(f"{code}: {detail}")
        self.code = code
        self.detail = detail


class FetchStopped(Exception):
    """Nobody wants it any more."""


@dataclass(frozen=True)
class Fetched:
    """What was fetched, in a local file."""

    path: Path
    name: str
    content_type: str
    size: int
    sha256: str


def fetch(
    settings: Settings,
    url: str,
    path: Path,
    on_bytes: Callable[[int, int | None], None] = lambda come, announced: None,
    stopped: Callable[[], bool] = lambda: False,
) -> Fetched:
    """Fetch `url` into the file `path`. `on_bytes` learns how much has come of how much, as far as that was said.

    Raises `FetchFailed`, `FetchStopped`, OSError.
    """
    deadline = time.monotonic() + settings.fetch_seconds
    try:
        with ExitStack() as stack:
            http = stack.enter_context(
                client(settings, connect_seconds=FETCH_CONNECT_SECONDS, seconds=settings.fetch_seconds)
            )
            response = _open(settings, http, url, deadline, stack)
            return _receive(settings, url, response, path, deadline, on_bytes, stopped)
    except AddressRefused as refused:
        raise FetchFailed("input_url_refused", str(refused)) from refused
    except httpx.TimeoutException as error:
        raise _too_slow(settings) from error
    except (httpx.HTTPError, httpx.InvalidURL) as error:
        raise _unreachable(f"the connection failed ({error or type(error).__name__})") from error


def _open(settings: Settings, http: httpx.Client, url: str, deadline: float, stack: ExitStack) -> httpx.Response:
    """Ask for the address, and for those that it leads on to. Returns the answer before its content has come."""
    for _ in range(MAX_REDIRECTS + 1):
        require_callable(url, settings.allowed_networks)
        left = deadline - time.monotonic()
        if left <= 0:
            raise _too_slow(settings)
        timeout = httpx.Timeout(min(left, STALL_SECONDS), connect=min(left, FETCH_CONNECT_SECONDS))
        response = http.send(http.build_request("GET", url, timeout=timeout, headers=ACCEPT_HEADERS), stream=True)
        stack.callback(response.close)
        if not response.has_redirect_location:
            if response.status_code != 200:
                raise _unreachable(f"it was answered with {response.status_code} {response.reason_phrase}".rstrip())
            return response
        url = str(response.url.join(response.headers["location"]))
        response.close()
    raise FetchFailed("input_url_refused", f"The address leads on more than {MAX_REDIRECTS} times: give the last one.")


def _receive(
    settings: Settings,
    url: str,
    response: httpx.Response,
    path: Path,
    deadline: float,
    on_bytes: Callable[[int, int | None], None],
    stopped: Callable[[], bool],
) -> Fetched:
    name = shown_name(unquote(urlsplit(url).path))
    announced = response.headers.get("content-length", "")
    total = int(announced) if announced.isdecimal() else None
    _require_size(largest_mb(settings), total or 0)
    _require_space(settings, total or 0)
    sha256, size, content_type, limit = hashlib.sha256(), 0, "", largest_mb(settings)
    with path.open("wb+") as file:
        for data in response.iter_raw():
            if stopped():
                raise FetchStopped
            if time.monotonic() > deadline:
                raise _too_slow(settings)
            file.write(data)
            sha256.update(data)
            size += len(data)
            if not content_type and size >= SNIFFED_BYTES:
                content_type = _recognise(path, file.flush, name)
                limit = largest_mb(settings, content_type)
            _require_size(limit, max(size, total or 0) if content_type else size)
            _require_space(settings)
            on_bytes(size, total)
        if size == 0:
            raise FetchFailed("file_empty", "What lies at the address is empty: it has 0 bytes.")
        content_type = content_type or _recognise(path, file.flush, name)
    return Fetched(path, name, content_type, size, sha256.hexdigest())


def _recognise(path: Path, flush: Callable[[], None], name: str) -> str:
    flush()
    with path.open("rb") as file:
        head = file.read(SNIFFED_BYTES)
    try:
        return recognise(head, name, declared="")  # what hosts declare says little
    except Problem as problem:
        raise FetchFailed(problem.code, problem.detail) from problem


def _require_size(limit_mb: float, size: int) -> None:
    if size > limit_mb * BYTES_PER_MEGABYTE:
        raise FetchFailed(
            "input_url_too_large",
            f"What lies at the address is larger than {limit_mb:g} MB, the most that is accepted.",
        )


def _require_space(settings: Settings, coming: int = 0) -> None:
    try:
        require_space(settings, coming)
    except Problem as problem:
        raise FetchFailed("disk_full", problem.detail) from problem


def _too_slow(settings: Settings) -> FetchFailed:
    return FetchFailed(
        "input_url_timeout",
        f"The address did not give everything within {settings.fetch_seconds:g} seconds, or fell silent: upload the file "
        "instead, or try again.",
    )


def _unreachable(why: str) -> FetchFailed:
    return FetchFailed(
        "input_url_unreachable",
        f"The address could not be read: {why}. See whether it opens without signing in, or upload the file instead.",
    )
