# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the forces of a result are those of the laws of its joint, computed anew from the displacements."""
import json

import numpy as np

from balance import off


def check_laws(scene, result):
    """F is the law of delta, for laws that are lines or powers and have no past."""
    laws = {name: law for name, law in scene.joint["laws"].items()}
    planes = iter(range(len(result["fastener/id"])))
    for fastener in scene.joint["fasteners"]:
        n = len(fastener["between"]) - 1
        names = [fastener["law"]] * n if isinstance(fastener["law"], str) else fastener["law"]
        clearance = fastener.get("clearance", 0.0)
        for k, plane in zip(range(n), planes):
            law, free = laws[names[k]], clearance if not isinstance(clearance, list) else clearance[k]
            if law["type"] not in ("linear", "power"):
                continue
            for step in range(len(result["load_factor"])):
                _check_law(json.dumps(law), law, free, result, step, plane)


def _check_law(text, law, free, result, step, plane):
    delta, F = result["delta"][step, plane], result["F"][step, plane]
    if law.get("one_sided") and delta < 0:
        wanted = slope = 0.0
    else:
        past = max(abs(delta) - free - law.get("delta0", 0.0), 0.0)
        n = law.get("n", 1)
        wanted = np.sign(delta) * law.get("k", law.get("A")) * past ** n
        slope = abs(wanted) * n / past if past > 0 else 0.0
        if n < 1 and delta:  # steep where it begins, so that rounding of delta changes F much
            scale_of_delta = abs(delta) + free + law.get("delta0", 0.0)
            slope = max(slope, law["A"] * (past + 1e-9 * scale_of_delta) ** n / (past + 1e-9 * scale_of_delta))
    scale = max(np.abs(result["F"][step]).max(), abs(wanted))
    # Forces that are set to zero as rounding:
    small = 1e-13 * law.get("k", law.get("A", 0.0) if law.get("n") == 1 else 0.0)
    rounding = 1e-12 * slope * abs(delta) + small + 1e-300
    off(f"plane {plane}, increment {step}: F is not its law {text}", [F], wanted, scale, rounding)
