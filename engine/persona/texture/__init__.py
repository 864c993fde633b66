"""The person's face as a picture of its own: all photographs laid on one another, and what is made of them (section 5)."""
