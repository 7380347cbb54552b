# SPDX-License-Identifier: GPL-3.0-or-later
"""The JSON Schemas and the strict readers of the programs give every input the same verdict, and examples have nothing that is implausible.

usage: agreement_test.py BIN_FOLDER [sweep]; with the last word every mutant of the good inputs, else every third
"""
import copy
import json
import pathlib
import re
import shutil
import sys
import tempfile
from itertools import islice

from jsonschema import Draft7Validator, validators

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "pipeline"))
from bad_inputs import BAD_INPUTS, MISSING  # noqa: E402
from plausible_test import KINDS  # noqa: E402
from programs import ROOT, Programs  # noqa: E402

GOOD = sorted((ROOT / "tests/schemas/good").glob("*.json"))
TABLES = sorted((ROOT / "tests/schemas/good").glob("*.csv"))
SCHEMAS = {kind: json.loads((ROOT / f"schemas/{kind}.schema.json").read_text()) for kind in ("plate", "joint", "study")}
# The joints that studies vary, by the folder of the study.
STUDIED = {"good": "joint_laws.json", "three_fasteners": "bare.json"}
IMPLAUSIBLE = "|".join(["may be", *(re.escape(f"[{code}]") for code, _ in KINDS)])
SWEEP = "sweep" in sys.argv[2:]
# Examples that take seconds, which pipeline/readme and pipeline/tune run.
RUN_ELSEWHERE = [] if SWEEP else ["butt_joint/collapse.json", "splice/tune.json"]
P = 3  # the lowest degree of which all joints converge soon is enough for a verdict

# Places whose loss is a matter of meaning: something else refers to what stood there.
REFERRED_TO = re.compile(r"/materials/[^/]+|/geometry/mesh/(arcs|edges(/[^/]+)?)|/laws/[^/]+|/plates/[^/]+|/samples")
# Words that change nothing else: each is tried in one good example.
EACH_WORD = [("joint", "joint_stack", "/solver/method")]


def recording(used):
    """A validator that also notes which properties and which words of which enum it met."""
    def properties(validator, properties, instance, schema):
        used.update((id(properties), key) for key in properties if isinstance(instance, dict) and key in instance)
        yield from Draft7Validator.VALIDATORS["properties"](validator, properties, instance, schema)

    def enum(validator, words, instance, schema):
        used.update((id(words), word) for word in words if word == instance)
        yield from Draft7Validator.VALIDATORS["enum"](validator, words, instance, schema)
    return validators.extend(Draft7Validator, {"properties": properties, "enum": enum})


USED = set()
VALIDATORS = {kind: recording(USED)(schema) for kind, schema in SCHEMAS.items()}


def pointer(keys):
    return "".join("/" + str(key).replace("~", "~0").replace("/", "~1") for key in keys)


def related(a, b):
    return a == b or a.startswith(b + "/") or b.startswith(a + "/")


class Judge:
    """Asks schema and program about documents of one kind in a folder that has what joints refer to."""

    def __init__(self, kind, folder, programs, studied=STUDIED["good"]):
        self.kind, self.folder, self.programs, self.studied = kind, folder, programs, folder and folder / studied

    def schema(self, document):
        """Places that the schema refuses."""
        return [pointer(error.absolute_path) for error in VALIDATORS[self.kind].iter_errors(document)]

    def program(self, document):
        """Exit status, place that the program refuses or None, and its message."""
        scene, output = self.folder / "input.json", self.folder / "output.h5"
        scene.write_text(self.with_digest(json.dumps(document)))
        if self.kind == "study":
            shutil.rmtree(f"{output}.parts", ignore_errors=True)
            result = self.programs.study(scene, output, self.studied)
        else:
            result = self.programs.plate(scene, output, P) if self.kind == "plate" else self.programs.joint(scene, output)
        named = re.search(f"error: {re.escape(str(scene))}: (/.*?): ", result.stderr)
        return result.returncode, named and named[1].rstrip("/"), result.stderr

    def with_digest(self, text):
        """The digest of a file depends on the machine's rounding: what stands for it in good inputs gives way to it."""
        matrices = self.folder / "plate_half_holes.matrices.h5"
        return text.replace("0123456789abcdef", matrices.read_bytes()[-17:-1].decode()) if matrices.exists() else text

    def good(self, document, implausible=None):
        refused = self.schema(document)
        if refused:
            yield f"the schema refuses {refused}"
        status, _, message = self.program(document)
        at_collapse = isinstance(document, dict) and str(document.get("name", "")).endswith(", collapse")
        if status != (4 if at_collapse else 0):
            yield f"the program ends with {status}: {message}"
        if implausible and re.search(implausible, message):
            yield f"the program finds something implausible: {message}"

    def bad(self, document, place):
        """Both must refuse, and there."""
        refused = self.schema(document)
        if not any(related(found, place) for found in refused):
            yield f"the schema refuses {refused or 'nothing'}, expected '{place}'"
        status, found, message = self.program(document)
        if status != 2 or found is None or not related(found, place):
            yield f"the program ends with {status}, expected 2 and the place '{place}': {message}"

    def same(self, document):
        refused = self.schema(document)
        status, _, message = self.program(document)
        if bool(refused) != (status == 2):
            yield f"the schema refuses {refused or 'nothing'}, the program ends with {status}: {message}"


def patched(document, place, value):
    """A changed copy, and where the change is to be noticed: a missing or nameless key in the object that it is of."""
    document = node = {"": copy.deepcopy(document)}
    *parents, last = [key.replace("~1", "/") for key in place.split("/")]
    for key in parents:
        node = node[int(key) if isinstance(node, list) else key]
    if value is MISSING:
        del node[last]
    else:
        node[int(last) if isinstance(node, list) else last] = value
    return document[""], place.rpartition("/")[0] if value is MISSING or not last else place


def everywhere(node, place=""):
    """(place, value) of a document and of all that is in it."""
    yield place, node
    children = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else []
    for key, child in children:
        yield from everywhere(child, f"{place}/{key}")


def mutants(document, seen):
    """(what is done, place, value) at every place of a kind not seen before."""
    for place, node in everywhere(document):
        kind = re.sub(r"/\d+", "/*", place)
        if (kind, type(node)) in seen:
            continue
        seen.add((kind, type(node)))
        yield "null", place, None
        if isinstance(node, dict):
            yield "unknown key", f"{place}/unknown", None
        if place and not kind.endswith("*") and not REFERRED_TO.fullmatch(kind):
            yield "missing key", place, MISSING


def check_examples(judge, folder, paths, samples=4, implausible=None):
    """Nor says the program what `implausible` matches, a pattern."""
    for path in paths:
        document = json.loads(path.read_text())
        schema = document.get("$schema")
        if schema and (path.parent / schema).resolve() != ROOT / f"schemas/{judge.kind}.schema.json":
            yield f"{path}: $schema does not lead to the schema"
        if judge.kind != "plate":
            judge.programs.prepare_joint(folder / path.name if judge.kind == "joint" else judge.studied, P)
        if "samples" in document:  # few are enough for a verdict
            document["samples"] = min(document["samples"], samples)
        yield from (f"{path}: {problem}" for problem in judge.good(document, implausible))


def check_words(judge, schema):
    for kind, base, place in EACH_WORD:
        if kind != judge.kind:
            continue
        good = json.loads((ROOT / f"tests/schemas/good/{base}.json").read_text())
        node = schema
        for key in place.split("/")[1:]:
            node = node["properties"][key]
        for word in node["enum"]:
            document, _ = patched(good, place, word)
            yield from (f"{base}: {place} = {word}: {problem}" for problem in judge.good(document))


def check_bad(judge):
    for name, base, place, value in BAD_INPUTS:
        if not name.startswith(judge.kind):
            continue
        good = json.loads((ROOT / f"tests/schemas/good/{base}.json").read_text())
        yield from (f"{name}: {problem}" for problem in judge.bad(*patched(good, place, value)))


def check_mutants(judge, paths):
    seen = set()
    every = 1 if SWEEP else 3
    for path in paths:
        good = json.loads(path.read_text())
        for what, place, value in islice(mutants(good, seen), 0, None, every):
            document, noticed = patched(good, place, value)
            problems = judge.same(document) if value is MISSING else judge.bad(document, noticed)
            yield from (f"{path}: {what} '{place}': {problem}" for problem in problems)


def check_schema(schema):
    """Every property is described; after the good examples, each has been used, and every word of every enum."""
    Draft7Validator.check_schema(schema)
    for place, node in everywhere(schema):
        if not isinstance(node, dict):
            continue
        if node.get("additionalProperties") is False:
            for key, value in node.get("properties", {}).items():
                target = schema["definitions"][value["$ref"].split("/")[-1]] if "$ref" in value else value
                if "description" not in target:
                    yield f"schema: {place}/properties/{key}: has no description"
                if (id(node["properties"]), key) not in USED:
                    yield f"schema: {place}/properties/{key}: is in no good example"
        for word in node.get("enum", []):
            if (id(node["enum"]), word) not in USED:
                yield f"schema: {place}/enum: {word} is in no good example"


def copied(folder, paths):
    for path in paths:
        shutil.copy(path, folder)
    return folder


def example_copied(root, example):
    """An example's folder, from which its Makefile finds the scripts and the other examples."""
    (root / "scripts").symlink_to(ROOT / "scripts")
    (root / "examples").mkdir()
    for other in (ROOT / "examples").iterdir():
        if other != example:
            (root / "examples" / other.name).symlink_to(other)
    return shutil.copytree(example, root / example.relative_to(ROOT), ignore=shutil.ignore_patterns("out", "*.h5"))


def main():
    programs = Programs(sys.argv[1])
    problems = []
    with tempfile.TemporaryDirectory() as name:
        folder = copied(pathlib.Path(name), GOOD + TABLES)
        for kind, schema in SCHEMAS.items():
            judge = Judge(kind, folder, programs)
            paths = [path for path in GOOD if path.name.startswith(kind)]
            problems += check_examples(judge, folder, paths)
            problems += check_words(judge, schema)
            problems += check_schema(schema)
            problems += check_bad(judge)
            problems += check_mutants(judge, paths)
    for path in sorted(ROOT.glob("examples/**/*.json")):
        kind = path.read_text().partition(".schema.json")[0].rpartition("/")[2]
        if any(path.match(each) for each in RUN_ELSEWHERE):
            problems += [f"{path}: the schema refuses {refused}" for refused in Judge(kind, None, programs).schema(json.loads(path.read_text()))]
        elif kind in SCHEMAS and path.parent.name != "out":  # what an example's run has left there is none
            with tempfile.TemporaryDirectory() as name:
                folder = example_copied(pathlib.Path(name), path.parent)
                studied = STUDIED.get(path.parent.name, "joint.json")
                # The paper moves its fasteners further than their holes are wide.
                implausible = None if path.match("three_fasteners/joint.json") else IMPLAUSIBLE
                problems += check_examples(Judge(kind, folder, programs, studied), folder, [path], 1, implausible)
    print("\n".join(problems) or "schemas and programs agree")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
