# SPDX-License-Identifier: GPL-3.0-or-later
"""The kinds of attack. Each class takes the bench, says in `what` what it counts, and `round(random, folder)` does one
round in an empty folder, raises Fall, and returns how many of them it tried."""
from damaged_hdf5 import DamagedHdf5
from killed_studies import KilledStudies
from kept_cases import KeptCases
from kills import Kills
from same_answers import SameAnswers
from scarce import Scarce
from wild_scenes import WildScenes
from words import Words

KINDS = {"cases": KeptCases, "words": Words, "hdf5": DamagedHdf5, "scenes": WildScenes, "invariance": SameAnswers,
         "kills": Kills, "scarce": Scarce, "studies": KilledStudies}
