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

/// True if a case of a sense acts under an amount of its load at a load factor. One of 0 counts as positive.
[[nodiscard]] inline bool acts(int sense, double amount, double load_factor) {
  return sense != ((amount < 0) == (load_factor < 0) ? -1 : 1);
}

/// Amount of each case per unit of the load factor, at a load factor, (cases).
/// @param load Amounts of the loads at load factor 1.
[[nodiscard]] VectorXd load_rates(const std::vector<LoadCase>& cases, const VectorXd& load, double load_factor);

/// Numbers of a run of a joint, by index: all that may change while its condensed system stays.
struct Parameters {
  VectorXd load;                ///< of each of loads_of at load factor 1, force or length
  std::vector<LawPointer> law;  ///< (n) of each plane
  VectorXd clearance;           ///< (n) length
  VectorXd mu, gap;             ///< of each fastener in each of its holes, fastener after fastener; gap: length
};

/// The numbers that JOINT.json gives.
[[nodiscard]] Parameters parameters_of(const JointModel& joint);

/// Place of a rim of contact.
struct RimPlace {
  Index plate, at;  ///< among PlateModel::contact
  Index hole = -1;  ///< of all holes of fasteners, in the order of Parameters::gap; -1 without a fastener
};
[[nodiscard]] std::vector<RimPlace> rim_places(const JointModel& joint);

}  // namespace fastjoint::stage3
