"""Make the graphs of the instance library that are neither drawn by hand nor given.

    python benchmarks/library_graphs.py [NAME …] [--surfaces FOLDER]

Without names all of them: the six scenes at several resolutions and the real parts, which needs the
extra ``frontend`` and takes minutes, and random ones, functions of a seed. ``instances`` gets the
graphs only; areas and lengths have six digits, and random graphs none. ``meta.made_by`` of each is
what made it. With ``--surfaces`` nothing but the labelled surfaces behind random graphs is made, as
``FOLDER/NAME.surface.json``: some graphs come from none.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.lab import families

TOP = Path(__file__).parents[1]
INSTANCES = TOP / "instances"

SCENES = ("hemisphere_flat", "hemisphere_tilted", "half_pipe", "wok", "wok_obstacle", "square")
RESOLUTIONS = (500, 2000, 8000)
"""Vertices of the object's mesh, about."""
PARTS = ("blend", "bracket", "perforated_sheet", "saddle", "sphere", "torus")

RANDOM = {
    "random": {
        "planar_0": "planar_graph(0, 40, 90, 6)",
        "planar_1": "planar_graph(1, 80, 200, 8, self_edges=True)",
        "waves_0": "MEDIUM['more waves'](0)",
        "waves_1": "MEDIUM['more waves'](1)",
        "cracks_0": "MEDIUM['cracks'](0)",
        "cracks_1": "MEDIUM['cracks'](1)",
        "islands_0": "MEDIUM['islands, holes'](0)",
        "islands_1": "MEDIUM['islands, holes'](1)",
        "rim_0": "MEDIUM['rim'](0)",
        "rim_1": "MEDIUM['rim'](1)",
        "thin_0": "MEDIUM['thin'](0)",
        "thin_1": "MEDIUM['thin'](1)",
        "points_48_0": "MEDIUM['48 × 48 points, 8 colors'](0)",
        "points_64_0": "MEDIUM['64 × 64 points, 10 colors'](0)",
        "annulus_0": "voronoi(0, 'annulus', 24, 30, 6)",
        "sphere_0": "voronoi(0, 'sphere', 24, 30, 6)",
        "torus_0": "voronoi(0, 'torus', 24, 30, 6, islands=3)",
        "torus_1": "voronoi(1, 'torus', 24, 60, 8, cracks=3)",
        "double_torus_0": "voronoi(0, 'double torus', 30, 40, 6)",
        "double_torus_1": "voronoi(1, 'double torus', 30, 80, 8, holes=2)",
        "thin_51": "MEDIUM['thin'](51)",
        "thin_11": "MEDIUM['thin'](11)",
        "thin_36": "MEDIUM['thin'](36)",
        "thin_42": "MEDIUM['thin'](42)",
        "thin_57": "MEDIUM['thin'](57)",
        "thin_40": "MEDIUM['thin'](40)",
        "rim_3": "MEDIUM['rim'](3)",
        "rim_26": "MEDIUM['rim'](26)",
        "disc_1": "LARGE['disc'](1)",
        "double_torus_2": "LARGE['double torus'](2)",
        "part_150": "part(0, 150, 40)",
        "large_blobs_0": "blobs(0, 80, 10, waves=2.5)",
    },
    "hubs": {
        "hub_60": "hub(0, 60, 4)",
        "hub_100": "hub(0, 100, 4)",
        "hub_wide_40": "wide_hub(0, 40, 8, 2)",
        "hub_tree": "cover_tree(0, 10, 4, 20, 3)",
        "hub_grid_2x2x3": "hub_grid(0, 2, 2, 4, 3)",
        "hub_grid_3x3x2": "hub_grid(0, 3, 3, 4, 2)",
        "hub_grid_4x4x2": "hub_grid(0, 4, 4, 4, 2)",
        "hub_grid_5x5x2": "hub_grid(0, 5, 5, 4, 2)",
        "hub_grid_6x6x2": "hub_grid(0, 6, 6, 4, 2)",
        "hub_loops_2x6": "hub_with_loops(0, 2, 6, 4)",
        "hub_loops_2x10": "hub_with_loops(0, 2, 10, 4)",
        "hub_loops_3x3": "hub_with_loops(0, 3, 3, 4)",
        "hub_200": "hub(0, 200, 4)",
        "hub_loops_3x4": "hub_with_loops(0, 3, 4, 4)",
        "hub_loops_4x4": "hub_with_loops(0, 4, 4, 4)",
        "hub_loops_5x4": "hub_with_loops(0, 5, 4, 4)",
        "hub_loops_4x6": "hub_with_loops(0, 4, 6, 4)",
        "hub_loops_2x12": "hub_with_loops(0, 2, 12, 4)",
    },
    "hard": {
        "hub_wide_80": "wide_hub(0, 80, 10, 2)",
        "hub_grid_10x10x2": "hub_grid(0, 10, 10, 4, 2)",
        "hub_grid_5x5x3": "hub_grid(0, 5, 5, 4, 3)",
        "hub_loops_4x6_8": "hub_with_loops(0, 4, 6, 8)",
        "large_torus_2": "LARGE['torus'](2)",
        "large_double_torus_1": "LARGE['double torus'](1)",
        "large_part_1": "LARGE['parts'](1)",
        "large_blobs_96_0": "blobs(0, 96, 12, waves=3.0)",
        "large_blobs_96_2": "blobs(2, 96, 12, waves=3.0)",
        "large_blobs_96_4": "blobs(4, 96, 12, waves=3.0)",
        "large_trees_1": "LARGE['trees'](1)",
        "large_blobs_192_0": "blobs(0, 192, 12, waves=8.0)",
        **{
            f"patches_overlapping_{seed}": (f"voronoi({seed}, 'disc', 24, 78, 20, scattered=True)")
            for seed in (0, 2, 3, 4)
        },
        "patches_disc_3": ("voronoi(3, 'disc', 24, 78, 30, scattered=True, coverage=(0.2, 0.4))"),
        "patches_torus_0": ("voronoi(0, 'torus', 16, 34, 30, scattered=True, coverage=(0.2, 0.4))"),
    },
}
"""The random graphs by folder and name, each as what makes it."""


def write_surfaces(names: list[str], folder: Path) -> None:
    """Write the surfaces of the random graphs that are asked for and come from one."""
    folder.mkdir(parents=True, exist_ok=True)
    for recipes in RANDOM.values():
        for name, recipe in recipes.items():
            if not names or name in names:
                made = made_by(recipe)
                if isinstance(made, LabelledSurface):
                    path = folder / f"{name}.surface.json"
                    path.write_text(replace(made, name=name).to_json(), encoding="utf-8")
                    print(f"{path}: {made}", flush=True)


def write_graphs(names: list[str]) -> None:
    """Write the graphs that are asked for."""
    for scene in SCENES:
        for vertices in RESOLUTIONS:
            for policy in ("raw", "clean"):
                name = f"{scene}_{vertices}_{policy}"
                if not names or name in names:
                    path = INSTANCES / "scenes" / f"{scene}.toml"
                    write("resolutions", name, built(path, policy, vertices))
    for part in PARTS:
        for name, policy in ((part, "clean"), (f"{part}_raw", "raw")):
            if not names or name in names:
                write("parts", name, built(INSTANCES / "parts" / f"{part}.toml", policy))
    for folder, recipes in RANDOM.items():
        for name, recipe in recipes.items():
            if not names or name in names:
                write(folder, name, random_graph(recipe))


def built(path: Path, policy: str, vertices: int | None = None) -> Instance:
    """The graph of a shipped scene, with another number of vertices, or without sliver policy."""
    from cellcolor.frontend import Scene, build_surface

    scene = Scene.read(path)
    made_by = f"cellcolor build {path.relative_to(TOP)}"
    if vertices is not None:
        scene = scene.varied(object={"target_vertices": vertices})
        made_by += f", object.target_vertices = {vertices}"
    if policy == "raw":
        scene = scene.with_setup(scene.setup.varied(slivers=None))
        made_by += ", its setup without [slivers]"
    surface = build_surface(scene).surface
    return replace(decompose(surface), meta={"made_by": made_by})


def made_by(recipe: str) -> Instance | LabelledSurface:
    """What a recipe makes."""
    made: Instance | LabelledSurface = eval(recipe, {"__builtins__": {}}, vars(families))
    return made


def random_graph(recipe: str) -> Instance:
    """The graph that a recipe makes."""
    made = made_by(recipe)
    graph = decompose(made) if isinstance(made, LabelledSurface) else made
    return replace(graph, meta={"made_by": f"cellcolor.lab.families.{recipe}"})


def write(folder: str, name: str, graph: Instance) -> None:
    """Write a graph into its folder, under its name."""
    cells = tuple(replace(cell, area=rounded(cell.area, folder)) for cell in graph.cells)
    edges = tuple(replace(edge, length=rounded(edge.length, folder)) for edge in graph.edges)
    path = INSTANCES / folder / f"{name}.json"
    path.parent.mkdir(exist_ok=True)
    graph = replace(graph, name=name, cells=cells, edges=edges, surface=None)
    path.write_text(graph.to_json(), encoding="utf-8")
    print(f"{path.relative_to(TOP)}: {graph}, {path.stat().st_size} bytes", flush=True)


def rounded(number: float | None, folder: str) -> float | None:
    """A size of something real in six digits; None of what is random or has none."""
    return None if number is None or folder in RANDOM else float(f"{number:.6g}")


def main() -> None:
    """Do what is asked for."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--surfaces", type=Path, metavar="FOLDER")
    arguments = parser.parse_args()
    if arguments.surfaces is not None:
        write_surfaces(arguments.names, arguments.surfaces)
    else:
        write_graphs(arguments.names)


if __name__ == "__main__":
    main()
