# SPDX-License-Identifier: GPL-3.0-or-later
"""Laws fitted to tests by scripts/fit_law, and stage 3 with them: fit_law_test.py BIN_FOLDER."""
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
from fractions import Fraction
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

import h5py
import numpy as np

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from law_fit import Failure, fit_cubic, fit_power

# A test of twelve points, its forces rounded.
MEASURED = [(.02, 419), (.03, 693), (.04, 971), (.06, 1386), (.08, 1745), (.1, 1999),
            (.13, 2370), (.16, 2722), (.19, 3117), (.22, 3465), (.26, 3802), (.3, 4110)]
ROOT_LAW = "delta,F\n0.01,100\n0.04,200\n0.09,300\n0.16,400\n"  # F = 1000 delta^0.5
FEW = [(0.1, 12 * 0.05**0.5), (0.2, 12 * 0.15**0.5), (0.3, 12 * 0.25**0.5)]
ENDLESS = "0.25,0.0325\n0.5,0.4588\n0.75,0.6867\n1,0.2878\n"


def load_script():
    loader = SourceFileLoader("fit_law", str(ROOT / "scripts/fit_law"))
    module = module_from_spec(spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


def table(points):
    """Points as the fits take them, shape (n, 3): delta, F, line of the file."""
    return np.array([(delta, F, line) for line, (delta, F) in enumerate(points, 1)])


def curve_points(n, first, last, curve):
    return [(delta, curve(delta)) for delta in np.linspace(first, last, n)]


def power(A, n, delta0):
    return lambda delta: A * (delta - delta0)**n if delta > delta0 else 0


def near(found, value, tolerance):
    assert np.all(np.abs(np.subtract(found, value)) <= tolerance), (found, value)


def sigmas(fit):
    return np.sqrt(np.diag(fit.covariance))


def check_exact_laws_are_found():
    for A, n, delta0 in [(9000, 0.6, 0.013), (9000, 0.6, 0), (1e-3, 0.4, 0.02), (500, 1, 0.013), (500, 1, 0)]:
        law = power(A, n, delta0)
        fit = fit_power(table(curve_points(20, 0, 0.2, law)))
        near(fit.constants, [A, n, delta0], [1e-8 * A, 1e-8, 1e-8 * 0.2])
        assert fit.has_uncertainty and (sigmas(fit) < [1e-10 * A, 1e-10, 1e-10 * 0.2]).all(), sigmas(fit)
        assert fit.rms < 1e-10 * law(0.2) and fit.n_points == 20
        assert list(fit.free) == [True, n != 1, delta0 != 0], fit
    fit = fit_cubic(table(curve_points(9, 0, 0.3, true_cubic)))
    near(fit.constants, [3e4, -9e4, 2e5], [3e-4, 9e-4, 2e-3])
    near(fit.thirds, [0.1, 0.2, 0.3], 1e-16)
    near(fit.force(fit.thirds), true_cubic(fit.thirds), 1e-9 * true_cubic(0.3))
    assert (fit.uncertainty(fit.thirds) < 1e-10 * true_cubic(0.3)).all() and fit.warnings == []


def check_reference_numbers():
    """By scipy 1.10: curve_fit(lambda x, A, n, d: A * (x - d)**n, delta, F, p0=[9000, .6, .01], xtol=1e-14) with its
    covariance, and numpy.linalg.lstsq of [x, x**2, x**3] with covariance res / 9 * inv(X.T @ X)."""
    fit = fit_power(table(MEASURED))
    near(fit.constants, [8848.396609, 0.6048590193, 0.0139527669], [1e-3, 1e-7, 1e-8])
    near(sigmas(fit), [159.401860, 0.0121005474, 0.00111138170], [2e-2, 2e-6, 2e-7])  # scipy's derivatives are differences
    near(fit.rms, 31.465106559, 1e-6)
    near(fit.force(np.array([0.2])), 3199.55511, 1e-3)
    near(fit.uncertainty(np.array([0.2, 0.01])), [13.5413918, 0], [2e-3, 0])
    assert fit.warnings == []
    fit = fit_cubic(table(MEASURED))
    near(fit.force(fit.thirds), [2006.003394569, 3216.132336839, 4138.234372871], 1e-6)
    near(fit.uncertainty(fit.thirds), [24.299093210, 30.312284532, 51.495346479], 1e-6)


def solve_exactly(M, right):
    """Gauss and Jordan in fractions: M^-1 right, column by column."""
    rows = [list(row) + list(more) for row, more in zip(M, right)]
    for i in range(len(rows)):
        rows[i] = [value / rows[i][i] for value in rows[i]]
        for k in range(len(rows)):
            if k != i:
                rows[k] = [a - rows[k][i] * b for a, b in zip(rows[k], rows[i])]
    return [row[len(M):] for row in rows]


def check_cubic_by_normal_equations():
    """Normal equations and covariance without rounding: X^T X c = X^T F, s^2 (X^T X)^-1."""
    delta, F = ([Fraction(str(value)) for value in column] for column in zip(*MEASURED))
    X = [[d, d**2, d**3] for d in delta]
    square = [[sum(x[i] * x[j] for x in X) for j in range(3)] for i in range(3)]
    identity = [[Fraction(i == j) for j in range(3)] for i in range(3)]
    inverse = solve_exactly(square, identity)
    right = [sum(x[i] * f for x, f in zip(X, F)) for i in range(3)]
    c = [sum(a * b for a, b in zip(row, right)) for row in inverse]
    variance = sum((sum(a * b for a, b in zip(c, x)) - f)**2 for x, f in zip(X, F)) / (len(F) - 3)
    fit = fit_cubic(table(MEASURED))
    expected = np.array(c, dtype=float)
    near(fit.constants, expected, 1e-11 * abs(expected))
    covariance = np.array([[variance * value for value in row] for row in inverse], dtype=float)
    near(fit.covariance, covariance, 1e-9 * abs(covariance))


def check_power_by_differences():
    """Whatever the search: no step along the axes of the covariance lowers the sum of squares, a step of one uncertainty
    raises it by the variance, and the covariance is that of central differences."""
    delta, F, _ = table(MEASURED).T
    fit = fit_power(table(MEASURED))
    def law(c):
        return c[0] * (delta - c[2])**c[1]

    least = ((law(fit.constants) - F)**2).sum()
    variance = least / (len(F) - 3)
    near(fit.rms, math.sqrt(least / len(F)), 1e-9)
    steps = np.diag(1e-3 * sigmas(fit))
    J = np.column_stack([(law(fit.constants + h) - law(fit.constants - h)) / (2e-3 * sigma)
                         for h, sigma in zip(steps, sigmas(fit))])
    covariance = variance * np.linalg.inv(J.T @ J)
    near(fit.covariance, covariance, 1e-5 * np.sqrt(np.outer(*2 * [np.diag(covariance)])))
    sizes, axes = np.linalg.eigh(fit.covariance / np.outer(sigmas(fit), sigmas(fit)))
    for size, axis in zip(sizes, axes.T):
        for sign in (0.1, -0.1):
            rise = ((law(fit.constants + sign * math.sqrt(size) * axis * sigmas(fit)) - F)**2).sum() - least
            near(rise, 0.01 * variance, 0.002 * variance)


def check_units():
    """A test in inches and pounds has the laws of the same test in mm and N."""
    inches = [(delta / 25.4, F / 4.448) for delta, F in MEASURED]
    mm, inch = fit_power(table(MEASURED)), fit_power(table(inches))
    near([inch.constants[1], sigmas(inch)[1]], [mm.constants[1], sigmas(mm)[1]], 1e-9)
    near(inch.constants[2] * 25.4, mm.constants[2], 1e-10)
    for fit in (fit_power, fit_cubic):
        near(fit(table(inches)).uncertainty(np.array([0.2 / 25.4])) * 4.448, fit(table(MEASURED)).uncertainty(np.array([0.2])),
             1e-6)


TRUTH = (9000, 0.6, 0.01)


def true_cubic(d):
    return 3e4 * d - 9e4 * d**2 + 2e5 * d**3


def scattered(random, n, curve):
    """n points past contact, each with a scatter of 30."""
    return table(curve_points(n, 0.017, 0.21, lambda delta: curve(delta) + random.normal(0, 30)))


def check_honest_uncertainties():
    """One standard uncertainty either side holds the truth in 68 % of all tests; of 500, 2 % is the scatter of that."""
    random, n_tests = np.random.default_rng(1), 500
    inside = np.zeros((2, 3))
    for _ in range(n_tests):
        fit = fit_power(scattered(random, 30, power(*TRUTH)))
        inside[0] += abs(fit.constants - TRUTH) < sigmas(fit)
        fit = fit_cubic(scattered(random, 12, true_cubic))
        inside[1] += abs(fit.force(fit.thirds) - true_cubic(fit.thirds)) < fit.uncertainty(fit.thirds)
    assert ((inside > 0.60 * n_tests) & (inside < 0.76 * n_tests)).all(), inside


def check_error_falls_with_the_root_of_the_number_of_points():
    """Sixteen times as many points, a quarter of the error; each side of the ratio is known to 1 / sqrt(800) = 3.5 %."""
    def rms_error_of_A(n_points):
        random = np.random.default_rng(3)
        errors = [fit_power(scattered(random, n_points, power(*TRUTH))).constants[0] - TRUTH[0] for _ in range(400)]
        return np.sqrt(np.mean(np.square(errors)))

    near(rms_error_of_A(20) / rms_error_of_A(320), 4, 0.6)


def check_bounds():
    fit = fit_power(table(curve_points(20, 0.01, 0.2, power(9000, 0.6, -0.02))))
    assert fit.constants[2] == 0 == sigmas(fit)[2] and list(fit.free) == [True, True, False], fit
    assert fit.constants[1] < 0.6 and sigmas(fit)[1] > 0
    fit = fit_power(table(curve_points(20, 0.01, 0.2, power(9000, 1.5, 0))))
    assert fit.constants[1] == 1 == fit.constants[1] + sigmas(fit)[1]
    assert "n is on its bound 1: the points rise as a line or steeper and steeper" in fit.warnings, fit.warnings
    # 12 (delta - 0.05)^0.5 from 0.1 on, but no force yet at 0.07: contact cannot come before.
    points = curve_points(20, 0.1, 1, power(12, 0.5, 0.05))
    near(fit_power(table(points)).constants[2], 0.05, 1e-9)
    held = fit_power(table([*points, (0, 0), (0.07, 0)]))
    near(held.constants[2], 0.07, 1e-15)
    assert list(held.free) == [True, True, False] and held.n_points == 22 and held.rms > 0
    first = table([(0, 10), (1, 1), (2, 2), (3, 3)])  # a force without displacement, the greatest of all
    near(fit_power(first).constants, [1, 1, 0], 1e-9)
    for beyond in (0.9, 0.99, 1.01, 1.1):  # the bound is where the sum of squares is least of all that are allowed
        delta, F = np.array(points).T
        shifted = held.constants[0] * np.maximum(delta - 0.07, 0)**(held.constants[1] * beyond)
        assert ((shifted - F)**2).sum() > ((held.force(delta) - F)**2).sum()


def check_warnings():
    no_uncertainty = "there is no uncertainty: that of 3 constants takes 4 points past contact or more, and the test has 3"
    for law in (fit_power, fit_cubic):
        fit = law(table(FEW))
        assert not fit.has_uncertainty and not fit.covariance.any() and fit.warnings == [no_uncertainty], fit
        near(fit.force(table(FEW)[:, 0]), table(FEW)[:, 1], 1e-9 * 12)
    before_contact = [*FEW, *((delta, 0) for delta in (0, 0.01, 0.02, 0.03))]
    assert not fit_power(table(before_contact)).has_uncertainty, "points before contact tell nothing of the scatter past it"
    fit = fit_cubic(table(curve_points(7, 0, 3, lambda x: x * (6.5 - 4.75 * x + x * x))))
    assert fit.warnings == ["the cubic does not rise everywhere up to its last delta 3: its slope at delta = 1.583 is "
                            "-1.021; the joint may have more than one solution"], fit.warnings


def check_a_law_that_misses_its_points():
    """Above 5 % of the greatest force, with the number, of a wave of any height about a law."""
    said = {fit_power: set(), fit_cubic: set()}
    for law, curve in ((fit_power, power(1, 0.7, 0)), (fit_cubic, true_cubic)):
        for height in np.linspace(0.04, 0.28, 13):
            delta, F, _ = points = table(curve_points(40, 0.02, 1, lambda d: curve(d) * (1 + height * math.sin(31 * d)))).T
            fit = law(points.T)
            miss = 100 * np.sqrt(np.mean((fit.force(delta) - F)**2)) / F.max()
            warned = [each for each in fit.warnings if "misses" in each]
            assert len(warned) == (miss > 5), (miss, fit.warnings)
            said[law].add(miss > 5)
            assert not warned or warned[0] == (
                f"the law misses its points by {miss:.2g} % of the largest force (RMS): their curve may be of another kind "
                "(several slopes, yield, slip); look at the picture (-o), leave out points after failure, or take a "
                '"table" law, which takes the points as they are'), warned
        assert said[law] == {False, True}, "both sides of the bound were tried"


def refusal(fit, points, status=2):
    try:
        fit(table(points))
    except Failure as failure:
        assert failure.status == status, failure.status
        return str(failure)
    raise AssertionError("was not refused")


def check_refusals():
    for fit in (fit_power, fit_cubic):
        for n, points in ((2, [(0, 0), (1, 2), (2, 3)]), (1, [(1, 1), (1, 2), (1, 3)]), (0, [(1, 0), (2, 0), (3, 0)])):
            said = refusal(fit, points)
            assert said == f"forces > 0 at {n} different delta > 0; allowed: at 3 or more of them", said
    def sized(length, force):
        return [(1 * length, 1 * force), (2 * length, 1.5 * force), (3 * length, 1.8 * force)]

    said = refusal(fit_power, sized(1e200, 1))
    assert said == "the largest delta is 3e+200; allowed: 1e-30 to 1e+30, in other units", said
    said = refusal(fit_power, [(0, 1e200), *sized(1, 1)])
    assert said == "the largest F is 1e+200; allowed: 1e-30 to 1e+30, in other units", said
    said = refusal(fit_cubic, sized(1, 1e-200))
    assert said == "the largest F is 1.8e-200; allowed: 1e-30 to 1e+30, in other units", said
    for fit in (fit_power, fit_cubic):
        measured = fit(table(MEASURED))
        for length, force in ((1e-29, 1), (1e29, 1), (1e-29, 1e26), (1e29, 1e-29)):
            scaled = fit(table([(delta * length, F * force) for delta, F in MEASURED]))
            at = np.array([0.1, 0.2, 0.3])
            near(scaled.force(at * length) / force, measured.force(at), 1e-4)
            near(scaled.uncertainty(at * length) / force, measured.uncertainty(at), 1e-4)
    said = refusal(fit_power, [(1, 4), (2, 2), (4, 1)])
    assert said == ("the force does not grow with delta, the power law that fits best has n = -1; allowed: a test whose "
                    "force grows"), said
    # delta (delta - 1.5)^2 - 0.1 delta is negative at a third of 4.5.
    said = refusal(fit_cubic, curve_points(10, 0, 4.5, lambda d: d * (d - 1.5)**2 - 0.1 * d))
    assert said == ("the cubic that fits best has F = -0.15 at delta = 1.5; allowed: a test whose cubic is above 0 at a "
                    "third, two thirds and all of its last delta"), said


def check_searches_that_do_not_end():
    """The sums of these fall ever more steeply until contact meets a point, past which only a step is left."""
    hump = [tuple(map(float, line.split(","))) for line in ENDLESS.split()]
    step = [(1, 0.1), (2, 1), (3, 1.02), (4, 1.01), (5, 1.03), (6, 1.04)]  # delta0 at 1 to rounding, n at 0.06
    for points in (hump, step):
        said = refusal(fit_power, points, 4)
        assert said == ("the search for a power law did not end; leave out points before contact and after failure"), said


def call(*words, status=0):
    """Output and messages of the script as a user calls it."""
    run = subprocess.run([ROOT / "scripts/fit_law", *words], capture_output=True, text=True)
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
    Path("line\nbreak.csv").write_text("1,1\n")
    assert call("line\nbreak.csv", "--law", "power", status=2)[1].startswith(r"fit_law: error: line\nbreak.csv: forces"), \
        "a message is one line"


def check_what_is_refused():
    number, columns = "allowed: a number >= 0 with a decimal point", "allowed: two columns, delta and F, parted by"
    for csv, status, message in [
            ("0,0\n1,2\n2,3\n", 2, ": forces > 0 at 2 different delta > 0; allowed: at 3 or more of them"),
            ("0,0\n1,-2\n", 2, f":2: '-2' is not allowed; {number}"),
            ("delta,F\n1,2\n\n# pause\n1,2 N\n", 2, f":5: '2 N' is not allowed; {number}"),
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
    check_exact_laws_are_found()
    check_reference_numbers()
    check_cubic_by_normal_equations()
    check_power_by_differences()
    check_units()
    check_honest_uncertainties()
    check_error_falls_with_the_root_of_the_number_of_points()
    check_bounds()
    check_warnings()
    check_a_law_that_misses_its_points()
    check_refusals()
    check_searches_that_do_not_end()
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
