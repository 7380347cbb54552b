# SPDX-License-Identifier: GPL-3.0-or-later
"""What fell once and was mended: each folder of cases/ has its inputs and case.json, with shell lines, the exit status of
each, and words that it has to print."""
import json
import shutil
from pathlib import Path

from bench import Fall

CASES = Path(__file__).parent / "cases"
LONGEST = 120.0  # seconds of one line


class KeptCases:
    """One round is one case, which its seed chooses: seeds that follow each other go through all of them."""

    def __init__(self, bench):
        self.bench = bench
        self.folders = sorted(path.parent for path in CASES.glob("*/case.json"))

    what = "kept cases"

    def round(self, random, folder):
        case = self.folders[random.seed_of_round % len(self.folders)]
        place = folder / case.name
        shutil.copytree(case, place)
        for step in json.loads((case / "case.json").read_text())["steps"]:
            if self.bench.sanitized and ("ulimit -v" in step["line"] or "ulimit -d" in step["line"]):
                continue  # sanitizers map terabytes
            outcome = self.bench.shell(step["line"], cwd=place, longest=LONGEST)
            words = f"{case.name}: {step['line']}\n  status {outcome.status}, expected {step['status']}\n  {outcome.stderr[-2000:]}"
            if outcome.status != step["status"] or step.get("says", "") not in outcome.stdout + outcome.stderr:
                raise Fall(words + (f"\n  expected to say: {step['says']}" if "says" in step else ""))
        return 1

    def all(self):
        """Number of rounds for every case once."""
        return len(self.folders)
