# SPDX-License-Identifier: GPL-3.0-or-later
"""Outputs and inputs at odd paths: folders, links of every kind, devices, names that are too long, other names of an input
or of another output, and places without rights."""
import os
import stat

from bench import Fall
from tiny_runs import check_whole
from spot import with_path

ODD_NAMES = ["two words", "-", "--help", "-o", "*.h5", "a\nb.h5", "\x01\x7f", "r\u00e9sum\u00e9.h5", b"\xff\xfe.h5", "%d.h5",
             "{}", "$HOME", "ros3:x", "'\"`", "~", "#x", "x.partial", "x.00000000.partial",
             "sub/../plain.h5", "./././plain.h5", ".//plain.h5"]
NO_FILES = ["folder", "folder/", "fifo", "loop", "loop a", "to folder", "to fifo", "to null", "to nowhere", "to long", ".", "..",
            "/", "/dev/null", "/dev/full", "/proc/self/mem", "none/x.h5", "none/", "sheet.json/x.h5", "sheet.json/", "loop/x.h5",
            "/proc/x.h5", "/sys/x.h5", "x" * 300, "x" * 300 + "/x.h5", "x/../" * 1000 + "x.h5", "./" * 2200 + "x.h5", "y" * 255,
            "y" * 240]


def option_and_old(spot, job):
    """An option of a job that names a file, and the bytes of its new file: None for one of times, and for a JOINT.json, in
    which the paths of the plates depend on its folder."""
    options = [word for word in ("-o", "--timings", "--csv", "--envelope", "--margins", "--totals")
               if any(each.split("=")[0] == word for each in job.words)]
    option = spot.random.choice(options)
    if job.name == "sample" and option == "-o":
        return option, None
    return option, job.outputs[job.main if option == "-o" else "times.json" if option == "--timings" else f"{option[2:]}.csv"]


def outcome_of(spot, job, option, path):
    """Runs a job with another file for an option; the outcome and the words."""
    words = with_path(job.words, option, path)
    return spot.run(*words), f"{' '.join(map(str, words))[:300]}"


def not_a_file(spot):
    """Folders, devices, loops and links to them are refused, and stay what they are."""
    job, folder = spot.job(), spot.folder
    option, _ = option_and_old(spot, job)
    (folder / "folder").mkdir()
    os.mkfifo(folder / "fifo")
    for name, target in (("loop", "loop"), ("loop a", "loop b"), ("loop b", "loop a"), ("to folder", "folder"),
                         ("to fifo", "fifo"), ("to null", "/dev/null"), ("to nowhere", "none/none/x.h5"), ("to long", "x" * 300)):
        (folder / name).symlink_to(target)
    before = {path.name: path.lstat().st_mode for path in folder.iterdir()}
    path = spot.random.choice(NO_FILES)
    outcome, what = outcome_of(spot, job, option, path)
    long_path = path.startswith(("./", "y"))
    if long_path and outcome.status == 0:
        return
    spot.refused(outcome, what)
    after = {path.name: path.lstat().st_mode for path in folder.iterdir()}
    extra = {name for name in after.keys() - before.keys() - job.outputs.keys() if not name.endswith(".parts")}
    if extra or any(after.get(name) != mode for name, mode in before.items()):
        raise Fall(f"{what}: changes {extra or 'what was there'}")


def through_link(spot):
    """A link to a file, there or not, stays a link, and its target is replaced."""
    job = spot.job()
    option, new = option_and_old(spot, job)
    elsewhere, folder = spot.folder / "elsewhere", spot.folder
    elsewhere.mkdir()
    there = spot.random.random() < 0.5
    if there:
        (elsewhere / "real").write_bytes(b"before")
    (elsewhere / "link").symlink_to("real")
    (folder / "far").symlink_to(spot.random.choice(
        ["elsewhere/real", elsewhere / "real", "elsewhere/link", "elsewhere/../elsewhere/link"]))
    (folder / "door").symlink_to("elsewhere")
    path = spot.random.choice(["far", "elsewhere/link", "door/link", "door/real", folder / "far"])
    outcome, what = outcome_of(spot, job, option, path)
    if outcome.status != 0:
        raise Fall(f"{what}: exit status {outcome.status}\n  {outcome.stderr[-300:]}")
    links = [folder / "far", elsewhere / "link", folder / "door"]
    if not all(link.is_symlink() for link in links) or (elsewhere / "real").is_symlink():
        raise Fall(f"{what}: a link has become a file")
    if new is not None:
        check_whole(elsewhere / "real", [new], what)
    spot.refused(outcome, what, allowed=(0,))


def alias(spot, name):
    """Another name of a file of the folder, which need not exist for most of them."""
    folder, there = spot.folder, (spot.folder / name).exists()
    kinds = ["same", "dot", "up", "absolute", "door", "link", "links"] + (["hard"] if there else [])
    kind = spot.random.choice(kinds)
    (folder / "sub").mkdir(exist_ok=True)
    if kind == "hard":
        os.link(folder / name, folder / "hard")
        return "hard"
    if kind in ("link", "links"):
        (folder / "alias").symlink_to(name)
        (folder / "aliases").symlink_to(folder / "alias")
        return "alias" if kind == "link" else "aliases"
    if kind == "door":
        (folder / "sub" / "door").symlink_to("..")
    return {"same": name, "dot": f".//{name}", "up": f"sub/../{name}", "absolute": str(folder / name),
            "door": f"sub/door/{name}"}[kind]


def inputs_of(job):
    """Names of the files that a job reads."""
    of_program = {"stage1_plate": ["sheet.json"], "stage2_extract": ["sheet.plate.h5"],
                  "stage3_nonlinear": ["joint.json", "sheet.h5"]}
    return of_program[job.words[0]] + (["study.json"] if "--study" in job.words else [])


def input_as_output(spot):
    """Any name of an input is refused as an output."""
    job = spot.job()
    option, _ = option_and_old(spot, job)
    inputs = inputs_of(job)
    outcome, what = outcome_of(spot, job, option, alias(spot, spot.random.choice(inputs)))
    spot.refused(outcome, what, allowed=(2,))
    if (spot.folder / job.main).exists():
        raise Fall(f"{what}: refused, but {job.main} is written")


def two_outputs_in_one(spot):
    """Two outputs of one run are not one file under two names."""
    job, folder = spot.job("tables", "stage2", "study", "stage1 threads"), spot.folder
    names = sorted(job.outputs)
    first, second = spot.random.sample(names, 2)
    option = "-o" if second == job.main else "--timings" if second == "times.json" else f"--{second[:-4]}"
    there = spot.random.random() < 0.5
    if there:
        (folder / first).write_bytes(b"before")
    outcome, what = outcome_of(spot, job, option, alias(spot, first))
    spot.refused(outcome, what, allowed=(2,))
    if (folder / first).exists() != there or there and (folder / first).read_bytes() != b"before":
        raise Fall(f"{what}: refused, but {first} is written")


def odd_name(spot):
    """Any name of a file works that the system takes, or is refused in one line."""
    job, name = spot.job("stage1", "stage2", "field", "stage3", "tables", "sample"), spot.random.choice(ODD_NAMES)
    option, new = option_and_old(spot, job)
    (spot.folder / "sub").mkdir()
    name = os.fsdecode(name)
    words = with_path(job.words, option, name)
    if option == "-o" and name.startswith("-") and name != "-":
        words = [word for word in words if word not in ("-o", name)] + [f"--output={name}"]
    outcome = spot.run(*words)
    what = f"{words}"
    if any(len(line) > 3000 or "\x01" in line for line in outcome.stderr.splitlines()):
        raise Fall(f"{what}: prints control characters\n  {outcome.stderr!r}")
    if outcome.status == 0 and new is not None and not name.endswith(".partial"):
        check_whole(spot.folder / name, [new], what)
    if outcome.status not in (0, 2, 3):
        raise Fall(f"{what}: exit status {outcome.status}")


def no_rights(spot):
    """A user without rights: in a folder that he may not write nothing changes; a file of others in a folder where only
    owners may replace theirs stays; a read-only file is replaced whole or refused; what he may not read is named."""
    job, folder = spot.job("stage1", "stage2", "field", "stage3", "tables", "sample"), spot.folder
    kind = spot.random.choice(["folder", "sticky", "file", "input"])
    option, new = option_and_old(spot, job)
    (folder / "sub").mkdir()
    target = folder / "sub" / "x"
    target.write_bytes(b"before")
    rights = spot.as_nobody()
    if kind == "input":
        unread = ["sheet.h5"] if job.name == "sample" else []  # a sample is drawn without the matrices
        os.chmod(folder / spot.random.choice(sorted(set(inputs_of(job)) - set(unread))), 0)
    if kind == "folder":
        os.chmod(folder / "sub", 0o555)
    if kind == "sticky" and os.geteuid() == 0:
        os.chown(folder / "sub", 0, 0)
        os.chown(target, 0, 0)
        os.chmod(folder / "sub", 0o777 | stat.S_ISVTX)
    if kind == "file":
        os.chmod(target, 0o444)
    words = with_path(job.words, option, "sub/x")
    outcome = spot.run(*words, **rights)
    os.chmod(folder / "sub", 0o755)
    what = f"without rights ({kind}): {' '.join(words)}"
    if kind in ("folder", "input") or kind == "sticky" and os.geteuid() == 0:
        spot.refused(outcome, what)
        check_whole(target, [b"before"], what)
    elif new is not None:
        check_whole(target, [new if outcome.status == 0 else b"before"], what)


def odd_parts(spot):
    """The folder of a study's blocks is no folder, or not his who runs the study: a line says so."""
    job, parts = spot.job("study"), spot.folder / "study.h5.parts"
    kind = spot.random.choice(["file", "loop", "link to nothing", "link to a file", "closed", "read only"])
    if kind == "file":
        parts.write_bytes(b"mine")
    elif kind in ("closed", "read only"):
        parts.mkdir()
    else:
        parts.symlink_to({"loop": parts.name, "link to nothing": "nothing", "link to a file": "joint.json"}[kind])
    rights = spot.as_nobody()
    if kind in ("closed", "read only"):
        parts.chmod(0 if kind == "closed" else 0o555)
    words = [*job.words, *spot.random.choice([[], ["--merge"], ["--slice", "1/2"]])]
    spot.refused(spot.run(*words, **rights), f"{parts.name} is {kind}: {' '.join(words)}")
    if kind == "file" and parts.read_bytes() != b"mine":
        raise Fall(f"{parts.name} was a file of others: {' '.join(words)} changes it")


def odd_input(spot):
    """Inputs that are no files, or empty, or end too early."""
    job = spot.job()
    program = job.words[0]
    name = job.words[1]
    old = spot.old(job)
    (spot.folder / "empty").write_bytes(b"")
    (spot.folder / "loop").symlink_to("loop")
    (spot.folder / "cut").write_bytes(spot.chain.bytes[name][:spot.random.randint(1, len(spot.chain.bytes[name]) - 2)])
    path = spot.random.choice([".", "/", "empty", "loop", "cut", "none", "/dev/null", "/dev/zero", "x" * 300, "y/" * 2500, "",
                               "/proc/self/mem", "/proc/self/exe"])
    outcome = spot.run(program, path, *job.words[2:])
    what = f"{program} {path[:300]!r} {' '.join(job.words[2:])}"
    spot.refused(outcome, what)
    spot.end(job, outcome.status, old, what)


ATTACKS = [not_a_file, not_a_file, not_a_file, through_link, input_as_output, input_as_output, two_outputs_in_one, odd_name,
           no_rights, odd_parts, odd_input]
