"""A face in a picture acts out what a tracked driver does: what portraits are, and what other systems draw heads with."""
