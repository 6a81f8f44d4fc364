"""From a scene to a motion that an independent judge passes, and its files in ./square-plan."""

import cellcolor

scene = cellcolor.read("square").varied(object={"target_vertices": 60})
planned = cellcolor.plan(scene, spacing_m=0.03, time_limit=300)
print(planned)
assert planned.verdict.valid
assert planned.trajectory.lift_offs == planned.solution.lift_offs

planned.save("square-plan")
trajectory = cellcolor.read("square-plan/trajectory.json")
print(len(trajectory.times), "samples,", f"{trajectory.seconds:.0f} s, in square-plan/")
