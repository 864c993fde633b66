"""The persona system: a puppet of a person from a collection of photographs (`pipeline`).

Source: S. Suwajanakorn, S. M. Seitz, I. Kemelmacher-Shlizerman, What makes Tom Hanks look like Tom Hanks, ICCV 2015.
"""
