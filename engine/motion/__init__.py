"""How characters move: skeletons and clips, motion capture in, retargeting, feet on the ground, clips of our own."""
