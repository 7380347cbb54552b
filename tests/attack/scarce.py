# SPDX-License-Identifier: GPL-3.0-or-later
"""Scarce: a run that is denied something - memory, space on the disk, files, threads, streams, rights, a sensible path or
environment - says so in a line and leaves its files as they were, or does all that it was asked to.

A round takes some things to deny at random, each in a folder of its own.
"""
import os
from collections import Counter

import scarce_company
import scarce_limits
import scarce_paths
import scarce_streams
from bench import Fall
from tiny_runs import Chain
from spot import Skipped, Spot

PER_ROUND = 24
ATTACKS = [*scarce_limits.ATTACKS, *scarce_paths.ATTACKS, *scarce_streams.ATTACKS, *scarce_company.ATTACKS]


class Scarce:
    def __init__(self, bench):
        self.skipped = Counter()
        if os.geteuid() == 0:
            bench.scratch.chmod(0o755)  # so that a user without rights can get at the folders of its runs
        self.bench = bench
        self.chain, self.other = Chain(bench, "scarce"), Chain(bench, "scarce-other", E=90000.0)

    @property
    def what(self):
        return "things denied" + "".join(f"\n  {n:5} skipped: {why}" for why, n in self.skipped.most_common())

    def round(self, random, folder):
        things, tried = self.bench.of_round(PER_ROUND), 0
        for i in range(things):
            attack = random.choice(ATTACKS)
            spot = Spot(self.bench, self.chain, self.other, random, folder / f"{i}-{attack.__name__}")
            spot.folder.mkdir()
            self.chain.copy(spot.folder)
            try:
                attack(spot)
                tried += 1
            except Skipped as why:
                self.skipped[f"{attack.__name__}: {why}"] += 1
            except Fall as fall:
                for path in spot.folder.rglob("*"):
                    if path.is_fifo():  # what cannot be copied
                        path.unlink()
                raise Fall(f"{attack.__name__}: {fall}") from fall
        return tried
