# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies that are killed, cut in slices, run twice at the same time, damaged and merged: what comes out at last is that of
the study that nothing disturbed, byte by byte, or a line says what is wrong, and after it has been put right the bytes are
those again. A round is one such life of a study."""
import json
import os
import shutil
import signal
import time

import h5py
import numpy as np

from bench import Fall
from kills import wait_for, wait_for_changes
from tiny_runs import Chain, check_whole, left_behind, study

PROGRAM = ["stage3_nonlinear", "joint.json", "--study", "study.json"]
SIGNALS = [signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGXCPU]
STUDIES = {"drawn": study(150, 7), "other seed": study(150, 8),
           "cube": study(90, 11, sampling="latin hypercube", outputs=["peaks"], limits={"force": 60, "peak": 9}),
           "long": study(1200, 3, cases=["pull"], outputs=["displacements"])}


class KilledStudies:
    what = "studies stopped or run"

    def __init__(self, bench):
        self.bench, self.chain, self.other = bench, Chain(bench, "studies"), Chain(bench, "studies-other", E=90000.0)
        self.whole, self.blocks, self.seconds = {}, {}, {}
        for name, text in STUDIES.items():
            self._undisturbed(name, text)

    def _undisturbed(self, name, text):
        """Notes the bytes of a study, those of its blocks, and how long it takes."""
        folder = self.chain.folder
        (folder / "study.json").write_text(json.dumps(text))
        run = self.bench.must(*PROGRAM, "-o", "study.h5", "--threads", "1", cwd=folder)
        self.whole[name], self.seconds[name] = (folder / "study.h5").read_bytes(), run.seconds
        self.bench.must(*PROGRAM, "-o", "study.h5", "--threads", "1", "--slice", "1/1", cwd=folder)
        parts = folder / "study.h5.parts"
        self.blocks[name] = {path.name: path.read_bytes() for path in sorted(parts.iterdir())}
        shutil.rmtree(parts)
        (folder / "study.h5").unlink()

    def round(self, random, folder):
        life = random.choice(LIVES)
        self.chain.copy(folder)
        name = random.choice(["drawn", "drawn", "cube", "long"])
        (folder / "study.json").write_text(json.dumps(STUDIES[name]))
        it = Life(self, name, random, folder)
        try:
            life(it)
        except Fall as fall:
            raise Fall(f"{life.__name__}, study {name!r}: {fall}") from fall
        return it.runs


class Life:
    """A study in a folder, and what may happen to it."""

    def __init__(self, kind, name, random, folder):
        self.kind, self.bench, self.name, self.random, self.folder = kind, kind.bench, name, random, folder
        self.parts, self.runs = folder / "study.h5.parts", 0
        self.whole, self.blocks, self.seconds = kind.whole[name], kind.blocks[name], kind.seconds[name]

    def words(self, *more):
        return [*PROGRAM, "-o", "study.h5", "--threads", str(self.random.choice([1, 1, 2, 5])), "--quiet", *more]

    def must(self, *more):
        self.runs += 1
        return self.bench.must(*self.words(*more), cwd=self.folder)

    def start(self, *more):
        self.runs += 1
        return self.bench.start(*self.words(*more), cwd=self.folder)

    def end(self, run, what, killed=()):
        """Waits for a run, which ends well or by a signal that it was sent."""
        said = self.bench.finish(run, what)
        if run.returncode != 0 and -run.returncode not in killed:
            raise Fall(f"{what}: exit status {run.returncode}\n  {said[-500:]}")

    def killed(self, *more):
        """Starts a run and kills it within its time, or at a change in the folder of the blocks."""
        how, moment = self.random.choice(SIGNALS), self.random.uniform(0, 1.1) * self.seconds
        run = self.start(*more)
        if self.random.random() < 0.5 and self.parts.exists():
            wait_for_changes(run, self.parts, self.random.randint(1, 8), self.random.choice([0, 2e-4, 2e-3]))
        elif self.random.random() < 0.2:
            wait_for_changes(run, self.folder, self.random.randint(1, 4), self.random.choice([0, 2e-4, 2e-3]))
        else:
            wait_for(run, moment)
        run.send_signal(how)
        self.end(run, f"{how.name} to {more}", [how])
        self.check_parts(f"after {how.name} to {more}")

    def check_parts(self, what):
        """Blocks that are there are whole, and so is a result that is there."""
        for path in self.parts.glob("*.h5") if self.parts.exists() else ():
            try:
                check_whole(path, [self.blocks.get(path.name)], what)
            except FileNotFoundError:
                continue
        check_whole(self.folder / "study.h5", [None, self.whole], what)

    def check_end(self, what):
        """The study is there as if nothing had happened, and nothing else is."""
        check_whole(self.folder / "study.h5", [self.whole], what)
        if self.parts.exists() or left_behind(self.folder):
            raise Fall(f"{what}: leaves {sorted(os.listdir(self.parts)) if self.parts.exists() else left_behind(self.folder)}")

    def refused(self, what, *more, statuses=(2, 3), words=()):
        """A run that has to be refused, with words that tell why."""
        self.runs += 1
        outcome = self.bench.run(*self.words(*more), cwd=self.folder)
        if outcome.status not in statuses or not any(word in outcome.stderr for word in words):
            raise Fall(f"{what}: exit status {outcome.status}, not {statuses} with any of {words}\n  {outcome.stderr[-500:]}")
        if (self.folder / "study.h5").exists():
            raise Fall(f"{what}: refused, but study.h5 is there")
        return outcome


def resumed(it):
    """Killed again and again, and then left alone."""
    for _ in range(it.random.randint(2, 10)):
        it.killed()
    it.must()
    it.check_end("resumed")


def in_slices(it):
    """Slices in any order, some killed and run again, some twice, cut in different ways; then merged."""
    n = it.random.choice([2, 3, 7, 100])
    todo = [f"{i}/{n}" for i in it.random.sample(range(1, n + 1), n)] if n < 100 else ["1/100", "100/100", "2/3", "1/3", "3/3"]
    for each in todo:
        while it.random.random() < 0.4:
            it.killed("--slice", each)
        it.must("--slice", each)
        if it.random.random() < 0.2:
            it.must("--slice", each)
    while it.random.random() < 0.4 and not (it.folder / "study.h5").exists():
        it.killed("--merge")
    if it.parts.exists():  # a merge that was killed while it removed the blocks has to be made again from the samples
        some_are_gone = len(list(it.parts.glob("*.h5"))) < len(it.blocks)
        it.must(*([] if some_are_gone or it.random.random() < 0.3 else ["--merge"]))
    it.check_end("slices merged")


def at_once(it):
    """The same slices by several processes at once, one of which may be killed, and at another time the rest; then merged."""
    n = it.random.choice([1, 1, 2, 3])
    slices = [f"{i + 1}/{n}" for i in range(n)]
    runs = [(each, it.start("--slice", each)) for each in slices * it.random.randint(2, 3)]
    killed = []
    if it.random.random() < 0.6:
        wait_for(runs[0][1], it.random.uniform(0, 1.2) * it.seconds * len(runs))
        killed = [it.random.choice(SIGNALS)]
        runs[it.random.randrange(len(runs))][1].send_signal(killed[0])
    for each, run in runs:
        it.end(run, f"slice {each}, of {len(runs)} at once{f', one killed by {killed[0].name}' if killed else ''}", killed)
    it.check_parts("slices at once")
    it.must("--merge")
    it.check_end(f"{len(runs)} slices at once{f', one killed by {killed[0].name}' if killed else ''}, then merged")


def twice_at_once(it):
    """The whole study by two processes at once: one of them at least ends it, the other ends it too or is refused since the
    first has removed the blocks; the next run leaves nothing."""
    runs = [it.start()]
    time.sleep(it.random.uniform(0, it.seconds))
    runs.append(it.start())
    said = [run.communicate(timeout=200 if it.bench.sanitized else 20)[1] for run in runs]
    statuses = [run.returncode for run in runs]
    said_why = all(": error: " in words for words, status in zip(said, statuses) if status != 0)
    if 0 not in statuses or not set(statuses) <= {0, 2, 3} or not said_why:
        raise Fall(f"the whole study twice at once: exit statuses {statuses}\n  {said}")
    check_whole(it.folder / "study.h5", [it.whole], f"the whole study twice at once, {statuses}")
    it.must()
    it.check_end(f"the whole study twice at once, {statuses}, and once more")


def lacking(it):
    """Some blocks are not there: a merge says which samples, and a run solves them."""
    it.must("--slice", "1/1")
    names = sorted(it.blocks)
    for name in it.random.sample(names, it.random.randint(1, len(names) - 1)):
        (it.parts / name).unlink()
    it.refused("blocks lack", "--merge", statuses=(2,), words=["lacks samples"])
    it.must()
    it.check_end("blocks that lacked")


def damage(it, path):
    """Damages a block in one of many ways; says how."""
    whole = path.read_bytes()
    other = it.random.choice(sorted(set(it.blocks) - {path.name}))
    ways = {"empty": b"", "cut": whole[:it.random.randrange(len(whole))], "longer": whole + b"x", "zeros": bytes(len(whole)),
            "of another place": it.blocks[other], "no HDF5": b"what is this",
            "of another seed": it.kind.blocks["other seed"].get(path.name),
            "of another study": it.kind.blocks["cube" if it.name != "cube" else "long"].get(path.name)}
    at = it.random.randrange(len(whole))
    ways["one bit"] = whole[:at] + bytes([whole[at] ^ 1 << it.random.randrange(8)]) + whole[at + 1:]
    ways = {way: text for way, text in ways.items() if text is not None}
    way = it.random.choice(sorted(ways) + ["folder", "link to nothing", "no rights of its own"])
    if way in ways:
        path.write_bytes(ways[way])
        return way
    path.unlink()
    if way == "folder":
        path.mkdir()
    elif way == "link to nothing":
        path.symlink_to("nothing")
    else:
        path.symlink_to("../joint.json")
    return way


def damaged(it):
    """A block is damaged or not one of this study: it is named, and once it is removed a run ends the study."""
    it.must("--slice", "1/1")
    name = it.random.choice(sorted(it.blocks))
    way = damage(it, it.parts / name)
    how = it.random.choice([["--merge"], [], ["--slice", "1/1"]])
    what = f"block {way}, then {how or 'the whole'}"
    if way == "link to nothing":
        if how == ["--merge"]:
            it.refused(what, *how, words=["lacks samples", name])
    else:
        it.refused(what, *how, words=[name, "another seed", "another study"])
    path = it.parts / name
    if path.is_dir():
        path.rmdir()
    else:
        path.unlink(missing_ok=True)
    it.must()
    it.check_end(what)


def of_another(it):
    """Joint, matrices, study or degree change between two parts: refused by name, and well again once they are as before."""
    it.must("--slice", "1/2")
    changes = {"joint.json": '{"name": "x", ', "study.json": '{"name": "x", ', "sheet.h5": None}
    name = it.random.choice([*changes, "degree"])
    path = it.folder / name
    more = it.random.choice([[], ["--merge"], ["--slice", "2/2"]])
    if name == "degree":
        it.refused("another degree", *more, "--p", "2", words=["another polynomial degree", "lacks samples", "hold stresses"])
    else:
        before = path.read_bytes()
        path.write_bytes(it.kind.other.bytes[name] if changes[name] is None else before.replace(b'{"', b'{ "', 1))
        it.refused(f"another {name}", *more, words=["another joint", "another study", "another matrices", "lacks samples"])
        path.write_bytes(before)
    it.must()
    it.check_end(f"{name} changed and changed back")


def without_seed(it):
    """A study that draws its seed goes on with it after kills, and is the one that has that seed."""
    text = {key: value for key, value in STUDIES["drawn"].items() if key != "seed"}
    (it.folder / "study.json").write_text(json.dumps(text))
    it.blocks, it.whole, it.name = {}, None, "drawn"
    it.refused("slices without a seed", "--slice", "1/2", words=["seed"])
    for _ in range(it.random.randint(1, 5)):
        run = it.start()
        wait_for(run, it.random.uniform(0, 1) * it.seconds)
        run.send_signal(signal.SIGKILL)
        it.end(run, "killed without a seed", [signal.SIGKILL])
    it.must()
    with h5py.File(it.folder / "study.h5") as found:
        seed, drawn = int(found.attrs["seed"]), {name: found["samples"][name][:] for name in found["samples"]}
    (it.folder / "study.json").write_text(json.dumps(text | {"seed": seed}))
    it.must()
    with h5py.File(it.folder / "study.h5") as truth:
        for name, values in drawn.items():
            if not np.array_equal(values, truth["samples"][name][:], equal_nan=values.dtype.kind == "f"):
                raise Fall(f"samples/{name} of a study that drew the seed {seed} is not that of the seed in STUDY.json")
    if it.parts.exists() or left_behind(it.folder):
        raise Fall("a study without a seed leaves its blocks")


def strangers(it):
    """Files of others among the blocks are not ours to remove, and change nothing."""
    it.must("--slice", "1/2")
    stranger = it.random.choice(["note.txt", "block-000900.h5", "block-1.h5", "block-000000.h5.old", "block-0.h5.zz.partial"])
    (it.parts / stranger).write_bytes(b"mine")
    it.must()
    check_whole(it.folder / "study.h5", [it.whole], f"{stranger} among the blocks")
    if it.parts.exists() and sorted(os.listdir(it.parts)) != [stranger]:
        raise Fall(f"{stranger} among the blocks: leaves {sorted(os.listdir(it.parts))}")


LIVES = [resumed, resumed, in_slices, in_slices, at_once, at_once, twice_at_once, lacking, damaged, damaged, damaged, of_another,
         without_seed, strangers]
