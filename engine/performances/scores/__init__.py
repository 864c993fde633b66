"""What is acted, second by second."""
