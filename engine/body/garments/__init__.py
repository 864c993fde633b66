"""Garments that change the template's shape so much that bare skin cannot be bent into it."""
