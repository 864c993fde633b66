"""Surfaces and pictures that are deformed: by handles, by cages and outlines, and as another surface is."""
