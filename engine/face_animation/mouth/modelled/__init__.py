"""A mouth's inside in three dimensions: rows of teeth, a tongue and the bag behind the lips, in the colours of the face they are in."""
