"""The face beyond its skin: parts within it, the mouth behind its lips, and expressions."""
