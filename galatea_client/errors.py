"""What can go wrong, as one tree of exceptions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import httpx

if TYPE_CHECKING:
    from galatea_client.job import JobDocument


class GalateaError(Exception):
    """Anything that this client raises."""


class InvalidAddress(GalateaError, ValueError):
    """What was given as the service's address is none."""


class Unreachable(GalateaError, httpx.TransportError):
    """The service cannot be reached, or the line broke, however often it was tried."""


class NotAName(GalateaError, ValueError):
    """A text names a file of this machine, where a text is an id or the name of something that the service knows."""


class ApiError(GalateaError):
    """The service refused a request: a problem document (RFC 9457).

    status : that of HTTP.
    code : stable and safe to compare with.
    detail : what to do.
    errors : each field that is wrong (`pointer`, `code`, `detail`).
    request_id : by it the request is found in the service's log.
    """

    def __init__(
        self,
        status: int,
        code: str,
        detail: str,
        errors: list[dict[str, Any]] | None = None,
        request_id: str | None = None,
    ):
        super().__init__(f"{code}: {detail}")
        self.status = status
        self.code = code
        self.detail = detail
        self.errors = errors or []
        self.request_id = request_id


class InvalidRequest(ApiError):
    """The request itself is wrong: a file, an option, a name (400, 413, 415, 416, 422)."""


class NotAllowed(ApiError):
    """No key, a wrong one, or one that may not do this (401, 403)."""


class NotFound(ApiError):
    """It was erased, or it never was (404, 410)."""


class Conflict(ApiError):
    """It does not suit the state that things are in (409)."""


class LimitReached(ApiError):
    """More than the key or the disk allows, also after waiting as long as the service asked for (429, 507)."""


class Unavailable(ApiError):
    """A fault of the service, or it does not answer for now (500, 502, 503, 504)."""


class DownloadBroken(GalateaError):
    """What arrived is not what the service has: other bytes than its checksum says."""


class JobFailed(GalateaError):
    """A job ended otherwise than well. `code` and `detail` say why; `job` is the job itself: a `Job`, or an `AsyncJob` of an
    `AsyncClient`."""

    def __init__(self, job: JobDocument):
        self.job: Any = job
        self.code = job.error.code if job.error else str(job.status)
        self.detail = job.error.detail if job.error else f"The job was {job.status}."
        super().__init__(f"{self.code}: {self.detail}")


STATUS_CLASSES: dict[int, type[ApiError]] = {
    **dict.fromkeys((400, 405, 413, 415, 416, 422), InvalidRequest),
    **dict.fromkeys((401, 403), NotAllowed),
    **dict.fromkeys((404, 410), NotFound),
    409: Conflict,
    **dict.fromkeys((429, 507), LimitReached),
}


def error_of(response: httpx.Response) -> ApiError:
    """The exception for an answer that has been read and is an error."""
    status = response.status_code
    kind = STATUS_CLASSES.get(status, Unavailable if status >= 500 else ApiError)
    try:
        document = response.json()
        return kind(status, document["code"], document["detail"], document.get("errors"), document.get("request_id"))
    except (ValueError, KeyError, TypeError):
        # Something in between answered: a proxy, or another service at this address.
        return kind(status, f"http_{status}", response.reason_phrase or "The answer is not one of Galatea's.")
