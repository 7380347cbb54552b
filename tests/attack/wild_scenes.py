# SPDX-License-Identifier: GPL-3.0-or-later
"""Random valid scenes through the three programs: their results balance, or they end with status 4 and say why."""
import json
import re
import shutil
from collections import Counter

from balance import Balance
from bench import ROOT, Fall
from chain import Chain, Refused, Slow
from ends import Ends
from force_laws import check_laws
from wild_joints import is_contact, random_scene

SCENES = 6  # of a round


def documented_codes():
    """Codes of warnings in the table of docs/results.md."""
    text = (ROOT / "docs/results.md").read_text().split("## Warnings")[1].split("\n## ")[0]
    return set(re.findall(r"^\| `([a-z0-9-]+)` \|", text, re.M))


def _any_law(scene, test):
    return any(test(law) for law in scene.joint["laws"].values())


def _falls(scene):
    """Whether forces may fall between increments, or in a case after another."""
    return any(isinstance(case.get("increments", 1), list) or "after" in case for case in scene.cases()) or _may_pass_by(scene)


def _may_pass_by(scene):
    """Whether a fastener may unload while loads grow: by gaps, interference, offsets, yield or temperature."""
    joint = scene.joint
    return (len(joint["fasteners"]) > 1 or any("gap" in f or "offset" in f for f in joint["fasteners"])
            or "temperatures" in json.dumps(joint))


def _has_friction(scene):
    return any("friction" in fastener for fastener in scene.joint["fasteners"])


def _has_play(scene):
    """Free motion: gaps, clearances, laws that begin late or slip or give no more."""
    return any("gap" in f or "clearance" in f for f in scene.joint["fasteners"]) or _any_law(
        scene, lambda law: "delta0" in law or "slip" in law or law.get("one_sided") or law["type"] == "table") or any(
        is_contact(hole) for hole in scene.holes().values())


def _has_quarter(scene):
    """Whether a sheet has a quarter of a hole, whose springs are on one side only."""
    return any(len(plate["disc_directions"]) == 1 and len(plate["supports"]) > 1 for plate in scene.plates.values())


# What must be so in a scene for a warning; a code that is not here says nothing that is checked cheaply.
CAUSES = {
    "beyond-last-point": lambda s: _any_law(s, lambda law: law["type"] in ("table", "cubic")),
    "bearing-twice": lambda s: _any_law(s, lambda law: law["type"] == "formula"),
    "crack-closes": lambda s: any(plate.get("cracks") for plate in s.plates.values()),
    "cubic-falls": lambda s: _any_law(s, lambda law: law["type"] == "cubic"),
    "disc-held-across": lambda s: any(len(plate["disc_directions"]) == 1 for plate in s.plates.values()),
    "disc-modulus-unlikely": lambda s: any("disk" in hole.get("spring", {}) for hole in s.holes().values()),
    "exponent-low": lambda s: _any_law(s, lambda law: law.get("n", 1) < 0.5),
    "formula-sheets-unlike": lambda s: _any_law(s, lambda law: law["type"] == "formula"),
    "formula-shear-unlike": lambda s: _any_law(s, lambda law: law["type"] == "formula"),
    "free-within-gaps": _has_play,
    "friction-against-slip": _has_friction,
    "friction-off-axes": _has_friction,
    "friction-turns": lambda s: _has_friction(s) and _falls(s),
    "friction-unlikely": lambda s: False,
    "gap-unlikely": lambda s: any("gap" in f or "clearance" in f or "offset" in f for f in s.joint["fasteners"]),
    "hole-diameter-unlike": lambda s: False,
    "hole-filled": lambda s: any("clearance" in f for f in s.joint["fasteners"]),
    "holes-apart": lambda s: False,
    "laminate-couples": lambda s: any("plies" in m for plate in s.plates.values() for m in plate["materials"].values()),
    "permanent-set": _falls,
    "plate-soft": lambda s: len(s.plates) > 1,
    "rim-sticks": _has_friction,
    "self-locking": _has_friction,
    "several-solutions": lambda s: _any_law(s, lambda law: law["type"] == "cubic"),
    "unstable-balance": lambda s: _has_friction(s) or _any_law(s, lambda law: law["type"] == "cubic"),
    "springs-at-nodes": lambda s: any("at" in hole or "links" in hole["spring"] for hole in s.holes().values()),
    "springs-wrong-arc": lambda s: any("arc" in hole.get("spring", {}) for hole in s.holes().values()) or _has_quarter(s),
    "springs-pull": lambda s: not all(is_contact(hole) for hole in s.holes().values()),
}


class WildScenes:
    """Scenes whose results are held to statics by their own matrices (balance.py)."""

    def __init__(self, bench):
        self.chain = Chain(bench)
        self.codes = documented_codes()
        self.ends, self.warned, self.solved, self.worst = Ends(), Counter(), 0, 0.0

    @property
    def what(self):
        """What was tried, and a table of the failures with a message by their first words."""
        lines = [f"wild scenes, {self.solved} solved, worst imbalance {self.worst:.1e} of the largest force"]
        lines += self.ends.lines()
        lines += ["  warnings: " + ", ".join(f"{code} {n}" for code, n in sorted(self.warned.items()))]
        return "\n".join(lines)

    def round(self, random, folder):
        scenes = self.chain.bench.of_round(SCENES)
        for k in range(scenes):
            place = folder / f"scene{k}"
            self.one(random_scene(random), place)
            shutil.rmtree(place)
        return scenes

    def one(self, scene, place):
        """One scene; what is left in its folder is kept if it falls."""
        self.ends.tried += 1
        try:
            matrices, result, codes = self.chain.scene(place, scene)
        except Refused as refused:
            self.ends.refused(refused, scene)
            return
        except Slow:
            self.ends.slow()
            return
        if not int(result.attributes["complete"]):
            raise Fall("status 0 of a result that is not complete")
        self.solved += 1
        self._check_warnings(scene, codes, result)
        balance = Balance(matrices, result)
        balance.check()
        check_laws(scene, result)
        self.worst = max(self.worst, balance.worst)

    def check_counts(self):
        self.ends.check()

    def _check_warnings(self, scene, codes, result):
        self.warned.update(codes)
        unknown = set(codes) - self.codes
        if unknown:
            raise Fall(f"warnings that docs/results.md does not have: {sorted(unknown)}")
        written = set(result["warning/code"])
        if not written <= set(codes):
            raise Fall(f"warnings in the file that were not printed: {sorted(written - set(codes))}")
        for code in set(codes):
            if not CAUSES.get(code, lambda s: True)(scene):
                raise Fall(f"warning [{code}] without its cause")
