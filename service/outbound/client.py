"""A client that calls only hosts that may be called.

The check sits where a connection is made: the name is looked up once, its addresses are judged, and the socket goes to
one of those very addresses. A name that points elsewhere a moment later (DNS rebinding) gains nothing by it. Every
redirect that a caller chooses to follow makes a connection of its own and is judged again. The name itself still
stands in `Host`, in the TLS handshake (SNI) and in the check of the certificate.
"""

from __future__ import annotations

import ssl
import time
from collections.abc import Iterable, Sequence
from http.cookiejar import CookieJar, DefaultCookiePolicy
from typing import Any

import httpcore
import httpx

import engine
from service.outbound.address import Network, resolve
from service.settings import Settings


def client(settings: Settings, *, connect_seconds: float, seconds: float, **options: Any) -> httpx.Client:
    """A client for addresses that users gave; `http://` is called in allowed networks only.

    A call takes `seconds` at most from its connection to the last byte of its answer, however slowly those come.
    `options` go to `httpx.Client`. A call raises `AddressRefused` or `httpx.HTTPError`.
    """
    trusted = httpx.create_ssl_context()
    allowed = settings.allowed_networks
    return httpx.Client(
        mounts={
            "https://": _Transport(Backend(allowed, seconds, encrypted=True), trusted),
            "http://": _Transport(Backend(allowed, seconds, encrypted=False), trusted),
        },
        timeout=httpx.Timeout(seconds, connect=connect_seconds),
        cookies=CookieJar(DefaultCookiePolicy(allowed_domains=())),  # no receiver's mark comes along to the next call
        trust_env=False,  # a proxy from the environment would look names up by itself
        headers={"User-Agent": f"Galatea/{engine.__version__}", "Accept-Encoding": "identity"},
        **options,
    )


class Backend(httpcore.NetworkBackend):
    """Makes connections to checked addresses, each with a deadline for all that it is used for."""

    def __init__(self, allowed: Sequence[Network], seconds: float, encrypted: bool):
        self._allowed = allowed
        self._seconds = seconds
        self._encrypted = encrypted
        self._sockets = httpcore.SyncBackend()

    def connect_tcp(
        self,
        host: str,
        port: int,
        timeout: float | None = None,
        local_address: str | None = None,
        socket_options: Iterable[Any] | None = None,
    ) -> httpcore.NetworkStream:
        deadline = Deadline(self._seconds)
        connected = Deadline(deadline.within(timeout))
        try:
            addresses = resolve(host, port, self._allowed, self._encrypted, connected.left())
        except TimeoutError as error:
            raise httpcore.ConnectTimeout(str(error)) from error
        except OSError as error:
            raise httpcore.ConnectError(str(error)) from error
        for address in addresses[:-1]:
            try:
                stream = self._sockets.connect_tcp(address, port, connected.left() / 2, local_address, socket_options)
                return Timed(stream, deadline)
            except (httpcore.ConnectError, httpcore.ConnectTimeout):
                continue
        stream = self._sockets.connect_tcp(addresses[-1], port, connected.left(), local_address, socket_options)
        return Timed(stream, deadline)


class Deadline:
    """A moment by which something must be done."""

    def __init__(self, seconds: float):
        self._end = time.monotonic() + seconds

    def left(self) -> float:
        """Seconds until then; a very short one where it has passed, because zero means something else to a socket."""
        return max(self._end - time.monotonic(), 0.001)

    def within(self, timeout: float | None) -> float:
        """A timeout, cut at the deadline."""
        return self.left() if timeout is None else min(timeout, self.left())

    def passed(self) -> bool:
        return time.monotonic() >= self._end


class Timed(httpcore.NetworkStream):
    """A connection that is of no use after its deadline."""

    def __init__(self, stream: httpcore.NetworkStream, deadline: Deadline):
        self._stream = stream
        self._deadline = deadline

    def read(self, max_bytes: int, timeout: float | None = None) -> bytes:
        if self._deadline.passed():
            raise httpcore.ReadTimeout("the answer took too long")
        return self._stream.read(max_bytes, self._deadline.within(timeout))

    def write(self, buffer: bytes, timeout: float | None = None) -> None:
        if self._deadline.passed():
            raise httpcore.WriteTimeout("the request took too long")
        self._stream.write(buffer, self._deadline.within(timeout))

    def close(self) -> None:
        self._stream.close()

    def start_tls(
        self, ssl_context: ssl.SSLContext, server_hostname: str | None = None, timeout: float | None = None
    ) -> httpcore.NetworkStream:
        stream = self._stream.start_tls(ssl_context, server_hostname, self._deadline.within(timeout))
        return Timed(stream, self._deadline)

    def get_extra_info(self, info: str) -> Any:
        return self._stream.get_extra_info(info)


class _Transport(httpx.HTTPTransport):
    """httpx's own transport over connections of ours, one for each call: a deadline belongs to one call."""

    def __init__(self, backend: Backend, trusted: ssl.SSLContext):
        super().__init__(verify=trusted, trust_env=False)
        self._pool.close()
        self._pool = httpcore.ConnectionPool(
            ssl_context=trusted, max_keepalive_connections=0, http2=False, network_backend=backend
        )
