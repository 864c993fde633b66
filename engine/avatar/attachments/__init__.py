"""What stands off the body, which the template's skin cannot be: brims, hair, tails of coats, bags."""
