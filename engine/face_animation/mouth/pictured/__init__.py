"""The upper teeth that one picture of a face shows, in its mouth as it moves."""
