// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/secondary_bending.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "stage3_nonlinear/output/output.hpp"
#include "stage3_nonlinear/strength/bending_factors.hpp"

namespace fastjoint::stage3 {
namespace {

/// A sheet of the lap: at its most loaded row, the hole with the largest gross stress, and its highest peak.
struct LapSheet {
  double t = 0, E = 0, gross = 0, peak = 0;
  std::string hole;  ///< of the highest peak
};

std::optional<LapSheet> loaded_sheet(const PlateModel& plate, const PlateState& state, int axis) {
  LapSheet found;
  for (Index i = 0; i < std::ssize(state.rims); ++i) {
    const HoleState& rim = state.rims[i];
    const double gross = rim.gross_concentration > 0 ? rim.peak_hoop / rim.gross_concentration : 0;
    if (rim.peak_hoop > found.peak) found.peak = rim.peak_hoop, found.hole = plate.stresses.rim_hole[i];
    if (!std::isfinite(gross) || !rim.in_tension || gross <= found.gross) continue;
    found.t = plate.stresses.rim_thickness[i], found.E = plate.stresses.rim_modulus(i, axis), found.gross = gross;
  }
  if (found.gross > 0 && found.t > 0 && found.E > 0) return found;
  return std::nullopt;
}

/// How far the outer rows of fasteners are apart along a direction; none if a fastener is not one of the two sheets
/// alone, or its hole is not known.
std::optional<double> overlap_along(const JointModel& joint, const Eigen::Vector2d& along) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ShearPlane& plane : joint.planes) {
    const FastenerModel& fastener = joint.fasteners[plane.fastener];
    if (fastener.grounded || fastener.holes.size() != 2) return std::nullopt;
    const HoleModel& hole = joint.holes(plane).front();
    const auto at = joint.described(hole);
    if (!at) return std::nullopt;
    const double place = joint.plates[hole.plate].stresses.rim_center.row(*at).dot(along);
    low = std::min(low, place);
    high = std::max(high, place);
  }
  return high - low;
}

}  // namespace

std::string secondary_bending(const JointModel& joint, const JointState& state) {
  if (joint.plates.size() != 2) return "";
  const Eigen::Vector2d force = state.plates[0].by_fasteners;
  if (force.norm() <= 0.5 * state.transferred_first.sum())
    return "";  // a doubler takes its load at one end and gives it back at the other
  const int axis = std::abs(force.x()) >= std::abs(force.y()) ? 0 : 1;
  const auto overlap = overlap_along(joint, force.normalized());
  const auto first = loaded_sheet(joint.plates[0], state.plates[0], axis);
  const auto second = loaded_sheet(joint.plates[1], state.plates[1], axis);
  if (!overlap || !first || !second) return "";
  const double N = std::max(first->gross * first->t, second->gross * second->t);
  const auto factors = bending_factors({first->t, second->t}, {first->E, second->E}, N, *overlap);
  std::string text = fmt::format(
      "  secondary bending, which the stresses above do not have, by the neutral line: if nothing supports this single "
      "lap against bending, outer rows {:.6g} {} apart\n",
      *overlap, unit(joint.units, 1, 0));
  for (const std::size_t i : {0, 1}) {
    const LapSheet& sheet = i == 0 ? *first : *second;
    text += fmt::format(
        "  {:<24} bending {:.3f} of the gross stress {:.6g}: {:+.6g} {} at the surface that touches the other sheet, "
        "where the highest membrane peak is {:.6g} (hole {})\n",
        joint.plates[i].name, factors[i], sheet.gross, factors[i] * sheet.gross, unit(joint.units, -2, 1), sheet.peak,
        sheet.hole);
  }
  return text;
}

}  // namespace fastjoint::stage3
