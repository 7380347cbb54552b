# SPDX-License-Identifier: GPL-3.0-or-later
"""The deflected stack of a joint with secondary bending, from RESULT.h5: between rows of fasteners each sheet is the exact beam-column
that its moments, deflections and tension say."""
import numpy as np

from json_file import parse_json

HEADS = {"free": "-", "clamped": "--"}
POINTS = 40  # of a bay
SIDES = {"x": ("left", "right"), "y": ("bottom", "top")}


def beam(x, w, M, N, EI):
    """Deflection at coordinates x between x[0] and x[-1], with deflections w and moments M = E I w'' of both ends."""
    L, s = x[-1] - x[0], (x - x[0]) / (x[-1] - x[0])
    straight = w[0] + (w[1] - w[0]) * s
    z = N * L * L / EI
    if abs(z) < 1e-6:
        return straight + L * L / EI * (M[0] * (s * s - s) / 2 + (M[1] - M[0]) * (s**3 - s) / 6)
    r = np.sqrt(complex(z))
    part = lambda at: (np.exp(r * (at - 1)) - np.exp(-r * (at + 1))) / (1 - np.exp(-2 * r))  # sinh(r at) / sinh(r)
    moment = (M[0] * part(1 - s) + M[1] * part(s)).real
    return straight + (moment - M[0] - (M[1] - M[0]) * s) / N


def slope(x0, x1, w, M, N, EI):
    """Slope at x0 of the beam between x0 and x1, whose ends may stand in either order."""
    near = x0 + 1e-5 * (x1 - x0)
    return (beam(np.array([x0, near, x1]), w, M, N, EI)[1] - w[0]) / (near - x0)


def outer(x, w, M, N, EI, at_row, hold):
    """Deflection of the bay from the outer row at x[0] to an end of the sheet at x[-1], by its slope at the row; None: not known."""
    if hold == "free" or abs(N) == 0:
        return w + (at_row or 0) * (x - x[0])

    def slopes(end, moment):
        """At the row and at the end, linear in both."""
        return np.array([slope(x[0], x[-1], (w, end), (M, moment), N, EI), slope(x[-1], x[0], (end, w), (moment, M), N, EI)])

    end = moment = 0
    base = slopes(0, 0)
    if hold == "clamped" and at_row is not None:
        moment = (at_row - base[0]) / (slopes(0, 1) - base)[0]
    elif hold == "symmetric":
        wanted = np.array([base[0] if at_row is None else at_row, 0])
        end, moment = np.linalg.solve(np.column_stack([slopes(1, 0) - base, slopes(0, 1) - base]), wanted - base)
    return beam(x, (w, end), (M, moment), N, EI)


def holds_of(file):
    """What JOINT.json says of the ends of its sheets: {sheet: {side: word}}."""
    bending = parse_json(file["input"].asstr()[()]).get("bending", {})
    return bending.get("ends", {}) if isinstance(bending, dict) else {}


def deflection(plate, axis, increment, heads, given=None):
    """Coordinates along an axis and deflections of a sheet, a group of RESULT.h5; None of one without rows along it.

    given: what JOINT.json says of its ends, {side: word}."""
    rows = plate["row/direction"].asstr()[:] == axis
    bays = plate["bay/direction"].asstr()[:] == axis
    if not rows.any() or not bays.any():
        return None
    at, w = plate["row/at"][rows], plate["row/deflection"][increment, rows, heads]
    M = plate["row/moment"][increment, rows, :, heads]
    N = np.r_[plate["row/before"][increment, rows][:1], plate["row/after"][increment, rows]]
    ends, EI, held = plate["bay/ends"][bays], plate["bay/bending"][bays], plate["bay/held"][bays]

    def stiffness(a, b):
        return EI[max(0, np.searchsorted(ends[:, 0], (a + b) / 2) - 1)]

    holds = [(given or {}).get(side, "hinged" if is_held else "free")
             for side, is_held in zip(SIDES[axis], (held[0][0], held[-1][1]))]
    xs, ws, slopes = [], [], [None, None]
    for i in range(len(at) - 1):
        bay = (w[i:i + 2], (M[i, 1], M[i + 1, 0]), N[i + 1], stiffness(*at[i:i + 2]))
        xs.append(np.linspace(at[i], at[i + 1], POINTS))
        ws.append(beam(xs[-1], *bay))
        if i == 0:
            slopes[0] = slope(at[0], at[1], *bay)
        slopes[1] = slope(at[i + 1], at[i], bay[0][::-1], bay[1][::-1], *bay[2:])
    for side, (x0, x1) in enumerate(((at[0], ends[0, 0]), (at[-1], ends[-1, 1]))):
        if x0 == x1:
            continue
        x = x0 + (x1 - x0) * np.linspace(0, 1, 4 * POINTS)**2  # the shape is steepest at the row
        its = outer(x, w[-side], M[-side, side], N[-side], stiffness(x0, x1), slopes[side], holds[side])
        xs.insert(len(xs) * side, x if side else x[::-1])
        ws.insert(len(ws) * side, its if side else its[::-1])
    return np.concatenate(xs), np.concatenate(ws)


def bending_axes(file, increment):
    """The axes along which a result has deflections at an increment."""
    found = []
    for axis in ("x", "y"):
        for name in file["plate/name"].asstr()[:]:
            plate = file[f"plates/{name}"]
            if "row/deflection" in plate:
                its = plate["row/deflection"][increment, plate["row/direction"].asstr()[:] == axis]
                if np.any(np.abs(np.nan_to_num(its)) > 0) and axis not in found:
                    found.append(axis)
    return found


def draw_stack(axes, file, axis, increment):
    """Draws the deflections of all sheets along an axis."""
    given = holds_of(file)
    for i, name in enumerate(file["plate/name"].asstr()[:]):
        plate = file[f"plates/{name}"]
        for heads, (word, style) in enumerate(HEADS.items()):
            curve = deflection(plate, axis, increment, heads, given.get(name))
            if curve is None or np.isnan(curve[1]).any():
                continue
            axes.plot(*curve, style, color=f"C{i}", label=name if style == "-" or len(HEADS) == 1 else None)
            rows = plate["row/direction"].asstr()[:] == axis
            axes.plot(plate["row/at"][rows], plate["row/deflection"][increment, rows, heads], "k.", markersize=4)
    unit = file[f"plates/{file['plate/name'].asstr()[0]}/row/deflection"].attrs["unit"]
    axes.set(xlabel=f"{axis} [{unit}]", ylabel=f"deflection [{unit}]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7)
