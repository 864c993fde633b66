"""The template fitted to what is seen of a person: body and hands, from landmarks and outlines."""
