"""Who a face belongs to: descriptors that are near each other for one person, and far for two."""
