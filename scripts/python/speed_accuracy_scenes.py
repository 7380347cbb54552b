# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes of scripts/measure/chart_speed_accuracy, in every discretisation, with what a run of each costs and gives."""
import json
import re
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

from refined_mesh import refined
from timed_runs import read_S_and_R, run, solve_sheet, timed

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples" / "three_fasteners"
COARSE_RINGS = 1  # of the mesh that the h-version cuts: its elements are about square


@dataclass(frozen=True)
class Setting:
    """A discretisation: each element of the grid's mesh in cut x cut; S from stresses, or as stage 2 extracts it."""
    space: str
    rings: int
    p: int
    cut: int = 1
    by_stress: bool = False



@dataclass
class Found:
    """What one run gives: S of the first sheet, or None, S_ee alone; the loads of the fasteners, or None."""
    seconds: float
    unknowns: int
    S_ee: float
    S: np.ndarray = None
    loads: np.ndarray = None


class Scene:
    """Sheets by name, each a scene on a grid, and the joint of them, if any; files go to a folder of its own.

    truth: the setting that errors are against, and one with half its cuts: their difference shows its own error. Cuts
    make all elements smaller, which extra rings do not: those leave 6e-11 in S of panel(1,1), and 7e-8 in the loads of
    the joint, where the thickness steps of the doubler meet its edges.
    """

    def __init__(self, name, sheets, joint, cut, folder):
        self.name, self.sheets, self.joint = name, sheets, joint
        self.truth = Setting("product", COARSE_RINGS, 8, cut), Setting("product", COARSE_RINGS, 8, cut // 2)
        self.key = re.sub(r"\W+", "_", name).strip("_")
        self.folder = Path(folder) / self.key
        self.folder.mkdir()

    def write(self, name, setting):
        """PLATE.json of a sheet, written once."""
        path = self.folder / f"{name}_{setting.space}_{setting.rings}_{setting.cut}.json"
        if path.exists():
            return path
        scene = json.loads(json.dumps(self.sheets[name])) | {"space": setting.space}
        for hole in scene["holes"]:
            hole |= {"rings": setting.rings, "stresses": False}
        path.write_text(json.dumps(scene))
        if setting.cut > 1:
            self.cut(scene, path, setting.cut)
        return path

    @staticmethod
    def cut(scene, path, cut):
        run("stage1_plate", path, "-o", path.with_suffix(".h5"), "--p", 1, "--quiet")
        with h5py.File(path.with_suffix(".h5")) as plate:
            scene["geometry"] = refined(plate, cut)
        for hole in scene["holes"]:
            del hole["rings"]
        path.write_text(json.dumps(scene))

    def run(self, setting):
        paths = {name: self.write(name, setting) for name in self.sheets}
        return self.run_by_stress(paths, setting) if setting.by_stress else self.run_stages(paths, setting)

    def run_stages(self, paths, setting):
        """All programs, from JSON to MATRICES.h5 of every sheet or to RESULT.h5 of the joint."""
        records, matrices = [], {}
        for name, path in paths.items():
            matrices[name], times = solve_sheet(path, setting.p)
            records += times
        unknowns = sum(record["unknowns"][str(setting.p)] for record in records[::2])
        S, _ = read_S_and_R(next(iter(matrices.values())))
        loads = S[0, 1:]
        if self.joint:
            scene, result = self.folder / "joint.json", self.folder / "joint.h5"
            scene.write_text(json.dumps(self.joint | {"plates": {name: str(at) for name, at in matrices.items()}}))
            records.append(timed("stage3_nonlinear", scene, result))
            with h5py.File(result) as f:
                loads = f["F"][-1]
        return Found(sum(record["total"] for record in records), unknowns, S[0, 0], S, loads)

    def run_by_stress(self, paths, setting):
        """The same run, but S_ee from stresses: either takes the same solution and hardly any time after it."""
        found = self.run_stages(paths, setting)
        (path,) = paths.values()
        stiffness = path.with_suffix(".stress.json")
        run("integrated_stress", path, "-o", stiffness, "--p", setting.p, "--quiet")
        return Found(found.seconds, found.unknowns, json.loads(stiffness.read_text())["S_ee"])


def panel(nx, ny, cut, folder):
    sheets = {"plate": json.loads(run(ROOT / "scripts/measure/make_panel", nx, ny))}
    return Scene(f"panel({nx},{ny})", sheets, None, cut, folder)


def three_fasteners(cut, folder):
    sheets = {name: json.loads((EXAMPLE / f"{name}.json").read_text()) for name in ("center", "doubler")}
    joint = json.loads((EXAMPLE / "joint.json").read_text())
    return Scene("three-fastener joint", sheets, joint, cut, folder)
