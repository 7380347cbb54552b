# SPDX-License-Identifier: GPL-3.0-or-later
"""What is derived from the forces is the same in another guise too: bearing and net stresses, peaks, bypass, concentrations and margins to
1e-6 of the largest value of their column. Whatever a number means along x it means along y."""
import numpy as np

from bench import Fall

SAME = 1e-6  # of the largest value of a column
ROUNDING = 1e-3  # of the largest in the joint: columns below count as that large, so that 1e-9 of it is nothing
FORCE, STRESS, RATIO = (1, 0), (1, -2), (0, 0)
QUANTITIES = {"bearing_stress": STRESS, "bypass_load": FORCE, "bypass_stress": STRESS, "bypass_across": STRESS, "net_stress": STRESS, "peak_hoop": STRESS,
              "gross_concentration": RATIO, "net_concentration": RATIO, "bearing_concentration": RATIO}


def _differ(guise, what, mine, others, allowed):
    """@param allowed: difference, one for all or one for each."""
    both = np.isfinite(mine) & np.isfinite(others)
    if (np.isfinite(mine) != np.isfinite(others)).any():
        raise Fall(f"{guise.name}: {what} is known in one guise only: {mine} and {others}")
    if (np.abs(np.where(both, mine, 0) - np.where(both, others, 0)) > allowed).any():
        raise Fall(f"{guise.name}: {what} differs, by more than {allowed}: {mine} and {others}")


def _largest(result, names, paths):
    """Largest finite magnitude of datasets of plates, as far as they are there."""
    values = [np.ravel(result[f"plates/{name}/{path}"]) for name in names for path in paths if f"plates/{name}/{path}" in result]
    values = np.abs(np.concatenate(values))
    return values[np.isfinite(values)].max(initial=0)


def compare_holes(guise, original, answers, turns, steps, rounding):
    """Quantities of all holes at an increment of the original and of the guise.

    @param rounding: force below which nothing is known.
    """
    a, b = steps
    floors = {FORCE: _largest(original.result, turns, ("Pe", "disc/bearing", "traction/force")),
              STRESS: _largest(original.result, turns, ("rim/peak_hoop", "rim/bearing_stress")), RATIO: 0}
    if floors[FORCE] < 100 * rounding:
        return
    for name, (own, _) in turns.items():
        of, to = f"plates/{name}/rim/", f"plates/{own}/rim/"
        if of + "hole" not in original.result or not len(original.result[of + "hole"]):
            continue
        order = [list(answers.result[to + "hole"]).index(hole) for hole in original.result[of + "hole"]]
        for quantity, unit in QUANTITIES.items():
            whole, other = original.result[of + quantity], answers.result[to + quantity]
            mine, others = whole[a], other[b][order] / (guise.force ** unit[0] * guise.length ** unit[1])
            allowed = SAME * np.maximum(_largest(original.result, [name], ["rim/" + quantity]), ROUNDING * floors[unit])
            if quantity == "peak_hoop":  # of a mesh so coarse that the error exceeds the peak, rounding is a share of the error
                allowed = np.maximum(allowed, SAME * np.nan_to_num(original.result[of + "peak_error"][a], posinf=0))
            if unit == RATIO:  # none where a section carries less than a thousandth of the load
                others = np.where((mine == 0) | (others == 0), mine, others)
            _differ(guise, f"{quantity} of {name} at increment {a}", mine, others, allowed)


def compare_ranges(guise, original, answers, turns, rounding):
    """Stress ranges, sorted, of a joint that is loaded.

    @param rounding: force below which nothing is known.
    """
    mine, others = (np.sort(result.get("stress_range/range", [])) for result in (original.result, answers.result))
    if len(mine) != len(others):
        raise Fall(f"{guise.name}: {len(mine)} stress ranges and {len(others)}")
    if not len(mine) or _largest(original.result, turns, ("Pe", "disc/bearing", "traction/force")) < 100 * rounding:
        return
    largest = _largest(original.result, turns, ("rim/peak_hoop", "rim/peak_error", "rim/bearing_stress"))  # of a coarse mesh rounding is a share of the error
    _differ(guise, "stress ranges", mine, others / (guise.force ** STRESS[0] * guise.length ** STRESS[1]), SAME * largest)


def compare_margins(guise, original, answers):
    """Margins by check, sorted, since names of sheets change; none of what is not loaded but for rounding."""
    mine, others = (result.get("margin/margin") for result in (original.result, answers.result))
    if mine is None or others is None:
        return
    checks, other_checks = original.result["margin/check"], answers.result["margin/check"]
    for check in sorted(set(checks)):
        if check == "peak" and guise.sign < 0:
            continue  # where the loads pulled they push now, and another spot has the peak
        x, y = (np.sort(values[np.array([each == check for each in names])]) for values, names in ((mine, checks), (others, other_checks)))
        if len(x) != len(y):
            raise Fall(f"{guise.name}: {len(x)} margins of {check} and {len(y)}")
        meant = np.minimum(x, y) < 1000
        _differ(guise, f"margins of {check}", x[meant], y[meant], SAME * (1 + np.abs(x[meant & np.isfinite(x)]).max(initial=0)))
