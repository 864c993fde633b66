"""HTTP/1.1 as h11 reads it, without what a proxy in front may read otherwise (request smuggling, RFC 9112, section 11.2).

h11 itself refuses Content-Lengths that differ, other transfer codings than `chunked`, white space before a colon and a
CR alone. It also refuses what follows a chunk that is longer than it says. It takes what the RFC lets a server take: a
line folded into the next (as a space), a LF alone at the end of a line of the head.
"""

from __future__ import annotations

import h11


class StrictConnection(h11.Connection):
    """Takes no request whose end two readers could see at two places."""

    def next_event(self) -> h11.Event | type[h11.NEED_DATA] | type[h11.PAUSED]:
        event = super().next_event()
        if isinstance(event, h11.Request):
            _require_one_end(event)
        return event


def _require_one_end(request: h11.Request) -> None:
    """Raise an error if a request has two ends, or one that HTTP/1.0 does not know."""
    names = {name for name, _ in request.headers}
    if b"transfer-encoding" in names and b"content-length" in names:
        raise h11.RemoteProtocolError("both Content-Length and Transfer-Encoding")
    if b"transfer-encoding" in names and request.http_version < b"1.1":
        raise h11.RemoteProtocolError("Transfer-Encoding before HTTP/1.1")
