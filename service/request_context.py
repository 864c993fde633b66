"""The opened context, as endpoints ask for it: workers, who answer no requests, open one without FastAPI."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Request

from service.context import Context


async def _context(request: Request) -> Context:  # `async`: what waits for nothing needs no thread
    context: Context = request.app.state.context
    return context


InContext = Annotated[Context, Depends(_context)]
