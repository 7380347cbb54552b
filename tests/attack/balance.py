# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a result is one of statics: computed anew from MATRICES.h5 and RESULT.h5, apart from the programs.

Each check raises Fall with what is off. Forces are compared with the largest of their increment, to 1e-8 and what the
rounding of displacements times stiffnesses leaves.
"""
import numpy as np

from bench import Fall
from written_files import check_numbers

ALLOWED = 1e-8      # of the largest force of the increment
ROUNDING = 2e-13    # of sums of products of displacements and stiffnesses
AXES = {"x": 0, "y": 1}


def off(what, found, wanted, scale, rounding=0.0, allowed=ALLOWED):
    """Raises Fall if two arrays differ by more than `allowed` of `scale` and the given rounding, or if these are no
    numbers that could be exceeded; returns the ratio beyond the rounding."""
    difference = np.abs(np.asarray(found, float) - wanted)
    limit = allowed * scale + rounding
    if not np.all(np.isfinite(limit)):
        raise Fall(f"{what}: allowed {np.max(limit):.3g}, of {scale:.3g}: nothing could be off")
    bad = difference > limit
    if np.any(bad) or not np.all(np.isfinite(difference)):
        at = np.unravel_index(np.argmax(np.where(np.isfinite(difference), difference, np.inf)), difference.shape)
        raise Fall(f"{what}: off by {difference[at]:.3g} at {tuple(map(int, at))}, of {scale:.3g}; allowed {np.max(limit):.3g}")
    return float(np.max(difference - rounding, initial=0) / scale) if scale else 0.0


def check_finite(result, matrices):
    """NaN and infinite numbers only where the pages of the files say so, and only for the causes that they name."""
    for name, file in [("result", result), *matrices.items()]:
        for path, value in file.data.items():
            if isinstance(value, np.ndarray) and value.dtype.kind == "f":
                check_numbers(file.attributes["format"], name, path, value)
    for plate in result["plate/name"]:
        rim = {key: result.get(f"plates/{plate}/rim/{key}") for key in ("peak_hoop", "peak_angle", "peak_error", "bypass_load", "net_stress",
                                                                         "gross_area", "net_area", "gross_area_y", "net_area_y")}
        if rim["peak_hoop"] is None:
            continue
        unknown = np.isnan(rim["peak_hoop"])
        if (unknown != np.isnan(rim["peak_angle"])).any() or np.isfinite(rim["peak_error"][unknown]).any():
            raise Fall(f"result: {plate}: a peak that is not known has an angle or an error")
        blind = (rim["gross_area"] == 0) | (rim["gross_area_y"] == 0)
        filled = (rim["net_area"] < 0.5 * rim["gross_area"]) | (rim["net_area_y"] < 0.5 * rim["gross_area_y"])
        if np.isinf(rim["bypass_load"])[:, ~blind].any() or np.isinf(rim["net_stress"])[:, ~(blind | filled)].any():
            raise Fall(f"result: {plate}: a stress is not known at a hole that has sections on both axes and does not fill them")


def _isotropic_like(C):
    """The compliance of an isotropic sheet with the same strains under stress along x."""
    a, b = C[0, 0], C[0, 1]
    return np.array([[a, b, 0], [b, a, 0], [0, 0, 2 * (a - b)]])


def _n_waves(order, sweep, tangential):
    """Number of distributions of pressure or shear up to an order around a whole circle, on a rim of the given angle."""
    if abs(sweep - 2 * np.pi) < 1e-9:
        return 2 * order + 1
    return int(order * sweep / np.pi + 1e-9) + (0 if tangential else 1)


class Sheet:
    """One sheet's matrices at the degree of the result, as one stiffness of externals, then discs."""

    def __init__(self, name, file, p):
        self.name, self.file = name, file
        level = list(file["p"]).index(p)
        self.e, self.m = len(file["external/id"]), len(file["disc/hole"])
        S_ed = file["S_ed"][level]
        self.S = np.block([[file["S_ee"][level], S_ed], [S_ed.T, file["S_dd"][level]]])
        self.R = np.vstack([file["R_ef"][level], file["R_df"][level]])
        self.T = np.vstack([file["T_e"][level], file["T_d"][level]])
        self.W = file["W"][level] if "W" in file else np.zeros((0, self.e + self.m))
        self.axis = np.array([AXES[d] for d in file["external/direction"] + file["disc/direction"]], int)
        self.traction_axis = np.array([AXES.get(d, -1) for d in file["traction/direction"]], int)
        self.unsupported = [AXES[d] for d in file["unsupported"]]

    def check_matrices(self):
        """Symmetry, no negative energy, and no force by a motion that no support resists."""
        S, largest = self.S, np.abs(self.S).max(initial=0)
        if largest == 0:
            return
        off(f"{self.name}: S is not symmetric", S, S.T, largest, allowed=1e-13)
        least = np.linalg.eigvalsh((S + S.T) / 2).min()
        if least < -1e-9 * largest:
            raise Fall(f"{self.name}: S has the eigenvalue {least:.3g} beside {largest:.3g}")
        for axis in self.unsupported:
            moved = (self.axis == axis).astype(float)
            off(f"{self.name}: S resists a motion along {'xy'[axis]}", S @ moved, 0, largest, allowed=1e-11)
            self._check_columns(moved, axis)

    def _check_columns(self, moved, axis):
        """Along an axis without supports what discs and externals take is the load with the opposite sign."""
        of_friction, of_tractions = self.resultants(axis)
        largest = np.abs(self.file["friction/resultant"]).max(initial=0) or 1
        off(f"{self.name}: R is out of balance", moved @ self.R, -of_friction, largest)
        off(f"{self.name}: T is out of balance", moved @ self.T, -of_tractions, 1)

    def resultants(self, axis):
        """Forces along an axis of every friction and of every traction of amount 1."""
        file = self.file
        friction = np.array(["xy".index(bearing[1]) for bearing in file["friction/bearing"]], int)
        along, across = file["friction/resultant"], file["friction/resultant_across"]
        of_friction = np.where(friction == axis, along, across) if len(friction) else along
        axes, across = self.traction_axis, file["traction/resultant_across"]
        return of_friction, np.where(axes == axis, 1.0, np.where(axes < 0, 0.0, across)) if len(axes) else across

    def check_rotation(self, p):
        """A floating sheet whose discs move along x and y turns without forces, as far as its elements can follow."""
        file = self.file
        if len(self.unsupported) < 2 or self.e or set(file["disc/direction"]) != {"x", "y"} or p < 4:
            return
        center = file["disc/center"]
        turned = np.where(self.axis == 0, -center[:, 1], center[:, 0])
        turned -= np.where(self.axis == 0, turned[self.axis == 0].mean(), turned[self.axis == 1].mean())
        size = np.abs(turned).max()
        if size > 0:
            off(f"{self.name}: S resists a rotation", self.S @ turned / size, 0, np.abs(self.S).max(), allowed=1e-2)


class Balance:
    """The balance of one result. `check` raises Fall; `worst` is the largest imbalance over the largest force."""

    def __init__(self, matrices, result):
        self.result, self.matrices = result, matrices
        p = int(result.attributes["p"])
        self.sheets = [Sheet(name, matrices[name], p) for name in result["plate/name"]]
        self.p, self.worst = p, 0.0

    def check(self):
        check_finite(self.result, self.matrices)
        for sheet in self.sheets:
            sheet.check_matrices()
            sheet.check_rotation(self.p)
        steps = range(len(self.result["load_factor"]))
        largest = max((self._largest(step) for step in steps), default=0) or 1e-30
        for step in steps:
            # Near no load the programs solve to the forces of gaps, which are of the order of those of the loads.
            small = abs(self.result["load_factor"][step]) < 0.01
            scale = max(self._largest(step), largest if small else 1e-4 * largest)
            for sheet in self.sheets:
                self._check_sheet(sheet, step, scale)
            self._check_fasteners(step, scale)

    def _of(self, sheet, path, step):
        return self.result[f"plates/{sheet.name}/{path}"][step]

    def _largest(self, step):
        """Largest force of all sheets at an increment."""
        return max(np.abs(self._of(sheet, path, step)).max(initial=0) for sheet in self.sheets
                   for path in ("Pe", "disc/bearing", "disc/friction", "traction/force"))

    def _check_sheet(self, sheet, step, scale):
        free = np.concatenate([self._of(sheet, "free/De", step), self._of(sheet, "free/D", step)])
        moved = np.concatenate([self._of(sheet, "De", step), self._of(sheet, "D", step)])
        friction, f = self._of(sheet, "Lambda", step), self._of(sheet, "traction/force", step)
        q = self._waves(sheet, step)
        W = sheet.W[:, :sheet.e + sheet.m]
        outside = sheet.S @ (moved - free) + sheet.R @ friction + sheet.T @ f + W.T @ q
        # Discs of contact take their friction too, of which the waves' part is in W; that of other springs acts on the rim.
        bearing, by_friction = self._of(sheet, "disc/bearing", step), self._of(sheet, "disc/friction", step)
        contact = np.isin(sheet.file["disc/hole"], sheet.file["pressure/hole"]) if "pressure/hole" in sheet.file else False
        given = np.concatenate([self._of(sheet, "Pe", step), bearing + np.where(contact, by_friction, 0)])
        rounding = ROUNDING * (np.abs(sheet.S) @ (np.abs(moved) + np.abs(free))) + 1e-9 * (np.abs(W.T) @ np.abs(q)) + self._of_gaps(sheet)
        where = f"{sheet.name}, increment {step}"
        if not self._couples(sheet):
            self._note(off(f"{where}: forces are not those of the matrices", outside, given, scale, rounding))
            self._check_reactions(sheet, step, outside, scale, rounding.sum())
        on_sheet = np.concatenate([self._of(sheet, "Pe", step), bearing + by_friction])
        for axis in 0, 1:
            loads = on_sheet[:sheet.e][sheet.axis[:sheet.e] == axis].sum() + f[sheet.traction_axis == axis].sum()
            loads += self._across(sheet, f, axis)
            fasteners = on_sheet[sheet.e:][sheet.axis[sheet.e:] == axis].sum()
            self._check_totals(sheet, step, axis, loads, fasteners, scale, rounding.sum())

    def _check_reactions(self, sheet, step, outside, scale, rounding):
        """Supports take what the matrices leave of the forces that they give at the displacements; where discs do not
        move along an axis, the matrices do not have what holds them."""
        for axis in set(sheet.axis[sheet.e:]):
            of_friction, of_tractions = sheet.resultants(axis)
            friction, f = self._of(sheet, "Lambda", step), self._of(sheet, "traction/force", step)
            wanted = -outside[sheet.axis == axis].sum() - of_friction @ friction - of_tractions @ f
            by_supports = self._of(sheet, "total/by_supports", step)[axis]
            off(f"{sheet.name}, increment {step}, {'xy'[axis]}: reaction", by_supports, wanted, scale, rounding)

    def _of_gaps(self, sheet):
        """What rounding leaves of the forces that closing the gaps of contact would take."""
        file, gap = sheet.file, self.result.data.get(f"plates/{sheet.name}/contact/gap")
        radii = file["rim/radius"] if "rim/radius" in file else np.zeros(0)
        least = 1e-16 * np.abs(sheet.S).max(initial=0) * radii.max(initial=0)  # of sheets that no force reaches
        if gap is None or not len(gap):
            return least
        modulus = np.maximum(file["pressure/modulus"], file["pressure/disk_E"] / file["pressure/radius"])
        lengths = np.abs(gap) + 1e-4 * file["pressure/radius"]  # without gaps, of the displacements of a small load
        return max(least, ROUNDING * (lengths * modulus * file["pressure/area"]).max())

    def _waves(self, sheet, step):
        """Amounts of the waves of contact that the elements carry: of each rim those before the shorter waves of the result,
        pressures, then shears."""
        amounts, at, kept = self._of(sheet, "wave/amount", step), 0, []
        if not len(amounts):
            return amounts
        file, result = sheet.file, self.result
        for i, hole in enumerate(file["pressure/hole"]):
            sweep = file["pressure/sweep"][i]
            carried = file["wave/order"][file["wave/hole"].index(hole)]
            for tangential in False, True:
                there, wanted = (_n_waves(order, sweep, tangential)
                                 for order in (result[f"plates/{sheet.name}/wave/order"][i], carried))
                kept.append(amounts[at:at + min(there, wanted)])
                at += there
        if at != len(amounts):
            raise Fall(f"{sheet.name}: {len(amounts)} amounts of waves, {at} by their orders")
        return np.concatenate(kept)

    def _couples(self, sheet):
        """Whether waves of contact shorter than those of the matrices push discs, as in anisotropic sheets, whose closed form
        couples waves of all orders. The matrices alone then do not have all forces."""
        file = sheet.file
        for i, hole in enumerate(file.get("pressure/hole", [])):
            at = file["wave/hole"].index(hole)
            C = file["wave/compliance"][at]
            isotropic = np.abs(C - _isotropic_like(C)).max() <= 1e-9 * np.abs(C).max()
            if self.result[f"plates/{sheet.name}/wave/order"][i] > file["wave/order"][at] and not isotropic:
                return True
        return False

    @staticmethod
    def _across(sheet, f, axis):
        """Force along an axis of tractions in holes that are along the other one."""
        other = (sheet.traction_axis >= 0) & (sheet.traction_axis != axis)
        return float(f[other] @ sheet.file["traction/resultant_across"][other]) if other.any() else 0.0

    def _check_totals(self, sheet, step, axis, loads, fasteners, scale, rounding):
        where = f"{sheet.name}, increment {step}, {'xy'[axis]}"
        off(f"{where}: applied force", self._of(sheet, "total/applied", step)[axis], loads, scale)
        off(f"{where}: force of fasteners", self._of(sheet, "total/by_fasteners", step)[axis], fasteners, scale)
        if axis in sheet.unsupported and np.any(sheet.axis == axis):
            self._note(off(f"{where}: out of balance without supports", loads + fasteners, 0, scale, rounding))

    def _check_fasteners(self, step, scale):
        """The forces of a fastener on its sheets are in balance unless the ground takes a part, and its planes move by
        what their discs do."""
        at, grounded = self._discs(step)
        for fastener, forces in at.items():
            if fastener not in grounded:
                self._note(off(f"fastener {fastener}, increment {step}: its forces do not balance",
                               sum(forces.values()), np.zeros(2), scale))
        result, axes = self.result, [AXES[d] for d in self.result["direction"]]
        places = self._displacements(step)
        size = max(np.abs(result[f"plates/{sheet.name}/D"]).max(initial=0) for sheet in self.sheets)
        size = max(size, 1e-5 * max(sheet.file["rim/radius"].max(initial=0) if "rim/radius" in sheet.file else 0 for sheet in self.sheets))
        for plane, (first, second) in enumerate(zip(result["fastener/first"], result["fastener/second"])):
            a, b = places[first][axes], places[second][axes] if second != "ground" else np.zeros(len(axes))
            off(f"plane {plane}, increment {step}: delta is not that of its discs", result["delta_vector"][step, plane],
                a - b, np.abs(a - b).max(), 1e-12 * size)
            moved, along = result["transferred"][step, plane], result["F"][step, plane]
            off(f"plane {plane}, increment {step}: its two sheets have different loads", moved[0], moved[1], scale)
            if not np.isfinite(along):
                raise Fall(f"plane {plane}, increment {step}: F = {along}")

    def _displacements(self, step):
        """Displacement (x, y) of every disc by "plate:hole"."""
        places = {}
        for sheet in self.sheets:
            for i, (hole, axis) in enumerate(zip(sheet.file["disc/hole"], sheet.axis[sheet.e:])):
                places.setdefault(f"{sheet.name}:{hole}", np.zeros(2))[axis] = self._of(sheet, "D", step)[i]
        return places

    def _discs(self, step):
        """Force (x, y) of every fastener on each of its sheets, and which fasteners go on to the ground."""
        result, of = self.result, {}
        for name, first, second in zip(result["fastener/id"], result["fastener/first"], result["fastener/second"]):
            of.setdefault(name, []).extend(hole for hole in (first, second) if hole not in of.get(name, []))
        forces = {}
        for sheet in self.sheets:
            total = self._of(sheet, "disc/bearing", step) + self._of(sheet, "disc/friction", step)
            for i, (hole, axis) in enumerate(zip(sheet.file["disc/hole"], sheet.axis[sheet.e:])):
                forces.setdefault(f"{sheet.name}:{hole}", np.zeros(2))[axis] += total[i]
        return ({name: {hole: forces[hole] for hole in holes if hole != "ground"} for name, holes in of.items()},
                {name for name, holes in of.items() if "ground" in holes})

    def _note(self, ratio):
        self.worst = max(self.worst, ratio)
