"""Plan drawn scenes and have them judged: ``python benchmarks/drives.py [--arms FOLDER] [CASE …]``.

Cases are numbers from 0 on: first the shipped scenes, then scenes that are drawn at random with a
fixed seed, of shipped arms and of the URDFs in a folder (those of ros-industrial, expanded from
xacro, for example), and of the parts below and the OBJ meshes in a folder. A line of JSON is
printed for each, and a table by cause at the end.
docs/measured.md has what came out.
"""

from __future__ import annotations

import argparse
import json
import re
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

import cellcolor
from cellcolor.errors import CellcolorError, InputError

ROOT = Path(__file__).parents[1]
SHIPPED_ARMS = ["ur5e", "kr6", "irb120", "tx2_60"]
SHIPPED = [
    *sorted(path.stem for path in (ROOT / "instances" / "scenes").glob("*.toml")),
    *sorted(path.stem for path in (ROOT / "instances" / "arms").glob("*.toml")),
    "saddle", "perforated_sheet", "sphere", "torus", "blend", "bracket",
]  # fmt: skip
SEED, DRAWN = 24, 90


def parts(folder: Path | None) -> dict[str, trimesh.Trimesh]:
    """Parts of about 0.2 m, sharp, thin, closed and open ones, and those of a folder."""
    hull = np.random.default_rng(SEED).normal(size=(14, 3))
    wedge = np.array([[x, y, z * (1.5 - x)] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    found = {
        "block": trimesh.creation.box((0.2, 0.14, 0.08)),
        "thin box": trimesh.creation.box((0.24, 0.16, 0.006)),
        "wedge": trimesh.convex.convex_hull(wedge),
        "faceted": trimesh.convex.convex_hull(hull),
        "torus": trimesh.creation.torus(0.075, 0.03),
        "capsule": trimesh.creation.capsule(0.12, 0.05),
        "cylinder": trimesh.creation.cylinder(0.06, 0.18),
        "ball": trimesh.creation.icosphere(3, 0.09),
        "egg": trimesh.creation.icosphere(3, 0.09),
        "ring": trimesh.creation.annulus(0.05, 0.1, 0.06),
        "cone": trimesh.creation.cone(0.09, 0.16),
    }
    found["egg"].apply_scale([1.3, 1.0, 0.7])
    shipped = ("bracket", "blend", "saddle", "perforated_sheet")
    for name in shipped:
        found[name] = trimesh.load_mesh(ROOT / "instances" / "parts" / f"{name}.obj")
    for file in sorted(folder.glob("*.obj")) if folder else []:
        found[file.stem] = trimesh.load_mesh(file)
    for mesh in found.values():
        mesh.apply_translation(-mesh.bounds.mean(axis=0))
        mesh.apply_scale(0.2 / mesh.extents.max())
    return found


def drawn(
    number: int, arms: list[Path], every: dict[str, trimesh.Trimesh], seed: int, folder: Path
) -> tuple[Path, str]:
    """A scene that is drawn, and what it is of: an arm, a part, and where that stands."""
    rng = np.random.default_rng([seed, number])
    arm = arms[number % len(arms)]
    name = str(rng.choice(sorted(every)))
    part = folder / f"{name.replace(' ', '_')}.obj"
    every[name].export(part)
    began = folder / arm.stem
    if not (began / "setup.toml").exists():
        every["capsule"].export(folder / "first.obj")
        cellcolor.new(folder / "first.obj", arm, began, unit="m")
        setup = began / "setup.toml"
        setup.write_text(re.sub("(?m)^home_rad = .*$", 'home_rad = "free"', setup.read_text()))
    far, side = rng.uniform(0.45, 0.75), rng.uniform(-1.0, 1.0)
    size = REACH.get(arm.stem, 0.9)
    place = [far * size * np.cos(side), far * size * np.sin(side), rng.uniform(0.05, 0.45) * size]
    tilt = [rng.uniform(-0.7, 0.7), rng.uniform(-0.7, 0.7)] if rng.random() < 0.6 else [0.0, 0.0]
    tilt[0] += np.pi / 2 * (rng.random() < 0.25)
    scale = min(1.6, max(0.8, size / 0.9))
    scene = folder / f"{number}.toml"
    scene.write_text(
        f'name = "{arm.stem} {name} {number}"\nsetup = "{began.name}/setup.toml"\n'
        f'[object]\nkind = "mesh"\nfile = "{part.name}"\nmeters_per_unit = {scale:.3f}\n'
        "repair = true\n"
        f"max_edge_m = {0.02 * scale:.4f}\n[placement]\n"
        f"position_m = {[round(float(v), 3) for v in place]}\n"
        f"rpy_rad = {[round(float(v), 3) for v in (*tilt, rng.uniform(-3.1, 3.1))]}\n"
        "[ground]\nheight_m = -0.05\n"
    )
    return scene, f"{arm.stem}, {name}"


REACH = {
    "irb2400": 1.5, "irb4400l_30_243": 2.2, "m10ia": 1.3, "lrmate200id": 0.75, "gp7": 0.9,
    "gp12": 1.35, "kr10r1100sixx": 1.0, "kr5_arc": 1.3, "kr16_2": 1.5, "kr6": 0.9,
    "ur5e": 0.85, "irb120": 0.6, "tx2_60": 0.65, "cr7ia": 0.7, "gp25": 1.7, "gp8": 0.72,
    "hc10": 1.2, "kr3r540": 0.54, "kr6r900sixx": 0.9, "lrmate200ic": 0.7, "m20ia": 1.8,
    "mh12": 1.44,
}  # fmt: skip
"""Metres, of the arms that scenes were drawn for; 0.9 for others."""


def outcome(scene: Path | str, time_limit: float) -> dict[str, Any]:
    """How a plan ended: ``valid``, or why not."""
    begun, worked = time.monotonic(), time.process_time()
    stages: list[tuple[str, float]] = []

    def progress(stage: str) -> None:
        stages.append((stage, time.monotonic()))

    found: dict[str, Any] = {}
    try:
        planned = cellcolor.plan(scene, time_limit=time_limit, progress=progress)
    except InputError as error:
        found = {
            "ends": "refused",
            "cause": str(error).rpartition(": ")[2][:60],
            "text": str(error),
        }
    except CellcolorError as error:
        found = {"ends": type(error).__name__, "cause": "time", "text": str(error)}
    except Exception as error:
        found = {"ends": "crash", "cause": repr(error)[:80], "text": repr(error)}
    else:
        verdict = planned.verdict
        counts = {
            (fault.kind if fault.reason is None else f"{fault.kind} ({fault.reason})"): 0
            for fault in verdict.faults
        }
        extra = Counter(one.reason for one in planned.trajectory.extra_lift_offs)
        found = {
            "ends": "valid" if verdict.valid else "not valid",
            "cause": ", ".join(counts) or None,
            "text": "; ".join(fault.text for fault in verdict.faults[:3]),
            "lift_offs": [verdict.minimum_lift_offs, verdict.lift_offs],
            "extra": dict(extra),
            "blocked": planned.trajectory.meta.get("blocked", []),
            "stages": {stage: round(took, 1) for stage, took in planned.seconds.items()},
        }
    found["seconds"] = round(time.monotonic() - begun, 1)
    found["cpu"] = round(time.process_time() - worked, 1)
    found["last stage"] = stages[-1][0] if stages else None
    return found


def main() -> None:
    """Run the cases and count by cause."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("case", type=int, nargs="*", help="numbers; all without")
    parser.add_argument("--arms", type=Path, help="folder of URDFs besides the shipped arms")
    parser.add_argument("--parts", type=Path, help="folder of OBJ meshes besides the parts here")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--folder", type=Path, help="where scenes are kept; temporary without")
    parser.add_argument("--time-limit", type=float, default=120.0, metavar="S")
    asked = parser.parse_args()
    arms = [ROOT / "models" / "robots" / f"{name}.urdf" for name in SHIPPED_ARMS]
    arms += sorted(asked.arms.glob("*.urdf")) if asked.arms else []
    every = parts(asked.parts)
    causes: Counter[tuple[str, str | None]] = Counter()
    with tempfile.TemporaryDirectory() as temporary:
        folder = asked.folder or Path(temporary)
        folder.mkdir(exist_ok=True)
        for number in asked.case or range(len(SHIPPED) + DRAWN):
            scene: Path | str
            try:
                if number < len(SHIPPED):
                    scene = name = SHIPPED[number]
                else:
                    scene, name = drawn(number - len(SHIPPED), arms, every, asked.seed, folder)
            except InputError as error:  # an arm that ``new`` refuses
                ended = {"of": "an arm", "ends": "refused", "cause": None, "text": str(error)}
            else:
                ended = {"of": name, **outcome(scene, asked.time_limit)}
            found: dict[str, Any] = {"case": number, **ended}
            causes[found["ends"], found["cause"]] += 1
            print(json.dumps(found), flush=True)
    for (ends, cause), times in causes.most_common():
        print(f"| {ends} | {cause or ''} | {times} |")


if __name__ == "__main__":
    main()
