"""Hair that stands off a head, hats and hoods among it: found in the picture, and made a surface of its own around the head."""
