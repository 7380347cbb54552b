// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/model/joint_model.hpp"

namespace fastjoint::stage3 {

/// A load that a joint can carry, in the order of the plates, externals before tractions.
struct Load {
  Index plate;
  Index at;  ///< external, or first traction of its boundary
  bool is_traction, is_displacement;
};
[[nodiscard]] std::vector<Load> loads_of(const JointModel& joint);

/// A column of the condensed system: a load, or one on one side of a hole, which bears under it.
struct LoadCase {
  Index load;  ///< among loads_of
  Index plate;
  Index at;  ///< external, or traction
  bool is_traction, is_displacement;
  int sense = 0;  ///< 1 or -1: acts while its amount has this sign; 0: always
};
[[nodiscard]] std::vector<LoadCase> load_cases(const JointModel& joint);

/// True if a case of a sense acts under an amount of its load, of which 0 has the sign of how it grows.
[[nodiscard]] inline bool acts(int sense, double amount, double rate = 0) {
  return sense != (amount < 0 || (amount == 0 && rate < 0) ? 1 : -1);
}

/// Numbers of a run of a joint, by index: all that may change while its condensed system stays. Friction may act where
/// it does in JOINT.json; planes that share a law there share it in a run, and its numbers keep their names.
struct Parameters {
  VectorXd load;                ///< what a unit of the load factor adds to each of loads_of, force or length
  std::vector<LawPointer> law;  ///< (n) of each plane
  VectorXd clearance;           ///< (n) length
  VectorXd mu, gap;             ///< of each fastener in each of its holes, fastener after fastener; gap: length
  VectorXd load_before = {};    ///< loads at load factor 0, force or length; empty: none

  /// Loads at a load factor.
  [[nodiscard]] VectorXd load_at(double load_factor) const {
    return load_before.size() > 0 ? VectorXd(load_before + load_factor * load) : VectorXd(load_factor * load);
  }
};

/// The numbers that JOINT.json gives.
[[nodiscard]] Parameters parameters_of(const JointModel& joint);
/// Those of a scene that differs from the joint's in numbers alone. Throws InputError where a number is not allowed.
[[nodiscard]] Parameters parameters_of(const JointModel& joint, const JointScene& scene);

/// Place of a rim of contact.
struct RimPlace {
  Index plate, at;  ///< among PlateModel::contact
  Index hole = -1;  ///< of all holes of fasteners, in the order of Parameters::gap; -1 without a fastener
};
[[nodiscard]] std::vector<RimPlace> rim_places(const JointModel& joint);

}  // namespace fastjoint::stage3
