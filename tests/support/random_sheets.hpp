// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>
#include <string>
#include <vector>

#include "tests/support/plates.hpp"

namespace fastjoint::test {

/// A scene on a grid that can be asked for a finer mesh of the same sheet.
struct GridSheet {
  std::vector<double> x, y;
  std::vector<std::vector<double>> thickness;  ///< (y cells, x cells)
  std::vector<HoleText> holes;
  std::string extra;  ///< members of the scene, each with a comma before it

  /// PLATE.json. @param rings Extra rings around every hole.
  [[nodiscard]] std::string json(int rings, const std::string& more) const;
};

/// The same sheet with lines at a tenth and, `layers` times over, a tenth of that of the room between each line and the
/// holes beside it: a mesh graded towards all that may be singular at lines.
[[nodiscard]] GridSheet graded(const GridSheet& sheet, int layers);

/// A sheet of 1 to 5 holes, whole or half, in a grid of random lines; thickness the same or a table; supports along
/// symmetry lines or clamped; rigid edges and tractions. Digits are those of every library: only the engine is the
/// standard's.
[[nodiscard]] GridSheet random_sheet(unsigned seed);

}  // namespace fastjoint::test
