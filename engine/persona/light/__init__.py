"""The light on a persona's face: what lights its photographs show, and how it is brought into one of them."""
