"""Landmarks of the person in space, from those that perception sees in frames: section 3.3 of the paper."""
