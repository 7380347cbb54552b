# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that appear whole or not at all."""
import os
import secrets
from pathlib import Path


def write_whole(path, content):
    """Puts bytes at a path by way of a temporary file beside it; a symbolic link stays one. Raises OSError."""
    target = Path(os.path.realpath(path))
    temporary = target.with_name(f"{target.name}.{secrets.token_hex(4)}.partial")
    try:
        temporary.write_bytes(content)
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)
