# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/input-*.md are what scripts/check/schema_pages makes of the schemas, every key and word of them among it."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def words(schema):
    """All keys, words and descriptions of a schema, at whatever depth; what conditions say again aside."""
    if isinstance(schema, list):
        yield from (word for each in schema for word in words(each))
    elif isinstance(schema, dict):
        yield from schema.get("properties", {})
        yield from (word for word in schema.get("enum", []) if isinstance(word, str))
        yield from [schema["description"]] if "description" in schema and isinstance(schema["description"], str) else []
        yield from (word for key, each in schema.items() if key not in ("if", "then", "else", "allOf") for word in words(each))


def main():
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([ROOT / "scripts/check/schema_pages", folder], check=True)
        for kind in ("plate", "joint", "study"):
            page = (ROOT / f"docs/input-{kind}.md").read_text()
            if page != Path(folder, f"input-{kind}.md").read_text():
                problems.append(f"docs/input-{kind}.md is not what scripts/check/schema_pages writes")
            schema = json.loads((ROOT / f"schemas/{kind}.schema.json").read_text())
            problems += [f"docs/input-{kind}.md: lacks {word}" for word in words(schema) if word.replace("|", "\\|") not in page]
    print("\n".join(problems) or "pages and schemas agree")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
