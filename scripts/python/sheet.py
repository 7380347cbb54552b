# SPDX-License-Identifier: GPL-3.0-or-later
"""One sheet, solved by the programs (taken from PATH): its matrices, and the stresses around its holes under loads."""
import json
import subprocess
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

from stress_field import Field


def run(program, source, target, *options):
    done = subprocess.run([program, source, "-o", target, "--quiet", *options], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr)


def datasets(path):
    """All of a file by their paths; text as strings."""
    found = {}
    with h5py.File(path) as f:
        f.visititems(lambda path, item: found.update({path: item.asstr()[()] if item.dtype == object else item[()]})
                     if isinstance(item, h5py.Dataset) else None)
    return found


class Sheet:
    """A scene (a dict as in PLATE.json) from JSON to MATRICES.h5, whose datasets are `sheet[PATH]`; `seconds` is what the
    programs took.

    @param loads {external: force} of a joint in which the ground holds all discs of the sheet; with them the stresses
                 around its holes are known.
    @param field Cases with amounts, as of stage2_extract --field, of a field whose file then is the Field `field`.
    """

    def __init__(self, scene, loads=None, field=""):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "plate.json").write_text(json.dumps({"format": "plate", "version": 1, **scene}))
            start = time.perf_counter()
            run("stage1_plate", folder / "plate.json", folder / "plate.h5")
            run("stage2_extract", folder / "plate.h5", folder / "matrices.h5")
            self.data = datasets(folder / "matrices.h5")
            if loads:
                fasteners = [{"id": disc, "between": [f"sheet:{disc}", "ground"], "law": "rigid"}
                             for disc in dict.fromkeys(self["disc/hole"])]
                (folder / "joint.json").write_text(json.dumps({
                    "format": "joint", "version": 1, "plates": {"sheet": "matrices.h5"}, "laws": {"rigid": {"type": "rigid"}},
                    "fasteners": fasteners,
                    "loads": [{"external": f"sheet:{id}", "force": force} for id, force in loads.items()]}))
                run("stage3_nonlinear", folder / "joint.json", folder / "result.h5", "--rim-stresses")
                self.result = datasets(folder / "result.h5")
            if field:
                run("stage2_extract", folder / "plate.h5", folder / "field.vtu", "--field", field)
                self.field = Field(folder / "field.vtu")
            self.seconds = time.perf_counter() - start

    def __getitem__(self, path):
        return self.data[path]

    def of_rim(self, name):
        return self.result[f"plates/sheet/rim/{name}"]

    def index(self, hole):
        return list(self.of_rim("hole")).index(hole)

    def rim(self, hole):
        """Angles in radians, one degree apart, sigma_rr, sigma_tt, sigma_rt around a hole under the loads."""
        i = self.index(hole)
        points = slice(self.of_rim("start")[i], self.of_rim("start")[i + 1])
        stresses = [self.of_rim(f"sigma_{kind}")[-1, points] for kind in ("rr", "tt", "rt")]
        return np.radians(self.of_rim("angle")[points]), *stresses

    def peak(self, hole):
        """Largest hoop stress around a hole under the loads."""
        return self.of_rim("peak_hoop")[-1, self.index(hole)]
