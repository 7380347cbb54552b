// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/governing.hpp"

#include <fmt/format.h>

#include <cmath>

namespace fastjoint::stage3 {

void set_governing(formats::JointResult& a) {
  const auto n = static_cast<int>(a.load_factor.size());
  if (n == 0) return;
  const auto govern = [&](int row, const std::string& reason) { a.governing = row + 1, a.governing_reason = reason; };
  if (!a.complete && a.case_name.size() == 1) return govern(n - 1, "the last that was solved");
  if (!a.margins.empty() && std::isfinite(a.margins[0].margin))
    return govern(a.margins[0].at, fmt::format("the smallest margin, {} of {}", a.margins[0].check, a.margins[0].of));
  constexpr double same_peak = 1e-9;  // the later of equal ones
  double highest = 0;
  for (const auto& plate : a.plates) {
    const auto& peaks = plate.columns["rim/peak_hoop"];
    for (int row = 0; row < peaks.rows(); ++row)
      for (Eigen::Index rim = 0; rim < peaks.cols(); ++rim) {
        const double peak = peaks(row, rim);
        if (!(peak > 0) || !(peak >= highest * (row >= a.governing ? 1 - same_peak : 1 + same_peak))) continue;
        highest = std::max(highest, peak);
        govern(row, fmt::format("the highest peak, at {}:{}", plate.name, plate.holes.hole[rim]));
      }
  }
  if (a.governing > 0) return;
  Eigen::Index row = n - 1, at = 0;
  const auto& transferred = a.columns["transferred"];
  if (transferred.size() > 0 && transferred.cwiseAbs().maxCoeff() > 0) transferred.cwiseAbs().maxCoeff(&row, &at);
  govern(static_cast<int>(row), "the largest load of a shear plane");
}

}  // namespace fastjoint::stage3
