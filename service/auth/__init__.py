"""Who calls: keys and sessions, what they may do, how often, and how much they may have."""
