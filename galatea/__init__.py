"""Galatea in Python: still pictures of people brought to life, in this process, without a service.

    import galatea

    galatea.animate("portrait.jpg", "performance.mp4", "out", strength=0.9)
    galatea.wake_up("photo.jpg", "out", motion="dance")

What is listed here is what stays; the packages beneath (`engine`) may change with any release.
"""

from engine.errors import GalateaError, Notice
from engine.run import Progress
from galatea.calls import animate, wake_up
from galatea.options import CharacterOptions, PortraitOptions
from galatea.result import Result

__all__ = [
    "CharacterOptions",
    "GalateaError",
    "Notice",
    "PortraitOptions",
    "Progress",
    "Result",
    "animate",
    "wake_up",
]
