"""A space of expressions: what is measured of a face whatever the head's turn, and prototypes of emotions in it."""
