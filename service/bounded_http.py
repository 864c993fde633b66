"""HTTP/1.1 by a compiled parser, with a limit that the parser itself has not: on what comes beside the bodies.

The parser keeps the address and the headers of a request, and the trailers of one that comes in chunks, until they are
complete. Without a limit a client could send them for ever, and the memory would be the service's.
"""

from __future__ import annotations

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

MOST_BYTES = 64 * 1024
"""How much may come of which nothing comes, before the line is closed; what is read at once comes on top."""


class BoundedHttp(HttpToolsProtocol):
    """Counts the bytes since the last that were of use."""

    _idle = 0

    def data_received(self, data: bytes) -> None:
        self._idle += len(data)
        super().data_received(data)
        if self._idle > MOST_BYTES and not self.transport.is_closing():
            self.send_400_response("The address and the headers are too long.")

    def on_headers_complete(self) -> None:
        self._idle = 0
        super().on_headers_complete()

    def on_body(self, body: bytes) -> None:
        self._idle = 0
        super().on_body(body)

    def on_message_complete(self) -> None:
        self._idle = 0
        super().on_message_complete()
