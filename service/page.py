"""The built web page at the root; its document says, too, that there is nothing at an address."""

from __future__ import annotations

from pathlib import Path, PurePosixPath

from fastapi.responses import HTMLResponse
from starlette.exceptions import HTTPException
from starlette.responses import Response
from starlette.staticfiles import StaticFiles
from starlette.types import Receive, Scope, Send

NOT_BUILT = "The web page is not built: `galatea doctor` says what to do. The API works without it."
NO_PAGE = f"""<!doctype html><title>Galatea</title><h1>Galatea</h1>
<p>The service runs. {NOT_BUILT} It is described at <a href="/v1/openapi.json">/v1/openapi.json</a>."""


def built(folder: Path) -> bool:
    """Whether there is a page in the folder."""
    return (folder / "index.html").is_file()


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
        if not built(self._folder):
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
        document = HTMLResponse((self._folder / "index.html").read_text(), status_code=404)
        return document if scope["method"] == "GET" else Response(status_code=404)

    async def check_config(self) -> None:
        """The page may be built while the service runs: nothing to check at the start."""
