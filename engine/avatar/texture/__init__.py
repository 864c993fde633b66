"""The avatar's texture: each face of the fitted mesh takes its colours from one frame, so that seams are few and not seen.

Source: the paper, section 3.5.
"""
