# SPDX-License-Identifier: GPL-3.0-or-later
"""The peer on deal.II finds the stiffness of panels: peer_test.py BIN_FOLDER."""
import json
import subprocess
import sys

import numpy as np

# Upper triangles, external first, of two codes that share nothing with it.
S_11 = [1362823.65898, -696592.70961, 1393185.41922]
S_31 = [1186725.85121, -44477.39561, -223280.81667, -875396.13066, 1201453.78766, -236655.94647, -44924.31491,
        919873.52627, -236655.94647, 1201453.78766]
SOLVERS = ("umfpack", "condensed")


def run(bin_folder, *words):
    return subprocess.run([f"{bin_folder}/peer_dealii", *map(str, words)], capture_output=True, text=True)


def solved(bin_folder, *words):
    result = run(bin_folder, *words)
    assert result.returncode == 0 and result.stderr == "", result
    return json.loads(result.stdout)


def check_values(bin_folder):
    for nx, upper, unknowns in ((1, S_11, (1101, 3149)), (3, S_31, (3305, 9449))):
        exact = np.zeros((nx + 1, nx + 1))
        exact[np.triu_indices(nx + 1)] = upper
        exact += np.triu(exact, 1).T
        for solver in SOLVERS:
            for rings, n, most in ((0, unknowns[0], 3e-6), (2, unknowns[1], 1e-10)):
                found = solved(bin_folder, nx, 1, 8, rings, solver)
                error = np.linalg.norm(np.array(found["S"]) - exact) / np.linalg.norm(exact)
                assert error < most and found["unknowns"] == n, (solver, rings, error, found)
                assert min(found["seconds"].values()) > 0 and found["solver"] == solver, found


def check_solvers_agree(bin_folder):
    """Two rows, and a degree without unknowns inside cells."""
    for p in (1, 4):
        one, other = (np.array(solved(bin_folder, 2, 3, p, 1, solver)["S"]) for solver in SOLVERS)
        assert one.shape == (7, 7) and np.abs(one - other).max() < 1e-12 * np.abs(one).max(), one - other
        assert np.linalg.eigvalsh(other).min() > 0


def check_usage(bin_folder):
    for words, message in (((1, 1, 8, 0), "five words are needed"),
                           ((0, 1, 8, 0, "umfpack"), "'0' is not a number in 1..1000"),
                           ((1, 1, "8x", 0, "umfpack"), "'8x' is not a number in 1..16"),
                           ((1, 1, 8, 0, "fast"), "'fast' is not a solver; allowed: umfpack, condensed")):
        result = run(bin_folder, *words)
        assert result.returncode == 2 and message in result.stderr and "usage: " in result.stderr, result


def main(bin_folder):
    check_values(bin_folder)
    check_solvers_agree(bin_folder)
    check_usage(bin_folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
