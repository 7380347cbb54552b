# SPDX-License-Identifier: GPL-3.0-or-later
"""An independent solution of sheets as beam-columns: cubic elements, many to a bay, and multipliers for what is equal."""
import numpy as np


def elements(EI, N, L):
    K = EI / L**3 * np.array([[12, 6 * L, -12, 6 * L], [6 * L, 4 * L * L, -6 * L, 2 * L * L],
                              [-12, -6 * L, 12, -6 * L], [6 * L, 2 * L * L, -6 * L, 4 * L * L]])
    G = np.array([[36, 3 * L, -36, 3 * L], [3 * L, 4 * L * L, -3 * L, -L * L],
                  [-36, -3 * L, 36, -3 * L], [3 * L, -L * L, -3 * L, 4 * L * L]]) / (30 * L)
    return K + N * G


def solve(sheets, rows, clamped, n=24):
    """Moments (rows, 2) before and behind each row, deflections, and coordinates and deflections in between, of each sheet.

    sheets: from the lowest, each {"x": [nodes], "EI", "t", "N": [tension of each bay], "held": [end, end]} with ends free, hinged or
    clamped. rows: (lower sheet, upper sheet, x, force of the upper on the lower sheet along x)."""
    first, count, K = [], 0, []
    for sheet in sheets:
        x = np.concatenate([np.linspace(a, b, n, endpoint=False) for a, b in zip(sheet["x"], sheet["x"][1:])] + [sheet["x"][-1:]])
        sheet["fine"] = x
        first.append(count)
        count += 2 * len(x)
    A, f = np.zeros((count, count)), np.zeros(count)
    for sheet, at in zip(sheets, first):
        for i, L in enumerate(np.diff(sheet["fine"])):
            part = slice(at + 2 * i, at + 2 * i + 4)
            A[part, part] += elements(sheet["EI"], sheet["N"][i // n], L)
    equal = []

    def same(a, b=None):
        equal.append(np.zeros(count))
        equal[-1][a] = 1
        if b is not None:
            equal[-1][b] = -1

    def node(sheet, x):
        return first[sheet] + 2 * np.abs(sheets[sheet]["fine"] - x).argmin()

    for lower, upper, x, q in rows:
        a, b = node(lower, x), node(upper, x)
        f[a + 1] -= q * sheets[lower]["t"] / 2
        f[b + 1] -= q * sheets[upper]["t"] / 2
        same(a, b)
        if clamped:
            same(a + 1, b + 1)
    for i, sheet in enumerate(sheets):
        for x, how in zip((sheet["x"][0], sheet["x"][-1]), sheet["held"]):
            if how != "free":
                same(node(i, x))
            if how == "clamped":
                same(node(i, x) + 1)
    C = np.array(equal)
    full = np.block([[A, C.T], [C, np.zeros((len(C), len(C)))]])
    scale = 1 / np.sqrt(np.maximum(np.abs(full).max(axis=1), 1e-300))
    u = scale * np.linalg.lstsq(full * np.outer(scale, scale), scale * np.r_[f, np.zeros(len(C))], rcond=1e-13)[0]
    results = []
    for i, sheet in enumerate(sheets):
        its = sorted({row[2] for row in rows if i in row[:2]})
        M, w = np.zeros((len(its), 2)), np.zeros(len(its))
        for k, x in enumerate(its):
            a = node(i, x)
            j = (a - first[i]) // 2
            w[k] = u[a]
            for side, e in ((0, j - 1), (1, j)):
                if 0 <= e < len(sheet["fine"]) - 1:
                    at = first[i] + 2 * e
                    forces = elements(sheet["EI"], sheet["N"][e // n], np.diff(sheet["fine"])[e]) @ u[at:at + 4]
                    M[k, side] = forces[3] if side == 0 else -forces[1]
        results.append((M, w, (sheet["fine"], u[first[i]:first[i] + 2 * len(sheet["fine"]):2])))
    return results
