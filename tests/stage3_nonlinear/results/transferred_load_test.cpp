// SPDX-License-Identifier: GPL-3.0-or-later
// What a fastener transfers, friction included, is one load on both its sheets, however unlike their friction is.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "stage3_nonlinear/path/load_path.hpp"
#include "tests/stage3_nonlinear/exact_path.hpp"
#include "tests/stage3_nonlinear/run_fixture.hpp"
#include "tests/stage3_nonlinear/stacks.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::HasSubstr;

constexpr double cosine = 2 / std::numbers::pi;

/// One bolt, whose friction is mu_a and mu_b, between a, pulled by P, and b, on a spring to the ground.
test::HandMade one_bolt(double P, double mu_a, double mu_b, bool law_includes_friction,
                        const std::shared_ptr<const Law>& law) {
  std::mt19937 random(61);
  test::Lap lap{test::spring_plate(1, 1, {{0, 1, 900}}), test::spring_plate(1, 0, {{0, test::ground, 400}}), P};
  for (auto* plate : {&lap.a, &lap.b}) test::add_friction(*plate, random);
  lap.a.R_ef[0] = -lap.a.friction_resultant.transpose() - lap.a.R_df[0];  // in balance: a floats
  auto joint = test::joint_of(lap, law);
  test::set_friction(joint, 0, 1);
  FastenerModel& bolt = joint.fasteners[0];
  bolt.law_includes_friction = law_includes_friction;
  for (const auto& [hole, mu] : {std::pair{&bolt.holes[0], mu_a}, std::pair{&bolt.holes[1], mu_b}}) {
    joint.set_mu(*hole, mu);
    if (mu == 0) hole->friction.clear();
  }
  return joint;
}

TEST(TransferredLoad, OfOneBoltIsWhatIsAppliedWhateverTheFrictionOfItsHoles) {
  constexpr double P = 1000, K = 300;
  for (const double sign : {1.0, -1.0})
    for (const auto& [mu_a, mu_b] :
         {std::pair{0.1, 0.3}, std::pair{0.3, 0.1}, std::pair{0.2, 0.0}, std::pair{0.0, 1.0}})
      for (const bool includes : {false, true}) {
        const auto joint = one_bolt(sign * P, mu_a, mu_b, includes, test::linear_law(K));
        const PathStep step = test::solved(joint);
        const JointState state = test::state_of(joint, step);
        EXPECT_NEAR(state.plates[1].by_supports[0], -sign * P, 1e-10) << mu_a << ", " << mu_b;
        EXPECT_NEAR(state.transferred_first[0], sign * P, 1e-10);
        EXPECT_NEAR(state.transferred_second[0], sign * P, 1e-10);
        const double F = includes ? P : P / (1 + cosine * (mu_a + mu_b) / 2);
        EXPECT_NEAR(step.F[0], sign * F, 1e-10);
        EXPECT_NEAR(step.delta[0], sign * F / K, 1e-12);
        EXPECT_LT(state.out_of_balance, 1e-13);
        EXPECT_LT(state.fasteners_out_of_balance, 1e-13);
        ASSERT_TRUE(state.plates_out_of_balance) << "a floats";
        EXPECT_LT(*state.plates_out_of_balance, 1e-13);
        // Each hole's friction is that of its own bearing force, P less that friction.
        const Index side = sign > 0 ? 0 : 1;
        EXPECT_NEAR(state.plates[1].bearing[0], sign * P / (1 + cosine * mu_b), 1e-10);
        if (mu_b > 0) {
          EXPECT_NEAR(state.plates[1].Lambda[side],
                      mu_b * P / (1 + cosine * mu_b) / joint.plates[1].friction_unit_force[side], 1e-8);
        }
      }
}

TEST(TransferredLoad, IsThatOfTheTestIfTheLawIncludesFriction) {
  // The bolt moved by delta in a test that measured A delta^n: without the flag friction comes on top, 12.7 %.
  constexpr double A = 5000, n = 0.7;
  for (const bool includes : {false, true}) {
    const auto joint = one_bolt(800, 0.2, 0.2, includes, test::power_law(A, n));
    const PathStep step = test::solved(joint);
    const double tested = A * std::pow(step.delta[0], n);
    EXPECT_NEAR(test::state_of(joint, step).transferred_first[0] / tested, includes ? 1 : 1.1273, 1e-4);
    EXPECT_NEAR(step.F[0], tested, 1e-9 * tested);
  }
}

/// Friction of a hole as a sheet has it, for the test's own equations.
struct Rubbing {
  double mu;
  std::vector<std::array<VectorXd, 2>> load;  ///< by direction and side, per unit bearing force and mu
};

/// Gives each hole of a stack friction of its own; returns it by fastener and hole.
std::vector<std::vector<Rubbing>> rub(test::HandMade& joint, std::mt19937& random) {
  std::uniform_real_distribution<double> number(0, 1);
  std::vector<std::vector<Rubbing>> all;
  for (auto& fastener : joint.fasteners) {
    auto& holes = all.emplace_back();
    fastener.law_includes_friction = number(random) < 0.5;
    for (auto& hole : fastener.holes) {
      Rubbing& rubbing = holes.emplace_back(Rubbing{number(random) < 0.3 ? 0 : 0.5 * number(random), {}});
      joint.set_mu(hole, rubbing.mu);
      for (Index d = 0; d < joint.n_directions(); ++d) {
        auto& sides = rubbing.load.emplace_back();
        for (const Side side : {plus_side, minus_side}) {
          const double sign = side == plus_side ? -1 : 1;
          sides[side] =
              VectorXd::NullaryExpr(joint.plates[hole.plate].n_unknowns(), [&] { return sign * 0.1 * number(random); });
          sides[side][hole.disc + d] += sign * 0.3;
        }
        if (rubbing.mu == 0) continue;
        hole.friction.push_back({});
        for (const Side side : {plus_side, minus_side})
          hole.friction.back()[side] = test::add_case(joint.plates[hole.plate], hole, d, side, sides[side], cosine);
      }
    }
  }
  return all;
}

/// All displacements by the displacement method, nothing condensed, for linear laws: F = K delta; a plane transfers
/// Q = F, or F (1 + the holes' mean share); a hole takes the difference B of its planes' Q and bears on
/// b = B / (1 + share); S u + mu |b| load = b + P. The signs of B are tried until they are those that come out.
VectorXd displacements(const test::HandMade& joint, const std::vector<std::vector<Rubbing>>& friction) {
  const Index N = joint.n_unknowns(), a = joint.n_directions();
  VectorXd P(N);
  MatrixXd S = MatrixXd::Zero(N, N);
  for (Index plate = 0; plate < std::ssize(joint.plates); ++plate) {
    const Index at = joint.offset(plate), m = joint.plates[plate].n_disc_unknowns();
    S.block(at, at, m, m) = joint.plates[plate].S;
    P.segment(at, m) = -joint.plates[plate].T;
  }
  VectorXd u = VectorXd::Zero(N), B = VectorXd::Zero(N);
  for (int tries = 0; tries < 50; ++tries) {
    MatrixXd transfer = MatrixXd::Zero(N, N);  // B = transfer u
    for (Index j = 0; j < joint.n_planes(); ++j) {
      const ShearPlane& plane = joint.planes[j];
      const auto& holes = friction[plane.fastener];
      double share = 0;
      for (const auto& hole : holes) share += cosine * hole.mu / static_cast<double>(holes.size());
      const Branch law = joint.law[j]->at(1, 1, 0);
      const double K = law.F / law.delta * (joint.fasteners[plane.fastener].law_includes_friction ? 1 : 1 + share);
      const Index first = joint.offset(joint.first_hole(plane).plate) + joint.first_hole(plane).disc;
      const Index second = joint.offset(joint.second_hole(plane).plate) + joint.second_hole(plane).disc;
      for (Index d = 0; d < a; ++d)
        for (const auto& [row, sign] : {std::pair{second + d, 1.0}, std::pair{first + d, -1.0}}) {
          transfer(row, first + d) += sign * K;
          transfer(row, second + d) -= sign * K;
        }
    }
    MatrixXd A = S;
    for (Index i = 0; i < std::ssize(friction); ++i)
      for (Index h = 0; h < std::ssize(friction[i]); ++h) {
        const HoleModel& hole = joint.fasteners[i].holes[h];
        const Rubbing& rubbing = friction[i][h];
        const Index offset = joint.offset(hole.plate);
        for (Index d = 0; d < a; ++d) {
          const Index row = offset + hole.disc + d;
          const double sign = B[row] < 0 ? -1 : 1;
          const VectorXd& load = rubbing.load[d][sign < 0 ? minus_side : plus_side];
          const VectorXd bearing = transfer.row(row) / (1 + cosine * rubbing.mu);
          A.row(row) -= bearing.transpose();
          A.middleRows(offset, load.size()) += sign * rubbing.mu * load * bearing.transpose();
        }
      }
    u = A.partialPivLu().solve(P);
    const VectorXd before = B;
    B = transfer * u;
    if (tries > 0 && (B.array() * before.array() >= 0).all()) return u;
  }
  ADD_FAILURE() << "signs do not settle";
  return u;
}

TEST(TransferredLoad, OfAnyStackIsThatOfTheDisplacementMethod) {
  std::mt19937 random(62);
  double largest = 0;
  for (int i = 0; i < 120; ++i) {
    const Index a = 1 + i % 2;
    test::HandMade joint = test::random_stack(random, 2 + i % 3, 1 + i % 4, static_cast<int>(a));
    const auto friction = rub(joint, random);
    const VectorXd expected = displacements(joint, friction);
    const PathStep step = test::solved(joint);
    const JointState state = test::state_of(joint, step);
    VectorXd D(joint.n_unknowns());
    for (Index plate = 0; plate < std::ssize(joint.plates); ++plate)
      D.segment(joint.offset(plate), joint.plates[plate].n_disc_unknowns()) = state.plates[plate].D;
    EXPECT_LT((D - expected).norm(), 1e-10 * expected.norm()) << "joint " << i;
    EXPECT_LT(state.out_of_balance, 1e-10) << "joint " << i;
    EXPECT_LT(state.fasteners_out_of_balance, 1e-10) << "joint " << i;
    EXPECT_LT((state.transferred_first - state.transferred_second).norm(), 1e-10 * state.transferred_first.norm());
    largest = std::max(largest, (magnitudes(step.F, a) - state.transferred_first).norm() / step.F.norm());
  }
  EXPECT_GT(largest, 0.1) << "friction matters";
}

TEST(TransferredLoad, OfCurvedLawsLeavesEveryFastenerInBalance) {
  std::mt19937 random(63);
  for (int i = 0; i < 40; ++i) {
    test::HandMade joint = test::random_stack(random, 2 + i % 3, 1 + i % 4, 1 + i % 2);
    joint.law.assign(joint.n_planes(), test::power_law(60, 0.6, 0.02));
    (void)rub(joint, random);
    const JointEquations equations = make_equations(joint);
    const LoadPath path = follow(equations, {0.4, 1, -1}, {.initial = {}, .solver = {.tolerance = 1e-12}});
    ASSERT_FALSE(path.failure) << "joint " << i;
    for (const auto& step : path.steps) {
      const JointState state = joint_state(joint, equations, step);
      EXPECT_LT(state.out_of_balance, 1e-9) << "joint " << i;
      EXPECT_LT(state.fasteners_out_of_balance, 1e-11) << "joint " << i;
    }
  }
}

TEST(TransferredLoad, OfTheExactPathIsThatOfTheSolvers) {
  std::mt19937 random(64);
  for (int i = 0; i < 40; ++i) {
    test::HandMade joint = test::random_stack(random, 2 + i % 3, 1 + i % 4, 1);
    joint.law.assign(joint.n_planes(), test::power_law(60, 1));
    joint.clearance.assign(joint.n_planes(), 0.01);
    (void)rub(joint, random);
    const JointEquations equations = make_equations(joint);
    const LoadPath path = follow(equations, {0.4, 1, -1}, {});
    ASSERT_FALSE(path.failure) << "joint " << i;
    for (const auto& step : path.steps)
      EXPECT_LT((exact_forces(equations, step.load_factor) - step.F).norm(), 1e-10 * step.F.norm()) << "joint " << i;
  }
}

TEST(TransferredLoad, SeesAFastenerOutOfBalance) {
  // A resultant that is not the one that the joint was solved with.
  test::HandMade joint = one_bolt(1000, 0.1, 0.3, false, test::linear_law(300));
  const PathStep step = test::solved(joint);
  joint.plates[1].friction_resultant *= 1.5;
  EXPECT_GT(test::state_of(joint, step).fasteners_out_of_balance, 0.05);
}

TEST_F(Run, ABoltOfUnlikeFrictionTransfersWhatIsApplied) {
  std::mt19937 random(65);
  test::Lap lap{test::spring_plate(1, 1, {{0, 1, 900}}), test::spring_plate(1, 0, {{0, test::ground, 400}}), 1000};
  for (auto* plate : {&lap.a, &lap.b}) test::add_friction(*plate, random);
  lap.a.R_ef[0] = -lap.a.friction_resultant.transpose() - lap.a.R_df[0];
  for (const bool includes : {false, true}) {
    write({{"loads", R"([{"external": "a:P", "force": 1000}])"},
           {"fasteners", fmt::format(R"([{{"id": "f1", "between": ["a:1", "b:1"], "law": "lin",
              "friction": {{"a": 0.1, "b": 0.3}}, "law_includes_friction": {}}}])",
                                     includes)}},
          lap);
    out_.str("");
    run();
    EXPECT_NEAR(result().transferred(0, 0), 1000, 1e-9);
    EXPECT_NEAR(result().transferred(0, 1), 1000, 1e-9);
    EXPECT_NEAR(result().F(0, 0), includes ? 1000 : 1000 / (1 + 0.2 * cosine), 1e-9);
    EXPECT_THAT(out_.str(), HasSubstr("  b                           0             1000                -1000\n"));
    EXPECT_THAT(out_.str(),
                testing::ContainsRegex("of the largest force, fastener by [0-9.e+-]+, sheet along axes without "
                                       "supports by [0-9.e+-]+\n"));
  }
}

}  // namespace
}  // namespace fastjoint::stage3
