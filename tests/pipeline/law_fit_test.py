# SPDX-License-Identifier: GPL-3.0-or-later
"""The laws that scripts/python/law_fit.py fits to tests, their uncertainties, warnings and refusals: law_fit_test.py BIN_FOLDER."""
import math
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts/python"))
from law_fit import Failure, fit_cubic, fit_power

# A test of twelve points, its forces rounded.
MEASURED = [(.02, 419), (.03, 693), (.04, 971), (.06, 1386), (.08, 1745), (.1, 1999),
            (.13, 2370), (.16, 2722), (.19, 3117), (.22, 3465), (.26, 3802), (.3, 4110)]
FEW = [(0.1, 12 * 0.05**0.5), (0.2, 12 * 0.15**0.5), (0.3, 12 * 0.25**0.5)]
ENDLESS = "0.25,0.0325\n0.5,0.4588\n0.75,0.6867\n1,0.2878\n"


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


def check_honest_uncertainties(n_tests):
    """One standard uncertainty either side holds the truth in 68 % of all tests, give or take what scatters in so many."""
    random, scatter = np.random.default_rng(1), np.sqrt(0.68 * 0.32 / n_tests)
    inside = np.zeros((2, 3))
    for _ in range(n_tests):
        fit = fit_power(scattered(random, 30, power(*TRUTH)))
        inside[0] += abs(fit.constants - TRUTH) < sigmas(fit)
        fit = fit_cubic(scattered(random, 12, true_cubic))
        inside[1] += abs(fit.force(fit.thirds) - true_cubic(fit.thirds)) < fit.uncertainty(fit.thirds)
    assert (abs(inside / n_tests - 0.68) < 3.8 * scatter).all(), inside


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


def main(_, sweep=None):
    check_exact_laws_are_found()
    check_reference_numbers()
    check_cubic_by_normal_equations()
    check_power_by_differences()
    check_units()
    check_honest_uncertainties(500 if sweep else 60)
    if sweep:
        check_error_falls_with_the_root_of_the_number_of_points()
    check_bounds()
    check_warnings()
    check_a_law_that_misses_its_points()
    check_refusals()
    check_searches_that_do_not_end()


if __name__ == "__main__":
    main(*sys.argv[1:])
