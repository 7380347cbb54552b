// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/interfaces/interface.hpp"
#include "stage3_nonlinear/model/parameters.hpp"

namespace fastjoint::stage3 {

/// Names of the input parameters by which forces are differentiated, and the columns of the derivatives: the load
/// factor, the clearances of all n planes, the parameters of laws, the coefficients of friction of fasteners, then of
/// rims of contact, forces, displacements, gaps.
struct JointNumbers {
  Index n_planes = 0;
  /// (l) names and parameters of the laws in the order of the planes, once for planes with the same law.
  std::vector<std::pair<std::string, Parameter>> law;
  std::vector<std::string> friction;      ///< (f) "plate:hole" of each hole of a fastener with friction
  std::vector<std::string> rim_friction;  ///< (s) "plate:hole" of each rim of contact with friction
  std::vector<std::string> force;         ///< (u) "plate:external" without a given displacement, loaded or not
  std::vector<std::string> displacement;  ///< (v) "plate:external" with a given one
  std::vector<std::string> gap;           ///< (g) "plate:hole" of each rim of contact
  // Columns, -1 if a parameter has none.
  std::vector<Index> of_law;       ///< (n) of the first parameter of each plane's law
  std::vector<Index> of_friction;  ///< of each hole of a fastener, fastener after fastener
  std::vector<Index> of_rim;       ///< (g) of the coefficient of each rim of contact
  std::vector<Index> of_load;      ///< of each of loads_of

  [[nodiscard]] Index first_gap() const { return n_derivatives() - std::ssize(gap); }
  [[nodiscard]] Index n_derivatives() const {
    return 1 + n_planes + std::ssize(law) + std::ssize(friction) + std::ssize(rim_friction) + std::ssize(force) +
           std::ssize(displacement) + std::ssize(gap);
  }
  [[nodiscard]] Index column(const Change& change) const;
  /// The kinds of numbers in the order of the columns.
  [[nodiscard]] std::vector<formats::NumberColumns> kinds() const;
};
[[nodiscard]] JointNumbers joint_numbers(const JointModel& joint, const Parameters& parameters);

}  // namespace fastjoint::stage3
