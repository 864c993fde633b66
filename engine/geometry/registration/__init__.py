"""What lies where something else lies: rigid fits, similarities, iterated closest points, and surfaces that bend."""
