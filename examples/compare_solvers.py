"""Two solvers that share no code, on graphs small enough for the paper's own search."""

import cellcolor

NAMES = ("ring", "parallel-corridors", "annulus")
SOLVERS = ("cp-sat", "dfs")

for name in NAMES:
    found = {solver: cellcolor.solve(name, solver=solver, time_limit=60) for solver in SOLVERS}
    print(name, {solver: result.segments for solver, result in found.items()})
    assert len({result.segments for result in found.values()}) == 1
    assert all(result.optimal for result in found.values())
