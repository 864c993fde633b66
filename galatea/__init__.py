"""Galatea in Python: still pictures of people brought to life, in this process, without a service.

    import galatea

    galatea.animate("portrait.jpg", "performance.mp4", "out", strength=0.9)
    galatea.wake_up("photo.jpg", "out", motion="dance")
    galatea.make_avatar("around_the_body.mp4", "out", head="around_the_head.mp4", height_m=1.8)
    galatea.make_persona("photos/", "performance.mp4", "out", composite="photo")

What is listed here is what stays; the packages beneath (`engine`) may change with any release.
"""

from engine.errors import GalateaError, Notice
from engine.run import Progress
from galatea.calls import animate, make_avatar, make_persona, wake_up
from galatea.options import AvatarOptions, CharacterOptions, PersonaOptions, PortraitOptions
from galatea.result import Result

__all__ = [
    "AvatarOptions",
    "CharacterOptions",
    "GalateaError",
    "Notice",
    "PersonaOptions",
    "PortraitOptions",
    "Progress",
    "Result",
    "animate",
    "make_avatar",
    "make_persona",
    "wake_up",
]
