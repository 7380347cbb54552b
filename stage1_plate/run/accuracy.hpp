// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <limits>
#include <string>

#include "common/matrices/stiffness_error.hpp"
#include "stage1_plate/scene/scene.hpp"

namespace fastjoint::stage1 {

/// Target relative errors in Frobenius norms; infinite without a target.
struct Targets {
  double matrices = std::numeric_limits<double>::infinity();  ///< for S, R and C_t
  double hoop = std::numeric_limits<double>::infinity();      ///< for hoop stresses around holes, by hoop_error
};

/// The model chosen for an accuracy, with its estimated errors.
struct Accuracy {
  PlateScene scene;  ///< with the space, rings, tolerance of waves and highest degree chosen
  Targets targets;
  std::vector<matrices::RelativeError> errors;  ///< estimated errors of S, R and C_t
  double hoop_error;                            ///< estimated, if it has a target
  bool free_rings;                              ///< true if the scene does not set the rings of some hole
  /// The larger ratio of an error to its target.
  [[nodiscard]] double excess() const {
    return std::max(matrices::largest(errors) / targets.matrices, hoop_error / targets.hoop);
  }
  [[nodiscard]] bool is_reached() const { return excess() <= 1; }
};

/// Finds the cheapest model whose estimated errors reach the targets, or else the best model. The number of wave orders
/// follows from the target for hoop stresses. It starts with the product space and one ring around every hole and
/// raises the degree from the scene's lowest; if the highest is not sufficient, it adds rings as long as they help.
/// Values of `space` and of a hole's `rings` in the scene are kept.
///
/// The order follows the cost of models with about equal errors of 1e-5, including the fields for stresses, in ms for
/// panels of 3 x 3 and 10 x 10 holes (one thread of a busy machine): product space, one ring, p = 4: 18 and 1300; two
/// rings, p = 4: 29 and 2000; no ring, p = 7: 31 and 1800; trunk space, one ring, p = 5: 27 and 1400, p = 6: 40 and
/// 2100. At 1e-9 and below, one ring is still as good as two. Where holes do not limit the error a ring may double the
/// cost.
///
/// Throws InputError for a scene with one degree only, or without discs and rigid externals if S has a target.
[[nodiscard]] Accuracy meet_accuracy(const PlateScene& scene, const Targets& targets);

/// One line: "accuracy 0.0001: product space, p = 4, rings 1: error of S about 6.10e-05, of R about 4.20e-05", and for
/// hoop stresses "accuracy of hoop stresses 0.001: product space, p = 5, rings 1: error of hoop stresses about
/// 4.2e-04".
[[nodiscard]] std::string to_text(const Accuracy& chosen);

/// Estimates the relative error of the strains along the rims, and so of hoop stresses, in unit cases: for each rim
/// twice the change from the degree below, plus the sum of all higher orders extrapolated from the last two pairs, as
/// in the error of a peak (docs/theory.md, section 11.4). Returns the maximum over all rims of Frobenius norms over
/// displacements and over tractions; infinite without a degree below, 0 without waves.
/// @param waves    Waves of every hole; those in contact come first in the rows.
/// @param W, below Rows of formats::PlateCases::W at this degree and at the one below, which is empty if there is none.
/// @param n_displacements, n_tractions Columns of unit displacements, the first, and of unit tractions, the last.
[[nodiscard]] double hoop_error(const std::vector<std::optional<rim::Waves>>& waves, const Eigen::MatrixXd& W,
                                const Eigen::MatrixXd& below, Eigen::Index n_displacements, Eigen::Index n_tractions);

}  // namespace fastjoint::stage1
