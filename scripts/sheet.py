# SPDX-License-Identifier: GPL-3.0-or-later
"""One sheet, solved by stage1_plate and stage2_extract (taken from PATH), and its stresses by superposition."""
import json
import subprocess
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np


class Sheet:
    """A scene (a dict as in PLATE.json) from JSON to MATRICES.h5; `seconds` is what both programs took."""

    def __init__(self, scene):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "plate.json").write_text(json.dumps({"format": "plate", "version": 1, **scene}))
            start = time.perf_counter()
            for program, source, target in (("stage1_plate", "plate.json", "plate.h5"),
                                            ("stage2_extract", "plate.h5", "matrices.h5")):
                run = subprocess.run([program, folder / source, "-o", folder / target, "--quiet"], capture_output=True,
                                     text=True)
                if run.returncode:
                    raise RuntimeError(run.stderr)
            self.seconds = time.perf_counter() - start
            with h5py.File(folder / "matrices.h5") as f:
                self.data = {}
                f.visititems(lambda path, item: self.data.update({path: item.asstr()[()] if item.dtype == object else
                                                                  item[()]}) if isinstance(item, h5py.Dataset) else None)

    def __getitem__(self, path):
        return self.data[path]

    def cases(self):
        """Names of the unit cases in their order."""
        a = self.data
        return ([("external", i) for i in a["external/id"]]
                + [("disc", *i) for i in zip(a["disc/hole"], a["disc/direction"])]
                + [("friction", *i) for i in zip(a["friction/hole"], a["friction/bearing"])]
                + [("traction", i) for i in a["traction/id"]])

    def amounts(self, given):
        """Amount of every unit case; `given` names those that are not zero."""
        names = self.cases()
        vector = np.zeros(len(names))
        for name, value in given.items():
            vector[names.index(name)] = value
        return vector

    def rim(self, hole, amounts, level=-1):
        """Angles in radians, sigma_rr, sigma_tt, sigma_rt around a hole at its degree stress/p[level]."""
        i = list(self["rim/hole"]).index(hole)
        points = slice(self["rim/start"][i], self["rim/start"][i + 1])
        stresses = [self[f"rim/sigma_{kind}"][level, points] @ amounts for kind in ("rr", "tt", "rt")]
        return np.radians(self["rim/angle"][points]), *stresses
