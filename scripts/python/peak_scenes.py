# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes of scripts/measure/chart_peaks with the true peak of the hoop stress of one hole, and their runs; N and mm."""
import copy
import json
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2] / "tests" / "support"))
import strip_with_hole  # noqa: E402
from calculix_pin import Pin  # noqa: E402
from cut_mesh import cut_mesh  # noqa: E402
from pin_on_springs import WideSheet, compliance, isotropic  # noqa: E402
from stress_field import Field, FineField  # noqa: E402
from timed_runs import timed  # noqa: E402

FORCE = 1000
PIN = Pin(E=70e3, nu=0.3, modulus=5 * 70e3, gap=0.574987 * FORCE / 70e3, force=FORCE, half_width=200)
LAMINATE = {"E1": 140e3, "E2": 10e3, "G12": 5e3, "nu12": 0.3, "angle": 30}
LINES = [5, 20, 60, 200]  # either side of the hole: at 200 radii the borders change the peak by 1e-5
MORE_LINES = [5, 12, 30, 60, 120, 240, 480]  # along stiff fibres borders show farther away
TRUE_WAVES = 192  # of the exact solution in a laminate: twice as many change the peak by 1e-5, a quarter by 1e-3
PIECES, WAVES = 3, 32  # of the cut mesh that the column's truth is by


@dataclass(frozen=True)
class Setting:
    """What a run sets, the same of all holes; None: the default, as a user has it who says nothing."""
    space: str = None
    rings: int = None
    p: int = None

    def of(self, sheet):
        """The sheet's PLATE.json with this setting."""
        sheet = copy.deepcopy(sheet) | ({"space": self.space} if self.space else {})
        for hole in sheet["holes"]:
            if self.rings is not None:
                hole["rings"] = self.rings
        return sheet


@dataclass
class Found:
    """Seconds and the peak, N/mm^2, as RESULT.h5 has it; the same by the stresses at points of the rim."""
    seconds: float
    peak: float
    point_seconds: float
    point_peak: float


class Scene:
    """Sheets by name and a joint of them; the peak is that of the last sheet's first hole.

    rings: how many of them are tried around each hole.
    """

    def __init__(self, name, sheets, fasteners, loads, law, folder, rings=(0, 1, 2)):
        self.name, self.sheets, self.folder, self.rings = name, sheets, Path(folder) / name.replace(" ", "_"), rings
        self.joint = {"format": "joint", "version": 1, "laws": {"law": law}, "loads": loads,
                      "fasteners": [{"law": "law", **fastener} for fastener in fasteners]}
        self.folder.mkdir()

    def in_contact(self):
        return any("spring" in hole for sheet in self.sheets.values() for hole in sheet["holes"])

    def run(self, setting):
        degrees = ["--p", setting.p] if setting.p else []
        return self.stages({name: setting.of(sheet) for name, sheet in self.sheets.items()}, degrees)

    def stages(self, sheets, degrees=()):
        """All programs from JSON to RESULT.h5, and to the field of the last sheet."""
        seconds, plates, matrices = 0, {}, {}
        for name, sheet in sheets.items():
            plate = self.folder / f"{name}.json"
            plate.write_text(json.dumps(sheet))
            plates[name], matrices[name] = plate.with_suffix(".h5"), plate.with_suffix(".matrices.h5")
            seconds += timed("stage1_plate", plate, plates[name], *degrees)["total"]
            seconds += timed("stage2_extract", plates[name], matrices[name])["total"]
        joint, result, field = (self.folder / end for end in ("joint.json", "joint.h5", "field.vtu"))
        joint.write_text(json.dumps(self.joint | {"plates": {key: str(path) for key, path in matrices.items()}}))
        seconds += timed("stage3_nonlinear", joint, result)["total"]
        with h5py.File(result) as f:
            peak = f[f"plates/{name}/rim/peak_hoop"][-1, 0]
        more = timed("stage2_extract", plates[name], field, "--field", result, "--plate", name)["total"]
        return Found(seconds, peak, seconds + more, peak_at_points(field, sheet["holes"][0]))

    def fine_peak(self):
        """By meshes cut along the rims."""
        programs = Path(shutil.which("stage1_plate")).resolve().parent
        return self.stages({name: cut_mesh(self.folder, programs, sheet, PIECES, WAVES)
                            for name, sheet in self.sheets.items()}).peak


def peak_at_points(path, hole):
    """The largest hoop stress of a field at points of a rim, several for each degree of an element."""
    fine, center = FineField(Field(path), "stress_xx"), complex(*hole["center"])
    z = fine.x + 1j * fine.y - center
    on_rim = np.abs(np.abs(z) / hole["radius"] - 1) < 0.005
    c, s = z[on_rim].real / np.abs(z[on_rim]), z[on_rim].imag / np.abs(z[on_rim])
    xx, yy, xy = (stress[on_rim] for stress in fine.stress)
    return (xx * s**2 + yy * c**2 - 2 * xy * s * c).max()


def plate(material, x, y, holes, thickness=1, **more):
    return {"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"m": material},
            "geometry": {"grid": {"x": x, "y": y, "thickness": thickness}}, "holes": holes, **more}


def pin_in_a_wide_sheet(name, material, modulus, gap, lines, folder, rings=(0, 1, 2)):
    """Half of the force leaves at either side, so that nothing passes by the pin."""
    lines, sides = [-at for at in reversed(lines)] + lines, ("left", "right")
    hole = {"id": "h", "center": [0, 0], "radius": 1, "spring": {"modulus": modulus, "compression_only": True}}
    sheet = plate(material, lines, lines, [hole],
                  external=[{"id": side, "on": side, "direction": "x", "kind": "rigid"} for side in sides])
    loads = [{"external": f"sheet:{side}", "force": -FORCE / 2} for side in sides]
    fastener = {"id": "pin", "between": ["sheet:h", "ground"], "gap": gap}
    return Scene(name, {"sheet": sheet}, [fastener], loads, {"type": "rigid"}, folder, rings)


def isotropic_pin(folder):
    scene = pin_in_a_wide_sheet("isotropic pin", {"E": PIN.E, "nu": PIN.nu}, PIN.modulus, PIN.gap, LINES, folder)
    return scene, WideSheet(isotropic(PIN.E, PIN.nu)).pin(PIN.force, PIN.modulus, PIN.gap)[2]


def laminate_pin(folder):
    modulus, gap = 5 * LAMINATE["E1"], 0.5 * FORCE / LAMINATE["E1"]
    scene = pin_in_a_wide_sheet("pin in a laminate", LAMINATE, modulus, gap, MORE_LINES, folder, (1, 2, 3))
    return scene, WideSheet(compliance(*LAMINATE.values())).pin(FORCE, modulus, gap, TRUE_WAVES)[2]


def column_of_rivets(folder):
    """Two sheets, cells 20 mm wide, three rivets of 4 mm behind one another; the first one of the lower sheet."""
    aluminium = {"E": 72400, "nu": 0.33}
    holes = [{"id": id, "center": [x, 10], "radius": 2, "spring": {"disk": aluminium, "compression_only": True}}
             for id, x in (("1", 90), ("2", 110), ("3", 130))]

    def sheet(x, *external, **more):
        support = {"on": "bottom", "fix": ["y"]}
        return plate(aluminium, x, [0, 20], holes, 1.6, supports=[*more.get("supports", []), support],
                     external=[{"id": "T", "on": "top", "direction": "y", "kind": "rigid"}, *external])

    upper = sheet([80, 100, 120, 140, 180, 220], {"id": "P", "on": "right", "direction": "x", "kind": "traction"})
    lower = sheet([0, 40, 80, 100, 120, 140], supports=[{"on": "left", "fix": ["x"]}])
    scene = Scene("column of rivets", {"upper": upper, "lower": lower},
                  [{"id": id, "between": [f"upper:{id}", f"lower:{id}"]} for id in "123"],
                  [{"external": "upper:P", "force": 3200}], {"type": "linear", "k": 50000}, folder)
    return scene, scene.fine_peak()


def open_hole(folder):
    """A strip twice as wide as its hole in tension. A joint wants a fastener: a corner has one that bears nothing."""
    sheet = plate({"E": 70e3, "nu": 0.3}, [-6, -2, 2, 6], [-2, 2], [{"id": "h", "center": [0, 0], "radius": 1}],
                  points=[{"id": "corner", "at": [-6, 2], "stiffness": 1e5}], disc_directions=["y"],
                  supports=[{"on": "left", "fix": ["x"]}],
                  external=[{"id": "P", "on": "right", "direction": "x", "kind": "traction"}])
    scene = Scene("open hole in a strip", {"sheet": sheet}, [{"id": "corner", "between": ["sheet:corner", "ground"]}],
                  [{"external": "sheet:P", "force": 4}], {"type": "linear", "k": 1e-3}, folder)
    return scene, strip_with_hole.concentration(0.5)
