"""Pictures and videos in: sniffing, limits, probing and decoding to sRGB arrays, frame by frame."""
