"""Streams and filters of EXT_meshopt_compression, written and read."""
