# SPDX-License-Identifier: GPL-3.0-or-later
"""A tiny chain of the three programs whose runs take some hundredths of a second, half of them for the write: what each
run writes when nothing disturbs it, against which a disturbed run is held.

Lengths are in mm, forces in N. Two sheets differ only in their modulus, so that their files have the same names inside
and other bytes; a file of the one is never taken for a file of the other.
"""
import json
import os
import shutil
from dataclasses import dataclass, field
from pathlib import Path

from bench import Fall

PARTIAL = ".partial"  # ending of the names of files that are being written, beside their target


def sheet(E):
    """PLATE.json of a sheet with two pinned holes of radius 1, moved along x at its right edge."""
    holes = [{"id": str(i + 1), "center": [0, 10 * i + 5], "radius": 1, "spring": {"modulus": E}} for i in range(2)]
    return {"format": "plate", "version": 1, "name": "sheet", "units": {"length": "mm", "force": "N"},
            "analysis": "plane stress", "materials": {"m": {"E": E, "nu": 0.3}},
            "geometry": {"grid": {"x": [-10, -4, 4, 10], "y": [0, 10, 20], "thickness": 1}}, "disc_directions": ["x"],
            "holes": holes, "supports": [{"on": side, "fix": ["y"]} for side in ("bottom", "top")],
            "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}]}


def joint():
    """JOINT.json of that sheet on the ground, with cases and margins, so that every table can be asked for."""
    fasteners = [{"id": "1", "between": ["sheet:1", "ground"], "law": "pin", "friction": 0.1},
                 {"id": "2", "between": ["sheet:2", "ground"], "law": "pin", "clearance": 0.01}]
    cases = [{"name": name, "loads": [{"external": "sheet:P", "force": P}], "increments": n}
             for name, P, n in (("pull", 100, 3), ("push", -50, 2))]
    return {"format": "joint", "version": 1, "name": "tiny", "plates": {"sheet": "sheet.h5"},
            "laws": {"pin": {"type": "linear", "k": 1000}}, "fasteners": fasteners, "cases": cases,
            "margins": {"checks": [{"check": "bearing", "F_br": 500}, {"check": "peak", "limit": 300}]}}


def study(samples, seed, **more):
    """STUDY.json of that joint: the clearances and the stiffness of the pins vary."""
    uniform = {"distribution": {"type": "uniform", "from": 0, "to": 0.02}}
    factor = {"distribution": {"type": "normal", "mean": 1, "deviation": 0.1}}
    return {"format": "study", "version": 1, "samples": samples, "seed": seed, "variables": [
        {"name": "clearance", "at": "/fasteners/*/clearance", "each": True, **uniform},
        {"name": "k", "at": "/laws/pin/k", "use": "factor", **factor}]} | more


@dataclass
class Job:
    """One command line; `outputs` are the files that it writes with their bytes, None for those of documented times."""
    name: str
    words: list
    outputs: dict = field(default_factory=dict)
    seconds: float = 0.0

    @property
    def main(self):
        """Name of the file of -o."""
        return self.words[self.words.index("-o") + 1]


def jobs():
    """Every way in which the programs write files."""
    joint_to, study_to = ["stage3_nonlinear", "joint.json", "-o"], ["stage3_nonlinear", "joint.json", "--study", "study.json"]
    tables = [f"--{kind}={kind}.csv" for kind in ("csv", "envelope", "margins", "totals")]
    times = ["--timings", "times.json"]
    return [
        Job("stage1", ["stage1_plate", "sheet.json", "-o", "new.plate.h5", "--p", "1..4"]),
        Job("stage1 threads", ["stage1_plate", "sheet.json", "-o", "new.plate.h5", "--p", "1..6", "--threads", "2", *times]),
        Job("stage2", ["stage2_extract", "sheet.plate.h5", "-o", "new.h5", *times]),
        Job("stage2 loads", ["stage2_extract", "sheet.plate.h5", "-o", "new.h5", "--loads-only"]),
        Job("field", ["stage2_extract", "sheet.plate.h5", "-o", "new.vtu", "--field", "external:P=0.01"]),
        Job("stage3", [*joint_to, "result.h5"]),
        Job("tables", [*joint_to, "result.h5", *tables, *times, "--rim-stresses"]),
        Job("sensitivities", [*joint_to, "result.h5", "--case", "pull", "--sensitivities"]),
        Job("sample", [*study_to, "--sample", "3", "-o", "sample.json"]),
        Job("study", [*study_to, "-o", "study.h5", *times])]


class Chain:
    """The inputs of a sheet of modulus E in a folder of their own, and jobs with what they write when undisturbed."""

    def __init__(self, bench, name, E=70000.0):
        self.bench, self.folder = bench, bench.folder(f"chain-{name}")
        for path, text in (("sheet.json", sheet(E)), ("joint.json", joint()), ("study.json", study(20, 7))):
            (self.folder / path).write_text(json.dumps(text))
        bench.must("stage1_plate", "sheet.json", "-o", "sheet.plate.h5", "--p", "1..4", cwd=self.folder)
        bench.must("stage2_extract", "sheet.plate.h5", "-o", "sheet.h5", cwd=self.folder)
        self.inputs = sorted(path.name for path in self.folder.iterdir())
        self.bytes = {name: (self.folder / name).read_bytes() for name in self.inputs}
        self.jobs = [self._undisturbed(job) for job in jobs()]

    def _undisturbed(self, job):
        """Runs a job twice, notes what it writes and how long it takes; a Fall if both runs do not write the same."""
        seen = []
        for _ in range(2):
            run = self.bench.must(*job.words, cwd=self.folder)
            written = sorted(set(path.name for path in self.folder.iterdir()) - set(self.inputs))
            seen.append({name: (self.folder / name).read_bytes() for name in written if name != "times.json"})
            job.seconds = run.seconds
            for name in written:
                (self.folder / name).unlink()
        if seen[0] != seen[1]:
            raise Fall(f"{job.name}: two runs write other bytes")
        job.outputs = seen[0] | {"times.json": None for word in job.words if word == "times.json"}
        return job

    def job(self, name):
        return next(job for job in self.jobs if job.name == name)

    def copy(self, folder):
        """Puts the inputs into the folder of a round."""
        for name in self.inputs:
            shutil.copy(self.folder / name, folder / name)

    def check_inputs(self, folder):
        """A Fall if a run has changed what it was to read alone."""
        for name, whole in self.bytes.items():
            if not (Path(folder) / name).is_file() or (Path(folder) / name).read_bytes() != whole:
                raise Fall(f"input {name} has changed")


def check_whole(path, allowed, what):
    """A Fall unless the file at a path is one of the allowed bytes; None among them allows that there is no file."""
    found = Path(path).read_bytes() if Path(path).is_file() else None
    if found in allowed:
        return found
    if found is None:
        raise Fall(f"{what}: {Path(path).name} is not there")
    sizes = " nor ".join(str(len(whole)) for whole in allowed if whole is not None)
    raise Fall(f"{what}: {Path(path).name} is torn or wrong: {len(found)} bytes, neither {sizes} allowed")


def is_times(path):
    """Whether a file of --timings is whole: JSON with all of its keys."""
    try:
        return json.loads(Path(path).read_text()).keys() >= {"program", "seconds", "total", "peak_memory_bytes"}
    except ValueError:
        return False


def check_job(job, folder, old, what, must_be_new=False):
    """Holds all files of a job against what may be there: the `old` bytes by name, or the new ones."""
    for name, new in job.outputs.items():
        path, before = folder / name, old.get(name)
        if new is not None:
            check_whole(path, [new] if must_be_new else [before, new], what)
            continue
        found = path.read_bytes() if path.is_file() else None
        if not (found is not None and is_times(path)) and (must_be_new or found != before):
            raise Fall(f"{what}: {name} is {'not there' if found is None else 'torn'}")


def left_behind(folder):
    """Paths of files of unfinished writes in a folder and below; links are not followed."""
    return sorted(os.path.join(at, name) for at, _, names in os.walk(folder) for name in names if name.endswith(PARTIAL))
