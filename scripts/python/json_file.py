# SPDX-License-Identifier: GPL-3.0-or-later
"""JSON files as the programs take them: with comments, // to the end of a line and /* */."""
import json
import re
import sys
from pathlib import Path

TOKENS = re.compile(r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/', re.S)


def parse_json(text):
    """What a text with comments holds."""
    return json.loads(TOKENS.sub(lambda found: found[0] if found[0][0] == '"' else re.sub(r"[^\n]", " ", found[0]), text))


def read_json(path, program):
    """What a file holds. Ends the program with status 2 and a message if it cannot be read."""
    try:
        return parse_json(Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
        fail(program, f"{path}: cannot be read: {error}")


def fail(program, text, status=2):
    """Ends the program with a message on stderr, as the three stages do."""
    print(f"{program}: error: {text}", file=sys.stderr)
    raise SystemExit(status)
