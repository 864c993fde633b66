"""The template laid on clouds of points: section 3.4 of the paper."""
