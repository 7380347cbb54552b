# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn in a picture."""
import contextlib
import io
import runpy
import sys
from unittest import mock

import matplotlib
import matplotlib.image
import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def run_and_look(script, *words):
    """Runs a Python script that draws; what it prints, and of each of the axes that it saves last the curves by label, x and y."""
    plt.close("all")
    printed, curves = io.StringIO(), []
    savefig = Figure.savefig

    def look_and_save(figure, *args, **options):
        curves[:] = [{line.get_label(): line.get_xydata().T for line in axis.lines} for axis in figure.axes]
        savefig(figure, *args, **options)

    with (mock.patch.object(sys, "argv", [str(script), *map(str, words)]), contextlib.redirect_stdout(printed),
          mock.patch.object(Figure, "savefig", look_and_save)):
        runpy.run_path(str(script), run_name="__main__")
    return printed.getvalue(), curves


def same_pixels(one, other):
    return np.array_equal(matplotlib.image.imread(one), matplotlib.image.imread(other))


def extent(path, colour):
    """Shares of a picture's width and height over which it has this colour, and of its area."""
    picture = matplotlib.image.imread(path)[:, :, :3]
    rows, columns = np.nonzero(np.abs(picture - to_rgb(colour)).max(axis=2) < 0.01)
    if len(rows) == 0:
        return 0, 0, 0
    height, width = picture.shape[:2]
    return np.ptp(columns) / width, np.ptp(rows) / height, len(rows) / (width * height)


def check_curves(path, colours, least_width=0.3):
    """Each of these colours runs across the picture, up or down."""
    for colour in colours:
        width, height, area = extent(path, colour)
        assert width > least_width and height > 0.1 and area > 3e-4, f"{path}: no curve of {colour}: {width}, {height}, {area}"


def check_field(path, colours="YlOrRd"):
    """A field is drawn with most colours of its map, those of the least and of the largest value among them."""
    picture = matplotlib.image.imread(path)[:, :, :3]
    drawn = {tuple(colour) for colour in np.rint(255 * picture.reshape(-1, 3)).astype(int)}
    scale = matplotlib.colormaps[colours](np.arange(256), bytes=True)[:, :3].astype(int)
    present = np.array([tuple(colour) in drawn for colour in scale])
    assert present[:8].any() and present[-8:].any() and present.mean() > 0.5, f"{path}: {present.sum()} colours of 256"
