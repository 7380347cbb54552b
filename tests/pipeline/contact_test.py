#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Contact of fasteners with their holes inside a joint, against closed forms and against numbers of other programs.

Usage: contact_test.py FOLDER_OF_PROGRAMS"""
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

PROGRAMS = Path(sys.argv[1]).resolve()
NISIDA = Path(__file__).resolve().parents[2] / "examples/nisida"


def run(folder, program, *arguments):
    done = subprocess.run([PROGRAMS / program, *arguments, "--quiet"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stderr


def sheet(x, y, thickness, material, holes, disc, *, contact=True, radius, p=(5, 8), harmonics=16,
          directions=("x", "y"), rings=None, **more):
    """PLATE.json of a grid with holes {id: (x, y)}, each with springs of a disc (E, nu)."""
    spring = {"disk": {"E": disc[0], "nu": disc[1]}, "compression_only": contact}
    if contact:
        spring["harmonics"] = harmonics
    return {"format": "plate", "version": 1, "analysis": "plane stress", "p": list(p),
            "disc_directions": directions,
            "materials": {"sheet": {"E": material[0], "nu": material[1]}},
            "geometry": {"grid": {"x": x, "y": y, "thickness": thickness, "material": "sheet"}},
            "holes": [{"id": id, "center": at, "radius": radius, "spring": spring, **({"rings": rings} if rings else {})}
                      for id, at in holes.items()], **more}


def joint(folder, plates, laws, fasteners, loads, **more):
    """RESULT.h5 of a joint of these sheets, as an open file."""
    for name, plate in plates.items():
        (folder / f"{name}.json").write_text(json.dumps(plate))
        run(folder, "stage1_plate", f"{name}.json", "-o", f"{name}.plate.h5")
        run(folder, "stage2_extract", f"{name}.plate.h5", "-o", f"{name}.h5")
    return again(folder, plates, laws, fasteners, loads, **more)


def again(folder, plates, laws, fasteners, loads, **more):
    """The same without making the matrices anew."""
    text = {"format": "joint", "version": 1, "plates": {name: f"{name}.h5" for name in plates}, "laws": laws,
            "fasteners": fasteners, "loads": loads, **more}
    (folder / "joint.json").write_text(json.dumps(text))
    run(folder, "stage3_nonlinear", "joint.json", "-o", "result.h5", "--rim-stresses")
    return h5py.File(folder / "result.h5")


def near(name, value, expected, share):
    worst = np.max(np.abs(np.asarray(value) / np.asarray(expected) - 1))
    print(f"{name}: {np.round(value, 6)}, expected {expected}, off by {worst:.1e}, allowed {share:.0e}")
    assert worst <= share, name


def pin_in_a_strip(folder):
    """A pin pushed along a strip; its displacement, peak pressure and arc were found by another program."""
    plate = sheet([0, 40, 80, 100], [0, 40], 2, (72000, 0.3), {"1": (60, 20)}, (210000, 0.3), radius=5, space="product", harmonics=32,
                  supports=[{"on": "left", "fix": ["y"]}],
                  external=[{"id": "P", "on": "left", "direction": "x", "kind": "rigid"}])
    pin = {"id": "pin", "between": ["strip:1", "ground"], "law": "rigid"}
    arguments = ({"strip": plate}, {"rigid": {"type": "rigid"}}, [pin], [{"external": "strip:P", "force": -10000}])
    joint(folder, *arguments)
    for gap, D, peak, half_angle in ((0, 0.184910, 1.1465, 88.2), (0.02, 0.211543, 1.2218, 76.8),
                                     (-0.02, 0.158588, 1.1061, 104.8)):
        pin["gap"] = gap
        with again(folder, *arguments) as result:
            strip = result["plates/strip"]
            near(f"pin, gap {gap}: displacement", -strip["De"][0, 0], D, 1e-4)
            near("  peak pressure over F / (d t)", strip["contact/peak_pressure"][0, 0] / 500, peak, 1e-3)
            near("  half angle, of which that program counted points", strip["contact/touching"][0, 0] / 2, half_angle, 0.015)


def nisida(folder):
    """The paper's pin-loaded sheet against another code; the arc does not depend on the size of the load."""
    text = json.loads((NISIDA / "frictionless.json").read_text())
    arguments = ({"sheet": json.loads((NISIDA / "sheet.json").read_text())}, text["laws"], text["fasteners"], text["loads"])
    with joint(folder, *arguments, increments=[1e-3, 1]) as result:
        sheet = result["plates/sheet"]
        half_angle, peak = sheet["contact/touching"][:, 0], sheet["contact/peak_pressure"][:, 0] / sheet["rim/bearing_stress"][:, 0]
        near("Nisida's pin: half angle of contact", half_angle, 87.19, 0.1 / 87.19)
        near("  peak pressure over P / (d t)", peak, 1.2045, 1e-3)
        near("  at a thousandth of the load", [half_angle[0], peak[0]], [half_angle[1], peak[1]], 1e-9)


def interference(folder):
    """Pressure without load, and the load at which contact is lost, of a disc pressed into a large sheet; both its ends
    take half of the load, so that nothing passes the disc by."""
    r, t, delta = 2.4, 1.6, 0.01
    E, E_disc, nu, nu_disc = 72000, 210000, 0.33, 0.3
    p = delta / r / ((1 + nu) / E + (1 - nu_disc) / E_disc)
    lost = math.pi / 2 * 2 * r * t * p
    assert abs(p - 191.083) < 5e-4 and abs(lost - 2305.17) < 5e-3
    side = [-200, -40, -10, -4, 4, 10, 40, 200]
    plate = sheet(side, side, t, (E, nu), {"1": (0, 0)}, (E_disc, nu_disc), radius=r, p=(8, 8),
                  external=[{"id": id, "on": on, "direction": "x", "kind": "rigid"} for id, on in (("P", "left"), ("Q", "right"))])
    pin = {"id": "pin", "between": ["sheet:1", "ground"], "law": "rigid", "gap": -delta}
    factors = [0, 0.5, 0.95, 1.05]
    with joint(folder, {"sheet": plate}, {"rigid": {"type": "rigid"}}, [pin],
               [{"external": f"sheet:{id}", "force": -lost / 2} for id in "PQ"], increments=factors) as result:
        contact = result["plates/sheet/contact"]
        near("interference, pressure without load", contact["peak_pressure"][0, 0], p, 1e-3)
        assert np.all(contact["touching"][:3, 0] == 360) and contact["touching"][3, 0] < 360
        moved = result["plates/sheet/De"][0, 0] - result["plates/sheet/De"][:, 0]
        near("  it moves as springs that also pull until contact is lost", moved[2] / moved[1], 1.9, 1e-9)
        assert moved[3] / moved[1] > 2.1 * (1 + 1e-6), "beyond, it bends"
        assert list(result["event"].asstr()) == ["", "", "", "sheet:1 loses full contact"]
        near("  pressures at no load", [contact["no_load_least"][0], contact["no_load_peak"][0]], [p, p], 1e-3)
        near("  full contact is lost", contact["full_until"][0], 1, 1e-3)
        until = contact["full_until"][0]
    with again(folder, {"sheet": plate}, {"rigid": {"type": "rigid"}}, [pin],
               [{"external": f"sheet:{id}", "force": -1.05 * lost / 2} for id in "PQ"], increments="events") as result:
        near("  contact is lost", result["load_factor"][:] * 1.05, [until, 1.05], 1e-9)
        assert list(result["event"].asstr()) == ["sheet:1 loses full contact", ""]


def interference_that_stays(folder):
    """Half the load loses no contact, and from no load on the same load factor is told; uses the sheet before."""
    for force, gap, expected in ((-1000, -0.01, np.inf), (-1000, 0, np.inf), (-9000, -0.01, None)):
        pin = {"id": "pin", "between": ["sheet:1", "ground"], "law": "rigid", "gap": gap}
        with again(folder, {"sheet": None}, {"rigid": {"type": "rigid"}}, [pin],
                   [{"external": f"sheet:{id}", "force": force / 2} for id in "PQ"]) as result:
            contact = result["plates/sheet/contact"]
            assert contact["full_until"][0] == expected if expected else abs(9000 * contact["full_until"][0] / 2305.17 - 1) < 1e-3
            assert (contact["no_load_least"][0] > 0) == (gap < 0)
    said = subprocess.run([PROGRAMS / "stage3_nonlinear", "joint.json", "-o", "result.h5"], cwd=folder, capture_output=True, text=True).stdout
    assert "interference at sheet:1: pressure 19" in said and "full contact is lost at load factor 0.25" in said, said


def lap_joint(folder):
    """Four fasteners between two sheets, as examples/lap_joint has them; forces by a prototype of the method."""
    holes = {"a": (50, 10), "b": (50, 30), "c": (68, 10), "d": (68, 30)}
    common = (1.6, (72400, 0.33), holes, (71000, 0.33))
    upper = sheet([40, 60, 80, 120], [0, 20, 40], *common, radius=2.4, supports=[{"on": "bottom", "fix": ["y"]}],
                  external=[{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])
    lower = sheet([0, 40, 60, 80], [0, 20, 40], *common, radius=2.4,
                  supports=[{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}])
    fasteners = [{"id": id, "between": [f"upper:{id}", f"lower:{id}"], "law": "bolt"} for id in holes]
    arguments = ({"upper": upper, "lower": lower}, {"bolt": {"type": "linear", "k": 30000}}, fasteners,
                 [{"external": "upper:P", "force": 4000}])
    with joint(folder, *arguments) as result:
        F = result["F_vector"][0]
        near("lap joint, forces along x", F[:, 0], [971.25, 1023.86, 974.49, 1030.41], 1e-3)
        near("  along y", F[:, 1], [21.22, 70.31, -20.94, -68.97], 1e-3)
        near("  peak pressures", result["plates/upper/contact/peak_pressure"][0], [145.50, 155.58, 136.09, 144.79], 1e-3)
    fasteners[1]["gap"] = [0.02, 0.02]
    with again(folder, *arguments) as result:
        F = result["F_vector"][0]
        near("  a loose bolt at b, along x", F[:, 0], [1117.11, 497.70, 1119.77, 1265.42], 1e-3)
        near("  along y", F[:, 1], [32.32, 47.30, -33.44, -77.00], 2e-3)
        touching = result["plates/upper/contact/touching"][0, 1]
        assert 80 < touching < 86, touching
        by_gaps = result["F_vector"][0].ravel(), [0, 0.02, 0, 0]
    with again(folder, *arguments, increments=[0.9999, 1, 1.0001], solver={"tolerance": 1e-13}) as result:
        upper = result["plates/upper"]
        slope = (upper["Pe"][2, 0] - upper["Pe"][0, 0]) / (upper["De"][2, 0] - upper["De"][0, 0])
        assert list(result["stiffness/external"].asstr()) == ["upper:P"]
        near("  stiffness at the load", result["stiffness/tangent"][1, 0], slope, 1e-5)
    for holes in ({}, {"hole_diameter": 4.8}, {"hole_diameter": [4.8, 4.8]}):
        fasteners[1] = {"id": "b", "between": ["upper:b", "lower:b"], "law": "bolt", "diameter": 4.76, **holes}
        with again(folder, *arguments) as result:
            near(f"  a diameter instead of gaps, {holes}", result["F_vector"][0].ravel(), by_gaps[0], 1e-9)
            assert np.allclose(result["plates/lower/contact/gap"][:], by_gaps[1], rtol=1e-12, atol=1e-15)
    fasteners[1]["hole_diameter"] = [4.8, 4.7]
    with again(folder, *arguments) as result:
        assert np.allclose([result[f"plates/{name}/contact/gap"][1] for name in ("upper", "lower")], [0.02, -0.03])
    fasteners[1] = {"id": "b", "between": ["upper:b", "lower:b"], "law": "bolt"}
    again(folder, *arguments).close()


def doubtful_gaps(folder):
    """Gaps that hardly any joint has are said; uses the joint before."""
    text = json.loads((folder / "joint.json").read_text())
    for gap, said in ((3, "/fasteners/1/gap: a gap of 3 at hole"), (-0.5, "/fasteners/1/gap: an interference of 0.5 strains the rim of hole"), (0.2, ""), (-0.02, "")):
        text["fasteners"][1]["gap"] = gap
        (folder / "joint.json").write_text(json.dumps(text))
        told = run(folder, "stage3_nonlinear", "joint.json", "-o", "result.h5")
        assert said in told and ("[gap-unlikely]" in told or "[interference-yields]" in told) == bool(said), (gap, told)


def column_of_rivets(folder):
    """One column of a lap splice of three rivets, with contact and with springs all around."""
    def solve(contact, y=(0, 20), k=50000, gap=0, **how):
        holes = {"1": (90, 10), "2": (110, 10), "3": (130, 10)}
        more = {"supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}], "radius": 2,
                "external": [{"id": "T", "on": "top", "direction": "y", "kind": "rigid"}], "contact": contact, **how}
        common = (1.6, (72400, 0.33), holes, (72400, 0.33))
        lower = sheet([0, 40, 80, 100, 120, 140], list(y), *common, **more)
        more["supports"] = more["supports"][1:]
        more["external"] = more["external"] + [{"id": "P", "on": "right", "direction": "x", "kind": "traction"}]
        upper = sheet([80, 100, 120, 140, 180, 220], list(y), *common, **more)
        fasteners = [{"id": id, "between": [f"upper:{id}", f"lower:{id}"], "law": "rivet", **({"gap": gap} if gap else {})}
                     for id in holes]
        return joint(folder, {"upper": upper, "lower": lower}, {"rivet": {"type": "linear", "k": k}}, fasteners,
                     [{"external": "upper:P", "force": 160 * (y[1] - y[0])}])

    with solve(True) as result:
        whole = result["F_vector"][0, :, 0], result["plates/lower/contact/peak_pressure"][0]
        near("column of rivets, forces", whole[0], [1129.94, 940.12, 1129.94], 1e-4)
        near("  peak pressures", whole[1], [187.4, 155.1, 191.8], 2e-3)
        here = result["plates/lower/rim/peak_hoop"][0]
        near("  hoop stresses, of two independent formulas", here, [408.17, 287.13, 227.92], 2e-3)
        rim, contact = result["plates/lower/rim"], result["plates/lower/contact"]
        around = [np.split(rim[f"sigma_{kind}"][0], rim["start"][1:-1]) for kind in ("rr", "tt", "rt")]
        near("  largest of the hoop stresses one degree apart", [hoop.max() for hoop in around[1]], here, 1e-2)
        assert all(hoop.max() <= peak for hoop, peak in zip(around[1], here)), "ends of contact lie between points"
        near("  largest of the pressures", [-radial.min() for radial in around[0]], contact["peak_pressure"][0], 1e-3)
        assert all(radial.max() == 0 for radial in around[0]) and all((shear == 0).all() for shear in around[2])
        touching = [(radial < 0).sum() for radial in around[0]]
        assert np.abs(touching - contact["touching"][0]).max() <= 1, (touching, contact["touching"][0])
    for gap in (0, 0.02, 0.05):
        with solve(True, gap=gap) as few, solve(True, gap=gap, harmonics=64) as many:
            rims = few["plates/lower/rim"]
            off = np.abs(rims["peak_hoop"][0] - many["plates/lower/rim/peak_hoop"][0])
            print(f"  hoop stresses by 16 waves for the gap {gap}: off by {off} from 64, error bars {rims['peak_error'][0]}")
            assert np.all(off <= rims["peak_error"][0])
            assert np.all(rims["peak_error"][0] <= 0.1 * rims["peak_hoop"][0])
    with solve(True, (10, 20), 25000, directions=["x"]) as result:
        near("  forces by half the column, whose holes are halves", 2 * result["F"][0], whole[0], 1e-5)
        near("  peak pressures", result["plates/lower/contact/peak_pressure"][0], whole[1], 1e-3)
        near("  hoop stresses", result["plates/lower/rim/peak_hoop"][0], here, 1e-9)
        assert np.all(result["plates/lower/pressure/sweep"][:] == np.pi)
    with solve(False) as result:
        near("  forces by springs all around", result["F_vector"][0, :, 0], [1146.75, 906.50, 1146.75], 1e-4)
        rim = result["plates/lower/rim"]
        off = np.abs(rim["peak_hoop"][0] - [132.8596, 87.4051, 47.2848])  # by "waves": 12 and three rings
        print(f"  hoop stresses off by {off}, error bars {rim['peak_error'][0]}")
        assert np.all(off <= rim["peak_error"][0])


def limits(folder):
    """So much interference that nothing opens is springs that also pull; so large a gap that nothing touches is an
    open hole."""
    def plates(contact):
        holes = {"1": (10, 10), "2": (30, 10)}
        common = ([0, 20, 40], [0, 20], 2, (70000, 0.3), holes, (70000, 0.3))
        a = sheet(*common, contact=contact, radius=3, rings=1, p=(4, 5), external=[
            {"id": "P", "on": "left", "direction": "x", "kind": "rigid"}], supports=[{"on": "bottom", "fix": ["y"]}])
        b = sheet(*common, contact=contact, radius=3, rings=1, p=(4, 5), supports=[{"on": "right", "fix": ["x", "y"]}])
        return {"a": a, "b": b}

    def solve(contact, gaps, make=joint):
        fasteners = [{"id": id, "between": [f"a:{id}", f"b:{id}"], "law": "bolt"} for id in ("1", "2")]
        for fastener, gap in zip(fasteners, gaps):
            if contact:
                fastener["gap"] = gap
        return make(folder, plates(contact), {"bolt": {"type": "linear", "k": 20000}}, fasteners,
                    [{"external": "a:P", "force": -1000}], increments=2)

    names = ("F_vector", "delta_vector", "plates/a/D", "plates/b/D", "plates/a/De")
    with solve(False, (0, 0)) as result:
        two_sided = [result[name][:] for name in names]
        near("limits, stiffness of springs that also pull", result["stiffness/tangent"][:, 0],
             result["plates/a/Pe"][:, 0] / result["plates/a/De"][:, 0], 1e-9)
    with solve(True, (-0.1, -0.1)) as result:
        F = result["F_vector"]
        for name, before in zip(names, two_sided):
            moved = result[name][1] - result[name][0]
            worst = np.max(np.abs(moved - (before[1] - before[0]))) / np.max(np.abs(before))
            print(f"limits, {name} moves as that of springs that also pull but for {worst:.1e} of the largest")
            assert worst < 1e-9
    with solve(True, (0, 1), again) as result:
        assert np.all(np.abs(result["F_vector"][1, 1]) < 1e-9) and np.all(result["plates/a/contact/touching"][:, 1] == 0)
        loose = result["F_vector"][1, 0].copy()
    near("  one bolt carries all beside a loose one", loose[0], -1000, 1e-9)


def events(folder):
    """A loose pin beside a fitting one touches at an increment, without pressure; uses the sheet a before."""
    def solve(increments):
        pins = [{"id": id, "between": [f"a:{id}", "ground"], "law": "rigid", "gap": gap} for id, gap in (("1", 0), ("2", 0.002))]
        return again(folder, {"a": None}, {"rigid": {"type": "rigid"}}, pins, [{"external": "a:P", "force": -1000}],
                     increments=increments)

    with solve("events") as result:
        assert list(result["event"].asstr()) == ["a:2 touches", ""], result["event"].asstr()[:]
        touches, last = result["load_factor"][:]
        contact = result["plates/a/contact"]
        assert 0.1 < touches < 0.9 and last == 1
        print(f"events: touches at {touches}, gap left {contact['least_gap'][0, 1]}, pressures {contact['peak_pressure'][:, 1]}")
        assert contact["least_gap"][0, 1] < 1e-12 and contact["peak_pressure"][0, 1] < 1e-4 * contact["peak_pressure"][1, 1]
    with solve([touches * (1 - 1e-4), touches * (1 + 1e-4), 1, 0.5 * touches]) as result:
        assert list(result["event"].asstr()) == ["", "a:2 touches", "", "a:2 opens"], result["event"].asstr()[:]
        assert result["plates/a/contact/touching"][0, 1] == 0 and result["plates/a/contact/touching"][1, 1] > 0


with tempfile.TemporaryDirectory() as name:
    for check in (pin_in_a_strip, nisida, interference, interference_that_stays, lap_joint, doubtful_gaps, column_of_rivets,
                  limits, events):
        check(Path(name))
