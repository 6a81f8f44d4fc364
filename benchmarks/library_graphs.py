"""Make the graphs of the instance library again that are neither drawn by hand nor given.

    python benchmarks/library_graphs.py [NAME …] [--surfaces FOLDER]

Each is made as its ``source`` in the index says: by a call with a seed, or from a shipped scene,
which needs the extra ``frontend``; all of them take minutes. ``instances`` gets the graphs only;
areas and lengths have six digits, and random graphs none. With ``--surfaces`` nothing but the
labelled surfaces behind random graphs is made, as ``FOLDER/NAME.surface.json``: some graphs come
from none. docs/library.md says what is in the library.
"""

from __future__ import annotations

import argparse
import re
from dataclasses import replace
from pathlib import Path

from cellcolor.data.instance import Instance
from cellcolor.data.library_index import LibraryEntry, LibraryIndex
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.lab import families

TOP = Path(__file__).parents[1]
INSTANCES = TOP / "instances"
RANDOM = "cellcolor.lab.families."
BUILT = re.compile(
    r"cellcolor build (?P<scene>[^,]+)(, object\.target_vertices = (?P<vertices>\d+))?"
    r"(?P<raw>, its setup without \[slivers\])?"
)


def made_by(source: str) -> Instance | LabelledSurface:
    """What a call of the random families makes."""
    recipe = source.removeprefix(RANDOM)
    made: Instance | LabelledSurface = eval(recipe, {"__builtins__": {}}, vars(families))
    return made


def built(source: str) -> Instance:
    """The graph of a shipped scene, with another number of vertices, or without sliver policy."""
    from cellcolor.frontend import Scene, build_surface

    told = BUILT.fullmatch(source)
    assert told is not None, source
    scene = Scene.read(TOP / told["scene"])
    if told["vertices"]:
        scene = scene.varied(object={"target_vertices": int(told["vertices"])})
    if told["raw"]:
        scene = scene.with_setup(scene.setup.varied(slivers=None))
    return decompose(build_surface(scene).surface)


def write_surface(entry: LibraryEntry, folder: Path) -> None:
    """Write the surface of a random graph, if it comes from one."""
    if entry.source.startswith(RANDOM):
        made = made_by(entry.source)
        if isinstance(made, LabelledSurface):
            path = folder / f"{entry.name}.surface.json"
            path.write_text(replace(made, name=entry.name).to_json(), encoding="utf-8")
            print(f"{path}: {made}", flush=True)


def write_graph(entry: LibraryEntry) -> None:
    """Write a graph over the file of its entry, if the source says how it is made."""
    random = entry.source.startswith(RANDOM)
    if not random and not entry.source.startswith("cellcolor build instances/"):
        return
    made = made_by(entry.source) if random else built(entry.source)
    graph = decompose(made) if isinstance(made, LabelledSurface) else made

    def rounded(number: float | None) -> float | None:
        return None if number is None or random else float(f"{number:.6g}")

    graph = replace(
        graph,
        name=entry.name,
        cells=tuple(replace(cell, area=rounded(cell.area)) for cell in graph.cells),
        edges=tuple(replace(edge, length=rounded(edge.length)) for edge in graph.edges),
        surface=None,
        meta={"made_by": entry.source},
    )
    path = INSTANCES / (entry.file or "")
    path.write_text(graph.to_json(), encoding="utf-8")
    print(f"{path.relative_to(TOP)}: {graph}, {path.stat().st_size} bytes", flush=True)


def main() -> None:
    """Do what is asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--surfaces", type=Path, metavar="FOLDER")
    asked = parser.parse_args()
    if asked.surfaces is not None:
        asked.surfaces.mkdir(parents=True, exist_ok=True)
    for entry in LibraryIndex.read(INSTANCES / "index.json").entries:
        if not asked.names or entry.name in asked.names:
            if asked.surfaces is not None:
                write_surface(entry, asked.surfaces)
            else:
                write_graph(entry)


if __name__ == "__main__":
    main()
