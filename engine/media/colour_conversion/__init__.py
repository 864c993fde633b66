"""Colours of video: between what codecs keep and sRGB, high dynamic range among it."""
