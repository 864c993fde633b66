"""A drawn figure as a flat cut-out with a little depth, on a skeleton in its own proportions."""
