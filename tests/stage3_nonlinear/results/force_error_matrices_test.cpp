// SPDX-License-Identifier: GPL-3.0-or-later
// Error bars of forces where each of a plate's matrices S, R, T and C has an error that is known.
#include <gtest/gtest.h>

#include <cmath>

#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/results/force_errors.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::force_error_matrices_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Levels = std::vector<MatrixXd>;

/// Sums of q^-4 over all degrees q above p, for p = 1 .. 8 and then of none: what a sequence of that rate lacks.
const VectorXd lacking = [] {
  VectorXd values = VectorXd::Zero(9);
  double sum = 0;
  for (int q = 10000; q > 1; --q) {
    sum += std::pow(q, -4.0);
    if (q <= 9) values[q - 2] = sum;
  }
  return values;
}();

/// Three fasteners with friction, plate a under a force and a traction; errors of order 1e-6.
test::Lap lap_with_traction() {
  test::Lap lap{test::chain(3, 1, 1000, {{2, 3, 1000}, {0, test::ground, 300}}),
                test::chain(3, 0, 700, {{0, test::ground, 700}}), 100};
  std::mt19937 random(5);
  test::add_friction(lap.a, random);
  test::add_friction(lap.b, random);
  lap.a.traction_id = {"T"};
  lap.a.traction_hole = {""};
  lap.a.traction_unit_force = Eigen::VectorXd::Zero(1);
  lap.a.traction_direction = {"x"};
  lap.a.traction_bearing = {""};
  lap.a.T_d = {Eigen::Vector3d(-0.5, -0.3, -0.1)};
  lap.a.T_e = {MatrixXd::Constant(1, 1, -0.05)};
  lap.a.C_t = {MatrixXd::Constant(1, 1, 1e-2)};
  return lap;
}

/// What plate a's matrices lack, per unit of `lacking`.
struct Errors {
  MatrixXd S_dd = MatrixXd::Zero(3, 3), R_df = MatrixXd::Zero(3, 6), T_d = MatrixXd::Zero(3, 1),
           C_t = MatrixXd::Zero(1, 1);
};

/// The joint with a's degrees 1 .. 8, or, exactly, with what they tend to.
test::HandMade joint_of(const Errors& errors, bool exact) {
  test::Lap lap = lap_with_traction();
  auto& a = lap.a;
  const Eigen::Index first = exact ? 8 : 0, last = exact ? 8 : 7;
  a.p = exact ? Eigen::VectorXi::Constant(1, 8) : Eigen::VectorXi(Eigen::VectorXi::LinSpaced(8, 1, 8));
  a.ndof = a.p;
  const auto at_all = [&](Levels& matrix, const MatrixXd& error) {
    const MatrixXd limit = matrix[0];
    matrix.clear();
    for (Eigen::Index i = first; i <= last; ++i) matrix.emplace_back(limit + lacking[i] * error);
  };
  at_all(a.S_dd, errors.S_dd);
  at_all(a.R_df, errors.R_df);
  at_all(a.T_d, errors.T_d);
  at_all(a.C_t, -errors.C_t);  // compliance comes from below
  for (auto* matrix : {&a.S_ed, &a.S_ee, &a.R_ef, &a.T_e})
    at_all(*matrix, MatrixXd::Zero((*matrix)[0].rows(), (*matrix)[0].cols()));
  auto joint = test::joint_of(lap, test::linear_law(400));
  joint.plates[0].traction_id = {"T"};
  joint.traction[{0, 0}] = 50;
  for (Eigen::Index j = 0; j < 3; ++j) test::set_friction(joint, j, 0.3);
  return joint;
}

/// Error bars over the true errors of the three forces.
VectorXd bars_over_errors(const Errors& errors) {
  const stage3::PathOptions tight{{}, {.tolerance = 1e-14, .max_iterations = 200}};
  const auto joint = joint_of(errors, false);
  const auto equations = make_equations(joint);
  const auto path = stage3::follow(equations, {1}, tight);
  const auto exact = stage3::follow(make_equations(joint_of(errors, true)), {1}, tight);
  const auto bars =
      stage3::ForceErrors(joint, equations)
          .at(test::point_of(equations, path.steps.at(0)), stage3::joint_state(joint, equations, path.steps[0]));
  return bars.cwiseQuotient((path.steps[0].F - exact.steps.at(0).F).cwiseAbs());
}

/// One direction of displacement, so that the bound of the mixed term is the error itself.
const MatrixXd stiffer = 1e-3 * Eigen::Vector3d(1, 0.5, 0.2) * Eigen::RowVector3d(1, 0.5, 0.2);

void expect_true_error(const Errors& errors) {
  const VectorXd ratio = bars_over_errors(errors);
  EXPECT_GT(ratio.minCoeff(), 0.97) << ratio.transpose();
  EXPECT_LT(ratio.maxCoeff(), 1.06) << ratio.transpose();  // hypot(1, 1/4) at most, and rounding of the rate
}

TEST(ForceError, IsThatOfTheStiffness) {
  Errors errors;
  errors.S_dd = stiffer;
  expect_true_error(errors);
}

/// R follows the rate of the energy, which a small error of S shows.
TEST(ForceError, IsThatOfTheReactionsToFriction) {
  Errors errors;
  errors.S_dd = 1e-4 * stiffer;
  errors.R_df = 1e-5 * (MatrixXd(3, 6) << 1, 2, 0, 1, 3, 1, 0, 1, 2, 1, 1, 0, 2, 0, 1, 3, 1, 1).finished();
  expect_true_error(errors);
}

/// T too; the energy falls by what the compliance C of the traction gains, against what T takes from it.
TEST(ForceError, IsThatOfTheTractionsReactionsAtTheRateOfTheirCompliance) {
  Errors errors;
  errors.T_d = 1e-4 * Eigen::Vector3d(-1, -2, -1.5);
  errors.C_t = MatrixXd::Constant(1, 1, 1e-3);
  expect_true_error(errors);
}

}  // namespace
}  // namespace fastjoint::force_error_matrices_test
