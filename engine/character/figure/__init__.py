"""Who is woken: the person found in the picture, their joints and face, the outline that is cut out, and what hands correct of it."""
