"""What is seen in an open mouth, and lips that stay off the skin."""
