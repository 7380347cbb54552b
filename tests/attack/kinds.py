# SPDX-License-Identifier: GPL-3.0-or-later
"""The kinds of attack. Each class takes the bench, says in `what` what it counts, and `round(random, folder)` does one
round in an empty folder, raises Fall, and returns how many of them it tried."""
from damaged_json import DamagedJson

KINDS = {"json": DamagedJson}
