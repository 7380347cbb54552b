# SPDX-License-Identifier: GPL-3.0-or-later
"""Joints of Bortman & Szabo, section 6.2, with other numbers than those of bare.json, for scripts."""
import json
from pathlib import Path

BARE = Path(__file__).resolve().parent / "bare.json"


def joint(k, load, clearance=0, friction=0):
    """Laws of stiffness k, a clearance of fastener 1 and friction in all holes; the paths of the plates are those of bare.json."""
    scene = json.loads(BARE.read_text())
    scene["laws"]["bolt"]["k"] = k
    scene["loads"][0]["force"] = load
    for fastener in scene["fasteners"]:
        fastener["friction"] = friction
    scene["fasteners"][0]["clearance"] = clearance
    return scene
