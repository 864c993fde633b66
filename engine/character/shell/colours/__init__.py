"""The shell's colours: what the picture shows of it, and what that says of the rest, part by part, once round each."""
