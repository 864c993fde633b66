"""Every error of the application as a problem document: what endpoints raise, what FastAPI does, and what goes wrong."""

from __future__ import annotations

from errno import EDQUOT, ENOSPC

import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from sqlalchemy.exc import SQLAlchemyError
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.responses import JSONResponse, Response
from starlette.routing import Match
from starlette.types import Scope

from service.database.postgresql import UNTRANSLATABLE_CODE, error_code
from service.database.sessions import database_unavailable
from service.problems import Problem, disk_full, field_errors, invalid_fields, unavailable
from service.storage.files import StorageUnavailable
from service.traces.requests import HTTP_METHODS
from service.vault import SecretUnreadable


def invalid_request(error: RequestValidationError) -> Problem:
    """The 422 problem for a request whose parts are not as the OpenAPI document says."""
    told = error.errors()
    return invalid_fields("invalid_request", field_errors(told), len(told))


def install(app: FastAPI) -> None:
    """Make every error of the application a problem document."""

    @app.exception_handler(Problem)
    async def problem(request: Request, error: Problem) -> JSONResponse:
        return error.response()

    @app.exception_handler(RequestValidationError)
    async def validation(request: Request, error: RequestValidationError) -> JSONResponse:
        return invalid_request(error).response()

    @app.exception_handler(HTTPException)
    async def http(request: Request, error: HTTPException) -> JSONResponse:
        if isinstance(
            error.__cause__, Problem
        ):  # what `service.http.json_bodies` says of a body, as FastAPI passes it on
            return error.__cause__.response()
        if error.status_code == 405:
            error.headers = {"Allow": ", ".join(_methods(app, request.scope))}
        code = {404: "not_found", 405: "method_not_allowed"}.get(error.status_code, f"http_{error.status_code}")
        detail = {
            404: "There is nothing at this address.",
            405: f"{request.method} is not offered at this address.",
        }.get(error.status_code, str(error.detail))
        return Problem(error.status_code, code, detail, headers=error.headers).response()

    @app.exception_handler(SecretUnreadable)
    async def locked(request: Request, error: SecretUnreadable) -> JSONResponse:
        structlog.get_logger().error("secret_unreadable", path=request.url.path)
        return Problem(503, "secret_unreadable", str(error)).response()

    @app.exception_handler(ClientDisconnect)
    async def disconnected(request: Request, error: ClientDisconnect) -> Response:
        return Response(status_code=400)  # nobody is there to read it

    @app.exception_handler(OSError)
    @app.exception_handler(SQLAlchemyError)
    async def storage(request: Request, error: OSError | SQLAlchemyError) -> JSONResponse:
        if getattr(error, "errno", None) in (ENOSPC, EDQUOT) or "disk is full" in str(error):
            return disk_full().response()
        if isinstance(error, StorageUnavailable) or database_unavailable(error):
            structlog.get_logger().warning("unavailable", path=request.url.path, reason=str(error).splitlines()[0])
            return unavailable().response()
        if error_code(getattr(error, "orig", None)) == UNTRANSLATABLE_CODE:
            return Problem(422, "invalid_request", "A text holds a character that cannot be kept (NUL).").response()
        return await unexpected(request, error)

    @app.exception_handler(Exception)
    async def unexpected(request: Request, error: Exception) -> JSONResponse:
        structlog.get_logger().error("unexpected_error", path=request.url.path, exc_info=error)
        return Problem(500, "internal_error", "Something went wrong inside the service; its log says what.").response()


def _methods(app: FastAPI, scope: Scope) -> list[str]:
    """The methods that an address offers, by whichever routes."""

    def offered(method: str) -> bool:
        return any(route.matches({**scope, "method": method})[0] is Match.FULL for route in app.router.routes)

    return [method for method in HTTP_METHODS if offered(method)]
