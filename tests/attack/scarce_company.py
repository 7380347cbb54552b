# SPDX-License-Identifier: GPL-3.0-or-later
"""Several writers of one file at once, readers of a file that is being replaced, and a current folder that is gone."""
import signal
import subprocess
import time

from bench import Fall
from tiny_runs import check_whole, left_behind
from spot import with_path

LONGEST = 60.0  # seconds for all of a company


def ends(bench, runs, what, killed=()):
    """Waits for all runs; a Fall for one that fails and was not killed."""
    for run in runs:
        try:
            _, words = run.communicate(timeout=LONGEST * (10 if bench.sanitized else 1))
        except subprocess.TimeoutExpired:
            for each in runs:
                each.kill()
                each.communicate()
            raise Fall(f"hang: {what}") from None
        if run.returncode != 0 and run not in killed:
            raise Fall(f"{what}: one of them ends with {run.returncode}\n  {words[-500:]}")


def other_inputs(spot):
    """Inputs of the other sheet in a folder beside those of this one."""
    folder = spot.folder / "other"
    folder.mkdir()
    spot.other.copy(folder)
    return folder


def writers(spot):
    """Some processes write one file; one may be killed. The file is whole and of one of them, and nothing else remains."""
    job = spot.job("stage1", "stage1 threads", "stage2", "stage2 loads", "field", "stage3", "tables")
    theirs, other = spot.other.job(job.name), other_inputs(spot)
    target = spot.folder / "shared"
    runs = []
    words = with_path([word for word in job.words if "=" not in word or ":" in word], "-o", target)
    if "--timings" in words:
        words = with_path(words, "--timings", spot.folder / "shared.times")
    for _ in range(spot.random.randint(2, 5)):
        runs.append(spot.bench.start(*words, "--quiet", cwd=spot.random.choice([spot.folder, other])))
        time.sleep(spot.random.choice([0, spot.random.uniform(0, 0.02)]))
    killed = []
    if spot.random.random() < 0.3 and len(runs) > 2:
        time.sleep(spot.random.uniform(0, 0.05))
        runs[0].send_signal(spot.random.choice([signal.SIGKILL, signal.SIGTERM]))
        killed = runs[:1]
    what = f"{len(runs)} writers at once: {' '.join(words)}"
    ends(spot.bench, runs, what, killed)
    check_whole(target, [job.outputs[job.main], theirs.outputs[theirs.main]], what)
    if killed:  # what it left goes with the next run
        spot.bench.must(*words, cwd=spot.folder)
    if left_behind(spot.folder):
        raise Fall(f"{what}: leaves {left_behind(spot.folder)}")


def readers(spot):
    """While a file is replaced again and again by that of the other sheet, whoever reads it finds one of them, whole."""
    by_stage1, by_stage2 = ["stage1_plate", "sheet.json", "--p", "1..4"], ["stage2_extract", "sheet.plate.h5"]
    name, writing, reading = spot.random.choice(
        [("sheet.plate.h5", by_stage1, "stage2"), ("sheet.plate.h5", by_stage1, "field"),
         ("sheet.h5", by_stage2, "stage3"), ("sheet.h5", by_stage2, "study")])
    job, theirs, other = spot.job(reading), spot.other.job(reading), other_inputs(spot)
    for _ in range(4):
        folders = spot.random.sample([spot.folder, other], 2)
        target = spot.folder / name
        runs = [spot.bench.start(*writing, "-o", target, "--quiet", cwd=at) for at in folders]
        time.sleep(spot.random.uniform(0, 0.05))
        runs.append(spot.bench.start(*job.words, cwd=spot.folder))
        while any(run.poll() is None for run in runs):
            check_whole(target, [spot.chain.bytes[name], spot.other.bytes[name]], f"{name}, read while it is replaced")
            time.sleep(1e-4)
        what = f"{' '.join(job.words)} while {name} is replaced"
        ends(spot.bench, runs, what)
        check_whole(spot.folder / job.main, [job.outputs[job.main], theirs.outputs[theirs.main]], what)
        if left_behind(spot.folder):
            raise Fall(f"{what}: leaves {left_behind(spot.folder)}")


def gone_folder(spot):
    """The current folder has been removed: absolute paths work all the same, others are refused."""
    job = spot.job("stage1", "stage2", "field", "stage3", "sample")
    absolute = [str(spot.folder / word) if word.endswith((".json", ".h5", ".vtu")) else word for word in job.words]
    spot.bench.must(*absolute, cwd=spot.folder)  # results have warnings, and these the path of the input
    whole = (spot.folder / job.main).read_bytes()
    (spot.folder / job.main).write_bytes(b"before")
    is_absolute = spot.random.random() < 0.6
    status, said = spot.redirected("", "sh", "-c", 'mkdir gone && cd gone && rmdir ../gone && exec "$@"', "sh",
                                   *(absolute if is_absolute else job.words))
    what = f"in a folder that is gone: {' '.join(absolute if is_absolute else job.words)}: exit status {status}"
    if status != 0 if is_absolute else status not in (2, 3):
        raise Fall(f"{what}\n  {said}")
    check_whole(spot.folder / job.main, [whole if is_absolute else b"before"], what)
    if left_behind(spot.folder):
        raise Fall(f"{what}: leaves {left_behind(spot.folder)}")


ATTACKS = [writers, writers, readers, readers, gone_folder]
