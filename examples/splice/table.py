# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the splice's loads and peak hoop stresses at the last increment in Markdown: table.py RESULT.h5 [OTHER.h5].

With another result of the same joint it prints what changes from that to this instead.
"""
import sys

import h5py

ROWS, COLUMNS = "abc", range(1, 7)


class Result:
    """What a RESULT.h5 says of each rivet at its last increment."""

    def __init__(self, path):
        with h5py.File(path) as f:
            rivets = f["fastener/id"].asstr()[:]
            self.load = dict(zip(rivets, f["transferred"][-1, :, 0]))
            self.peak, self.error, self.angle = ({plate: dict(zip(f[f"plates/{plate}/rim/hole"].asstr()[:],
                                                                  f[f"plates/{plate}/rim/{name}"][-1]))
                                                  for plate in ("upper", "lower")}
                                                 for name in ("peak_hoop", "peak_error", "peak_angle"))

    def highest(self):
        """Plate and hole of the highest peak."""
        return max(((plate, hole) for plate, peaks in self.peak.items() for hole in peaks), key=lambda at: self.peak[at[0]][at[1]])


def grid(title, cell):
    print(f"| {title} | " + " | ".join(f"column {c}" for c in COLUMNS) + " |")
    print("|---" * (len(COLUMNS) + 1) + "|")
    for row in ROWS:
        print(f"| row {row} | " + " | ".join(cell(f"{row}{c}") for c in COLUMNS) + " |")
    print()


def show(result):
    grid("load, N", lambda rivet: f"{result.load[rivet]:.0f}")
    grid("peak hoop stress, upper / lower, N/mm²",
         lambda rivet: " / ".join(f"{result.peak[plate][rivet]:.0f}" for plate in ("upper", "lower")))
    plate, hole = result.highest()
    print(f"The highest peak, {result.peak[plate][hole]:.1f} +- {result.error[plate][hole]:.1f} N/mm², is at hole {plate}:{hole}, "
          f"{result.angle[plate][hole]:.0f} degrees from x.")


def compare(result, other):
    """The largest changes from the other result to this one, in per cent."""
    peaks = {f"{plate}:{hole}": 100 * (result.peak[plate][hole] / other.peak[plate][hole] - 1)
             for plate in ("upper", "lower") for hole in result.peak[plate]}
    loads = {rivet: 100 * (load / other.load[rivet] - 1) for rivet, load in result.load.items()}
    peak, load = (max(changes, key=lambda at: abs(changes[at])) for changes in (peaks, loads))
    highest = ":".join(result.highest())
    print(f"Peaks change by up to {peaks[peak]:+.1f} % ({peak}), the highest ({highest}) by {peaks[highest]:+.1f} %, "
          f"loads by up to {loads[load]:+.1f} % ({load}).")


if __name__ == "__main__":
    results = [Result(path) for path in sys.argv[1:]]
    show(*results) if len(results) == 1 else compare(*results)
