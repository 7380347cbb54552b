# SPDX-License-Identifier: GPL-3.0-or-later
"""Command lines for valid inputs: options in any number, repeated, contradictory, without a value, with an empty or a
wild one, and words that nobody expects."""

# Values of the options of each program, None for one without; the first ones are valid.
STAGE1 = {"--p": ["2", "1..3", "8", "0", "3..1", "1..", "9"], "--accuracy": ["1e-2", "1", "1e-10", "0", "1e-11", "2"],
          "--peak-accuracy": ["1e-1", "1", "1e-6", "1e-7", "0"], "--threads": ["2", "1", "256", "0", "257"],
          "--timings": ["times.json"], "--quiet": None}
STAGE2 = {"--loads-only": None, "--plate": ["strap", "base", "nobody"], "--increment": ["1", "3", "0", "99"],
          "--field": ["external:P=0.01", "joint_laws.h5", "external:nobody=1", "external:P", "=", "P=1"],
          "--p": ["1", "3", "2", "9"], "--timings": ["times.json"], "--quiet": None}
STAGE3 = {"--p": ["1", "3", "2", "9", "1..3"], "--all-stresses": None, "--rim-stresses": None, "--csv": ["t.csv"],
          "--distance": ["0.5", "1e-30", "1e30", "0", "1e-31", "100"], "--case": ["pull", "more", "warm", "nobody"],
          "--envelope": ["e.csv", "t.csv"], "--margins": ["m.csv", "t.csv"], "--totals": ["o.csv", "t.csv"],
          "--sensitivities": None, "--verbose": None, "--threads": ["2", "1", "0", "257"],
          "--timings": ["times.json", "t.csv"], "--study": ["study_random.json", "study_grid.json", "joint_laws.json"],
          "--slice": ["1/2", "2/2", "0/2", "3/2", "1/0", "1"], "--merge": None,
          "--sample": ["0", "2", "3", "-1"], "--quiet": None}
WILD = ["", " ", "-1", "nan", "inf", "1e999", "0x1", "1,5", "1 ", "+1", "\u0661", "x" * 5000, "\n", "\x1b[2J", "--",
        "-", "--quiet", "-o", "%s%n", "1e", "2147483648", "99999999999999999999", "a-folder", "none/x", "/dev/null",
        "*"]
STRANGE = ["", "-", "--", "---", "-x", "--bogus", "--bogus=1", "-o", "--output", "--help=1", "--quiet=maybe",
           "--quiet=false", "-p", "=", "--=", "joint_bolt.json", "none.json", "@file", "--outp", "-oother.h5", "--p2",
           "\xff", "a" * 100000]
OUTPUT = "output.h5"


def base(random, scenes):
    """Words of a run that would do its work, and the options of its program."""
    program = random.randrange(6)
    if program == 0:
        return ["stage1_plate", random.choice(scenes.plates)], STAGE1
    if program == 1:
        return ["stage2_extract", f"{random.choice(scenes.plates)[:-5]}.h5"], STAGE2
    if program == 2:
        return ["stage2_extract", "plate_strap.h5", "--field", "joint_laws.h5"], STAGE2
    if program == 3:
        return ["stage3_nonlinear", "joint_laws.json", "--study", random.choice(scenes.studies)], STAGE3
    return ["stage3_nonlinear", random.choice(scenes.joints)], STAGE3


def option(random, options):
    """An option with one of its values, seldom another one or none, as one word or as two."""
    name = random.choice(sorted(options))
    values = options[name]
    value = random.choice(WILD + [""] * 10) if random.random() < 0.15 else random.choice(values) if values else None
    if value is None or values and random.random() < 0.05:
        return [name]
    return [f"{name}={value}"] if random.random() < 0.3 else [name, value]


def command_line(random, scenes):
    """Words of a run, with options among them, and seldom damaged."""
    words, options = base(random, scenes)
    chosen = [option(random, options) for _ in range(random.choice([0, 1, 1, 2, 2, 3, 5]))]
    if chosen and random.random() < 0.15:
        chosen.append(random.choice(chosen))
    parts = [words[1:], ["-o", OUTPUT], *chosen]
    random.shuffle(parts)
    line = [words[0], *(word for part in parts for word in part)]
    if random.random() < 0.15:
        line.insert(random.randrange(1, len(line) + 1), random.choice(STRANGE))
    if random.random() < 0.1:
        del line[random.randrange(1, len(line))]
    return [word.replace("\x00", "") for word in line], options


def must_be_refused(words, options):
    """Why a command line may not be accepted; None if it may. Asked for help a program need not look at the rest."""
    if {"-h", "--help", "--version"} & set(words):
        return None
    for name in (name for name, values in options.items() if values):
        given = [i for i, word in enumerate(words) if word == name or word.startswith(name + "=")]
        if len(given) > 1:
            return f"{name} stands twice"
        if any(words[i] == name + "=" or words[i:i + 2] == [name, ""] or words[i:] == [name] for i in given):
            return f"{name} has no value"
    if "" in words:
        return "a word is empty"
    return None
