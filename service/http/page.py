"""The built web page at the root; its document says, too, that there is nothing at an address.

Files whose names hold the hash of their content never change; all others are asked for anew each time, and answered with
304 where they are the same. `web/compress.mjs` left a brotli and a gzip copy beside what is worth it.
"""

from __future__ import annotations

import os
from mimetypes import guess_type
from pathlib import Path, PurePosixPath

from fastapi.responses import HTMLResponse
from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.responses import FileResponse, Response
from starlette.staticfiles import NotModifiedResponse, StaticFiles
from starlette.types import Receive, Scope, Send

from service.http import browser
from service.http.encodings import accepts

NOT_BUILT = "The web page is not built: `galatea doctor` says what to do. The API works without it."
NO_PAGE = f"""<!doctype html><title>Galatea</title><h1>Galatea</h1>
<p>The service runs. {NOT_BUILT} It is described at <a href="/v1/openapi.json">/v1/openapi.json</a>."""


def is_built(folder: Path) -> bool:
    """Whether there is a page in the folder."""
    return (folder / "index.html").is_file()


HASHED_FOLDER = "assets"
"""The folder of files that are named by their content."""

CONTENT_CODINGS = (("br", ".br"), ("gzip", ".gz"))
"""Content codings, best first, and how files end that have them."""


class Page(StaticFiles):
    """Static files; unknown addresses without a file's ending are answered with the page's document, and 404."""

    def __init__(self, folder: Path):
        super().__init__(directory=folder, html=True, check_dir=False)
        self._folder = folder

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Whole files alone: of a page nobody needs a range, and those that are none would be answered by no problem."""
        headers = [(name, value) for name, value in scope["headers"] if name not in (b"range", b"if-range")]
        await super().__call__({**scope, "headers": headers}, receive, send)

    async def get_response(self, path: str, scope: Scope) -> Response:
        if scope["path"].startswith("/v1/"):
            raise HTTPException(404)
        if not is_built(self._folder):
            if path == ".":
                return HTMLResponse(NO_PAGE)
            raise HTTPException(404)
        try:
            return await super().get_response(path, scope)
        except HTTPException as error:
            if error.status_code != 404 or PurePosixPath(path).suffix:
                raise
            return await self._lost(scope)

    async def _lost(self, scope: Scope) -> Response:
        """The page, which says that there is nothing at this address: whole, and as the failure that it is."""
        headers = {"Cache-Control": "no-cache", "Content-Security-Policy": browser.PAGE_POLICY}
        document = HTMLResponse((self._folder / "index.html").read_text(), 404, headers)
        return document if scope["method"] == "GET" else Response(status_code=404)

    def file_response(
        self, full_path: str | os.PathLike[str], stat_result: os.stat_result, scope: Scope, status_code: int = 200
    ) -> Response:
        request = Headers(scope=scope)
        media_type = guess_type(full_path)[0] or "application/octet-stream"
        hashed = Path(full_path).parent == (self._folder / HASHED_FOLDER).resolve()
        headers = {
            "Cache-Control": "public, max-age=31536000, immutable" if hashed else "no-cache",
            "Vary": "Accept-Encoding",
        }
        if media_type == "text/html":
            headers["Content-Security-Policy"] = browser.PAGE_POLICY
        for coding, ending in CONTENT_CODINGS:
            copy = Path(f"{full_path}{ending}")
            if accepts(request.get("accept-encoding"), coding) and _is_copy(copy, stat_result):
                full_path, stat_result = copy, copy.stat()
                headers["Content-Encoding"] = coding
                break
        response = FileResponse(full_path, status_code, headers, media_type, stat_result=stat_result)
        if not self.is_not_modified(response.headers, request):
            return response
        unchanged = NotModifiedResponse(response.headers)
        if policy := headers.get("Content-Security-Policy"):
            unchanged.headers["Content-Security-Policy"] = policy  # browsers keep what a 304 tells, in place of the old
        return unchanged

    async def check_config(self) -> None:
        """The page may be built while the service runs: nothing to check at the start."""


def _is_copy(copy: Path, of: os.stat_result) -> bool:
    """Whether this is a compressed copy of a file, and not of an older one."""
    return copy.is_file() and copy.stat().st_mtime >= of.st_mtime
