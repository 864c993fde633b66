"""The template fitted to the person: pose, proportions, head and fingers (the paper's sections 3 and 5)."""
