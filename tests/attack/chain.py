# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene through the three programs, and what they left, as arrays."""
import json
import re

import h5py
import numpy as np

from bench import Fall

WARNING = re.compile(r"^\S+: warning \[([a-z0-9-]+)\]: ", re.M)


LONGEST = 60.0  # seconds; stacks of sheets in contact with many events have taken 20


class Refused(Exception):
    """A program ended with a status other than 0: `program`, `status`, and the first line of why."""

    def __init__(self, program, outcome):
        self.program, self.status = program, outcome.status
        lines = [line for line in outcome.stderr.splitlines() if ": error: " in line]
        self.line = lines[0] if lines else ""
        super().__init__(f"{program}: status {outcome.status}: {self.line}")


class Slow(Exception):
    """Stage 3 took longer than LONGEST: many rims of very stiff disks with friction, which is known (docs/limits.md)."""


class File:
    """The datasets of an HDF5 file by path, as numpy arrays, text as lists of str. Missing ones raise KeyError."""

    def __init__(self, path):
        self.data = {}
        with h5py.File(path) as file:
            self.attributes = dict(file.attrs)
            file.visititems(self._take)

    def _take(self, path, item):
        if isinstance(item, h5py.Dataset):
            value = item.asstr()[()] if item.dtype == object else item[()]
            self.data[path] = list(value) if isinstance(value, np.ndarray) and value.dtype == object else value

    def __getitem__(self, path):
        return self.data[path]

    def get(self, path, other=None):
        return self.data.get(path, other)

    def __contains__(self, path):
        return path in self.data


class Chain:
    """Runs scenes on the bench. Every run is held to what bench.py says; Refused for a status other than 0."""

    def __init__(self, bench):
        self.bench, self.slowest = bench, 0.0
        self.longest = LONGEST / (10 if bench.sanitized else 1)  # the bench gives sanitized programs ten times as long

    def _run(self, *words, cwd):
        try:
            outcome = self.bench.run(*words, "--quiet", cwd=cwd, longest=self.longest)
        except Fall as fall:
            if words[0] == "stage3_nonlinear" and str(fall).startswith("hang:"):
                raise Slow from fall
            raise
        self.slowest = max(self.slowest, outcome.seconds)
        if outcome.status:
            raise Refused(words[0], outcome)
        return WARNING.findall(outcome.stderr)

    def sheet(self, folder, name, plate):
        """NAME.matrices.h5 of a PLATE.json; returns its File and the codes of warnings."""
        (folder / f"{name}.json").write_text(json.dumps(plate))
        codes = self._run("stage1_plate", f"{name}.json", "-o", f"{name}.h5", cwd=folder)
        codes += self._run("stage2_extract", f"{name}.h5", "-o", f"{name}.matrices.h5", cwd=folder)
        return File(folder / f"{name}.matrices.h5"), codes

    def joint(self, folder, joint, *options):
        """RESULT.h5 of a JOINT.json whose matrices are there; returns its File and the codes of warnings."""
        (folder / "joint.json").write_text(json.dumps(joint))
        codes = self._run("stage3_nonlinear", "joint.json", "-o", "result.h5", *options, cwd=folder)
        return File(folder / "result.h5"), codes

    def scene(self, folder, scene, *options):
        """Files of all sheets by name, that of the result, and all codes."""
        folder.mkdir(exist_ok=True)
        codes, sheets = [], {}
        for name, plate in scene.plates.items():
            sheets[name], more = self.sheet(folder, name, plate)
            codes += more
        result, more = self.joint(folder, scene.joint, *options)
        return sheets, result, codes + more
