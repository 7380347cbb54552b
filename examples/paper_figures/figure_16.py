# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws Figure 16 of Bortman & Szabo: figure_16.py -o PICTURE.png. What the springs of (29) are worth against the elastic disk.

Lines: closed forms; points: the programs (taken from PATH). The numbers are printed as CSV.
"""
import argparse

import matplotlib
import numpy as np

import inclusion

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", required=True)
    arguments = parser.parse_args()
    computed = {law: [inclusion.harmonics(inclusion.sheet(beta, law)) for beta in inclusion.BETAS]
                for law in ("plane stress", "second harmonic")}
    print("E_D/E_P,A,B,B by the second-harmonic law,B of the disk")
    for i, beta in enumerate(inclusion.BETAS):
        (A, B), (_, matched) = computed["plane stress"][i], computed["second harmonic"][i]
        print(f"{beta:.4g},{A:.6f},{B:.6f},{matched:.6f},{inclusion.disk(beta)[1]:.6f}")
    beta = np.geomspace(0.05, 20, 200)
    plt.figure(figsize=(6.5, 4.2))
    plt.semilogx(beta, inclusion.springs(beta)[0], "C0-", label="A, disk and springs")
    plt.semilogx(beta, inclusion.disk(beta)[1], "C1--", label="B, disk")
    plt.semilogx(beta, inclusion.springs(beta)[1], "C1-", label="B, springs of (29)")
    plt.semilogx(inclusion.BETAS, [A for A, _ in computed["plane stress"]], "C0o", label="computed, (29)")
    plt.semilogx(inclusion.BETAS, [B for _, B in computed["plane stress"]], "C1o")
    plt.semilogx(inclusion.BETAS, [B for _, B in computed["second harmonic"]], "k+", label="computed, second harmonic matched")
    plt.xlabel("E_D / E_P")
    plt.ylabel("4 sigma_rr / s = A + B cos 2 theta")
    plt.title("Disc in an infinite sheet (Figure 16)")
    plt.legend(fontsize=8)
    plt.grid(alpha=0.3)
    plt.tight_layout()
    plt.savefig(arguments.output, dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    main()
