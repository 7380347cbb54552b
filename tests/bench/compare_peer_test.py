# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/measure/compare_peer, with the peer if it is built and without it: compare_peer_test.py BIN_FOLDER."""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def compare(folder, *words):
    path = f"{folder}{os.pathsep}/usr/bin{os.pathsep}/bin"
    return subprocess.run([ROOT / "scripts/measure/compare_peer", *words], env=os.environ | {"PATH": path}, capture_output=True,
                          text=True)


def check_without(bin_folder):
    with tempfile.TemporaryDirectory() as folder:
        for program in ("stage1_plate", "stage2_extract"):
            (Path(folder) / program).symlink_to(bin_folder / program)
        result = compare(folder)
    assert (result.returncode, result.stdout) == (2, ""), result
    assert "peer_dealii is not on PATH" in result.stderr and "apt-get install" in result.stderr, result
    for words in (("--nx", "0"), ("--p", "9"), ("--rings", "-1"), ("--repeat", "0")):
        result = compare(bin_folder, *words)
        assert result.returncode == 2 and f"argument {words[0]}: " in result.stderr, result


def check_table(bin_folder):
    result = compare(bin_folder, "--nx", "2", "--ny", "1", "--p", "2", "5", "--rings", "0", "1", "--repeat", "1")
    assert result.returncode == 0, result
    lines = [line for line in result.stdout.splitlines() if line.startswith("|")]
    header, _, *rows = ([cell.strip() for cell in line.strip("|").split("|")] for line in lines)
    assert header == ["code", "space", "rings", "p", "unknowns", "error of S", "seconds", "over ours",
                      "seconds with stresses", "with stresses, over ours"], header
    codes = {row[0] for row in rows}
    assert codes == {"ours", "deal.II, UMFPACK", "deal.II, condensed, CHOLMOD"} and len(rows) >= 12, rows
    for low, high in zip(rows[::2], rows[1::2]):  # p = 2, p = 5
        assert low[:3] == high[:3] and float(high[5]) < 0.1 * float(low[5]) and int(high[4]) > int(low[4]), (low, high)
    for row in rows:
        if row[0] != "ours":  # both times are of one run
            assert float(row[8]) >= float(row[6]), row
        for at in (6, 8):
            check_ratio(row[0], float(row[5]), *row[at:at + 2],
                        [(float(each[5]), float(each[at])) for each in rows if each[0] == "ours"])


def check_ratio(code, error, seconds, ratio, ours):
    """Of one time of a row over ours, which are (error, seconds)."""
    quicker = [time for ours_error, time in ours if ours_error <= 1.5 * error]
    assert bool(ratio) == (code != "ours" and bool(quicker)), (code, ratio, ours)
    if ratio:  # of two digits
        assert abs(float(ratio) * min(quicker) / float(seconds) - 1) < 0.1, (seconds, ratio, ours)


def main(bin_folder):
    bin_folder = Path(bin_folder).resolve()
    check_without(bin_folder)
    if (bin_folder / "peer_dealii").exists():
        check_table(bin_folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
