"""The client that blocks."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable, Coroutine, Generator
from functools import wraps
from types import TracebackType
from typing import Any, Concatenate, ParamSpec, Self, TypeVar

import httpx

from galatea_client.core import Core
from galatea_client.job import Job
from galatea_client.lines import BlockingLine, each, run
from galatea_client.requests import address_of, headers_of
from galatea_client.transport import Transport

P = ParamSpec("P")
T = TypeVar("T")
_Core = Core[Job]


def now(
    method: Callable[Concatenate[Core[Job], P], Coroutine[Any, Any, T]],
) -> Callable[Concatenate[Client, P], T]:
    """A method of the core, brought to its end on the spot."""

    @wraps(method)
    def call(client: Client, /, *arguments: P.args, **named: P.kwargs) -> T:
        return run(method(client._core, *arguments, **named))

    return call


def one_by_one(
    method: Callable[Concatenate[Core[Job], P], AsyncGenerator[T]],
) -> Callable[Concatenate[Client, P], Generator[T]]:
    """A method of the core that yields, as an iterator; it asks for nothing before its first item is wanted."""

    @wraps(method)
    def call(client: Client, /, *arguments: P.args, **named: P.kwargs) -> Generator[T]:
        return each(method(client._core, *arguments, **named))

    return call


class Client:
    """A connection to a service; a context manager. What its methods do is written in `core`.

    Parameters
    ----------
    base_url : where the service is, such as "http://127.0.0.1:8000".
    key : what `galatea keys create` printed; none is needed on the service's own machine.
    retries : how often a request is sent again when the line breaks or the service says to come back later.
    patience : the longest that the service may ask to wait before that, seconds.
    timeout : seconds without an answer after which a line counts as broken.
    transport : what httpx sends requests by, such as `httpx.HTTPTransport(verify=...)`; its own by default.

    Raises
    ------
    InvalidAddress : `base_url` is none.
    """

    def __init__(
        self,
        base_url: str,
        key: str | None = None,
        retries: int = 4,
        patience: float = 60.0,
        timeout: float = 30.0,
        transport: httpx.BaseTransport | None = None,
    ):
        base = address_of(base_url)
        http = httpx.Client(base_url=base, headers=headers_of(key), timeout=timeout, transport=transport)
        self._core = Core(Transport(BlockingLine(http), base, retries, patience), timeout, Job, owner=self)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    close = now(_Core.close)

    # Files

    upload = now(_Core.upload)
    file = now(_Core.file)
    download_file = now(_Core.download_file)

    # Jobs

    submit = now(_Core.submit)
    revise = now(_Core.revise)
    job = now(_Core.job)
    jobs = one_by_one(_Core.jobs)
    follow = one_by_one(_Core.follow)
    wait = now(_Core.wait)
    rename = now(_Core.rename)
    cancel = now(_Core.cancel)
    delete = now(_Core.delete)
    revisions = now(_Core.revisions)
    download = now(_Core.download)
    download_archive = now(_Core.download_archive)

    # Public links

    create_link = now(_Core.create_link)
    links = now(_Core.links)
    all_links = one_by_one(_Core.all_links)
    revoke_link = now(_Core.revoke_link)

    # Kinds and drivers

    kinds = now(_Core.kinds)
    drivers = now(_Core.drivers)
    driver = now(_Core.driver)
    search_driver = now(_Core.search_driver)
    create_live = now(_Core.create_live)
    live = now(_Core.live)
    end_live = now(_Core.end_live)
    create_driver = now(_Core.create_driver)
    rename_driver = now(_Core.rename_driver)
    delete_driver = now(_Core.delete_driver)

    # Motions

    motions = now(_Core.motions)
    motion = now(_Core.motion)
    create_motion = now(_Core.create_motion)
    check_motion = now(_Core.check_motion)
    rename_motion = now(_Core.rename_motion)
    delete_motion = now(_Core.delete_motion)
    download_motion = now(_Core.download_motion)

    # Webhooks

    webhooks = now(_Core.webhooks)
    create_webhook = now(_Core.create_webhook)
    change_webhook = now(_Core.change_webhook)
    delete_webhook = now(_Core.delete_webhook)
    webhook_secret = now(_Core.webhook_secret)
    rotate_webhook_secret = now(_Core.rotate_webhook_secret)
    test_webhook = now(_Core.test_webhook)
    deliveries = one_by_one(_Core.deliveries)
    replay = now(_Core.replay)

    # Keys

    own_key = now(_Core.own_key)
    keys = now(_Core.keys)
    create_key = now(_Core.create_key)
    revoke_key = now(_Core.revoke_key)
