// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/stresses/rim_points.hpp"

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
double turned(double angle, double low) { return rim::wrapped(angle, low - same_angle); }

std::vector<SideAngles> all_sides(const pfem::Mesh& mesh, const pfem::Edges& edges, const rim::Rim& rim) {
  std::vector<SideAngles> sides;
  sides.reserve(rim.sides.size());
  for (const auto& side : rim.sides) {
    const auto curve = pfem::edge_curve(mesh, edges, side.element, side.local_edge);
    sides.push_back({side, curve.start_angle(), curve.sweep()});
  }
  return sides;
}

/// A part of a rim without gaps.
struct Piece {
  double from, to;
};

/// The pieces that end somewhere; none of a closed rim.
std::vector<Piece> open_pieces(const std::vector<SideAngles>& sides) {
  const auto meets = [](double end, double start) { return std::abs(turned(end, start) - start) < same_angle; };
  std::vector<Piece> pieces;
  for (const auto& first : sides) {
    const auto ends_here = [&](const SideAngles& other) { return meets(other.high(), first.low()); };
    if (std::any_of(sides.begin(), sides.end(), ends_here)) continue;
    Piece piece{first.low(), first.high()};
    const auto goes_on = [&](const SideAngles& other) { return meets(piece.to, other.low()); };
    for (auto next = std::find_if(sides.begin(), sides.end(), goes_on); next != sides.end();
         next = std::find_if(sides.begin(), sides.end(), goes_on))
      piece.to += next->high() - next->low();
    pieces.push_back(piece);
  }
  return pieces;
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

std::vector<RimPoint> rim_points(const pfem::Mesh& mesh, const pfem::Edges& edges, const rim::Rim& rim) {
  const auto sides = all_sides(mesh, edges, rim);
  constexpr double step = rim::full_turn / n_points_per_turn;
  std::vector<RimPoint> points;
  if (sides.empty()) return points;
  const auto pieces = open_pieces(sides);
  if (pieces.empty())
    for (int i = 0; i < n_points_per_turn; ++i) points.push_back(point_at(sides, i * step));
  for (const auto& piece : pieces) {
    const int n_steps = std::max(1, static_cast<int>(std::lround((piece.to - piece.from) / step)));
    for (int i = 0; i <= n_steps; ++i)
      points.push_back(point_at(sides, piece.from + i * (piece.to - piece.from) / n_steps));
  }
  return points;
}

}  // namespace fastjoint::stage2
