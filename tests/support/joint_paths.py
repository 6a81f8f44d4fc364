"""Small scenes for plans in joint angles, and paths that touch their vertices one after another.

The small SCARA scene with a motion: a few vertices of the pipe, wide passes.
"""

from __future__ import annotations

from functools import cache

import networkx
import numpy as np
import pinocchio as pin
from shipped import TOP, shipped

import cellcolor
from cellcolor.arrays import Array
from cellcolor.data.plan import ContactPath, Plan
from cellcolor.frontend import Scene
from cellcolor.frontend.build import BuildResult, build_surface
from cellcolor.frontend.setup import Motion

TIP = "tool_tip"


@cache
def scene(name: str = "wok_obstacle", vertices: int = 200) -> BuildResult:
    """A shipped scene on a coarse mesh."""
    return build_surface(shipped(name, vertices))


def pose(built: BuildResult, joints: Array) -> tuple[Array, Array]:
    """Where Pinocchio has the tip, m, and the tool's axis."""
    model = built.robot.model
    data = model.createData()
    pin.framesForwardKinematics(model, data, joints)
    tip = data.oMf[model.getFrameId(TIP)]
    return np.array(tip.translation), np.array(tip.rotation[:, 2])


def configuration(built: BuildResult, vertex: int, color: int) -> Array:
    """The scene's own configuration of a color at a vertex."""
    (branch,) = np.flatnonzero(built.node_color[vertex] == color)
    return np.array(built.configurations[vertex, branch])


def joints_of(built: BuildResult, plan: Plan) -> Array:
    """A row a vertex, NaN without a color."""
    joints = np.full((len(plan.vertex_colors), built.robot.joints), np.nan)
    for vertex, color in enumerate(plan.vertex_colors):
        if color is not None:
            joints[vertex] = configuration(built, vertex, color)
    return joints


def walk_round(graph: networkx.Graph, start: int) -> list[int]:
    """Vertices round a spanning tree of the component of one, which is at both ends."""
    walk = [start]
    for one, other, kind in networkx.dfs_labeled_edges(graph, start):
        if one != other and kind != "nontree":
            walk.append(other if kind == "forward" else one)
    return walk


def walk_of(built: BuildResult, plan: Plan) -> tuple[ContactPath, list[int]]:
    """A path with a stroke a segment that walks along the mesh, and the vertex of each sample.

    Between two strokes is a sample without contact, at the vertex before.
    """
    surface, colors = built.surface, plan.vertex_colors
    graph: networkx.Graph = networkx.Graph()
    graph.add_nodes_from(v for v, color in enumerate(colors) if color is not None)
    for a, b in surface.left_of:
        color = colors[a]
        if color is not None and color == colors[b] and color not in surface.cracked(a, b):
            graph.add_edge(a, b)
    vertices, contact = [], []
    for segment in networkx.connected_components(graph):
        walk = walk_round(graph, min(segment))
        vertices += [*walk, walk[-1]]
        contact += [True] * len(walk) + [False]
    joints = np.array([configuration(built, v, colors[v] or 0) for v in vertices])
    return ContactPath(joints, surface.vertices[vertices], np.array(contact)), vertices


SLIDE = 2
"""The prismatic joint of the four."""
MOTION = Motion(
    spacing_m=0.02,
    tool_radius_m=0.03,
    joint_velocities_rad_per_s=(3.0, 3.0, 0.15, 6.0),
    joint_accelerations_rad_per_s2=(8.0, 8.0, 2.0, 16.0),
    retract_m=0.02,
    clearance_m=0.003,
)


def scara_scene(motion: Motion = MOTION) -> Scene:
    """The shipped scene with 250 vertices and longer, so that each end has an elbow of its own."""
    scene = Scene.read(TOP / "instances" / "planar" / "cobra600_pipe.toml")
    scene = scene.varied(object={"target_vertices": 250, "length_m": 0.54})
    return scene.with_setup(scene.setup.model_copy(update={"motion": motion}))


@cache
def driven_scara() -> cellcolor.PlannedScene:
    """Its motion, planned and judged once a session."""
    return cellcolor.plan(scara_scene())
