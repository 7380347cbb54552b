# SPDX-License-Identifier: GPL-3.0-or-later
"""How scenes end that give no answers, or none to compare: each of these ends is allowed, but only so often."""
import re
from collections import Counter

from bench import Fall

LEAST = 100  # scenes from which on shares are judged
# Largest share of each end. Of 234 random scenes 8 were refused and none was slow; of 118 guises none ended in another
# way, 6 had a doubtful solution and none another mesh.
MOST = {"refused": 0.1, "slow": 0.01, "another end": 0.01, "doubtful": 0.3, "another mesh": 0.1}
# Of cracks that no mesh of the cells follows (docs/limits.md).
OF_CRACKS = "which cannot be moved through it", "is folded", "edges of the crack that have"


class Ends:
    """Counts of ends by their name in MOST and by what is said of them, of `tried` scenes."""

    def __init__(self):
        self.tried, self.counts, self.texts = 0, Counter(), Counter()

    def count(self, name, text):
        self.counts[name] += 1
        self.texts[text] += 1

    def slow(self, what=""):
        self.count("slow", f"{what}no end within a minute")

    def refused(self, refused, scene):
        """Status 4 is allowed with a message; scenes are valid, so that 2 and 3 are not, but for some cracks."""
        has_cracks = any(plate.get("cracks") for plate in scene.plates.values())
        if refused.status != 4 and not (has_cracks and any(words in refused.line for words in OF_CRACKS)):
            raise Fall(f"a valid scene is refused: {refused}")
        if "NaN" in refused.line:
            raise Fall(f"a failure of numbers instead of a message: {refused}")
        self.count("refused", first_words(refused))

    def check(self):
        """Raises Fall for ends that are no exceptions any more."""
        for name, n in self.counts.items():
            if self.tried >= LEAST and n > MOST[name] * self.tried:
                raise Fall(f"{name}: {n} of {self.tried} scenes, allowed {MOST[name]:.0%}\n" + "\n".join(self.lines()))

    def lines(self):
        """A table of what was said, the most frequent first."""
        return [f"  {n:5} ended with {text}" for text, n in self.texts.most_common()]


def first_words(refused):
    """The program and the first words of its refusal without numbers, which many refusals share."""
    words = re.sub(r"[-+]?\d[-+.e\d]*", "#", refused.line.split(": error: ")[-1])
    words = re.sub(r"^\S+: ", "", words)
    return f"{refused.program}: {words[:60]}"
