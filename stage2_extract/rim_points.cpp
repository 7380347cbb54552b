// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/rim_points.hpp"

#include <algorithm>
#include <cmath>

namespace fastjoint::stage2 {
namespace {

constexpr double same_angle = 1e-7;

/// A side of a rim by its angles.
struct SideAngles {
  pfem::Side side;
  double start, sweep;  ///< at s = -1, and its increase up to s = 1

  [[nodiscard]] double low() const { return std::min(start, start + sweep); }
  [[nodiscard]] double high() const { return std::max(start, start + sweep); }
};

/// The multiple of a full turn away from `angle` in [low - same_angle, low - same_angle + full turn).
double turned(double angle, double low) {
  return angle - pfem::full_turn * std::floor((angle - low + same_angle) / pfem::full_turn);
}

std::vector<SideAngles> all_sides(const pfem::Mesh& mesh, const pfem::Edges& edges, const pfem::Rim& rim) {
  std::vector<SideAngles> sides;
  sides.reserve(rim.sides.size());
  for (const auto& side : rim.sides) {
    const auto curve = pfem::edge_curve(mesh, edges, side.element, side.local_edge);
    sides.push_back({side, curve.start_angle(), curve.sweep()});
  }
  return sides;
}

/// Where no other side ends; 0 of a closed rim.
double first_angle(const std::vector<SideAngles>& sides) {
  for (const auto& side : sides) {
    const auto ends_here = [&](const SideAngles& other) {
      return turned(other.high(), side.low()) < side.low() + same_angle;
    };
    if (std::none_of(sides.begin(), sides.end(), ends_here)) return side.low();
  }
  return 0;
}

RimPoint point_at(const std::vector<SideAngles>& sides, double angle) {
  RimPoint point{angle, {}};
  for (const auto& side : sides) {
    const double inside = turned(angle, side.low());
    if (inside > side.high() + same_angle) continue;
    const double s = -1 + 2 * (inside - side.start) / side.sweep;
    point.on.push_back({side.side, std::clamp(s, -1.0, 1.0), 2 / side.sweep});
  }
  return point;
}

}  // namespace

std::vector<RimPoint> rim_points(const pfem::Mesh& mesh, const pfem::Edges& edges, const pfem::Rim& rim) {
  const auto sides = all_sides(mesh, edges, rim);
  const double step = pfem::full_turn / n_points_per_turn;
  const int n_steps = static_cast<int>(std::lround(pfem::covered_angle(mesh, edges, rim) / step));
  const int n = n_steps < n_points_per_turn ? n_steps + 1 : n_steps;
  const double first = first_angle(sides);
  std::vector<RimPoint> points;
  for (int i = 0; i < n; ++i) points.push_back(point_at(sides, first + i * step));
  return points;
}

}  // namespace fastjoint::stage2
