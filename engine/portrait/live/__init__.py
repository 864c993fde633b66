"""A portrait that follows a camera: the portrait system's parts, causal, a frame in and a frame out.

Begin with `live_portrait`. What the portrait system finds by looking at a whole clip is not there: creases, points
around the head, the flow on the skin, the second look. Of a ratio image's marks, the clip's most expressive frame tells
which are no creases. A frame's picture depends on no later frame.
"""
