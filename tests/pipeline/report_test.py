#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of scripts/report has the numbers of RESULT.h5, holds everything, and is the same twice: report_test.py FOLDER_OF_PROGRAMS."""
import html.parser
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support")]
sys.dont_write_bytecode = True
from examples import copy_example  # noqa: E402
from one_hole import PROGRAMS, run  # noqa: E402


class Page(html.parser.HTMLParser):
    """Rows of cells of each section, and whether every tag is closed."""

    def __init__(self, text):
        super().__init__()
        self.open, self.sections, self.references = [], {}, []
        self.title = self.cell = None
        self.feed(text)
        assert not self.open, self.open

    def handle_starttag(self, tag, attributes):
        self.references += [value for key, value in attributes if key in ("src", "href", "xlink:href") and not value.startswith("#")]
        assert tag not in ("script", "link", "iframe", "object"), tag
        if tag not in ("meta", "br"):
            self.open.append(tag)
        if tag == "tr":
            self.sections.setdefault(self.title, []).append([])
        if tag in ("td", "th", "h2"):
            self.cell = ""

    def handle_startendtag(self, tag, attributes):
        self.references += [value for key, value in attributes if key in ("src", "href", "xlink:href") and not value.startswith("#")]

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, tag
        if tag == "h2":
            self.title, self.cell = self.cell, None
        if tag in ("td", "th"):
            self.sections[self.title][-1].append(self.cell)
            self.cell = None

    def handle_data(self, data):
        if self.cell is not None:
            self.cell += data


def report(result, output):
    subprocess.run([ROOT / "scripts/report", result, "-o", output], check=True)
    text = output.read_text()
    page = Page(text)
    assert not page.references and "http" not in text.split("JOINT.json:")[0] and "@import" not in text and "url(http" not in text, page.references
    return text, page.sections


def check_numbers(folder):
    copy = copy_example("butt_joint", folder)
    for name in ("cover", "left", "right"):
        run(copy, "stage1_plate", f"{name}.json", "-o", f"{name}.h5")
        run(copy, "stage2_extract", f"{name}.h5", "-o", f"{name}.matrices.h5")
    run(copy, "stage3_nonlinear", "cases.json", "-o", "cases.h5")
    text, found = report(copy / "cases.h5", folder / "report.html")
    assert report(copy / "cases.h5", folder / "again.html")[0] == text, "the same bytes"
    with h5py.File(copy / "cases.h5") as f:
        margins = [list(f[f"margin/{name}"][:]) for name in ("margin", "allowable", "applied")]
        load, peak, of = np.abs(f["transferred"][:, :, 0]), f["plates/right/rim/peak_hoop"][:], f["case/of"][:]
        names = list(f["case/name"].asstr()[:])
        net = f["plates/right/rim/net_stress"][:]
    rows = found["Smallest margins"][1:]
    assert len(rows) == 20 and all(row[2:5] == [f"{margins[0][i]:+.3f}", f"{margins[1][i]:.6g}", f"{margins[2][i]:.6g}"] for i, row in enumerate(rows))
    rows = found["Load cases"][1:]
    assert [row[0] for row in rows] == names and [row[2] for row in rows] == [f"{load[of == i].max():.6g}" for i in range(len(names))], rows
    rows = found["Loads of the fasteners"][1:]
    assert [row[3] for row in rows] == [f"{each:.6g}" for each in sorted(load.max(axis=0), reverse=True)] and rows[0][5] == "increment 1 of ultimate pull"
    worst = found["The holes with the highest peaks"][1]
    i = int(peak.max(axis=0).argmax())
    assert worst[0] == "right:8" and worst[1] == f"{peak.max():.6g}" and worst[6] == f"{net[peak[:, i].argmax(), i]:.6g}", worst
    row = int(load.max(axis=1).argmax())
    sums = {(float(line[0]), line[1]): float(line[3]) for line in found["Load by rows"][1:]}
    assert abs(sum(value for (_, between), value in sums.items() if between == "top-right") / load[row, 8::2].sum() - 1) < 1e-4, sums
    assert sum(f"<h2>Sheet {name}</h2>" in text for name in ("top", "left", "right", "bottom")) == 4 and text.count("<svg") == 5
    wrong = subprocess.run([ROOT / "scripts/report", copy / "cover.h5", "-o", folder / "x.html"], capture_output=True, text=True)
    assert wrong.returncode == 2 and 'not of the format "joint-result"' in wrong.stderr and not (folder / "x.html").exists(), wrong


def check_hundred(folder):
    """A hundred fasteners with names that HTML must not take for its own, under many increments."""
    n = 10
    sheet = {"format": "plate", "version": 1, "units": {"length": "mm", "force": "N"}, "analysis": "plane stress", "p": [2, 3],
             "materials": {"m": {"E": 7e4, "nu": 0.3}},
             "geometry": {"grid": {"x": [20 * i for i in range(n + 1)], "y": [20 * i for i in range(n + 1)], "thickness": 2}},
             "holes": [{"id": f"<b>{i}&{k}", "center": [20 * i + 10, 20 * k + 10], "radius": 3, "spring": {"modulus": 1e5}} for i in range(n) for k in range(n)]}
    for name, more in (("upper", {"external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}]}), ("lower", {"supports": [{"on": "left", "fix": ["x", "y"]}]})):
        (folder / f"{name}.json").write_text(json.dumps(sheet | more))
        run(folder, "stage1_plate", f"{name}.json", "-o", f"{name}.plate.h5")
        run(folder, "stage2_extract", f"{name}.plate.h5", "-o", f"{name}.h5")
    joint = {"format": "joint", "version": 1, "name": "a <script> of 100", "plates": {"upper": "upper.h5", "lower": "lower.h5"},
             "laws": {"bolt": {"type": "bilinear", "k": 5e4, "F_yield": 2000, "k_yield": 5e3}},
             "fasteners": [{"id": hole["id"], "between": [f"upper:{hole['id']}", f"lower:{hole['id']}"], "law": "bolt"} for hole in sheet["holes"]],
             "loads": [{"external": "upper:P", "force": 250000}], "increments": 4}
    (folder / "joint.json").write_text(json.dumps(joint))
    run(folder, "stage3_nonlinear", "joint.json", "-o", "joint.h5")
    text, found = report(folder / "joint.h5", folder / "hundred.html")
    assert len(text) < 1e6 and "a &lt;script&gt; of 100" in text and len(found["Loads of the fasteners"]) == 21, len(text)
    assert len(re.findall(r"<text", text)) > 200 and "Load path" in text


def main():
    assert PROGRAMS.is_dir()
    with tempfile.TemporaryDirectory() as name:
        check_numbers(Path(name))
        check_hundred(Path(name))


if __name__ == "__main__":
    main()
