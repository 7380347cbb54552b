// SPDX-License-Identifier: GPL-3.0-or-later
// Discs that move along x and y, or along y alone.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "common/input/value.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "tests/stage3_nonlinear/stacks.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

const std::vector<std::string> xy{"x", "y"};

/// The joint in a frame in which every vector (u, v) of a disc is Q (u, v).
test::HandMade turned(test::HandMade joint, const Matrix2d& Q) {
  for (auto& plate : joint.plates) {
    MatrixXd all = MatrixXd::Zero(plate.n_disc_unknowns(), plate.n_disc_unknowns());
    for (Index i = 0; i < plate.n_disc_unknowns(); i += 2) all.block<2, 2>(i, i) = Q;
    plate.S = all * plate.S * all.transpose();
    plate.T = all * plate.T;
  }
  return joint;
}

VectorXd turned(const VectorXd& vectors, const Matrix2d& Q) {
  return (Q * vectors.reshaped(2, vectors.size() / 2)).reshaped();
}

struct LawCase {
  const char* name;
  std::shared_ptr<const Law> law;
  double clearance;
};

class Objectivity : public testing::TestWithParam<LawCase> {};

/// A stack does not know which way x points: turned or reflected, its forces turn along.
TEST_P(Objectivity, ForcesTurnWithTheJoint) {
  std::mt19937 random(21);
  for (int i = 0; i < 6; ++i) {
    test::HandMade joint = test::random_stack(random, 2 + i % 3, 1 + i % 4, 2);
    joint.law.assign(joint.n_planes(), GetParam().law);
    joint.clearance.assign(joint.n_planes(), GetParam().clearance);
    const PathStep step = test::solved(joint);
    ASSERT_GT(magnitudes(step.F, 2).maxCoeff(), 0.1);
    for (const double angle : {0.3, 1.0, std::numbers::pi / 2, 2.7, 4.4}) {
      const Matrix2d Q = Eigen::Rotation2Dd(angle).toRotationMatrix();
      const PathStep there = test::solved(turned(joint, Q));
      EXPECT_LT((there.F - turned(step.F, Q)).norm(), 1e-9 * step.F.norm()) << "joint " << i << ", angle " << angle;
      EXPECT_LT((there.delta - turned(step.delta, Q)).norm(), 1e-9 * step.delta.norm());
      EXPECT_LT((magnitudes(there.F, 2) - magnitudes(step.F, 2)).norm(), 1e-9 * step.F.norm());
    }
    const Matrix2d mirror = Vector2d(1, -1).asDiagonal();
    EXPECT_LT((test::solved(turned(joint, mirror)).F - turned(step.F, mirror)).norm(), 1e-9 * step.F.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Each, Objectivity,
                         testing::Values(LawCase{"linear", test::linear_law(40), 0},
                                         LawCase{"linear_with_gap", test::linear_law(40), 0.02},
                                         LawCase{"power", test::power_law(40, 0.5), 0.02},
                                         LawCase{"bilinear", test::bilinear_law(60, 3, 2), 0.01},
                                         LawCase{"cubic", test::cubic_law({0.1, 0.2, 0.3}, {5.0, 8.0, 12.0}), 0.01}),
                         [](const auto& test) { return test.param.name; });

TEST(PlaneMotion, OfStacksIsThatOfTheDisplacementMethod) {
  // Linear planes are two springs each: (S + B K B') u = loads, and F = K B' u, per direction.
  std::mt19937 random(22);
  for (int i = 0; i < 30; ++i) {
    const test::HandMade joint = test::random_stack(random, 2 + i % 4, 1 + i % 3, 2);
    const auto [A, load] = test::loose_plates(joint);
    const PathStep step = test::solved(joint);
    const VectorXd u = test::displacements_of(joint, step.delta);
    VectorXd balance = A * u - load;
    for (Index j = 0; j < joint.n_planes(); ++j) {
      const ShearPlane& plane = joint.planes[j];
      const HoleModel &a = joint.first_hole(plane), &b = joint.second_hole(plane);
      const Index first = joint.offset(a.plate) + a.disc, second = joint.offset(b.plate) + b.disc;
      const double K = test::stiffness_of(*joint.law[j]);
      const Vector2d F = K * (u.segment<2>(first) - u.segment<2>(second));
      balance.segment<2>(first) += F;
      balance.segment<2>(second) -= F;
      EXPECT_LT((step.F.segment<2>(2 * j) - F).norm(), 1e-10 * step.F.norm());
    }
    EXPECT_LT(balance.norm(), 1e-11 * load.norm()) << "joint " << i;
  }
}

/// Both plates of one disc; the first is pulled, the second held by k in all directions.
test::HandMade single_lap(double k, const Vector2d& P) {
  auto joint = test::joint_of({test::disc_plate(Matrix2d::Zero(), xy), test::disc_plate(k * Matrix2d::Identity(), xy)});
  test::load_discs(joint, 0, P);
  test::add_fastener(joint, {{0, 0}, {1, 0}}, test::power_law(100, 0.5));
  return joint;
}

TEST(PlaneMotion, ClearanceIsACircle) {
  // Pulled by P at any angle, the first disc moves by the gap and (P / 100)^2 along P.
  constexpr double P = 20, k = 300, gap = 0.05;
  for (double angle = 0; angle < 6.28; angle += 0.41) {
    const Vector2d e(std::cos(angle), std::sin(angle));
    auto joint = single_lap(k, P * e);
    joint.clearance[0] = gap;
    const PathStep step = test::solved(joint);
    EXPECT_LT((step.F - P * e).norm(), 1e-10 * P);
    EXPECT_LT((step.delta - (gap + P * P / 1e4) * e).norm(), 1e-11);
    EXPECT_LT((test::state_of(joint, step).plates[1].D - P / k * e).norm(), 1e-11);
  }
}

TEST(PlaneMotion, WithoutForcesAcrossIsThatOfDiscsAlongX) {
  // Between x and y the plates have no coupling, and nothing pulls along y.
  std::mt19937 random(23);
  for (int i = 0; i < 10; ++i) {
    test::HandMade along = test::random_stack(random, 3, 3, 1);
    std::vector<formats::PlateMatrices> plates;
    for (const auto& plate : along.plates) {
      const MatrixXd across = 100 * test::random_stiffness(random, 3);
      MatrixXd S = MatrixXd::Zero(6, 6);
      for (Index r = 0; r < 3; ++r)
        for (Index c = 0; c < 3; ++c) S.block<2, 2>(2 * r, 2 * c) = Vector2d(plate.S(r, c), across(r, c)).asDiagonal();
      plates.push_back(test::disc_plate(S, xy));
    }
    test::HandMade plane = test::joint_of(plates);
    plane.fasteners = along.fasteners;
    plane.planes = along.planes;
    for (auto& fastener : plane.fasteners)
      for (auto& hole : fastener.holes) hole.disc *= 2;
    for (Index p = 0; p < 3; ++p) {
      VectorXd load = VectorXd::Zero(6);
      for (Index hole = 0; hole < 3; ++hole) load[2 * hole] = -along.plates[p].T(hole, 0);
      test::load_discs(plane, p, load);
    }
    for (test::HandMade* joint : {&along, &plane}) {
      joint->law.assign(joint->n_planes(), test::power_law(40, 0.6));
      joint->clearance.assign(joint->n_planes(), 0.02);
    }
    const VectorXd F = test::solved(along).F;
    const MatrixXd vectors = test::solved(plane).F.reshaped(2, F.size());
    EXPECT_LT((vectors.row(0).transpose() - F).norm(), 1e-9 * F.norm());
    EXPECT_LT(vectors.row(1).norm(), 1e-9 * F.norm());
  }
}

TEST(PlaneMotion, SumsOfForcesAreKeptByAxis) {
  const Vector2d P(3, -5);
  const test::HandMade joint = single_lap(300, P);
  const JointState state = test::state_of(joint, test::solved(joint));
  EXPECT_LT((state.plates[0].by_fasteners + P).norm(), 1e-11);
  EXPECT_LT((state.plates[1].by_fasteners - P).norm(), 1e-11);
  EXPECT_LT((state.plates[1].by_supports + P).norm(), 1e-11);
  EXPECT_NEAR(state.transferred_second[0], P.norm(), 1e-11);
  EXPECT_LT(state.out_of_balance, 1e-11);
}

/// Friction mu in every hole of a fastener: of each side and direction the case of a real sheet, whose own disc takes
/// most of its resultant, the others some.
void rub(test::HandMade& joint, std::mt19937& random, double mu) {
  std::uniform_real_distribution<double> number(-0.1, 0.1);
  for (auto& fastener : joint.fasteners)
    for (auto& hole : fastener.holes) {
      PlateModel& plate = joint.plates[hole.plate];
      joint.set_mu(hole, mu);
      hole.friction.resize(2);
      for (Index d = 0; d < 2; ++d)
        for (const Side side : {plus_side, minus_side}) {
          constexpr double resultant = 2 / std::numbers::pi;
          VectorXd load = VectorXd::Zero(plate.n_unknowns());
          for (Index i = 0; i < plate.n_disc_unknowns(); ++i) load[i] = resultant * number(random);
          load[hole.disc + d] -= (side == plus_side ? 0.7 : -0.7) * resultant;
          hole.friction[d][side] = test::add_case(plate, hole, d, side, load, resultant);
        }
    }
}

/// With laws that never fall and usual friction there is a solution, and it is found.
TEST(PlaneMotion, RandomStacksConverge) {
  std::mt19937 random(25);
  std::uniform_real_distribution<double> number(0, 1);
  for (int i = 0; i < 200; ++i) {
    test::HandMade joint = test::random_stack(random, 2 + i % 4, 1 + i % 5, 2);
    for (Index j = 0; j < joint.n_planes(); ++j) {
      joint.law[j] = test::power_law(std::exp(2 + 5 * number(random)), 0.4 + 0.6 * number(random));
      joint.clearance[j] = number(random) < 0.5 ? 0.1 * number(random) : 0;
    }
    if (i % 2 == 1) rub(joint, random, 0.4 * number(random));
    const LoadPath path = follow(make_equations(joint), {0.3, 1, -0.5}, {});
    ASSERT_FALSE(path.failure) << "joint " << i;
  }
}

/// A plate of one disc with friction cases +x, -x, +y, -y of these columns and constants.
void add_friction(test::HandMade& joint, Index plate, const MatrixXd& R, double mu) {
  constexpr double c = 0.01;
  PlateModel& model = joint.plates[plate];
  model.R = R;
  model.friction_unit_force = VectorXd::Constant(4, c);
  model.friction_resultant = Eigen::Vector4d(1, -1, 1, -1) * 2 / std::numbers::pi * c;
  model.friction_hole.assign(4, model.holes[0]);
  model.friction_bearing = {"+x", "-x", "+y", "-y"};
  HoleModel& hole = joint.fasteners[0].holes[plate];
  joint.set_mu(hole, mu);
  hole.friction.resize(2);
  for (Index direction = 0; direction < 2; ++direction)
    for (const Side side : {plus_side, minus_side}) {
      const Index column = 2 * direction + side;
      hole.friction[direction][side] = {column, c, 2 / std::numbers::pi * c};
    }
}

TEST(PlaneMotion, EachComponentOfTheForceHasItsFrictionCase) {
  // Statically determinate, F = P: S D + sum of r |F_d| = F on the second plate, written out for all four quadrants.
  constexpr double P = 20, mu = 0.3;
  std::mt19937 random(24);
  std::uniform_real_distribution<double> number(-0.004, 0.004);
  const MatrixXd R = MatrixXd::NullaryExpr(2, 4, [&] { return number(random); });
  Matrix2d S;
  S << 300, 40, 40, 200;
  for (const double angle : {0.4, 2.0, 3.9, 5.5}) {
    const Vector2d F = P * Vector2d(std::cos(angle), std::sin(angle));
    auto joint = single_lap(1, F);
    joint.plates[1].S = S;
    add_friction(joint, 0, MatrixXd::Zero(2, 4), mu);  // of a sheet that is all but rigid
    add_friction(joint, 1, R, mu);
    const PathStep step = test::solved(joint);
    EXPECT_LT((step.F - F).norm(), 1e-11 * P);
    const JointState state = test::state_of(joint, step);
    const Index x = F[0] > 0 ? 0 : 1, y = F[1] > 0 ? 2 : 3;
    const Vector2d friction = mu / 0.01 * (R.col(x) * std::abs(F[0]) + R.col(y) * std::abs(F[1]));
    EXPECT_LT((S * state.plates[1].D + friction - F).norm(), 1e-11 * P) << angle;
    VectorXd Lambda = VectorXd::Zero(4);
    Lambda[x] = mu / 0.01 * std::abs(F[0]);
    Lambda[y] = mu / 0.01 * std::abs(F[1]);
    EXPECT_LT((state.plates[1].Lambda - Lambda).norm(), 1e-11 * Lambda.norm());
    // Both resultants together act along the bearing force, and (2 / pi) mu of it.
    const double share = 2 / std::numbers::pi * mu;
    EXPECT_NEAR(state.transferred_second[0], P * (1 + share), 1e-10);
    EXPECT_NEAR(state.transferred_first[0], P * (1 + share), 1e-10);
    EXPECT_LT(state.fasteners_out_of_balance, 1e-13);
    EXPECT_LT((state.plates[1].by_fasteners - F * (1 + share)).norm(), 1e-10);
    EXPECT_LT(state.out_of_balance, 1e-12);
  }
}

}  // namespace
}  // namespace fastjoint::stage3
