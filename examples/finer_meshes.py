"""Does a finer mesh of the same part have the same minimum? Each proof is about one mesh."""

import sys

import cellcolor

SCENE = sys.argv[1] if len(sys.argv) > 1 else "wok"
VERTICES = [int(number) for number in sys.argv[2:]] or [1_000, 4_000]

scene = cellcolor.build(SCENE).scene
minima = []
for vertices in VERTICES:
    finer = scene.varied(object={"target_vertices": vertices})  # of a mesh file: "max_edge_m"
    result = cellcolor.solve(finer, time_limit=120)
    cells, edges = len(result.instance.cells), len(result.instance.edges)
    print(f"{vertices:,} vertices: {cells} cells, {edges} edges, {result}")
    minima.append(result.segments)
print("the same on each" if len(set(minima)) == 1 else "not the same")
