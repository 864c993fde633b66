"""HTTP/1.1 as uvicorn speaks it by h11, whose own refusals are problem documents too."""

from __future__ import annotations

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

from service.problems import Problem


class Protocol(H11Protocol):
    """Answers what is no request, or one whose head has no end, as the service answers every error."""

    def send_400_response(self, msg: str) -> None:
        detail = "This is no HTTP/1.1 request, or its address and headers do not end within 64 KB."
        answer = Problem(400, "malformed_request", detail, headers={"Connection": "close"}).response()
        for event in (
            h11.Response(status_code=answer.status_code, headers=answer.raw_headers),
            h11.Data(data=answer.body),
            h11.EndOfMessage(),
        ):
            self.transport.write(self.conn.send(event) or b"")
        self.transport.close()
