# SPDX-License-Identifier: GPL-3.0-or-later
"""Whose fault a fall at damaged bytes is: that of a program, or of the HDF5 library, as the debugger gdb sees it."""
import re
import shutil
import subprocess

TRIES = 6  # what the library does at damaged bytes depends on what its memory holds
# Ends the run with a signal when it is busy for long, or holds much memory, so that gdb says where it then is.
WATCH = """python
import os, signal, threading, time
def watch(start=time.monotonic()):
    while True:
        time.sleep(0.002)
        for pid in [each.pid for each in gdb.inferiors() if each.pid]:
            try:
                held = int(open(f"/proc/{pid}/statm").read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
            except OSError:
                continue
            if time.monotonic() - start > %(seconds)g or held > %(memory)d:
                os.kill(pid, signal.SIGINT)
                return
threading.Thread(target=watch, daemon=True).start()
end
set disable-randomization off
run
bt 60
"""
# Frames that stand above the one that is to blame: of the C and C++ libraries, of sanitizers, and what has no name.
OF_OTHERS = re.compile(r"libc\.so|libstdc\+\+|ld-linux|linux-vdso|libgcc|libasan|/sysdeps/|"
                       r"\./(malloc|string|nptl|stdlib|io|libio|debug)/|__asan|"
                       r"__interceptor|__sanitizer|__ubsan|in (mem|str)\w+ \(\)$|in \?\? \(\)$")
OF_LIBRARY = re.compile(r"\bH5[A-Z]\w*|libhdf5|libsz|libz\.so|libaec")


def falls_in_library(bench, words, folder, memory):
    """Whether the run, repeated under the debugger, ends by a signal, is busy after a while, or has come to hold much
    memory within the HDF5 library. Without gdb nobody knows: False."""
    script = WATCH % {"seconds": 6 if bench.sanitized else 2, "memory": memory // 2}
    return bool(shutil.which("gdb")) and any(_stops_in_library(bench, words, folder, script) for _ in range(TRIES))


def _stops_in_library(bench, words, folder, script):
    (folder / ".gdb").write_text(script)
    environment = bench.environment | {"ASAN_OPTIONS": bench.environment["ASAN_OPTIONS"] + ":abort_on_error=1"}
    try:
        gdb = ["gdb", "-batch", "-nx", "-x", ".gdb", "--args"]
        run = subprocess.run([*gdb, bench.programs / words[0], *words[1:]], cwd=folder, env=environment, timeout=120,
                             stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace", check=False)
    except subprocess.TimeoutExpired:
        return False
    finally:
        (folder / ".gdb").unlink()
    return "received signal" in run.stdout and is_of_library(run.stdout)


def is_of_library(trace):
    """Whether the first frame that is one of the programs or of HDF5 is one of HDF5."""
    frames = [line for line in trace.splitlines() if re.match(r"#\d+ ", line) and not OF_OTHERS.search(line)]
    return bool(frames) and bool(OF_LIBRARY.search(frames[0]))
