// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/extremes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace fastjoint::pfem {
namespace {

/// Smallest and largest of some numbers.
struct Span {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  void add(double x) { low = std::min(low, x), high = std::max(high, x); }
  [[nodiscard]] std::string text() const { return fmt::format("{:.3g} to {:.3g}", low, high); }
};

}  // namespace

std::string extremes(const Mesh& mesh, const std::vector<Eigen::Matrix3d>& elasticity,
                     const std::vector<double>& springs) {
  double slender = 1;
  int most_slender = 0;
  Span sides, thicknesses, moduli, of_springs;
  for (int i = 0; i < mesh.n_elements(); ++i) {
    Span its;
    for (int side = 0; side < 4; ++side)
      its.add((mesh.nodes.col(mesh.quads(side, i)) - mesh.nodes.col(mesh.quads((side + 1) % 4, i))).norm());
    sides.add(its.low), sides.add(its.high);
    thicknesses.add(mesh.thickness[i]);
    if (its.high / its.low > slender) slender = its.high / its.low, most_slender = i;
  }
  for (const auto& D : elasticity) moduli.add(D.diagonal().minCoeff()), moduli.add(D.diagonal().maxCoeff());
  for (const double each : springs)
    if (each > 0) of_springs.add(each);
  return fmt::format(
      "the most slender element, {}, is {:.3g} times as long as it is short, sides are {}, thicknesses {}, moduli "
      "{}{}; "
      "allowed: more even cells, springs nearer to modulus times thickness, supports or springs that hold the sheet "
      "well, nu further from 0.5 in plane strain, or a lower p",
      most_slender, slender, sides.text(), thicknesses.text(), moduli.text(),
      of_springs.high > 0 ? ", springs " + of_springs.text() : "");
}

}  // namespace fastjoint::pfem
