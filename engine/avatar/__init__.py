"""Two smartphone clips that orbit a person become a game-ready avatar.

Source: Realistic Virtual Humans from Smartphone Videos, VRST 2020: S. Wenninger, J. Achenbach, A. Bartl, M. E. Latoschik,
M. Botsch. "The paper" in this folder is that one.
"""
