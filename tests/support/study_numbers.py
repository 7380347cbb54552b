# SPDX-License-Identifier: GPL-3.0-or-later
"""The random numbers of a study by numpy's Philox and Python's own functions, from what docs/studies.md says."""
import math
from statistics import NormalDist

import numpy as np

NORMAL = NormalDist()
# Of the middle of the normal distribution (Wichura 1988, AS 241), which GSL multiplies by q at the end, Python before it divides.
ABOVE = (2509.0809287301226727, 33430.575583588128105, 67265.770927008700853, 45921.953931549871457, 13731.693765509461125,
         1971.5909503065514427, 133.14166789178437745, 3.387132872796366608)
BELOW = (5226.495278852854561, 28729.085735721942674, 39307.89580009271061, 21213.794301586595867, 5394.1960214247511077,
         687.1870074920579083, 42.313330701600911252, 1.0)


def polynomial(coefficients, x):
    result = coefficients[0]
    for each in coefficients[1:]:
        result = x * result + each
    return result


def normal(u):
    """What gsl_cdf_ugaussian_Pinv gives, to the last bit."""
    q = u - 0.5
    if abs(q) > 0.425:
        return NORMAL.inv_cdf(u)
    r = 0.180625 - q * q
    return q * (polynomial(ABOVE, r) / polynomial(BELOW, r))


def word(seed, *counter):
    """First word of Philox4x64-10 with the key (seed, 0); numpy adds 1 to the counter before it begins."""
    counter = sum(part << (64 * i) for i, part in enumerate(counter))
    before = (counter - 1) % 2**256
    parts = np.array([before >> (64 * i) & (2**64 - 1) for i in range(4)], dtype=np.uint64)
    return int(np.random.Philox(key=np.array([seed, 0], dtype=np.uint64), counter=parts).random_raw())


def share(seed, sample, variable):
    return ((word(seed, sample, variable) >> 12) + 0.5) / 2**52


def place(seed, sample, variable, n):
    """The sample's stratum of a Latin hypercube: a Feistel cipher of six rounds."""
    half = 1
    while 4**half < n:
        half += 1
    mask = 2**half - 1
    at = sample
    while True:
        left, right = at >> half, at & mask
        for rounds in range(1, 7):
            left, right = right, left ^ (word(seed, right, variable, rounds) & mask)
        at = left << half | right
        if at < n:
            return at


def value(distribution, u):
    """The value below which a share u of a distribution of STUDY.json lies."""
    kind, low, high = distribution["type"], distribution.get("from"), distribution.get("to")
    if kind == "uniform":
        return low + u * (high - low)
    if kind == "triangular":
        mode, width = distribution["mode"], high - low
        if u * width <= mode - low:
            return low + math.sqrt(u * width * (mode - low))
        return high - math.sqrt((1 - u) * width * (high - mode))
    if kind == "discrete":
        weights = distribution.get("weights", [1.0] * len(distribution["values"]))
        sums = np.cumsum(weights)
        return distribution["values"][min(int(np.searchsorted(sums / sums[-1], u, side="right")), len(weights) - 1)]
    mean, deviation = distribution["mean"], distribution["deviation"]
    if kind == "lognormal":
        variance = math.log1p((deviation / mean)**2)
        mean, deviation = math.log(mean) - variance / 2, math.sqrt(variance)
    x = mean + deviation * normal(u)
    return math.exp(x) if kind == "lognormal" else x
