// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <limits>
#include <string>

#include "common/matrices/stiffness_error.hpp"
#include "stage1_plate/scene/scene.hpp"

namespace fastjoint::stage1 {

/// Relative errors by Frobenius norms that a model is to reach; infinite: any will do.
struct Wanted {
  double matrices = std::numeric_limits<double>::infinity();  ///< of S, R and C_t
  double hoop = std::numeric_limits<double>::infinity();      ///< of hoop stresses around holes, by hoop_error
};

/// The model that was chosen for an accuracy.
struct Accuracy {
  PlateScene scene;  ///< with the space, rings, tolerance of waves and highest degree chosen
  Wanted asked;
  std::vector<matrices::RelativeError> errors;  ///< estimated, of S, R and C_t
  double hoop_error;                            ///< estimated, if it is wanted
  bool free_rings;                              ///< true if the scene left the rings of a hole open
  /// The worse of the errors over what is wanted.
  [[nodiscard]] double excess() const {
    return std::max(matrices::largest(errors) / asked.matrices, hoop_error / asked.hoop);
  }
  [[nodiscard]] bool is_reached() const { return excess() <= 1; }
};

/// Takes the cheapest model that reaches relative errors by its own estimates, or else the best that there is: no more
/// orders of waves than the error of hoop stresses asks for, product space, one ring around every hole, the degree
/// rising from the scene's lowest; where its highest does not do, another ring, as long as rings help. What the scene
/// itself says of `space` and of a hole's `rings` stays.
///
/// The order follows what models cost at about equal error, here 1e-5, in ms with the fields for stresses, of panels of
/// 3 x 3 and 10 x 10 holes (one thread of a busy machine): product space, one ring, p = 4: 18 and 1300; two rings, p =
/// 4: 29 and 2000; none, p = 7: 31 and 1800; trunk space, one ring, p = 5: 27 and 1400, p = 6: 40 and 2100. To 1e-9 and
/// below, one ring is still as good as two. Where holes do not limit the error a ring may double the cost.
///
/// Throws InputError for a scene of one degree only, or with nothing that S is of.
[[nodiscard]] Accuracy meet_accuracy(const PlateScene& scene, const Wanted& wanted);

/// One line: "accuracy 0.0001: product space, p = 4, rings 1: error of S about 6.10e-05, of R about 4.20e-05", and of
/// hoop stresses "accuracy of hoop stresses 0.001: product space, p = 5, rings 1: error of hoop stresses
/// about 4.2e-04".
[[nodiscard]] std::string to_text(const Accuracy& chosen);

}  // namespace fastjoint::stage1
