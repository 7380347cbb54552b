# SPDX-License-Identifier: GPL-3.0-or-later
"""Power and cubic laws fitted to the points of a fastener's test, for fit_law."""
import math
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import least_squares

LOW, HIGH = 1e-30, 1e30  # squares and powers of what is outside overflow
CLOSE = 0.05  # RMS residual over the greatest force above which a law misses its points
ON_BOUND = 1e-9  # of scaled constants: what a search of exact points leaves
FLAT = 0.01  # a power law of a smaller n is a step


class Failure(Exception):
    """One sentence for the user, the line of the file that it is about (or None) and the exit status."""

    def __init__(self, sentence, line=None, status=2):
        super().__init__(sentence)
        self.line, self.status = line, status


@dataclass
class Fit:
    """A law fitted to the points of a test, with standard uncertainties: residual variance of the points past contact times
    the inverse of J^T J, J the derivatives by the constants. Bates & Watts, Nonlinear Regression Analysis and its
    Applications, Wiley 1988, section 2.2."""
    law: str
    constants: np.ndarray  # power: A, n, delta0 of A (delta - delta0)^n; cubic: a, b, c of a delta + b delta^2 + c delta^3
    free: np.ndarray  # shape (3), false where power holds n at 1, delta0 at 0 or at the last point without force
    last: float  # greatest delta, length
    n_points: int
    rms: float = 0  # root of the mean square of the residuals, force
    has_uncertainty: bool = False  # false with no more points past contact than free constants
    covariance: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))  # zero in rows of what is held
    warnings: list = field(default_factory=list)  # one sentence each

    def force(self, delta):
        return power(self.constants, delta) if self.law == "power" else cubic_gradient(delta) @ self.constants

    def uncertainty(self, delta):
        """Standard uncertainty of the force; 0 before contact."""
        J = power_gradient(self.constants, delta) if self.law == "power" else cubic_gradient(delta)
        return np.sqrt(np.maximum(np.einsum("ij,jk,ik->i", J, self.covariance, J), 0))

    @property
    def contact(self):
        """Displacement up to which the law has no force."""
        return self.constants[2] if self.law == "power" else 0

    @property
    def thirds(self):
        """The three displacements by which a cubic is written."""
        return self.last * np.array([1, 2, 3]) / 3


def require_enough(points):
    """Raises Failure for points (delta, F, line of the file), shape (n, 3), that no law fits."""
    n = len(np.unique(points[(points[:, 0] > 0) & (points[:, 1] > 0), 0]))
    if n < 3:
        raise Failure(f"forces > 0 at {n} different delta > 0; allowed: at 3 or more of them")
    for name, column in (("delta", 0), ("F", 1)):
        largest = points[points[:, column].argmax()]
        if not LOW <= largest[column] <= HIGH:
            raise Failure(f"the largest {name} is {largest[column]:g}; allowed: {LOW:g} to {HIGH:g}, in other units",
                          int(largest[2]))


def power(c, x):
    """A (x - delta0)^n, and 0 up to delta0."""
    F, past = np.zeros(len(x)), x > c[2]
    F[past] = c[0] * (x[past] - c[2]) ** c[1]
    return F


def power_gradient(c, x):
    """Derivatives by A, n and delta0, shape (n, 3); 0 up to delta0."""
    J, past = np.zeros((len(x), 3)), x > c[2]
    u = x[past] - c[2]
    J[past] = np.column_stack([u ** c[1], c[0] * u ** c[1] * np.log(u), -c[0] * c[1] * u ** (c[1] - 1)])
    return J


def cubic_gradient(x):
    """Derivatives by a, b and c, shape (n, 3)."""
    return x[:, None] ** np.array([1, 2, 3])


def inverse_of_square(J):
    """Inverse of J^T J."""
    half = np.linalg.pinv(J)
    return half @ half.T


@dataclass
class Search:
    """Where the sum of squares of scaled points is least."""
    free: np.ndarray
    constants: np.ndarray
    square_sum: float
    ended: bool


def start_from_grid(x, y, free, least):
    """The best of a grid of n and delta0, each with the A that suits it: least squares may have several valleys."""
    half = min(x[y >= 0.5], default=1)  # contact comes before half of the greatest force
    trials = [(1, n, delta0) for delta0 in (least + (half - least) * np.arange(40 if free[2] else 1) / 40)
              for n in (np.arange(1, 11) / 10 if free[1] else [1])]
    shapes = np.array([power(trial, x) for trial in trials])
    A = shapes @ y / (shapes**2).sum(axis=1)
    best = ((A[:, None] * shapes - y) ** 2).sum(axis=1).argmin()
    return np.array([A[best], *trials[best][1:]])


def at_right_angles(f, J, c):
    """Whether residuals have no part along their derivatives; those of rounding have no direction."""
    small_cosine, rounding = 1e-5, 1e-12
    lengths = np.linalg.norm(J, axis=0)
    return bool(np.linalg.norm(f) <= rounding * lengths @ abs(c)
                or (abs(J.T @ f) <= small_cosine * np.linalg.norm(f) * lengths).all())


def search(x, y, free, least):
    """Least squares of a power law by Levenberg and Marquardt, with what is not free held at n = 1, delta0 = least."""
    free = np.array(free)
    start = start_from_grid(x, y, free, least)

    def whole(some):
        c = start.copy()
        c[free] = some
        return c

    done = least_squares(lambda some: power(whole(some), x) - y, start[free],
                         lambda some: power_gradient(whole(some), x)[:, free], method="lm", x_scale="jac", xtol=1e-15,
                         ftol=1e-15, gtol=1e-15, max_nfev=1000)
    c = whole(done.x)
    step = ((abs(x - c[2]) < ON_BOUND) & (y > 0)).any()  # where contact meets a point with force, laws run away to a step
    return Search(free, c, 2 * done.cost, at_right_angles(done.fun, done.jac, done.x) and not step)


@np.errstate(all="ignore")  # a search that strays comes to nothing, which at_right_angles sees
def search_power(x, y, least):
    """The best of the searches whose constants are inside their bounds, with as few held as need be."""
    def inside(found):
        _, n, delta0 = found.constants
        return (not found.free[1] or n < 1 - ON_BOUND) and (not found.free[2] or delta0 > least + ON_BOUND)

    best = search(x, y, (True, True, True), least)
    if not inside(best):
        best = search(x, y, (True, False, False), least)
        for free in ((True, False, True), (True, True, False)):
            found = search(x, y, free, least)
            if inside(found) and found.square_sum < best.square_sum:
                best = found
    if not best.ended:
        raise Failure("the search for a power law did not end; leave out points before contact and after failure",
                      status=4)
    if best.constants[1] < FLAT:
        raise Failure(f"the force does not grow with delta, the power law that fits best has n = {best.constants[1]:.3g}; "
                      "allowed: a test whose force grows")
    return best


def weigh(fit, points, inverse):
    """Sets what both laws have in common. inverse: of J^T J of the constants, shape (3, 3)."""
    delta, F, _ = points.T
    squares = (fit.force(delta) - F) ** 2
    fit.rms = math.sqrt(squares.mean())
    past, n_free = delta > fit.contact, fit.free.sum()
    if past.sum() > n_free:
        fit.has_uncertainty = True
        fit.covariance = squares[past].sum() / (past.sum() - n_free) * inverse
    else:
        fit.warnings.append(f"there is no uncertainty: that of {n_free} constants takes {n_free + 1} points past contact "
                            f"or more, and the test has {past.sum()}")
    miss = fit.rms / F.max()
    if miss > CLOSE:
        fit.warnings.append(f"the law misses its points by {100 * miss:.2g} % of the largest force (RMS): their curve may "
                            "be of another kind (several slopes, yield, slip); look at the picture (-o), leave out points "
                            'after failure, or take a "table" law, which takes the points as they are')


def fit_power(points):
    """Fit with 0 < n <= 1, delta0 >= 0; points before the first force only say that delta0 is not less.

    points: delta, F, line of the file, shape (n, 3). Raises Failure."""
    require_enough(points)
    delta, F, _ = points.T
    last, greatest = delta.max(), F.max()
    contact = max(delta[(F == 0) & (delta < delta[F > 0].min())], default=0)
    used = (delta > 0) & ((delta > contact) | (F > 0))
    x, y = delta[used] / last, F[used] / greatest  # so that constants are of order 1
    found = search_power(x, y, contact / last)
    A, n, delta0 = found.constants
    unit = greatest / last**n
    fit = Fit("power", np.array([A * unit, n, delta0 * last]), found.free, last, len(points))
    if not found.free[1]:
        fit.warnings.append("n is on its bound 1: the points rise as a line or steeper and steeper")
    scale = np.diag([unit, 1, last]) / greatest  # derivatives of A, n, delta0 by the scaled constants, over the force
    scale[0, 1] = -A * unit * math.log(last) / greatest
    inverse = np.zeros((3, 3))
    inverse[np.ix_(found.free, found.free)] = inverse_of_square(power_gradient(found.constants, x)[:, found.free])
    weigh(fit, points, scale @ inverse @ scale.T)
    return fit


def slope_warning(fit):
    """A sentence if the cubic does not rise everywhere, else nothing."""
    a, b, c = fit.constants
    candidates = [0, fit.last] + ([-b / (3 * c)] if c != 0 and 0 < -b / (3 * c) < fit.last else [])
    slope, delta = min((a + 2 * b * x + 3 * c * x**2, x) for x in candidates)
    return [] if slope > 0 else [
        f"the cubic does not rise everywhere up to its last delta {fit.last:g}: its slope at delta = {delta:.4g} is "
        f"{slope:.4g}; the joint may have more than one solution"]


def fit_cubic(points):
    """Fit of a delta + b delta^2 + c delta^3 to points (delta, F, line of the file), shape (n, 3). Raises Failure."""
    require_enough(points)
    delta, F, _ = points.T
    last, greatest = delta.max(), F.max()
    J = cubic_gradient(delta[delta > 0] / last)
    unit = cubic_gradient(np.array([1 / last]))[0]
    constants = greatest * unit * (np.linalg.pinv(J) @ (F[delta > 0] / greatest))
    fit = Fit("cubic", constants, np.full(3, True), last, len(points))
    for at, force in zip(fit.thirds, fit.force(fit.thirds)):
        if not force > 0:
            raise Failure(f"the cubic that fits best has F = {force:.4g} at delta = {at:.4g}; allowed: a test whose cubic "
                          "is above 0 at a third, two thirds and all of its last delta")
    weigh(fit, points, unit[:, None] * inverse_of_square(J) * unit)
    fit.warnings += slope_warning(fit)
    return fit
