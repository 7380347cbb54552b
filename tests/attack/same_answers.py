# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene in two guises (guises.py) gives the same answers: S to 1e-8 of its largest entry, or to what its file says that
rounding may change, and displacements and forces to 1e-6 of the largest. Contact is judged at points of a rim that are
counted from the x axis: turned by any angle, a rim of few waves has others. A joint of four waves then changed by 1.6e-6 of
its largest force, which was 0.46 N (2.4e-4) off that of 32 waves, and with 32 waves by 5e-8; joints in contact turned so are held to 1e-5.
"""
import json
from collections import Counter

import numpy as np

import any_angle
import guises
import same_derived
from bench import Fall
from chain import Chain, File, Refused, Slow
from ends import Ends, first_words
from wild_joints import is_contact, random_scene, remembers

SAME_S, SAME_RESULT, SAME_TURNED_RESULT = 1e-8, 1e-6, 1e-5
# Warnings with which the solution may be another one in another guise: laws that fall, and friction that holds itself.
DOUBTFUL = {"several-solutions", "unstable-balance", "self-locking", "limit-load", "rim-sticks"}


def _same_mesh(shape, other):
    return len(shape) == len(other) and np.abs(shape - other).max() <= 1e-9 * shape.max()


def _keys(sheet, file):
    """Names of the displacements that S goes with, externals, then discs."""
    return [(sheet, "external", name) for name in file["external/id"]] + [
        (sheet, "disc", hole, axis) for hole, axis in zip(file["disc/hole"], file["disc/direction"])]


def _stiffness(file, level):
    S_ed = file["S_ed"][level]
    return np.block([[file["S_ee"][level], S_ed], [S_ed.T, file["S_dd"][level]]])


def _shape(nodes):
    """Distances of the nodes of a mesh from their mean, ascending: the same however it is turned, mirrored or numbered."""
    return np.sort(np.hypot(*(nodes - nodes.mean(axis=0)).T))


class Answers:
    """What the programs say of a scene, in the places of another scene's displacements."""

    def __init__(self, chain, folder, scene):
        self.sheets, self.result, self.codes = chain.scene(folder, scene)
        solved = {name: File(folder / f"{name}.h5") for name in scene.plates}
        self.rounding = {name: float(file["probe/rounding"][0]) for name, file in solved.items()}
        self.shape = {name: _shape(file["mesh/nodes"]) for name, file in solved.items()}

    def turn(self, guise, original, sheet):
        """Matrix whose columns are the images of the original's displacements of a sheet among those of this one."""
        mine = {key: i for name, file in self.sheets.items() for i, key in enumerate(_keys(name, file))}
        names = _keys(sheet, original.sheets[sheet])
        images = [guise.image(key) for key in names]
        own = next(iter(images[0]))[0] if images else sheet
        Q = np.zeros((len(_keys(own, self.sheets[own])), len(names)))
        for column, image in enumerate(images):
            for key, coefficient in image.items():
                Q[mine[key], column] = coefficient
        return own, Q


def _steps(result):
    """Rows of the result by (name of case, number in it), and the last row of each case."""
    rows, last = {}, {}
    for row, case in enumerate(result["case/of"]):
        name = result["case/name"][case]
        rows[name, len([key for key in rows if key[0] == name])] = last[name] = row
    return rows, last


class SameAnswers:
    def __init__(self, bench):
        self.chain = Chain(bench)
        self.tried, self.explained, self.originals, self.guises = Counter(), Counter(), Ends(), Ends()
        self.worst_S, self.worst_result = 0.0, 0.0

    @property
    def what(self):
        ends = self.guises.counts
        lines = [f"scenes in other guises, S the same to {self.worst_S:.1e} and results to {self.worst_result:.1e}; of "
                 f"{ends['doubtful']} the solution is not the only one, {ends['another end']} ended with status 4 in "
                 f"one guise, {ends['another mesh']} had another mesh; of {self.originals.tried} scenes"]
        lines += [f"  {n:5} {name}, in {self.explained[name]} S differs by more than {SAME_S:g} but within its rounding"
                  for name, n in self.tried.most_common()]
        return "\n".join(lines + self.originals.lines() + self.guises.lines())

    def check_counts(self):
        self.originals.check()
        self.guises.check()

    def round(self, random, folder):
        scene = random_scene(random)
        choices = [lambda s: guises.in_units(s, random.choice(list(guises.SYSTEMS))), lambda s: guises.renumbered(s, random),
                   lambda s: guises.moved(s, guises.QUARTER_TURN), lambda s: guises.moved(s, guises.MIRROR)]
        if any("one_sided" in law for law in scene.joint["laws"].values()):
            del choices[3]
        if "cases" in scene.joint:
            choices.append(lambda s: guises.reordered_cases(s, random))
        if _is_odd(scene):
            choices.append(guises.reversed_loads)
        if _has_no_past(scene):
            choices.append(guises.halved_increments)
        pairs = any_angle.loads_in_pairs(scene)
        if pairs and random.random() < 0.8:
            scene, choices = pairs, [lambda s: any_angle.turned(s, random.uniform(-180, 180))]
        self.originals.tried += 1
        try:
            original = Answers(self.chain, folder / "original", scene)
        except Refused as refused:
            self.originals.refused(refused, scene)
            if refused.status == 4:
                self.must_end_alike(random.choice(choices)(scene), folder / "guise", refused)
            return 0
        except Slow:
            self.originals.slow()
            return 0
        if random.random() < 0.2:
            return self.all_units(scene, original, folder)
        chosen = random.sample(choices, min(3, len(choices)))
        for k, make in enumerate(chosen):
            self.compare(make(scene), original, folder / f"guise{k}")
        return len(chosen)

    def all_units(self, scene, original, folder):
        """The scene in all systems of units."""
        for system in guises.SYSTEMS:
            self.compare(guises.in_units(scene, system), original, folder / system.replace("/", "-"))
        return len(guises.SYSTEMS)

    def must_end_alike(self, guise, folder, refused):
        """Of a scene that is refused with status 4: counts a guise that is solved, unless its codes are doubtful."""
        self.guises.tried += 1
        try:
            answers = Answers(self.chain, folder, guise.scene)
        except (Refused, Slow):
            return
        if not set(answers.codes) & DOUBTFUL:
            self.guises.count("another end", f"{guise.name} solved, the original not: {first_words(refused)}")

    def compare(self, guise, original, folder):
        folder.mkdir(exist_ok=True)
        (folder / "guise.txt").write_text(guise.name + "\n")
        kind = "turned by any angle" if _is_by_any_angle(guise) else guise.name
        self.tried[kind] += 1
        self.guises.tried += 1
        try:
            answers = Answers(self.chain, folder, guise.scene)
        except Refused as refused:
            if refused.status != 4:
                raise Fall(f"{guise.name}: refused, but not the original: {refused}") from refused
            name = "doubtful" if set(original.codes) & DOUBTFUL else "another end"
            self.guises.count(name, f"{kind}, the original not: {first_words(refused)}")
            return
        except Slow:
            self.guises.slow(f"{kind}: ")
            return
        turns = {name: answers.turn(guise, original, name) for name in original.sheets}
        if not all(_same_mesh(original.shape[name], answers.shape[own] / guise.length) for name, (own, _) in turns.items()):
            # Where rays of two holes meet a common side, the mesher takes those of the first.
            self.guises.count("another mesh", "another mesh")
            return
        for name in original.sheets:
            self._compare_stiffness(guise, original, answers, name, turns[name], kind)
        if (set(answers.codes) | set(original.codes)) & DOUBTFUL:
            self.guises.count("doubtful", "a solution that is not the only one")
            return
        self._compare_results(guise, original, answers, turns)

    def _compare_stiffness(self, guise, original, answers, name, turn, kind):
        own, Q = turn
        factor = guise.force / guise.length
        rounding = original.rounding[name] + answers.rounding[own] / factor
        for level in range(len(original.sheets[name]["p"])):
            S = _stiffness(original.sheets[name], level)
            other = Q.T @ _stiffness(answers.sheets[own], level) @ Q / factor
            largest = np.abs(S).max(initial=0)
            difference = np.abs(other - S).max(initial=0)
            if difference > max(SAME_S * largest, rounding):
                p = original.sheets[name]["p"][level]
                raise Fall(f"{guise.name}: S of {name} at p = {p} differs by {difference / largest:.2e} of its largest entry; "
                           f"rounding may be {rounding / largest:.2e}")
            if difference > SAME_S * largest:
                self.explained[kind] += 1
            elif largest:
                self.worst_S = max(self.worst_S, difference / largest)

    def _compare_results(self, guise, original, answers, turns):
        (mine, my_last), (other, other_last) = _steps(original.result), _steps(answers.result)
        factors = original.result["load_factor"], answers.result["load_factor"]
        ends_only = mine.keys() != other.keys() or guise.name == "increments halved" or any(
            abs(factors[0][mine[k]] - factors[1][other[k]]) > 1e-9 for k in mine)  # events are found to 1e-6 or so
        pairs = [(my_last[name], other_last[name]) for name in my_last] if ends_only else [(mine[k], other[k]) for k in mine]
        free = "free-within-gaps" in set(original.codes) | set(answers.codes)
        for a, b in pairs:
            self._compare_step(guise, original, answers, turns, a, b, free)
            if not _is_by_any_angle(guise) and guise.sign > 0 and not free:
                same_derived.compare_holes(guise, original, answers, turns, (a, b), _rounding_of_forces(original))
        if not ends_only and not free and not _is_by_any_angle(guise):
            same_derived.compare_margins(guise, original, answers)
            if guise.sign > 0:
                same_derived.compare_ranges(guise, original, answers, turns, _rounding_of_forces(original))

    def _compare_step(self, guise, original, answers, turns, a, b, free):
        factors = {"force": guise.force * guise.sign, "length": guise.length * guise.sign}
        kinds = [("forces", "force", ("Pe",), ("disc/bearing", "disc/friction"))]
        kinds += [] if free else [("displacements", "length", ("De",), ("D",))]
        for what, unit, at_externals, at_discs in kinds:
            values, others = [], []
            for name, (own, Q) in turns.items():
                known = what == "forces" or _is_known(original, name, a)
                values.append(_vector(original.result, name, at_externals, at_discs, a) * known)
                others.append(Q.T @ _vector(answers.result, own, at_externals, at_discs, b) / factors[unit] * known)
            x, y = np.concatenate(values), np.concatenate(others)
            whole = np.abs(np.concatenate([_vector(original.result, name, at_externals, at_discs, slice(None)).ravel()
                                           for name in turns])).max(initial=0)
            applied = max(np.abs(original.result[f"plates/{name}/traction/force"]).max(initial=0) for name in turns)
            least = 1e-4 * max(whole, applied) if what == "forces" else 1e-4 * whole
            scale = max(np.abs(x).max(initial=0), least, _rounding_of_forces(original) if what == "forces" else 0) or 1.0
            ratio = np.abs(x - y).max(initial=0) / scale
            if not ratio <= (SAME_TURNED_RESULT if _has_other_points(guise) else SAME_RESULT):
                raise Fall(f"{guise.name}: {what} of increment {a} differ by {ratio:.2e} of the largest, {scale:.3g}: "
                           f"{json.dumps([float(v) for v in x])[:300]} and {json.dumps([float(v) for v in y])[:300]}")
            self.worst_result = max(self.worst_result, ratio)


def _is_by_any_angle(guise):
    return guise.name.startswith("turned by") and "90 " not in guise.name


def _has_other_points(guise):
    """Whether contact is judged at other points of the rims."""
    return _is_by_any_angle(guise) and any(is_contact(hole) for hole in guise.scene.holes().values())


def _rounding_of_forces(original):
    """Forces below which nothing is known: 1e-8 of stiffnesses times displacements, of which 1e-6 is told apart."""
    largest = 0.0
    for name, file in original.sheets.items():
        moved = [np.abs(original.result[f"plates/{name}/{path}"]).max(initial=0) for path in ("D", "De")]
        largest = max(largest, np.abs(_stiffness(file, -1)).max(initial=0) * max(moved))
    return 1e-8 * largest


def _is_known(original, name, step):
    """1 for displacements of discs that a force beyond rounding holds in place, and of externals of sheets with supports or
    such a disc or force, else 0: a fastener without force lies anywhere within its gaps, and so does a sheet."""
    result, of = original.result, f"plates/{name}/"
    forces = np.abs(result[of + "disc/bearing"][step]) + np.abs(result[of + "disc/friction"][step])
    every = max(np.abs(result[f"plates/{other}/{path}"]).max(initial=0) for other in original.sheets
                for path in ("disc/bearing", "Pe", "traction/force"))
    holes = original.sheets[name]["disc/hole"]
    of_hole = {hole: max(f for f, other in zip(forces, holes) if other == hole) for hole in holes}
    held = [of_hole[hole] > 1e-6 * every for hole in holes]
    loaded = any(held) or np.abs(result[of + "Pe"][step]).max(initial=0) > 1e-6 * every
    placed = loaded or not len(original.sheets[name]["unsupported"])
    return np.array([placed] * len(result[of + "De"][step]) + held, float)


def _vector(result, name, at_externals, at_discs, step):
    """Sums of the datasets of externals, then of discs, at one increment (or several: the last axis)."""
    of = f"plates/{name}/"
    parts = [sum(result[of + path][step] for path in paths) for paths in (at_externals, at_discs)]
    return np.concatenate(parts, axis=-1)


def _is_odd(scene):
    """Whether reversed loads reverse all answers: nothing that bears one way, no friction, no state without loads."""
    text = json.dumps(scene.joint)
    plain = not any(word in text for word in ("one_sided", "friction", "temperature", "offset", ":B"))
    return plain and not any(is_contact(hole) for hole in scene.holes().values())


def _has_no_past(scene):
    """Whether the end does not depend on the way."""
    return "friction" not in json.dumps(scene.joint) and not any(remembers(law) for law in scene.joint["laws"].values())
