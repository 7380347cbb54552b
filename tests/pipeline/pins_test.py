#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pins in wide sheets by default settings, on springs and elastic: peaks of hoop stress and of pressure and ends of contact against closed
forms and collocation, friction against the slip.

Usage: pins_test.py FOLDER_OF_PROGRAMS

Every number that is off by more than it may be is told; then the test fails."""
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "scripts/python")]
sys.dont_write_bytecode = True
from one_hole import LAMINATES, WIDE, WIDER, end_if_missed, laminate, matrices, near, plate, state  # noqa: E402
from pin_on_springs import WideSheet, compliance, isotropic  # noqa: E402


def pin_in_a_wide_sheet(folder, material, pin, lines, analysis="plane stress", friction=0):
    """A function of the gap over F / E: the state under a force of 1000, of which either end takes half, so that nothing passes by."""
    external = [{"id": side, "on": side, "direction": "x", "kind": "rigid"} for side in ("left", "right")]
    spring = {"spring": {"compression_only": True, **(pin if isinstance(pin, dict) else {"modulus": pin})}}
    matrices(folder, plate(material, lines, lines, spring, analysis=analysis, external=external))

    def solve(gap):
        return state(folder, [{"id": "pin", "between": ["sheet:h", "ground"], "law": "law", "gap": gap, "friction": friction}],
                     [{"external": f"sheet:{side}", "force": -500} for side in ("left", "right")])

    return solve


def isotropic_pins(folder):
    """The table of rim.md; the closed form of this test agrees with it, whose stresses were taken beside their top."""
    E, nu = 70e3, 0.3
    solve, exact = pin_in_a_wide_sheet(folder, {"E": E, "nu": nu}, 5 * E, WIDE), WideSheet(isotropic(E, nu))
    for gap, half_angle, pressure, hoop, share in ((0, 85.43, 1.2137, 0.8894, 0.01), (0.574987, 64.95, 1.3997, 1.1017, 0.01),
                                                   (4.34, 35.42, 2.3265, 1.3644, 0.02)):
        angle, peak, stress = exact.pin(1000, 5 * E, gap * 1000 / E)
        assert abs(angle - half_angle) < 0.05 and abs(peak / 500 / pressure - 1) < 1e-4 and abs(stress / 500 / hoop - 1) < 1.2e-3
        found = solve(gap * 1000 / E)
        near(f"isotropic pin, E g t/P = {gap}: hoop stress", found["hoop"][0], stress, share, found["bar"][0])
        near("  peak pressure", found["pressure"][0], peak, 5e-3)
        near("  half-angle of contact, degrees", found["half-angle"][0], angle, 1, absolute=True)


def laminate_pins(folder):
    for name, moduli in LAMINATES.items():
        for angle in (0, 30):
            solve = pin_in_a_wide_sheet(folder, laminate(*moduli, angle), 5 * moduli[0], WIDER)
            exact = WideSheet(compliance(*moduli, angle))
            for gap in (0, 0.5):
                half_angle, peak, stress = exact.pin(1000, 5 * moduli[0], gap * 1000 / moduli[0], n_waves=96)
                found = solve(gap * 1000 / moduli[0])
                near(f"pin in a laminate, {name}, {angle} degrees, E g t/P = {gap}: hoop stress", found["hoop"][0], stress, 0.02, found["bar"][0])
                near("  peak pressure", found["pressure"][0], peak, 0.02)
                near("  half-angle of contact, degrees", found["half-angle"][0], half_angle, 2, absolute=True)


def plane_strain_pin(folder):
    """A pin in plane strain is one in plane stress with E / (1 - nu^2), nu / (1 - nu)."""
    E, nu = 70e3, 0.3
    solve = pin_in_a_wide_sheet(folder, {"E": E, "nu": nu}, 5 * E, WIDE, "plane strain")
    exact = WideSheet(isotropic(E / (1 - nu**2), nu / (1 - nu)))
    for gap in (0, 0.574987):
        half_angle, peak, stress = exact.pin(1000, 5 * E, gap * 1000 / E)
        found = solve(gap * 1000 / E)
        near(f"pin in plane strain, E g t/P = {gap}: hoop stress", found["hoop"][0], stress, 0.01, found["bar"][0])
        near("  peak pressure", found["pressure"][0], peak, 5e-3)


def persson_gap(half_angle):
    """E g t / P of a disk of the sheet's own material that touches so far, degrees: Persson (1964)."""
    b2 = np.tan(np.radians(half_angle) / 2)**2
    return (2 * (1 - b2) - np.log(1 + b2) / (1 + b2)) / (np.pi * b2)


def elastic_pins(folder):
    """Disks of the sheet's own material, with the exact peaks of rim.md, section 5, and Persson's closed form."""
    E, nu = 70e3, 0.3
    solve = pin_in_a_wide_sheet(folder, {"E": E, "nu": nu}, {"disk": {"E": E, "nu": nu, "law": "elastic"}}, WIDE)
    for gap, pressure, hoop in ((0, 1.1993, 0.9066), (1, 1.4092, 1.1490)):
        found = solve(gap * 1000 / E)
        near(f"elastic pin, E g t/P = {gap}: hoop stress", found["hoop"][0], 500 * hoop, 5e-3, found["bar"][0])
        near("  peak pressure", found["pressure"][0], 500 * pressure, 1.5e-3)
    for half_angle in (84.9, 75, 61, 45, 30, 20, 10):
        found = solve(persson_gap(half_angle) * 1000 / E)
        near("elastic pin: half-angle of contact by Persson, degrees", found["half-angle"][0], half_angle, 0.01, absolute=True)


def stiff_springs(folder):
    """Springs much stiffer than the sheet are as good as an elastic disk as stiff: peaks and bars are those of a nearly rigid pin. With friction
    the stress has a square root at the end of contact, which feels a compliance of 1 / 300 as one of its root."""
    E, nu, gap = 70e3, 0.3, 0.01
    for mu in (0, 0.15):
        disk = pin_in_a_wide_sheet(folder, {"E": E, "nu": nu}, {"disk": {"E": 1000 * E, "nu": nu, "law": "elastic"}}, WIDE, friction=mu)(gap)
        for ratio, share in ((300, 5e-3 if mu == 0 else 2e-2), (9000, 1e-4 if mu == 0 else 1e-3)):
            found = pin_in_a_wide_sheet(folder, {"E": E, "nu": nu}, ratio * E, WIDE, friction=mu)(gap)
            near(f"springs of {ratio} E / r, friction {mu}: hoop stress as of a stiff disk", found["hoop"][0], disk["hoop"][0], share)
            near("  its error bar", found["bar"][0], disk["bar"][0], 0.1 if mu == 0 else 0.3)


def friction_against_slip(folder):
    """Degrees on which friction acts against the slip, without gap and with one: none by springs at 0.15, as the paper has it; an elastic disk
    of the sheet's material slips less, and sticks the more the larger friction is."""
    E, nu = 70e3, 0.3
    for law, truths in (("plane stress", {0.15: (0, 0), 0.3: (3.5, 0)}), ("elastic", {0.05: (0, 0), 0.15: (10, 0), 0.3: (42.5, 6)})):
        for mu, (without, with_gap) in truths.items():
            for waves, allowed in (({}, 4), ({"harmonics": 64}, 1)):
                solve = pin_in_a_wide_sheet(folder, {"E": E, "nu": nu}, {"disk": {"E": E, "nu": nu, "law": law}, **waves}, WIDE, friction=mu)
                for gap, truth in ((0, without), (1, with_gap)):
                    near(f"{law}, friction {mu}, E g t/P = {gap}, {waves}: against the slip, degrees", solve(gap * 1000 / E)["against"][0], truth,
                         allowed, absolute=True)
    matrices(folder, plate({"E": E, "nu": nu}, WIDE, [0, *(y for y in WIDE if y > 0)],
                           {"spring": {"compression_only": True, "disk": {"E": E, "nu": nu, "law": "elastic"}}}, supports=[{"on": "bottom", "fix": ["y"]}],
                           external=[{"id": end, "on": end, "direction": "x", "kind": "rigid"} for end in ("left", "right")]))
    half = state(folder, [{"id": "pin", "between": ["sheet:h", "ground"], "law": "law", "friction": 0.3}],
                 [{"external": f"sheet:{end}", "force": -250} for end in ("left", "right")])
    near("  of half the sheet: degrees of the whole hole", half["against"][0], 42.5, 1, absolute=True)
    solve = pin_in_a_wide_sheet(folder, {"E": E, "nu": nu}, {"disk": {"E": E, "nu": nu}, "harmonics": 1}, WIDE)
    assert solve(0)["bar"][0] == np.inf, ("one wave tells nothing about further ones", solve(0))


def rigid_pins_in_strips(folder):
    """Rigid pins near the ends of strips under uniform tension at 1.5 W, e = W, nu = 0.3, half a strip: half-angle of contact, pressure and
    hoop stress over P / (d t) by an independent code."""
    for width, half_angle, pressure, hoop in ((2, 89.280, 1.10548, 2.21604), (6, 84.378, 1.14548, 1.20590)):  # over the diameter
        W = 2 * width
        matrices(folder, plate({"E": 70e3, "nu": 0.3}, [-W, -W / 2, W / 2, 1.5 * W], [0, W / 2],
                               {"spring": {"compression_only": True, "disk": {"E": 70e6, "nu": 0.3, "law": "elastic"}}},
                               supports=[{"on": "bottom", "fix": ["y"]}], external=[{"id": "P", "on": "right", "direction": "x", "kind": "traction"}]))
        found = state(folder, [{"id": "pin", "between": ["sheet:h", "ground"], "law": "law"}], [{"external": "sheet:P", "force": 500}])
        near(f"rigid pin, W/d = {width}: hoop stress", found["hoop"][0], 500 * hoop, 1.5e-3, found["bar"][0])
        near("  peak pressure", found["pressure"][0], 500 * pressure, 1.5e-3)
        near("  half-angle of contact, degrees", 2 * found["half-angle"][0], half_angle, 0.15, absolute=True)


def pressed_in_disk(folder):
    """An elastic disk with an interference that keeps it in full contact in a sheet under tension, in closed form: Airy's functions of
    orders 0 and 2, as (30) and (31) of the paper have them, with the disk's own compliance in the place of the springs'."""
    E, nu, E_D, nu_D, S, overlap = 70e3, 0.3, 110e3, 0.35, 60.0, 0.004
    p0 = (overlap - S / E) / ((1 + nu) / E + (1 - nu_D) / E_D)
    p2 = -2 * S / E / ((5 - nu) / (3 * E) + (3 + nu_D) / (3 * E_D))
    assert p0 + p2 > 0 and p0 - p2 > 0  # full contact
    external = [{"id": side, "on": side, "direction": "x", "kind": "rigid"} for side in ("left", "right")]
    disk = {"compression_only": True, "disk": {"E": E_D, "nu": nu_D, "law": "elastic"}}
    matrices(folder, plate({"E": E, "nu": nu}, WIDER, WIDER, {"spring": disk}, external=external))
    force = S * (WIDER[-1] - WIDER[0])
    found = state(folder, [{"id": "pin", "between": ["sheet:h", "ground"], "law": "law", "gap": -overlap}],
                  [{"external": "sheet:left", "force": -force}, {"external": "sheet:right", "force": force}])
    near("elastic disk pressed in, tension: hoop stress", found["hoop"][0], 3 * S + p0 + p2, 1e-5, found["bar"][0])
    near("  peak pressure", found["pressure"][0], p0 - p2, 1e-5)
    near("  half-angle of contact, degrees", found["half-angle"][0], 180, 0, absolute=True)


def waves_with_friction(folder):
    """At the end of contact with an elastic pin and friction the hoop stress is like a square root. Peaks fall as N^-1/2 and are
    extrapolated so: they hardly depend on the number of waves, and the bars hold."""
    for friction in (0.15, 0.3):
        found = {}
        for waves in (128, 64, 48, 32, 24, None):
            pin = {"disk": {"E": 110e3, "nu": 0.3, "law": "elastic"}, **({"harmonics": waves} if waves else {})}
            found[waves] = pin_in_a_wide_sheet(folder, {"E": 70e3, "nu": 0.3}, pin, WIDE, friction=friction)(0)
            bar, truth = found[waves]["bar"][0], found[128]["hoop"][0]
            near(f"friction {friction}, {waves or 'default'} waves: hoop stress", found[waves]["hoop"][0], truth, min(5e-3, 1.5 * bar / truth), bar)


with tempfile.TemporaryDirectory() as name:
    for check in (rigid_pins_in_strips, elastic_pins, stiff_springs, waves_with_friction, friction_against_slip, pressed_in_disk,
                  isotropic_pins, plane_strain_pin, laminate_pins):
        check(Path(name))
end_if_missed()
