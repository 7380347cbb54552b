#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of scripts/report has the numbers of RESULT.h5, holds everything, is the same twice, and is seen and printed by a browser:
report_test.py FOLDER_OF_PROGRAMS."""
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import matplotlib.image
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support")]
sys.dont_write_bytecode = True
from examples import copy_example  # noqa: E402
from one_hole import PROGRAMS, matrices, run  # noqa: E402
from pictures import extent  # noqa: E402
from scripts import run_script  # noqa: E402


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
    done = run_script("report", result, "-o", output)
    assert done.returncode == 0, done
    text = output.read_text()
    page = Page(text)
    assert not page.references and "http" not in text.split("JOINT.json:")[0] and "@import" not in text and not re.search(r"url\((?!#)", text), page.references
    return text, page.sections


def check_numbers(folder):
    copy = copy_example("butt_joint", folder)
    run(copy, "stage3_nonlinear", "cases.json", "-o", "cases.h5", "--rim-stresses")
    text, found = report(copy / "cases.h5", folder / "report.html")
    assert report(copy / "cases.h5", folder / "again.html")[0] == text, "the same bytes"
    with h5py.File(copy / "cases.h5") as f:
        checks = list(f["margin/check"].asstr()[:])
        order = sorted(range(len(checks)), key=lambda i: (checks.index(checks[i]) != i, i))  # the smallest of each check first
        margins = [f[f"margin/{name}"][:][order] for name in ("margin", "allowable", "applied")]
        row, reason = f["governing/increment"][()] - 1, f["governing/reason"].asstr()[()]
        assert row == f["margin/at"][0] and reason == f"the smallest margin, {checks[0]} of {f['margin/of'].asstr()[0]}", (row, reason)
        load, peak, of = np.abs(f["transferred"][:, :, 0]), f["plates/right/rim/peak_hoop"][:], f["case/of"][:]
        names = list(f["case/name"].asstr()[:])
        net = f["plates/right/rim/net_stress"][:]
    rows = found["Smallest margins"][1:]
    assert len(rows) == 20 and all(row[2:5] == [f"{margins[0][i]:+.3f}", f"{margins[1][i]:.6g}", f"{margins[2][i]:.6g}"] for i, row in enumerate(rows))
    rows = found["Load cases"][1:]
    assert [row[0] for row in rows] == names and [row[2] for row in rows] == [f"{load[of == i].max():.6g}" for i in range(len(names))], rows
    rows = found["Loads of the fasteners"][1:]
    assert [row[3] for row in rows] == [f"{each:.6g}" for each in sorted(load.max(axis=0), reverse=True)] and rows[0][5] == "ultimate pull"
    worst = found["The holes with the highest peaks"][1]
    i = int(peak.max(axis=0).argmax())
    assert worst[0] == "right:8" and worst[1] == f"{peak.max():.6g}" and worst[6] == f"{net[peak[:, i].argmax(), i]:.6g}", worst
    with h5py.File(copy / "cases.h5") as f:
        rows = f["plates/right/row"]
        lines = [[f"{rows['at'][i]:.6g}", str(rows["holes"][i]), *(f"{rows[name][row, i]:.6g}" for name in ("force", "before"))]
                 for i, axis in enumerate(rows["direction"].asstr()) if axis == "x"]
        warnings = list(f["warning/text"].asstr()[:])
    assert [line[1:5] for line in found["Load by rows"] if line[0] == "right"] == lines and len(lines) > 1, lines
    assert [line[1] for line in found.get("Warnings", [[]])[1:]] == warnings
    with h5py.File(copy / "cases.h5") as f:
        edges = [[f"{plate}:{name}", f"{f[f'plates/{plate}/Pe'][row, i]:.6g}", f"{f[f'plates/{plate}/De'][row, i]:.6g}"]
                 for plate in f["plate/name"].asstr()[:] for i, name in enumerate(f[f"plates/{plate}/external/id"].asstr()[:])]
    assert found["Loaded edges"][1:] == edges and edges, (found["Loaded edges"], edges)
    assert "<h2>Secondary bending</h2>" in text
    assert sum(f"<h2>Sheet {name}</h2>" in text for name in ("top", "left", "right", "bottom")) == 4 and text.count("<svg") == 7
    assert "FS = 1, FF = 1.15 in all of these" in text and reason in text
    assert ["right", "7075-T6", "E = 71000, nu = 0.33"] in found["Materials of the sheets"], found["Materials of the sheets"]
    check_collapse(folder)
    check_geometry(copy / "cases.h5", found)
    check_rims(copy / "cases.h5", text)
    check_without_rims(copy)
    check_browser(folder, folder / "report.html", found)
    wrong = run_script("report", copy / "cover.h5", "-o", folder / "x.html")
    assert wrong.returncode == 2 and 'not of the format "joint-result"' in wrong.stderr and not (folder / "x.html").exists(), wrong


def check_collapse(folder):
    """A run to the limit load: the page has its last increment, and names the load."""
    copy = copy_example("two_bolts", folder)
    for name in ("upper", "lower"):
        matrices(copy, json.loads((copy / f"{name}.json").read_text()), f"{name}.matrices")
    joint = json.loads((copy / "joint.json").read_text())
    joint["laws"]["bolt"] = {"type": "bilinear", "k": 1e5, "F_yield": 1500, "k_yield": 0}
    (copy / "joint.json").write_text(json.dumps(joint | {"increments": 10}))
    done = subprocess.run([PROGRAMS / "stage3_nonlinear", "joint.json", "-o", "joint.h5", "--quiet"], cwd=copy, capture_output=True, text=True)
    assert done.returncode == 4 and "limit load reached" in done.stderr, done
    text, found = report(copy / "joint.h5", folder / "collapse.html")
    with h5py.File(copy / "joint.h5") as f:
        n = len(f["load_factor"])
        assert f["governing/increment"][()] == n == 8, n
        applied = f["plates/upper/Pe"][-1, 0]
    assert "limit load reached: beyond load factor 0.857" in text.split("Not solved to the end")[1].split("</p>")[0], text
    assert found["Loaded edges"][1][1] == f"{applied:.6g}", found["Loaded edges"]


def check_geometry(path, found):
    """Of examples/butt_joint: holes of 5 mm, 25 mm apart, in strips of 40 mm."""
    with h5py.File(path) as f:
        along = f["margin/edge_ratio"][:][f["margin/of"].asstr()[:] == "right:8"].min()
    rows = found["Geometry of the fasteners' holes"]
    assert rows[0] == ["hole", "diameter D [mm]", "mean thickness [mm]", "nearest edge e/D", "e/D along the load", "p/D along x", "p/D along y",
                       "gross area [mm²]", "net area [mm²]"], rows[0]
    assert len(rows) == 25 and ["right:8", "5", "3", "5.5", f"{along:.4g}", "5", "5", "120", "105"] in rows[1:], rows
    assert [row[5] for row in rows if row[0] in ("top:4", "top:5", "top:8")] == ["5", "4.8", "4.8"], rows


def check_rims(path, text):
    """The picture tells the four highest peaks and their angles, and its curves are the hoop stresses around these holes."""
    picture = text.split("<h2>Stresses around the worst rims</h2>")[1].split("<h2>")[0]
    with h5py.File(path) as f:
        names, around, worst = f["case/name"].asstr()[:], {}, []
        for plate in f["plate/name"].asstr()[:]:
            rim = f[f"plates/{plate}/rim"]
            for i, hole in enumerate(rim["hole"].asstr()[:]):
                row, points = int(rim["peak_hoop"][:, i].argmax()), slice(*rim["start"][i:i + 2])
                place = f"{plate}:{hole}, {names[f['case/of'][row]]}"
                hoop, at = rim["peak_hoop"][row, i], rim["peak_angle"][row, i]
                worst.append((hoop, at, place))
                around[place] = 180 - (180 - np.append(rim["angle"][points], at)) % 360, np.append(rim["sigma_tt"][row, points], hoop)
    worst = sorted(worst, key=lambda each: -each[0])[:4]
    assert re.findall(r">([^<>]+) at ([^<>]+) deg<", picture) == [(f"{hoop:.6g}", f"{angle:.4g}") for hoop, angle, _ in worst], worst
    assert all(f">{place}<" in picture for _, _, place in worst)
    curves = re.findall(r'd="([^"]*)"[^>]*stroke: #000000; stroke-width: 1.2', picture)
    assert len(curves) == 4, len(curves)
    for curve, (_, _, place) in zip(curves, worst):
        x, y = np.array(re.findall(r"([-\d.]+) ([-\d.]+)", curve), float).T
        angle, hoop = (each[np.argsort(around[place][0])] for each in around[place])
        expected = np.interp(angle[0] + (x - x[0]) / np.ptp(x) * np.ptp(angle), angle, hoop)
        slope, start = np.polyfit(expected, y, 1)
        off = np.abs(slope * expected + start - y).max() / np.ptp(y)
        assert slope < 0 and off < 0.02 and len(x) > 30, f"{place}: {off} of the curve's height off"


def check_without_rims(copy):
    """Without stresses around rims the page says how to have them; a hole near to an edge is marked."""
    run(copy, "stage3_nonlinear", "cases.json", "-o", "bare.h5")
    with h5py.File(copy / "bare.h5", "r+") as f:
        i = list(f["margin/of"].asstr()[:]).index("right:5")
        f["margin/edge_ratio"][i] = 1.25
    text, found = report(copy / "bare.h5", copy / "bare.html")
    assert "stage3_nonlinear --rim-stresses writes them" in text and text.count("<svg") == 6
    assert ["right:5", "5", "3", "2.4", "1.25"] == found["Geometry of the fasteners' holes"][1][:5] and text.count(' bad">') == 1


def browse(folder, page):
    """A page in Chromium without a network: its elements, and the addresses outside that it asked for. Leaves page.png and page.pdf."""
    log = folder / "net.json"
    headless = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", f"--user-data-dir={folder / 'profile'}"]
    no_network = ["--proxy-server=127.0.0.1:9", "--proxy-bypass-list=<-loopback>", f"--log-net-log={log}"]  # nothing listens there
    outputs = ["--dump-dom", f"--screenshot={folder / 'page.png'}", "--hide-scrollbars", "--window-size=1100,8000",
               f"--print-to-pdf={folder / 'page.pdf'}", "--no-pdf-header-footer"]
    done = subprocess.run(["chromium", *headless, *no_network, *outputs, page.as_uri()], env={**os.environ, "HOME": str(folder)},
                          capture_output=True, text=True, timeout=25, check=True)
    requests = [event.get("params", {}) for event in json.loads(log.read_text())["events"]]
    own = "not an origin"  # what the browser asks for by itself
    return done.stdout, [each["url"] for each in requests if "url" in each and each.get("initiator", own) != own]


def check_browser(folder, page, found):
    if not shutil.which("chromium"):
        print("skipped: the page in a browser, for want of the Debian package chromium")
        return
    (folder / "outside.html").write_text('<img src="http://outside.invalid/x.png">')
    assert browse(folder, folder / "outside.html")[1] == ["http://outside.invalid/x.png"], "requests are seen"
    elements, asked = browse(folder, page)
    assert asked == [] and Page(elements).sections == found and elements.count("<svg") == 7, asked
    headings = [re.findall("<h[12]>(.*)</h[12]>", html.unescape(text)) for text in (elements, page.read_text())]
    assert headings[0] == headings[1] and "Stresses around the worst rims" in headings[0], headings
    picture = matplotlib.image.imread(folder / "page.png")[:, :, :3]
    assert picture.shape[1] == 1100 and 0.01 < (picture < 0.5).any(axis=2).mean() < 0.5 and picture[:, -10:].min() == 1, "neither blank nor too wide"
    assert extent(folder / "page.png", "#24a")[0] > 0.3 and extent(folder / "page.png", "C0")[0] > 0.3, "arrows and curves"
    pdf = (folder / "page.pdf").read_bytes()
    assert pdf.startswith(b"%PDF-") and 1 <= len(re.findall(rb"/Type\s*/Page\b", pdf)) < 10


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
    run(folder, "stage3_nonlinear", "joint.json", "-o", "joint.h5", "--rim-stresses")
    text, found = report(folder / "joint.h5", folder / "hundred.html")
    assert len(text) < 1e6 and "a &lt;script&gt; of 100" in text and len(found["Loads of the fasteners"]) == 21, len(text)
    assert len(re.findall(r"<text", text)) > 200 and "Load path" in text
    with h5py.File(folder / "joint.h5") as f:
        warnings = [list(each) for each in zip(f["warning/code"].asstr()[:], f["warning/text"].asstr()[:])]
    assert warnings and found["Warnings"][1:] == warnings, (found["Warnings"], warnings)
    rows = found["Geometry of the fasteners' holes"]
    assert rows[0] == ["hole", "diameter D [mm]", "mean thickness [mm]", "nearest edge e/D", "p/D along x", "p/D along y", "gross area [mm²]", "net area [mm²]"], rows[0]
    assert len(rows) == 41
    assert all(row[1:] == ["6", "2", "1.667", "3.333", "3.333", "40", "28"] for row in rows[1:]), "the corners and edges are nearest"


def main():
    assert PROGRAMS.is_dir()
    with tempfile.TemporaryDirectory() as name:
        check_numbers(Path(name))
        check_hundred(Path(name))


if __name__ == "__main__":
    main()
