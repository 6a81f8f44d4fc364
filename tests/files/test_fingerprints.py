"""Fingerprints: of what a solver reads and nothing else; files of version 1."""

from __future__ import annotations

import hashlib
import json
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from documents import INSTANCE, SOLUTION, SURFACE, Document, broken, drop, put
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES
from meshes import surfaces

from cellcolor.checker.claimed_numbers import claims
from cellcolor.checker.division import check_solution
from cellcolor.data.instance import Coverage, Instance, KnownResult, KnownResults, SurfaceReference
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError

VERSION_1 = Path(__file__).parent / "version_1"
"""Files that the program wrote, or read, when there was only version 1."""


def canonical(instance: Instance) -> str:
    """The fingerprint as docs/formats.md describes it, put together by hand."""
    cells = []
    for cell in instance.cells:
        loops = []
        for loop in cell.loops:
            turns = [list(loop[i:] + loop[:i]) for i in range(len(loop))]
            loops.append(min(turns))
        cells.append([sorted(cell.colors), sorted(loops)])
    edges = [
        [edge.id, edge.left, edge.right, list(instance.joinable(edge.id))]
        for edge in sorted(instance.edges, key=lambda edge: edge.id)
    ]
    text = json.dumps({"cells": cells, "colors": len(instance.colors), "edges": edges})
    return hashlib.sha256(text.replace(" ", "").encode()).hexdigest()


@given(surfaces(), st.randoms(use_true_random=False))
def test_what_no_solver_reads_is_not_in_it(mesh: LabelledSurface, random: Any) -> None:
    instance = decompose(mesh, "one.surface.json")
    assert instance.sha256 == canonical(instance)
    edges = list(instance.edges)
    random.shuffle(edges)
    cells = []
    for cell in instance.cells:
        loops = []
        for loop in cell.loops:
            first = random.randrange(len(loop))
            loops.append(loop[first:] + loop[:first])
        random.shuffle(loops)
        cells.append(replace(cell, loops=tuple(loops), area=random.random()))
    same = Instance(
        "other name",
        tuple(f"color {number}" for number in range(len(instance.colors))),
        tuple(cells),
        tuple(replace(e, length=1.0, colors=instance.joinable(e.id)) for e in edges),
        {"seconds": random.random()},
        SurfaceReference("elsewhere.json", instance.surface.vertex_cell, "0" * 64)
        if instance.surface
        else None,
        KnownResults(KnownResult(3)),
        Coverage(1.0, 0.5, 0.0),
    )
    assert same.sha256 == instance.sha256
    assert Instance.from_document(json.loads(same.to_json())).sha256 == instance.sha256


@pytest.mark.parametrize(
    "change",
    [
        put("colors", to=["red", "blue", "green"]),
        put("cells", 0, "colors", to=[0, 1]),
        put("cells", 1, "loops", to=[[-1, 3, 4], [-4]]),
        put("edges", 3, "colors", to=[]),
        drop("edges", 3, "colors"),
        lambda d: (
            put("edges", 0, "id", to=7)(d),
            put("cells", 0, "loops", to=[[7, 2]])(d),
            put("cells", 1, "loops", to=[[-7, 3], [4, -4]])(d),
        ),
    ],
    ids=["colors", "colors of a cell", "loops", "dead edge", "live edge", "id of an edge"],
)
def test_what_a_solver_reads_is_in_it(change: Any) -> None:
    other = Instance.from_document(broken(INSTANCE, change))
    assert other.sha256 != Instance.from_document(INSTANCE).sha256


@given(surfaces(), st.randoms(use_true_random=False))
def test_fingerprint_of_a_surface(mesh: LabelledSurface, random: Any) -> None:
    faces = [face[k:] + face[:k] for face in mesh.faces.tolist() for k in [random.randrange(3)]]
    random.shuffle(faces)
    other = LabelledSurface(
        "other", ("a", "b", "c"), mesh.vertices, np.array(faces), mesh.vertex_colors, mesh.cracks
    )
    assert other.sha256 == mesh.sha256
    content = {
        "vertices": "".join(
            struct.pack(">d", x + 0.0).hex() for point in mesh.vertices.tolist() for x in point
        ),
        "faces": sorted(min(f[k:] + f[:k] for k in range(3)) for f in faces),
        "vertex_colors": [list(colors) for colors in mesh.vertex_colors],
        "cracks": sorted([c.i, c.j, list(c.colors)] for c in mesh.cracks),
    }
    text = json.dumps(dict(sorted(content.items()))).replace(" ", "")
    assert mesh.sha256 == hashlib.sha256(text.encode()).hexdigest()
    bare = tuple(v for v, colors in enumerate(mesh.vertex_colors) if not colors)
    assert (replace(mesh, given_up=bare).sha256 == mesh.sha256) == (not bare)
    moved = mesh.vertices.copy()
    moved[0, 2] += 1e-9
    assert replace(mesh, vertices=moved).sha256 != mesh.sha256


def test_minus_zero_is_zero() -> None:
    mesh = LabelledSurface.read(VERSION_1 / "split.surface.json")
    assert replace(mesh, vertices=mesh.vertices * [1, 1, -1.0]).sha256 == mesh.sha256


def test_an_instance_names_its_surface_by_content() -> None:
    mesh = LabelledSurface.read(VERSION_1 / "split.surface.json")
    reference = decompose(mesh, "split.surface.json").surface
    assert reference is not None and reference.sha256 == mesh.sha256


def test_the_library_names_its_surfaces_by_content() -> None:
    for path in INSTANCES.rglob("*.json"):
        document = json.loads(path.read_text(encoding="utf-8"))
        if document["format"] != "cellcolor/instance":
            continue
        reference = Instance.from_document(document).surface
        if reference is not None:
            assert reference.sha256 == LabelledSurface.read(path.parent / reference.path).sha256


@pytest.mark.parametrize("name", ["split", "foreign"])
def test_a_solution_of_version_1_names_its_instance_by_a_text_that_nothing_compares(
    name: str,
) -> None:
    """``foreign`` has colors out of order and whole numbers for measures."""
    instance = Instance.read(VERSION_1 / f"{name}.json")
    solution = Solution.read(VERSION_1 / f"{name}.solution.json")
    rewritten = Solution.from_document(json.loads(solution.to_json()))
    assert rewritten == solution and solution.instance.of == "text"
    assert check_solution(instance, solution).problems == ()
    assert claims(instance, solution)["instance.sha256"] == solution.instance.sha256


def test_solutions_of_a_surface_of_version_1_still_fit() -> None:
    path = VERSION_1 / "split.surface.json"
    instance = decompose(LabelledSurface.read(path), path.name)
    solution = Solution.read(VERSION_1 / "split.schemes.jsonl")
    assert check_solution(instance, solution).problems == ()


@pytest.mark.parametrize(
    ("document", "kind", "field"),
    [
        (SURFACE, LabelledSurface, "given_up"),
        (INSTANCE, Instance, "coverage"),
        (broken(INSTANCE, drop("coverage")), Instance, "surface.sha256"),
        (SOLUTION, Solution, "bounds"),
        (broken(SOLUTION, drop("bounds")), Solution, "coverage"),
        (broken(broken(SOLUTION, drop("bounds")), drop("coverage")), Solution, "notes"),
    ],
)
def test_version_1_has_no_members_of_version_2(
    document: Document, kind: type[LabelledSurface | Instance | Solution], field: str
) -> None:
    old = broken(document, put("version", to=1))
    with pytest.raises(InputError, match="is a member of version 2") as refusal:
        kind.from_document(old)
    assert refusal.value.field == field


def test_version_2_has_no_model() -> None:
    old = broken(SOLUTION, put("version", to=2))
    with pytest.raises(InputError, match="is a member of version 3, but the file says version 2"):
        Solution.from_document(old)
    read = Solution.from_document(broken(old, drop("model")))
    assert read == replace(Solution.from_document(SOLUTION), model=None)
    assert read.to_document()["version"] == 3
    with pytest.raises(InputError, match="must be 1 to 3, is 4"):
        Solution.from_document(broken(SOLUTION, put("version", to=4)))
