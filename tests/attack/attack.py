# SPDX-License-Identifier: GPL-3.0-or-later
"""Attacks the three programs for a given time: damaged and hostile input, kills, scarce resources, wild valid scenes.

attack.py PROGRAMS SECONDS [--seed N] [--only KIND,...] [--rounds N] [--keep FOLDER]

First all kept cases run; then each other kind has an equal part of the time. Every round has its own seed, from which all
its choices come, so that `--only KIND --seed N --rounds 1` repeats it. What a fall left is kept in FOLDER/KIND-SEED with
its message. Exit status 1 if anything fell.
"""
import argparse
import random
import shutil
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from bench import Bench, Fall  # noqa: E402
from kinds import KINDS  # noqa: E402


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", help="folder of the programs")
    parser.add_argument("seconds", type=float)
    parser.add_argument("--seed", type=int, help="seed of the first round; by default one of the clock, which is printed")
    parser.add_argument("--only", default=",".join(KINDS), help="kinds of attack, of " + ", ".join(KINDS))
    parser.add_argument("--rounds", type=int, help="rounds of each kind instead of the time")
    parser.add_argument("--keep", default="attack-falls", help="folder of what fell")
    arguments = parser.parse_args()
    for name in arguments.only.split(","):
        if name not in KINDS:
            parser.error(f"--only: '{name}' is no kind of attack; allowed: {', '.join(KINDS)}")
    return arguments


def pipes(folder, names):
    """Those of a folder that are pipes, which cannot be copied."""
    return [name for name in names if Path(folder, name).is_fifo()]


def attack(kind, seed, bench, keep):
    """One round: number of things tried in it, and its fall or None."""
    folder = bench.folder(f"{kind.name}-{seed}")
    try:
        return kind.round(random.Random(seed), folder), None
    except Fall as fall:
        kept = Path(keep) / folder.name
        kept.parent.mkdir(parents=True, exist_ok=True)
        try:
            shutil.copytree(folder, kept, dirs_exist_ok=True, symlinks=True, ignore=pipes)
        except shutil.Error:  # names too long, folders without rights: what could be copied is there
            pass
        (kept / "message.txt").write_text(f"{fall}\n")
        print(f"FALL {kind.name} --seed {seed}: {fall}\n  kept in {kept}", flush=True)
        return 1, fall
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def main():
    arguments = parse()
    seed = arguments.seed if arguments.seed is not None else int(time.time()) % 10**6 * 1000
    print(f"seed {seed}", flush=True)
    falls = 0
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(arguments.programs, scratch)
        names = arguments.only.split(",")
        end = time.monotonic() + arguments.seconds
        for k, name in enumerate(names):
            kind = KINDS[name](bench)
            kind.name = name
            its_end = time.monotonic() + max(end - time.monotonic(), 0) / (len(names) - k)
            wanted = arguments.rounds or (kind.all() if name == "cases" else None)
            tried = rounds = 0
            while rounds < wanted if wanted else time.monotonic() < its_end:
                count, fall = attack(kind, seed + rounds, bench, arguments.keep)
                tried, rounds, falls = tried + count, rounds + 1, falls + (fall is not None)
            print(f"{name}: {rounds} rounds, {tried} {kind.what}", flush=True)
    print(f"{falls} falls" if falls else "nothing fell")
    return int(falls > 0)


if __name__ == "__main__":
    sys.exit(main())
