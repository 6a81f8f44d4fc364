"""Is the wrist above the forearm? Counted in the shipped scenes, and searched for over a wok.

    python benchmarks/wrist.py [SCENE ...]
    python benchmarks/wrist.py --near
    python benchmarks/wrist.py --search PLACEMENTS [SEED] [--tool] [--thresholds]

Above: the crossing of axes 5 and 6 lies above the forearm's line, in the plane across axis 4.
The first form prints one line a branch with the valid configurations of the scene as stored, and
how often only one of a shoulder's two wrists, one above and one below, is valid.

The second form looks at a shallow wok close to the robot: as the setup has it, with capsules of
50 mm on forearm and wrist 2, and with a motor on the tool, beside the flange.

The third form varies place, tilt, size and depth of a wok and the height of the ground, with
--tool length and radius of the tool as well, with --thresholds those on conditioning. It climbs
from random starts towards the largest share of valid configurations, by area, with the wrist
above, among placements with at least 85 % reachable by two branches that are both needed. Every
climb prints its best. The figures of docs/experiments.md were made with this.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.errors import InputError
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.ur import BRANCHES
from cellcolor.frontend.parts.placement import rotation_from_rpy
from cellcolor.frontend.prepared import PreparedScene, prepare
from cellcolor.frontend.scene import Scene

TOP = Path(__file__).parents[1]
SCENES, ROBOTS = TOP / "instances" / "scenes", TOP / "models" / "robots"
NAMES = ("hemisphere_flat", "hemisphere_tilted", "half_pipe", "wok", "wok_obstacle", "square")
LEFT, RIGHT = range(4), range(4, 8)

PLACEMENT = {  # lowest and highest value; m and rad
    "distance": (0.15, 0.85),  # from the robot's axis to the wok's
    "rim": (-0.4, 0.6),  # height of the rim's plane, before the tilt
    "rim_radius": (0.13, 0.25),
    "half_angle": (np.deg2rad(30), np.deg2rad(80)),
    "away": (-np.deg2rad(60), np.deg2rad(60)),  # tilt, away from the robot and sideways
    "aside": (-np.deg2rad(45), np.deg2rad(45)),
    "gap": (0.003, 0.5),  # from the lowest point down to the ground, which is not above 0
}
TOOL = {"length": (0.04, 0.3), "radius": (0.015, 0.09)}
# A shallow wok close to the robot, on the ground that the robot stands on.
NEAR = {
    "distance": 0.28,
    "rim": 0.07,
    "rim_radius": 0.153,
    "half_angle": np.deg2rad(32),
    "away": 0.0,
    "aside": 0.0,
    "gap": 0.07,
}
# Parallel to the tool, on the side away from wrist 1, and 200 mm back from the flange.
MOTOR = """<collision>
      <origin xyz="0 -0.15 -0.075"/><geometry><cylinder radius="0.07" length="0.25"/></geometry>
    </collision>"""
THRESHOLDS = {"manipulability": (0.0, 0.06), "determinant": (0.0, 0.012)}


def heights(robot: Robot, configurations: Array) -> Array:
    """How far the wrist is above the forearm, (n,) in m, of configurations (n, 6) in rad."""
    poses = forward(robot, configurations)
    elbow, wrist, knuckle = poses.origin[:, 3], poses.origin[:, 4], poses.origin[:, 5]
    up = np.cross(poses.axis[:, 2], wrist - elbow)
    up *= np.sign(up[:, 2:]) / np.linalg.norm(up, axis=1, keepdims=True)
    above: Array = np.einsum("ij,ij->i", knuckle - wrist, up)
    return above


def judged(prepared: PreparedScene) -> tuple[Mask, Array]:
    """Validity (n, 8) and heights (n, 8) of all candidates, NaN without a solution."""
    solutions = prepared.arm.inverse(prepared.surface.vertices, -prepared.surface.normals)
    verdicts = prepared.judge(solutions.reshape(-1, 6))
    above = np.full(verdicts.reasons.shape, np.nan)
    solved = ~np.isnan(verdicts.configurations[:, 0])
    above[solved] = heights(prepared.robot, verdicts.configurations[solved])
    return (verdicts.reasons == VALID).reshape(-1, 8), above.reshape(-1, 8)


def count(name: str) -> None:
    """Print what a shipped scene has."""
    valid, above = judged(prepare(SCENES / f"{name}.toml"))
    for branch in np.flatnonzero(valid.any(axis=0)):
        up = above[valid[:, branch], branch] > 0
        print(f"{name} {BRANCHES[branch]}: wrist above in {up.sum()} of {len(up)}")
    ups, downs = [], []
    for first in range(0, 8, 2):  # the two wrists of a shoulder and elbow
        pair, good = above[:, first : first + 2], valid[:, first : first + 2]
        mixed = np.flatnonzero((pair > 0).any(axis=1) & (pair <= 0).any(axis=1))
        up = np.argmax(pair[mixed] > 0, axis=1)
        ups.append(good[mixed, up])
        downs.append(good[mixed, 1 - up])
    up, down = np.concatenate(ups), np.concatenate(downs)
    print(
        f"{name}: {len(up)} pairs of wrists, one above and one below: both valid"
        f" {(up & down).sum()}, only above {(up & ~down).sum()}, only below {(down & ~up).sum()}"
    )


def variant(values: dict[str, float], stout: bool = False, motor: bool = False) -> Scene:
    """The wok with such a placement, arm and tool."""
    radius = float(values["rim_radius"] / np.sin(values["half_angle"]))
    height = float(values["rim"] - radius * np.cos(values["half_angle"]))
    turn = (values["aside"], values["away"], 0.0)
    rim = np.linspace(0, 2 * np.pi, 90)
    circle = [values["rim_radius"] * np.cos(rim), values["rim_radius"] * np.sin(rim)]
    edge = np.stack([*circle, np.full(90, values["rim"] - height)]).T @ rotation_from_rpy(*turn).T
    ground = min(0.0, float(edge[:, 2].min()) + height - values["gap"])
    wok = Scene.read(SCENES / "wok.toml")
    setup = wok.setup.varied(
        robot={"arm_urdf": arm(stout), "tool_urdf": tool(values, motor)},
        thresholds={
            "min_manipulability_m3": values.get("manipulability", 0.01),
            "min_task_determinant_m3": values.get("determinant", 0.001),
        },
    )
    return wok.varied(
        setup=setup,
        object={
            "radius_m": radius,
            "half_angle_rad": values["half_angle"],
            "target_vertices": 271,
        },
        placement={"position_m": (values["distance"], 0.0, height), "rpy_rad": turn},
        ground={"height_m": ground},
    )


def tool(values: dict[str, float], motor: bool) -> str:
    """The shipped tool's URDF with another length and radius, or with a motor beside it."""
    text = (ROBOTS / "polishing_tool.urdf").read_text()
    body = values.get("length", 0.1) - 0.01
    text = text.replace('<origin xyz="0 0 0.1"/>', f'<origin xyz="0 0 {body + 0.01}"/>')
    text = text.replace('xyz="0 0 0.045"', f'xyz="0 0 {body / 2}"')
    text = text.replace(
        'radius="0.02" length="0.09"', f'radius="{values.get("radius", 0.02)}" length="{body}"'
    )
    return text.replace("</link>", f"{MOTOR}</link>", 1) if motor else text


def arm(stout: bool) -> str:
    """The shipped arm's URDF, with capsules of 50 mm on forearm and wrist 2 if it is stout."""
    text = (ROBOTS / "ur5.urdf").read_text()
    for link, radius_now in {"forearm_link": "0.045", "wrist_2_link": "0.043"}.items():
        head, name, rest = text.partition(f'<link name="{link}">')
        body_text, end, tail = rest.partition("</link>")
        if stout:
            body_text = body_text.replace(f'radius="{radius_now}"', 'radius="0.05"')
        text = head + name + body_text + end + tail
    return text


def score(scene: Scene) -> tuple[float, str]:
    """How near a placement comes to the paper's wok, and what it is like."""
    try:
        prepared = prepare(scene)
    except InputError as error:
        if error.field != "placement":
            raise
        return -1.0, "the wok stands in the robot"
    valid, above = judged(prepared)
    area = prepared.surface.vertex_areas()
    area /= area.sum()
    covered = area @ valid
    if not covered.any():
        return -1.0, "out of reach"
    one, share = float(covered.max()), float((area @ (valid & (above > 0))).sum() / covered.sum())
    reached = float(area @ valid.any(axis=1))
    pair = max(float(area @ (valid[:, i] | valid[:, j])) for i in LEFT for j in RIGHT)
    below = float(area @ (valid & (above <= 0)).any(axis=1))
    found = (
        f"wrist above {share:.1%}, reachable {reached:.1%}, by one branch {one:.1%},"
        f" by a left and a right one {pair:.1%}; some wrist below valid on {below:.1%}"
    )
    faults = (
        1.5 * max(0.0, 0.85 - reached)
        + 3.0 * max(0.0, 0.03 - (reached - one))
        + 2.0 * max(0.0, reached - pair - 0.005)
    )
    return share - faults, found


def search(trials: int, seed: int, ranges: dict[str, tuple[float, float]]) -> None:
    """Climb from random starts (a plain evolution strategy), printing each climb's best."""
    random = np.random.default_rng(seed)
    low, high = np.array(list(ranges.values())).T
    done = 0

    def tried(point: Array) -> tuple[float, str, Array]:
        nonlocal done
        done += 1
        values = dict(zip(ranges, (low + point * (high - low)).tolist(), strict=True))
        value, found = score(variant(values))
        return value, found, point

    while done < trials:
        best = max((tried(random.random(len(low))) for _ in range(40)), key=lambda t: t[0])
        mean, spread, idle = best[2], 0.15, 0
        while idle < 12 and done < trials:
            steps = spread * random.standard_normal((10, len(low)))
            some = sorted((tried(p) for p in np.clip(mean + steps, 0, 1)), key=lambda t: -t[0])
            mean = np.average([t[2] for t in some[:4]], axis=0, weights=[4, 3, 2, 1])
            if some[0][0] > best[0] + 1e-3:
                best, idle = some[0], 0
            else:
                mean, spread, idle = best[2], 0.85 * spread, idle + 1
        values = dict(zip(ranges, low + best[2] * (high - low), strict=True))
        place = ", ".join(f"{key} {value:.3f}" for key, value in values.items())
        print(f"{done}: score {best[0]:.3f}: {best[1]}\n    {place}", flush=True)


def main(arguments: list[str]) -> None:
    """Count, look close to the robot, or search."""
    if "--near" in arguments:
        for name, changes in (
            ("as it is", {}),
            ("capsules of 50 mm", {"stout": True}),
            ("motor", {"motor": True}),
        ):
            print(f"{name}: {score(variant(NEAR, **changes))[1]}", flush=True)
        return
    if "--search" not in arguments:
        for name in arguments or NAMES:
            count(name)
        return
    trials, seed, *_ = [int(a) for a in arguments if a.isdigit()] + [1]
    ranges = PLACEMENT | (TOOL if "--tool" in arguments else {})
    ranges |= THRESHOLDS if "--thresholds" in arguments else {}
    search(trials, seed, ranges)


if __name__ == "__main__":
    main(sys.argv[1:])
