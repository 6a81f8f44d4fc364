"""What the place of a part costs: a shipped scene, moved away from the robot step by step."""

import cellcolor

scene = cellcolor.read("wok").varied(object={"target_vertices": 150})
x, y, z = scene.placement.position_m

for centimeters in (0, 6, 12):
    moved = scene.moved(position_m=[x + centimeters / 100, y, z])
    built = cellcolor.build(moved, time_limit=60)
    result = cellcolor.solve(built, time_limit=60)
    share = built.report.reachable_area_m2 / built.report.area_m2
    print(f"{centimeters:2d} cm farther: {result.lift_offs} lift-offs, {share:.1%} reachable")
    assert result.optimal
