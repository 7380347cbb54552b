# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/fit_law as users call it, its pictures, and stage 3 with its laws: fit_law_test.py BIN_FOLDER."""
import json
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

import h5py
import numpy as np

sys.dont_write_bytecode = True
from law_fit_test import ENDLESS, FEW, MEASURED, near, table
from law_fit import Failure, fit_cubic, fit_power

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from scripts import run_script  # noqa: E402

ROOT_LAW = "delta,F\n0.01,100\n0.04,200\n0.09,300\n0.16,400\n"  # F = 1000 delta^0.5


def load_script():
    loader = SourceFileLoader("fit_law", str(ROOT / "scripts/fit_law"))
    module = module_from_spec(spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


def call(*words, status=0):
    """Output and messages of the script as a user calls it."""
    run = run_script("fit_law", *words)
    assert run.returncode == status, (words, run)
    return run.stdout, run.stderr


def fit(csv, *words, status=0):
    Path("test.csv").write_text(csv)
    return call("test.csv", *words, status=status)


def check_what_is_printed():
    out, err = fit(ROOT_LAW, "--law", "power")
    assert err == "" and re.fullmatch(
        r"power law fitted to 4 points of test\.csv; uncertainties are standard ones \(1 sigma\)\n"
        r"  A = 1000 \+- \S+\n  n = 0\.5 \+- \S+\n  delta0 = 0 \(on its bound\)\n  RMS residual of F: \S+\n"
        r'  F measured between sheets has their friction in it: fasteners with "friction" then take '
        r'"law_includes_friction": true\n'
        r'put this among the "laws" of a joint:\n  "fitted": {"type": "power", "A": 1000, "n": 0\.5, "delta0": 0}\n', out), out
    out, err = fit("1;1\n2;1.8\n3;2.4\n", "--law", "cubic")
    assert err.startswith("fit_law: warning: test.csv: there is no uncertainty: ") and err.count("\n") == 1, err
    assert "\n  delta = 1: F = 1\n  delta = 2: F = 1.8\n  delta = 3: F = 2.4\n" in out, out
    assert '  "fitted": {"type": "cubic", "delta": [1, 2, 3], "F": [1, 1.8, 2.4]}\n' in out, out
    assert fit(ROOT_LAW, "--law", "power", "--quiet") == ("", "")
    assert fit(ROOT_LAW, "--law", "power") == fit(ROOT_LAW, "--law", "power")
    assert fit("delta,F\n1,3\n2,4\n4,5\n5,7\n", "--law", "cubic") == fit('"F [N]","delta"\n3,1\n4,2\n5,4\n7,5\n', "--law", "cubic")
    Path("line\nbreak.csv").write_text("1,1\n")
    assert call("line\nbreak.csv", "--law", "power", status=2)[1].startswith(r"fit_law: error: line\nbreak.csv: forces"), \
        "a message is one line"


def check_what_is_refused():
    number, columns = "allowed: a number >= 0 with a decimal point", "allowed: two columns, delta and F, parted by"
    for csv, status, message in [
            ("0,0\n1,2\n2,3\n", 2, ": forces > 0 at 2 different delta > 0; allowed: at 3 or more of them"),
            ("0,0\n1,-2\n", 2, f":2: '-2' is not allowed; {number}"),
            ("delta,F\n1,2\n\n# pause\n1,2 N\n", 2, f":5: '2 N' is not allowed; {number}"),
            ("slip,load\n1,2\n", 2, ":1: columns 'slip' and 'load'; allowed: \"delta\" and \"F\", with units or without, or "
             "no names"),
            ("1,2\n1,2,3\n", 2, f":2: 3 columns in '1,2,3'; {columns} a comma, semicolon or tab"),
            ("the force was measured\n", 2, f":1: 1 column in 'the force was measured'; {columns} a comma, semicolon or tab"),
            ("# nothing\ndelta,F\n", 2, f": no points; {columns} a comma, semicolon or tab"),
            ("1,1\n3e200,2\n4,3\n", 2, ":2: the largest delta is 3e+200; allowed: 1e-30 to 1e+30, in other units"),
            (ENDLESS, 4, ": the search for a power law did not end; leave out points before contact and after failure")]:
        assert fit(csv, "--law", "power", status=status) == ("", f"fit_law: error: test.csv{message}\n")
    assert call("none.csv", "--law", "power", status=3) == (
        "", "fit_law: error: none.csv: cannot be opened: No such file or directory\n")
    assert call(".", "--law", "power", status=3) == ("", "fit_law: error: .: is not a regular file\n")
    for words, message in [((), "required: --law"), (("--law", "glue"), "choose from 'power', 'cubic'"),
                           (("--law", "power", "-o", "fit.pdf"), "'fit.pdf' is not allowed; allowed: a name in .svg or .png"),
                           (("--law", "power", "--colour"), "unrecognized arguments: --colour")]:
        out, err = fit(ROOT_LAW, *words, status=2)
        assert out == "" and message in err, (words, err)


def check_pictures_are_whole():
    """A fit that fails, or a picture that cannot be written, leaves what was there and nothing besides."""
    Path("fit.svg").write_text("before")
    fit("1,1\n", "--law", "power", "-o", "fit.svg", status=2)
    assert Path("fit.svg").read_text() == "before"
    out, err = fit(ROOT_LAW, "--law", "power", "-o", "no/fit.svg", status=3)
    assert (out, err) == ("", "fit_law: error: no/fit.svg: cannot be written: No such file or directory\n"), err
    assert not Path("no").exists()
    Path("folder.svg").mkdir()
    assert "folder.svg: cannot be written: Is a directory" in fit(ROOT_LAW, "--law", "power", "-o", "folder.svg", status=3)[1]
    Path("test.svg").write_text(ROOT_LAW)
    assert "./test.svg is the input file; choose another name" in call("test.svg", "--law", "power", "-o", "./test.svg",
                                                                     status=2)[1]
    assert Path("test.svg").read_text() == ROOT_LAW
    Path("link.svg").symlink_to("fit.svg")
    fit(ROOT_LAW, "--law", "power", "-o", "link.svg", "--quiet")
    assert Path("link.svg").is_symlink() and "<svg" in Path("fit.svg").read_text()
    assert not list(Path(".").glob("*.partial"))


def check_figure(script):
    """What its artists show: the points, the law from 0 to the last delta, one uncertainty above and below it."""
    for law in (fit_power, fit_cubic):
        points = table(MEASURED)
        fit = law(points)
        axes = script.draw(fit, points).axes[0]
        artists = {artist.get_gid(): artist for artist in [*axes.lines, *axes.collections]}
        assert (axes.get_xlabel(), axes.get_ylabel()) == ("delta", "F")
        assert axes.get_title() == f"{fit.law} law fitted to 12 points"
        assert np.array_equal(artists["points"].get_xydata(), points[:, :2])
        delta, F = artists["law"].get_xydata().T
        assert len(delta) > 100 and delta.min() == 0 and delta.max() == 0.3
        near(F, fit.force(delta), 1e-9)
        outline = np.vstack([path.vertices for path in artists["band"].get_paths()])
        at = np.unique(outline[:, 0])
        for where in at[1:-1]:
            sides = np.unique(outline[outline[:, 0] == where][:, 1])
            F, sigma = fit.force(np.array([where])), fit.uncertainty(np.array([where]))
            near([sides.min(), sides.max()], [*(F - sigma), *(F + sigma)], 1e-9)
            assert sigma < F, "near contact the band would fall below 0"
        assert at.max() == 0.3 and len(at) > 100
        assert axes.get_xlim()[0] == 0 == axes.get_ylim()[0] and axes.get_ylim()[1] > points[:, 1].max()
    axes = script.draw(fit_cubic(table(FEW)), table(FEW)).axes[0]
    assert not axes.collections and len(axes.lines) == 2, "no band without uncertainty"


def check_files_of_pictures():
    """The SVG holds the points and the law at one scale, and words as text; the PNG shows the same; both have no date."""
    csv = "".join(f"{delta},{F}\n" for delta, F in MEASURED)
    fit(csv, "--law", "power", "-o", "fit.svg")
    first = Path("fit.svg").read_bytes()
    fit(csv, "--law", "power", "-o", "fit.svg")
    assert Path("fit.svg").read_bytes() == first
    svg = xml.fromstring(first)
    space = {"s": "http://www.w3.org/2000/svg"}
    words = [text.text for text in svg.iterfind(".//s:text", space)]
    assert {"delta", "F", "power law", "test", "one standard uncertainty", "power law fitted to 12 points"} <= set(words), words
    marks = np.array([[float(use.get(axis)) for axis in "xy"] for use in svg.iterfind(".//s:g[@id='points']//s:use", space)])
    assert len(marks) == len(MEASURED)
    scales = [np.polyfit(np.array(MEASURED)[:, i], marks[:, i], 1) for i in (0, 1)]
    for i, scale in enumerate(scales):
        near(np.polyval(scale, np.array(MEASURED)[:, i]), marks[:, i], 1e-4)
    numbers = re.findall(r"[ML] (\S+) (\S+)", svg.find(".//s:g[@id='law']/s:path", space).get("d"))
    delta, F = ((np.array(column, dtype=float) - scale[1]) / scale[0] for column, scale in zip(zip(*numbers), scales))
    near(F, fit_power(table(MEASURED)).force(delta), 20)  # at contact the slope is infinite: rounding of delta
    near(delta.max(), 0.3, 1e-6)
    fit(csv, "--law", "power", "-o", "fit.PNG")
    from matplotlib.image import imread
    pixels = imread("fit.PNG")[:, :, :3]
    law_blue, black = (np.abs(pixels - colour).max(axis=2) < 0.02 for colour in ((31 / 255, 119 / 255, 180 / 255), (0, 0, 0)))
    assert pixels.shape[0] > 300 and law_blue.any(axis=0).sum() > 0.6 * pixels.shape[1] and black.any(), pixels.shape


def joint(law):
    """One fastener of the law between a sheet under 300 and a doubler on the ground."""
    Path("joint.json").write_text(json.dumps({
        "format": "joint", "version": 1, "name": "one fastener", "plates": {"sheet": "sheet.h5", "doubler": "doubler.h5"},
        "laws": {"fitted": law}, "fasteners": [{"id": "1", "between": ["sheet:1", "doubler:1"], "law": "fitted"}],
        "loads": [{"external": "sheet:P", "force": 300}]}))
    return subprocess.run(["stage3_nonlinear", "joint.json", "-o", "joint.h5"], capture_output=True, text=True)


def check_laws_that_are_printed_run_in_joints():
    for name, end in (("sheet", "--right=external:P=1e5"), ("doubler", "--left=ground=1e5")):
        subprocess.run([ROOT / "scripts/chain_matrices", end, "-o", f"{name}.h5"], check=True)
    for kind in ("power", "cubic"):
        out, _ = fit(ROOT_LAW, "--law", kind)
        law = json.loads("{" + out.splitlines()[-1] + "}")["fitted"]
        run = joint(law)
        assert run.returncode == 0 and run.stderr == "", run
        with h5py.File("joint.h5") as f:
            (F,), (delta,) = f["F"][-1], f["delta"][-1]
        near(F, 300, 1e-6)
        if kind == "power":
            near([law["A"] * (delta - law["delta0"])**law["n"], delta], [F, 0.09], [1e-6, 1e-9])
        else:
            x = np.array(law["delta"])
            near(np.polyval(np.polyfit([0, *x], [0, *law["F"]], 3), delta), F, 1e-6)


def check_stage_3_reads_the_same_files(script):
    """Both take or refuse a file of points alike; what they refuse, in the same words."""
    fields = ["1", "+1", "-1", "+-1", "++1", "1.", ".5", "1e0", "1E+0", "1e", "1e999", "0x1", "1_0", "1 0", "1 N", "inf", "nan",
              "Infinity", "", "one", '"1"', "\u0661", "1\r", "1\f", "1#2", "-0"]
    files = [f"{field},1\n2,2\n3,3\n" for field in fields] + [f"1,1\n2,2\n3,{field}\n" for field in fields]
    files += ["delta,F\n1,1\n2,2\n", "\ufeff\"delta [mm]\";\"F [N]\"\r\n0;0\r\n1;2\r\n2;3\r\n", "1\t1\n2\t2", "1;1\n2,5;2\n", "",
              "# x\n", "a,b\nc,d\n1,1\n", "nan,nan\n1,1\n2,2\n", "1,1,1\n", "1\n", "a,\n1,1\n", "1;2\t3\n", "1,1\n2,2\n\n\n#,,,\n"]
    verdicts = set()
    for content in files:
        Path("test.csv").write_text(content, newline="")
        run = joint({"type": "table", "file": "test.csv"})
        try:
            script.read_points("test.csv")
            said = None
        except Failure as failure:
            said = "test.csv" + (f":{failure.line}: " if failure.line else ": ") + str(failure)
        verdicts.add(said is None)
        if said is None:
            assert "test.csv:" not in run.stderr, (content, run)  # though a table law has rules of its own
        else:
            assert run.returncode == 2, (content, said, run)
            told = script.one_line(said).replace("1 column ", "1 columns ")
            assert told in run.stderr.replace("1 column ", "1 columns "), (told, run.stderr)
    assert verdicts == {True, False}


def main(folder):
    os.environ["PATH"] = os.path.abspath(folder) + os.pathsep + os.environ["PATH"]
    script = load_script()
    check_figure(script)
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        check_what_is_printed()
        check_what_is_refused()
        check_pictures_are_whole()
        check_files_of_pictures()
        check_laws_that_are_printed_run_in_joints()
        check_stage_3_reads_the_same_files(script)
        os.chdir("/")


if __name__ == "__main__":
    main(*sys.argv[1:])
