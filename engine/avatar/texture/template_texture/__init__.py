"""The template's own texture, made by code, for what films do not show well: eyes, mouth and hands.

Source: the paper, section 3.5, takes these from its template's texture and matches histograms in CIELAB.
"""
