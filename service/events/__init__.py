"""What happens to jobs: written down with the change itself, and followed as it comes."""
