"""The fewest segments of a shipped graph, why there are not fewer, and what a checker says."""

import cellcolor

result = cellcolor.solve("ring", time_limit=60)
print(result)

for bound in result.solution.bounds:
    print(f"  at least {bound.value} by the bound {bound.kind!r}")

report = cellcolor.check("ring", result)
print("the checker finds", report.problems or "nothing wrong")

assert result.solution.proved_for_surface
assert report.valid
