"""From labels to a closed surface: layers, their fronts and backs, and what joins them (the paper's sections 4.1 and 4.2)."""
