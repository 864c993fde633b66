"""A face in a picture acts out what a tracked driver does: what portraits are, and what other systems draw heads with.

Reading order: `target_face` and `driver` (what goes in), `stages` (what makes both ready), `animation` (the one door: frames
come out). Behind it `layers` (person and background), `rig` with `control_points` and `dense_field` (the warp), `control_motion`
(equation 1, the head in 3D), `fine_details` (creases), `eyes_and_lids`, `mouth_interior`, `tracking_refinement`.
"""
