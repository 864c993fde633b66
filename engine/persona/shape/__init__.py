"""The person's average shape: how the face is curved, by how it shines in all photographs (section 4)."""
