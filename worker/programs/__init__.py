"""Our modules as programs: how they are started, give way to others, and end with who started them."""
