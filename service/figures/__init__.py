"""Counts that outlive what they count."""
