# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run that is killed while it writes leaves: killed_test.py BIN_FOLDER."""
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def partial():
    return sorted(path.name for path in Path().glob("plate.h5.*.partial"))


def killed_while_writing(how):
    """Starts stage 1, waits until its file grows beside the target and kills it; its exit status and words."""
    run = subprocess.Popen(["stage1_plate", "panel.json", "-o", "plate.h5", "--p", "5..6", "--quiet"], text=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    before = partial()
    while run.poll() is None and partial() == before:
        time.sleep(0.0002)
    run.send_signal(how)
    _, words = run.communicate()
    return run.returncode, words


def caught(how, tries=20):
    """The same until the kill came before the end of the run, which the machine decides."""
    for _ in range(tries):
        status, words = killed_while_writing(how)
        if status != 0:
            return status, words
    raise AssertionError(f"{tries} runs ended before {how.name} came")


def main():
    os.environ["PATH"] = f"{Path(sys.argv[1]).resolve()}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        Path("panel.json").write_text(subprocess.run([ROOT / "scripts/measure/make_panel", "12", "12"], check=True,
                                                     capture_output=True, text=True).stdout)
        Path("plate.h5").write_text("what was there")
        for how in signal.SIGTERM, signal.SIGINT:
            status, words = caught(how)
            assert status == -how, (how, status)
            assert words == ("stage1_plate: error: stopped by a signal; files that it had not finished are as they were "
                             "before\n"), words
            assert partial() == [] and sorted(os.listdir()) == ["panel.json", "plate.h5"], os.listdir()
        status, words = caught(signal.SIGKILL)
        assert status == -signal.SIGKILL and words == "" and len(partial()) == 1, (status, words, partial())
        subprocess.run(["stage1_plate", "panel.json", "-o", "plate.h5", "--p", "1"], check=True, stdout=subprocess.DEVNULL)
        assert partial() == [], partial()
        ignored = subprocess.Popen(["stage1_plate", "panel.json", "-o", "plate.h5", "--p", "5"], stdout=subprocess.DEVNULL,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN))
        ignored.send_signal(signal.SIGINT)
        assert ignored.wait() == 0, "a job in the background does not stop by the keyboard of another"
        os.chdir("/")


main()
