"""What hangs down from the hips around both legs: skirts, coats, and jackets that end below the crotch."""
