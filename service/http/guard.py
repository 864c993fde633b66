"""Keeping web pages and proxies from using the service in somebody else's name.

Where no key is needed, the service is bound to loopback and only programs of this machine may speak to it. Two
ways lead in from outside all the same. A web page that the user visits can send requests to loopback: its `Origin`
gives it away, and a name that was made to point here (DNS rebinding) gives itself away in `Host`. And a proxy on
this machine can pass on what comes from the network: it is refused unless the operator lists it in
`GALATEA_TRUSTED_PROXIES` and so vouches for whom it lets through.

Where keys are needed, or one is sent, whoever holds it may come from anywhere. What is left to keep out are pages of
other origins that count on the browser's cookie: they bring no key of their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from ipaddress import IPv4Network, IPv6Network, ip_address
from urllib.parse import SplitResult, urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.http import browser
from service.loopback import is_loopback
from service.problems import Problem

FORWARDING_HEADERS = ("forwarded", "x-forwarded-for", "x-forwarded-host", "x-forwarded-proto", "x-real-ip", "via")

PUBLIC_PATH = "/v1/public/"
"""What lies here is meant for pages of any origin."""


class Guard:
    """Refuses requests that a web page or a proxy brought in, and tells browsers what every answer may do."""

    def __init__(
        self,
        app: ASGIApp,
        trusted_proxies: Sequence[IPv4Network | IPv6Network] = (),
        keys_required: bool = False,
        origins: Sequence[str] = (),
    ):
        self.app = app
        self.trusted_proxies = trusted_proxies
        self.keys_required = keys_required
        self.origins = origins

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return

        async def send_marked(message: Message) -> None:
            if message["type"] in ("http.response.start", "websocket.http.response.start"):
                browser.add_security_headers(MutableHeaders(scope=message))
            await send(message)

        problem: Problem | None
        if "\0" in scope["path"]:  # a text that no database may keep names nothing
            problem = Problem(404, "not_found", "There is nothing at this address.")
        else:
            problem = self.refusal(Headers(scope=scope), (scope.get("client") or ("", 0))[0], scope["path"])
        if problem is not None:
            await problem.response()(scope, receive, send_marked)
        else:
            await self.app(scope, receive, send_marked)

    def refusal(self, headers: Headers, peer: str, path: str = "/") -> Problem | None:
        """Why a request is refused; None if it is not."""
        host = headers.get("host", "")
        forwarded = any(name in headers for name in FORWARDING_HEADERS)
        if forwarded and self._trusts(peer):
            host = headers.get("x-forwarded-host", host).split(",")[0].strip()
        elif not (self.keys_required or "authorization" in headers):
            if forwarded:
                return Problem(
                    403,
                    "proxy_not_trusted",
                    f"The request came through a proxy ({peer}) that is not listed in GALATEA_TRUSTED_PROXIES.",
                )
            if not is_loopback(_parts(f"//{host}").hostname or ""):
                return Problem(
                    403, "host_not_allowed", "The service answers on loopback only: use http://127.0.0.1 or localhost."
                )
        origin = headers.get("origin")
        if origin is None or "authorization" in headers or origin in self.origins or path.startswith(PUBLIC_PATH):
            return None
        if _parts(origin).netloc.lower() != host.lower():
            return Problem(403, "origin_not_allowed", "A web page of another origin may not use the service.")
        return None

    def _trusts(self, peer: str) -> bool:
        try:
            address = ip_address(peer)
        except ValueError:
            return False
        return any(address in network for network in self.trusted_proxies)


def _parts(url: str) -> SplitResult:
    """The parts of an address; empty ones where it is none."""
    try:
        return urlsplit(url)
    except ValueError:
        return urlsplit("")
