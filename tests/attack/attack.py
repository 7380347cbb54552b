# SPDX-License-Identifier: GPL-3.0-or-later
"""Attacks the three programs for a given time: damaged and hostile input, kills, scarce resources, wild valid scenes.

attack.py PROGRAMS SECONDS [--seed N] [--only KIND,...] [--rounds N] [--keep FOLDER]

First all kept cases run; then each other kind has an equal part of the time, and at least one round. Every round has
its own seed, from which all its choices come, so that `--only KIND --seed N --rounds 1` repeats it. What a fall left is
kept in FOLDER/KIND-SEED with its message; an exception of the attack itself is a fall too, and the other rounds go on.
Exit status 1 if anything fell.
"""
import argparse
import shutil
import sys
import tempfile
import time
import traceback
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from bench import Bench, Choices, Fall  # noqa: E402
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


def keep_fall(name, seed, folder, keep, fall):
    """Reports a fall, or an exception of the attack itself with its traceback, and keeps what is in the folder."""
    message = str(fall) if isinstance(fall, Fall) else "".join(traceback.format_exception(fall))
    kept = Path(keep) / f"{name}-{seed}"
    kept.mkdir(parents=True, exist_ok=True)
    try:
        shutil.copytree(folder, kept, dirs_exist_ok=True, symlinks=True, ignore=pipes)
    except OSError:  # names too long, folders without rights: what could be copied is there
        pass
    (kept / "message.txt").write_text(f"{message}\n", errors="backslashreplace")
    text = f"FALL {name} --seed {seed}: {message}\n  kept in {kept}"
    print(text.encode(errors="backslashreplace").decode(), flush=True)


def attempt(name, seed, folder, keep, what):
    """What a part of an attack returns, or None if it falls."""
    try:
        return what()
    except Exception as fall:
        keep_fall(name, seed, folder, keep, fall)
        return None


def rounds_of(kind, name, seed, bench, arguments, end):
    """Rounds of one kind until a moment, or as many as wanted, at least one; up to 10 while nothing could be tried.
    Returns how many there were, how many things were tried in them, and how many fell."""
    wanted = arguments.rounds or (kind.all() if name == "cases" else None)
    rounds = tried = falls = 0
    while rounds < wanted if wanted else rounds == 0 or time.monotonic() < end or tried == 0 and rounds < 10:
        folder = bench.folder(f"{name}-{seed + rounds}")
        choices = Choices(seed + rounds)
        count = attempt(name, seed + rounds, folder, arguments.keep, lambda: kind.round(choices, folder))
        shutil.rmtree(folder, ignore_errors=True)
        rounds, tried, falls = rounds + 1, tried + (1 if count is None else count), falls + (count is None)
    return rounds, tried, falls


def all_of(name, seed, bench, arguments, end):
    """One kind of attack from its making to what it has counted; returns its numbers of rounds and of falls."""
    start = time.monotonic()
    kind = attempt(name, seed, bench.scratch, arguments.keep, lambda: KINDS[name](bench))
    if kind is None:
        return 0, 1
    rounds, tried, falls = rounds_of(kind, name, seed, bench, arguments, end)
    print(f"{name}: {rounds} rounds in {time.monotonic() - start:.0f} s, {tried} {kind.what}", flush=True)
    if hasattr(kind, "check_counts"):  # each of what it counts is allowed, but not many
        folder, checked = bench.folder("counts"), lambda: kind.check_counts() or True
        falls += attempt(f"{name}-counts", seed, folder, arguments.keep, checked) is None
    return rounds, falls


def main():
    arguments = parse()
    seed = arguments.seed if arguments.seed is not None else int(time.time()) % 10**6 * 1000
    print(f"seed {seed}", flush=True)
    names, rounds, falls = arguments.only.split(","), [], 0
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(arguments.programs, scratch)
        end = time.monotonic() + arguments.seconds
        for k, name in enumerate(names):
            its_end = time.monotonic() + max(end - time.monotonic(), 0) / (len(names) - k)
            n, fallen = all_of(name, seed, bench, arguments, its_end)
            rounds, falls = [*rounds, f"{name} {n}"], falls + fallen
    print(f"rounds: {', '.join(rounds)}; {falls or 'nothing'} fell")
    return int(falls > 0)


if __name__ == "__main__":
    sys.exit(main())
