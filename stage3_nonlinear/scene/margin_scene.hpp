// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/input/value.hpp"

namespace fastjoint::stage3 {

enum class CheckKind { bearing, fastener_shear, tension, shear_out, bearing_bypass, peak };

/// Values of "check" in JOINT.json, in the order of CheckKind.
inline const std::vector<std::string> check_names{"bearing",   "fastener shear", "tension",
                                                  "shear-out", "bearing-bypass", "peak"};

/// An allowable: a number, or a table over the edge distance e/D, linear between its points, constant above and falling
/// to 0 at e/D = 0.5 below.
struct Allowable {
  std::vector<double> edge_ratio;  ///< ascending; empty: one number for all
  std::vector<double> value;

  [[nodiscard]] double at(double ratio) const;
};

/// A strength check of holes or fasteners.
struct CheckScene {
  CheckKind kind = CheckKind::bearing;
  std::string name;             ///< in results
  std::vector<std::string> of;  ///< plates, "plate:hole", or fasteners; empty: all
  Allowable allowable;          ///< stress; of fastener shear with `is_force` the force of a shear plane
  bool is_force = false;
  bool with_bending = false;                       ///< of a peak: the stress of secondary bending is added
  std::optional<double> edge_distance;             ///< of the hole's centre along the load, length
  std::optional<double> diameter;                  ///< of the fastener, length
  std::vector<std::pair<double, double>> polygon;  ///< (bypass stress, bearing stress), around the origin
  std::vector<std::string> cases;                  ///< whose increments are checked; empty: of all cases
  double safety_factor = 1, fitting_factor = 1;
  std::string where;

  /// True if the increments of a case are checked.
  [[nodiscard]] bool counts(const std::string& its_case) const {
    return cases.empty() || std::ranges::find(cases, its_case) != cases.end();
  }
};

/// Reads "margins". @param cases Names of the joint's cases. @throws InputError.
[[nodiscard]] std::vector<CheckScene> read_margins(const input::Value& value, const std::vector<std::string>& cases);

}  // namespace fastjoint::stage3
