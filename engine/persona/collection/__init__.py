"""Which photographs show the person, and show the face so that something can be learnt from it."""
