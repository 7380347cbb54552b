// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/condensed_system.hpp"

#include <gmock/gmock.h>

#include <Eigen/LU>

#include "common/errors.hpp"
#include "stage3_nonlinear/equations/first_guesses.hpp"
#include "stage3_nonlinear/equations/joint_equations.hpp"
#include "stage3_nonlinear/output/output.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"
#include "tests/support/warning.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::ground;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A plate with n discs and externals of this stiffness matrix.
formats::PlateMatrices plate_of(const MatrixXd& S, int n_discs, int n_externals) {
  auto plate = test::spring_plate(n_discs, n_externals, {});
  plate.S_dd[0] = S.topLeftCorner(n_discs, n_discs);
  plate.S_ed[0] = S.bottomLeftCorner(n_externals, n_discs);
  plate.S_ee[0] = S.bottomRightCorner(n_externals, n_externals);
  return plate;
}

using test::linear_solution;

TEST(CondensedSystem, OfTwoEqualSheetsIsHalfASheet) {
  // Equal S: the parallel sum S (S + S)^-1 S is S / 2, where the minus sign printed in (26) has no value at
  // all.
  std::mt19937 random(3);
  const MatrixXd S = test::random_stiffness(random, 5);
  auto joint = test::joint_of({plate_of(S, 4, 1), plate_of(S, 4, 1), 10}, test::linear_law(1));
  const MatrixXd Shat = S.topLeftCorner(4, 4) - S.topRightCorner(4, 1) * S.bottomLeftCorner(1, 4) / S(4, 4);
  const JointEquations equations = make_equations(joint);
  EXPECT_LT((equations.system->S_ud - Shat / 2).norm(), 1e-14 * Shat.norm());
  // Rigid fasteners: both plates move as one, so the second carries half of what the discs of the first must
  // be held with.
  const VectorXd Phat = S.topRightCorner(4, 1) / S(4, 4) * 10.0;
  EXPECT_LT((equations.q + Phat / 2).norm(), 1e-14 * Phat.norm());
}

TEST(CondensedSystem, OfTwoEqualSheetsWithOneFastenerHasAClosedForm) {
  // Each disc is held by k to the ground; the first is pulled by P through any spring: F = P/2 K / (K + k/2).
  constexpr double k = 300, K = 70, P = 10;
  const auto joint = test::joint_of(
      {test::spring_plate(1, 1, {{0, ground, k}, {0, 1, 55}}), test::spring_plate(1, 0, {{0, ground, k}}), P},
      test::linear_law(K));
  EXPECT_NEAR(linear_solution(joint, K)[0], P / 2 * K / (K + k / 2), 1e-14 * P);
}

/// A sheet as if in other units: two springs in series between the discs, none free.
TEST(CondensedSystem, SheetsMayBeMuchSofterThanTheirNeighbours) {
  for (const double soft : {1e-6, 1e-9, 1e-12}) {
    const double k = 300 * soft;
    const auto joint = test::joint_of(
        {test::spring_plate(1, 1, {{0, ground, k}, {0, 1, k}}), test::spring_plate(1, 0, {{0, ground, 300}}), 10},
        test::linear_law(70));
    EXPECT_NEAR(condense(joint, joint.numbers().held).S_ud(0, 0) / k, 1 / (1 + soft), 1e-9) << soft;
    const auto said = warnings(joint, make_equations(joint), {});
    if (soft > 1e-8) {
      EXPECT_THAT(said, testing::IsEmpty());
    } else {
      EXPECT_THAT(said, testing::ElementsAre(test::is_warning("plate-soft", " times as stiff as plate \"b\""))) << soft;
    }
  }
}

TEST(CondensedSystem, OfAFloatingDoublerHasAClosedForm) {
  // Sheet: ground - k1 - disc 1 - k2 - disc 2 - k3 - P. Doubler: disc 1 - kd - disc 2, held by its two
  // fasteners K only. It carries T: (P - T)/k2 - T/kd = 2 T/K, so T = P / (1 + k2/kd + 2 k2/K); F = (-T, T).
  constexpr double k1 = 900, k2 = 700, k3 = 300, kd = 450, K = 120, P = 10;
  const auto joint = test::joint_of(
      {test::spring_plate(2, 1, {{0, ground, k1}, {0, 1, k2}, {1, 2, k3}}), test::spring_plate(2, 0, {{0, 1, kd}}), P},
      test::linear_law(K));
  const VectorXd F = linear_solution(joint, K);
  const double T = P / (1 + k2 / kd + 2 * k2 / K);
  EXPECT_NEAR(F[0], -T, 1e-14 * P);
  EXPECT_NEAR(F[1], T, 1e-14 * P);
}

TEST(CondensedSystem, IsTheSameForALargerSpreadOfStiffness) {
  // The same doubler, a billion times softer than the sheet: units and contrast must not matter.
  constexpr double k2 = 7e8, kd = 0.45, K = 1.2, P = 10;
  const auto joint = test::joint_of({test::spring_plate(2, 1, {{0, ground, 9e8}, {0, 1, k2}, {1, 2, 3e8}}),
                                     test::spring_plate(2, 0, {{0, 1, kd}}), P},
                                    test::linear_law(K));
  const double T = P / (1 + k2 / kd + 2 * k2 / K);
  EXPECT_NEAR(linear_solution(joint, K)[1] / T, 1, 1e-9);
}

/// The other way round, where rounding of the doubler's stiffness meets what holds it; at last nothing seems to.
TEST(CondensedSystem, AFloatingSheetMayBeMuchStifferThanWhatHoldsIt) {
  constexpr double k = 700, K = 1200, P = 10;
  const auto joint = [](double contrast) {
    return test::joint_of({test::spring_plate(2, 1, {{0, ground, k}, {0, 1, k}, {1, 2, k}}),
                           test::spring_plate(2, 0, {{0, 1, contrast * k}}), P},
                          test::linear_law(K));
  };
  for (const double contrast : {1e3, 1e6, 1e9}) {
    const double T = P / (1 + 1 / contrast + 2 * k / K);
    EXPECT_NEAR(linear_solution(joint(contrast), K)[1], T, 1e-15 * contrast * T) << contrast;
  }
  EXPECT_THAT([&] { return make_equations(joint(1e12)); },
              testing::ThrowsMessage<NumericalError>(HasSubstr("mechanism")));
}

TEST(CondensedSystem, ImposedDisplacementActsLikeItsForce) {
  std::mt19937 random(4);
  auto joint = test::joint_of(
      {plate_of(test::random_stiffness(random, 4), 3, 1), plate_of(test::random_stiffness(random, 3), 3, 0), 10},
      test::linear_law(2));
  const VectorXd F = linear_solution(joint, 2);
  const double displacement = test::displacements_of(joint, F / 2)[3];
  joint.force[{0, 0}] = 0;
  joint.displacement[{0, 0}] = displacement;
  EXPECT_LT((linear_solution(joint, 2) - F).norm(), 1e-13 * F.norm());
  const JointState state = joint_state(joint, make_equations(joint), {1, F, F / 2, 1, 0, {}});
  EXPECT_NEAR(state.plates[0].Pe[0], 10, 1e-12);
  EXPECT_EQ(state.plates[0].De[0], displacement);
}

TEST(CondensedSystem, TractionActsThroughItsHoldingForces) {
  // A traction f that asks T f to hold the unknowns is a load of -T f on them.
  std::mt19937 random(5);
  auto joint = test::joint_of(
      {plate_of(test::random_stiffness(random, 3), 2, 1), plate_of(test::random_stiffness(random, 2), 2, 0), 0},
      test::linear_law(2));
  joint.plates[0].T = Eigen::Vector3d(-0.2, -0.3, -0.4);
  joint.plates[0].traction_id = {"T"};
  joint.traction[{0, 0}] = 50;
  joint.plates[0].traction_axis = {0};
  const JointEquations with_traction = make_equations(joint);
  const VectorXd F = linear_solution(joint, 2);
  // Only the external can carry a load of its own: the part of T f on it.
  joint.plates[0].T = Eigen::Vector3d(0, 0, -0.4);
  const VectorXd part = make_equations(joint).q;
  joint.traction[{0, 0}] = 0;
  joint.force[{0, 0}] = 0.4 * 50;
  EXPECT_LT((make_equations(joint).q - part).norm(), 1e-14 * part.norm());
  joint.plates[0].T = Eigen::Vector3d(-0.2, -0.3, -0.4);
  joint.force[{0, 0}] = 0;
  joint.traction[{0, 0}] = 50;
  const JointState state = joint_state(joint, with_traction, {1, F, F / 2, 1, 0, {}});
  EXPECT_LT(state.out_of_balance, 1e-14);
  EXPECT_EQ(state.plates[0].applied[0], 50);
}

/// Parallel-sum form of docs/theory.md, section 7.2, for fasteners whose forces have the signs of `forces`.
struct Theory {
  MatrixXd S_ud;
  VectorXd q;
};

Theory theory(const formats::PlateMatrices& a, const formats::PlateMatrices& b, const VectorXd& mu, double P,
              const VectorXd& forces) {
  const Index n = mu.size();
  const MatrixXd I = MatrixXd::Identity(n, n);
  MatrixXd R_b(n, n), R_a(n, n), R_e(1, n);
  VectorXd M_b(n), M_a(n);
  for (Index j = 0; j < n; ++j) {
    const Index plus = 2 * j, minus = 2 * j + 1;
    const double sign = forces[j] > 0 ? 1 : -1;
    const Index side_b = sign > 0 ? plus : minus;
    const Index side_a = sign > 0 ? minus : plus;
    R_b.col(j) = b.R_df[0].col(side_b);
    R_a.col(j) = a.R_df[0].col(side_a);
    R_e.col(j) = a.R_ef[0].col(side_a);
    M_b[j] = sign * mu[j] / b.friction_unit_force[side_b];
    M_a[j] = sign * mu[j] / a.friction_unit_force[side_a];
  }
  const MatrixXd load = a.S_ed[0].transpose() / a.S_ee[0](0, 0);
  const MatrixXd Shat = a.S_dd[0] - load * a.S_ed[0];
  const MatrixXd modify_a = (I + (R_a - load * R_e) * M_a.asDiagonal()).inverse();
  const MatrixXd S_a = modify_a * Shat;
  const VectorXd P_a = modify_a * load * P;
  const MatrixXd S_b = (I - R_b * M_b.asDiagonal()).inverse() * b.S_dd[0];
  const MatrixXd sum = (S_a + S_b).inverse();
  return {S_a * sum * S_b, -S_b * sum * P_a};
}

struct JointWithFriction {
  const char* name;
  bool floating;
  bool mixed_signs;
};
class Friction : public testing::TestWithParam<JointWithFriction> {};

TEST_P(Friction, IsThatOfTheTheory) {
  std::mt19937 random(6);
  constexpr int n = 4;
  // Where the first plate holds itself, the second is only a doubler, and its fasteners push both ways.
  const double held = GetParam().floating ? 0 : GetParam().mixed_signs ? 10 : 400;
  const double sheet = GetParam().mixed_signs ? 500 : 0;
  auto a = test::chain(n, 1, 1000, {{n - 1, n, 800}, {0, ground, 1 + sheet}});
  auto b = test::chain(n, 0, 700, {{0, ground, held}});
  test::add_friction(a, random);
  test::add_friction(b, random);
  auto joint = test::joint_of({a, b, 100}, test::linear_law(300));
  const Eigen::Vector4d mu(0.1, 0.3, 0, 0.2);
  for (Index j = 0; j < n; ++j)
    if (mu[j] > 0) test::set_friction(joint, j, mu[j]);

  const JointEquations equations = make_equations(joint);
  const LinearForces forces = linear_forces(equations, VectorXd::Constant(n, 1.0 / 300), 1);
  ASSERT_TRUE(forces.consistent);
  const bool both_ways = forces.F.minCoeff() < 0 && forces.F.maxCoeff() > 0;
  EXPECT_EQ(both_ways, GetParam().mixed_signs);
  const Theory expected = theory(a, b, mu, 100, forces.F);
  const VectorXd residual = forces.F + expected.S_ud * forces.F / 300 - expected.q;
  EXPECT_LT(residual.norm(), 1e-12 * expected.q.norm());
  PathStep step{1, forces.F, forces.F / 300, 1, 0, {}};
  step.Lambda = contact_state(equations, forces.F + equations.system->stiffness.cwiseProduct(step.delta)).Lambda;
  EXPECT_LT(joint_state(joint, equations, step).out_of_balance, 1e-13);
  // It matters: without friction the same joint has other forces.
  const VectorXd without = linear_solution(test::joint_of({a, b, 100}, test::linear_law(300)), 300);
  EXPECT_GT((without - forces.F).norm(), 1e-3 * forces.F.norm());
}

INSTANTIATE_TEST_SUITE_P(Each, Friction,
                         testing::Values(JointWithFriction{"definite", false, false},
                                         JointWithFriction{"both_ways", false, true},
                                         JointWithFriction{"floating", true, true}),
                         [](const auto& test) { return test.param.name; });

TEST(CondensedSystem, TakesAnyStackOfPlates) {
  // Sheet a - strap s - sheet b: disc 1 of the strap joins a, disc 2 joins b; all in series, so each fastener
  // carries P and its displacement is P / K; the far end moves by all flexibilities together.
  constexpr double P = 10, K = 50, k = 200;
  auto joint = test::joint_of({test::spring_plate(1, 1, {{0, 1, k}}), test::spring_plate(1, 0, {{0, ground, k}}), P},
                              test::linear_law(K));
  joint.plates.push_back(make_plate("s", "s.h5", test::spring_plate(2, 0, {{0, 1, k}}), 8));
  joint.fasteners[0].holes[1] = {2, 0, 0, {}};
  test::add_fastener(joint, {{2, 1}, {1, 0}}, test::linear_law(K));
  const VectorXd F = linear_solution(joint, K);
  EXPECT_NEAR(F[0], P, 1e-13 * P);
  EXPECT_NEAR(F[1], P, 1e-13 * P);
  EXPECT_NEAR(test::displacements_of(joint, F / K)[1], P * (3 / k + 2 / K), 1e-13);
}

TEST(CondensedSystem, NamesThePlatesThatCanMove) {
  // Nothing holds either plate: they move together.
  const auto joint =
      test::joint_of({test::chain(2, 1, 1000, {{1, 2, 1000}}), test::chain(2, 0, 1000, {}), 10}, test::linear_law(1));
  EXPECT_THAT([&] { (void)condense(joint, joint.numbers().held); },
              ThrowsMessage<NumericalError>(HasSubstr(
                  "joint.json: the joint is a mechanism: plate \"a\" with plate \"b\" can move freely even with "
                  "rigid fasteners; give a plate a support (stage 1), fix an external with \"displacement\": 0")));
}

TEST(CondensedSystem, NamesAPlateWithoutStiffness) {
  // Its rows are exactly 0, those of its external too.
  const auto joint = test::joint_of(
      {test::spring_plate(2, 1, {}), test::chain(2, 0, 1000, {{0, test::ground, 1000}}), 10}, test::linear_law(1));
  EXPECT_THAT([&] { (void)condense(joint, joint.numbers().held); },
              ThrowsMessage<NumericalError>(HasSubstr("the joint is a mechanism: plate \"a\" can move freely")));
}

TEST(CondensedSystem, IsHeldByAnImposedDisplacement) {
  auto joint =
      test::joint_of({test::chain(2, 1, 1000, {{1, 2, 1000}}), test::chain(2, 0, 1000, {}), 0}, test::linear_law(1));
  joint.displacement[{0, 0}] = 0.1;
  // All go along, without force.
  EXPECT_EQ(make_equations(joint).q.norm(), 0) << "rounding must not become the largest force";
  const VectorXd D = test::displacements_of(joint, VectorXd::Zero(2));
  EXPECT_LT((D.array() - 0.1).abs().maxCoeff(), 1e-13);
}

}  // namespace
}  // namespace fastjoint::stage3
