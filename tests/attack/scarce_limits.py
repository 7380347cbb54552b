# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits of memory, of the size of files, of their number, of threads and of the disk.

A limit under which not even the libraries can be loaded is no fault of a program: `--version` under it tells, and then
only the files are held. Sanitized programs reserve terabytes of addresses, so their memory is not limited.
"""
import ctypes
import os
import resource
import subprocess

from bench import Fall
from tiny_runs import check_whole, left_behind
from spot import Skipped, name_of, with_path

MEGABYTE = 2**20
LEAST_STACK = 2**18  # bytes; systems give 2^23


def starts(spot, job, limits):
    """Whether the program of a job can be loaded under limits: whether `--version` ends as the manual says."""
    def before():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        for which, value in limits:
            resource.setrlimit(which, (value, value))
    try:
        run = subprocess.run([spot.bench.programs / job.words[0], "--version"], preexec_fn=before, capture_output=True,
                             env=spot.bench.environment, timeout=20, check=False)
    except (OSError, subprocess.SubprocessError):
        return True  # a program that hangs has been loaded; one that the system does not start is found so by the run
    return run.returncode in (0, 2, 3, 4)


def limited(spot, job, limits, what):
    """Runs a job under limits and holds it and its files; Skipped if not even the libraries could be loaded."""
    old = spot.old(job)
    try:
        status = spot.run(*job.words, limits=limits).status
    except OSError:
        status = None  # not even started
    except Fall:
        if starts(spot, job, limits):
            raise
        status = None
    spot.end(job, status, old, what)
    if status is None:
        raise Skipped("the program could not be loaded")


def memory(spot):
    """Addresses or data, from a megabyte to plenty."""
    if spot.bench.sanitized:
        raise Skipped("sanitizers reserve memory without end")
    which = spot.random.choice(["AS", "DATA"])
    n = int(MEGABYTE * spot.random.choice([2**spot.random.uniform(0, 10), spot.random.uniform(60, 320)]))
    job = spot.job()
    limited(spot, job, [(getattr(resource, f"RLIMIT_{which}"), n)], f"{job.name} with RLIMIT_{which} {n}")


def stack(spot):
    """Little stack, or one without limit; threads get as much."""
    n = spot.random.choice([LEAST_STACK, 2**19, 2**20, resource.RLIM_INFINITY])
    job = spot.job()
    limited(spot, job, [(resource.RLIMIT_STACK, n)], f"{job.name} with RLIMIT_STACK {n}")


def open_files(spot):
    """From no file to some."""
    n, job = spot.random.randint(0, 12), spot.job()
    limited(spot, job, [(resource.RLIMIT_NOFILE, n)], f"{job.name} with RLIMIT_NOFILE {n}")


def size_of_files(spot):
    """Files up to a size that may fall within what a run writes: a message, not the signal SIGXFSZ."""
    if spot.bench.sanitized:
        raise Skipped("the OpenMP of sanitized programs keeps a file of its own in shared memory")
    job = spot.job()
    most = max(len(whole) for whole in job.outputs.values() if whole is not None)
    n = spot.random.choice([0, 1, spot.random.randint(1, 1000), spot.random.randint(1, most + 100), most - 1, most, most + 1])
    old, what = spot.old(job), f"{job.name} with RLIMIT_FSIZE {n} of {most}"
    try:  # its words come through a pipe, since a file of them would be limited too
        run = subprocess.run(job.words, cwd=spot.folder, env=spot.bench.environment, capture_output=True, text=True, check=False,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (n, n)), timeout=60)
    except subprocess.TimeoutExpired:
        raise Fall(f"{what}: hang") from None
    if run.returncode not in (0, 3) or run.returncode == 3 and ": error: " not in run.stderr:
        raise Fall(f"{what}: {name_of(run.returncode)}\n  {run.stderr[-500:]}")
    spot.end(job, run.returncode, old, what)


def threads(spot):
    """No more threads than a few: fewer work, or a line says why none do."""
    if spot.bench.sanitized:
        raise Skipped("sanitized programs do not start without threads")
    rights = spot.as_nobody()
    job, n = spot.job("stage1", "study", "stage3"), spot.random.randint(0, 4)
    words = [*job.words, "--threads", "8"] if job.name != "stage3" else job.words
    old = spot.old(job)
    outcome = spot.run(*words, limits=[(resource.RLIMIT_NPROC, n)], **rights)
    spot.end(job, outcome.status, old, f"{job.name} with RLIMIT_NPROC {n}")


def processor_time(spot):
    """No time of the processor is left: the system ends a run by SIGXCPU, which may not tear a file. Runs of the chain
    are over before a second, the least limit, so a large sheet is solved."""
    text = (spot.folder / "sheet.json").read_text().replace('"x": [-10, -4, 4, 10]', f'"x": {[-10, -4, 4, *range(10, 5000, 2)]}')
    (spot.folder / "large.json").write_text(text)
    (spot.folder / "large.h5").write_bytes(b"before")
    run = subprocess.run([spot.bench.programs / "stage1_plate", "large.json", "-o", "large.h5", "--p", "1..8", "--quiet"],
                         preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (1, 3)), cwd=spot.folder, check=False,
                         env=spot.bench.environment, capture_output=True, timeout=60)
    same = (spot.folder / "large.h5").read_bytes() == b"before"
    if same != (run.returncode != 0):
        raise Fall(f"RLIMIT_CPU 1: {name_of(run.returncode)}, and the old file is {'' if same else 'not '}there")


def mount(folder, options, flags=0):
    """Mounts a small disk of memory; Skipped where that is not allowed."""
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.mount(b"tmpfs", os.fsencode(folder), b"tmpfs", flags, options.encode()) != 0:
        raise Skipped(f"no disk could be mounted: {os.strerror(ctypes.get_errno())}")


def full_disk(spot):
    """A disk of few pages or few files: one of the outputs does not fit on it, or just does."""
    job, disk = spot.job(), spot.folder / "disk"
    if job.name == "study":
        full_disk_of_study(spot, job, disk)
        return
    options = [word for word in ("-o", "--timings", "--csv", "--totals") if any(each.split("=")[0] == word for each in job.words)]
    option = spot.random.choice(options)
    name = job.main if option == "-o" else "times.json" if option == "--timings" else f"{option[2:]}.csv"
    disk.mkdir()
    most = len(job.outputs[name] or bytes(300))
    few_pages, few_files = f"size={spot.random.randint(4096, most + 20000)}", f"nr_inodes={spot.random.randint(2, 4)}"
    limit = few_pages if spot.random.random() < 0.7 else few_files
    mount(disk, limit)
    try:
        old = b"before" if spot.random.random() < 0.5 else None
        if old:
            (disk / name).write_bytes(old)
        status = spot.run(*with_path(job.words, option, f"disk/{name}")).status
        what = f"{job.name}, {option} on a disk of {limit}: exit status {status}"
        found = (disk / name).read_bytes() if (disk / name).exists() else None
        any_text = option == "--timings" or name == "sample.json"  # of times, or of paths that depend on the folder
        new = found if any_text and status == 0 else job.outputs[name]
        if found != (new if status == 0 else old) or (not found and status == 0):
            raise Fall(f"{what}: {name} is {'not there' if found is None else f'of {len(found)} bytes'}")
        if [path.name for path in disk.iterdir() if path.name != name]:
            raise Fall(f"{what}: leaves {os.listdir(disk)}")
    finally:
        subprocess.run(["umount", disk], check=True)


def full_disk_of_study(spot, job, disk):
    """The blocks of a study are kept: once there is room it ends as one that was never stopped."""
    remount = 32  # MS_REMOUNT
    disk.mkdir()
    size = spot.random.randint(4096, 80000)
    mount(disk, f"size={size}")
    try:
        words = with_path(job.words, "-o", "disk/study.h5")
        status = spot.run(*words).status
        if left_behind(disk):
            raise Fall(f"study on a disk of {size}: exit status {status} leaves {left_behind(disk)}")
        mount(disk, "size=10000000", remount)
        spot.bench.must(*words, cwd=spot.folder)
        check_whole(disk / "study.h5", [job.outputs["study.h5"]], f"study on a disk of {size}, then with room")
        if os.listdir(disk) != ["study.h5"]:
            raise Fall(f"study on a disk of {size}, then with room: leaves {os.listdir(disk)}")
    finally:
        subprocess.run(["umount", disk], check=True)


ATTACKS = [memory, memory, memory, stack, open_files, size_of_files, size_of_files, threads, processor_time, full_disk, full_disk]
