"""What browsers are told about everything that the service sends: what it may do, and who may show it.

Three kinds of things are sent. The page runs scripts, all of them its own files. What users gave and what was made of it
runs none, wherever it is opened. All else is for programs.
"""

from __future__ import annotations

from starlette.datastructures import MutableHeaders

VIEWER_STYLE_HASH = "'sha256-PXtZZkJMMyc18o/DN1ZEFOJ2qEGq95IQbVaJFMOXOb0='"
"""The style sheet that model-viewer writes into itself: the one between `<style>` and `</style>` in its
`lib/template.js`. Where another release has another one, the browser tests tell its hash."""

PAGE_POLICY = "; ".join(
    (
        "default-src 'self'",
        "script-src 'self' 'wasm-unsafe-eval'",  # model-viewer's decoder of meshes; no text becomes a script
        f"style-src 'self' {VIEWER_STYLE_HASH}",
        "img-src 'self' blob: data:",  # pictures before they are sent, textures of characters
        "media-src 'self' blob:",  # recordings before they are sent, clips of profiles
        "connect-src 'self' blob: data:",  # likewise, as three reads them
        "object-src 'none'",
        "base-uri 'none'",
        "form-action 'self'",
        "frame-ancestors 'none'",
    )
)
"""The page is nobody's frame: who is signed in could be made to press its buttons."""

MEDIA_POLICY = (
    "default-src 'none'; img-src 'self'; media-src 'self'; style-src 'unsafe-inline'; sandbox allow-same-origin"
)
"""What a user gave must never act as a page of ours, whatever it holds: nothing runs in it. A browser that is led straight
to it shows it in a page of its own making, which fetches a video once more, and may not as a stranger."""

NOTHING_POLICY = "default-src 'none'; frame-ancestors 'none'"

PERMISSIONS_POLICY = (
    "camera=(self), microphone=(self), xr-spatial-tracking=(self), "
    "geolocation=(), payment=(), usb=(), serial=(), midi=(), display-capture=()"
)


def add_security_headers(headers: MutableHeaders) -> None:
    """Add what holds for every answer, and a policy where it brings none of its own."""
    headers["X-Content-Type-Options"] = "nosniff"
    headers["Referrer-Policy"] = "same-origin"
    headers["Permissions-Policy"] = PERMISSIONS_POLICY
    headers.setdefault("Content-Security-Policy", NOTHING_POLICY)
