// SPDX-License-Identifier: GPL-3.0-or-later
// Fasteners that the ground holds, against closed forms and joints that say the same without it.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>

#include "common/errors.hpp"
#include "stage3_nonlinear/path/walk.hpp"
#include "stage3_nonlinear/results/sensitivity.hpp"
#include "tests/stage3_nonlinear/exact_path.hpp"
#include "tests/stage3_nonlinear/run_fixture.hpp"
#include "tests/stage3_nonlinear/stacks.hpp"

namespace fastjoint::stage3::ground_test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// Plates of one free disc each, loaded by these forces, one fastener through all into the ground.
test::HandMade hung(const std::vector<double>& forces, const std::shared_ptr<const Law>& law) {
  std::vector<std::pair<Index, Index>> holes;
  for (Index i = 0; i < std::ssize(forces); ++i) holes.emplace_back(i, 0);
  auto joint =
      test::joint_of(std::vector<formats::PlateMatrices>(forces.size(), test::disc_plate(MatrixXd::Zero(1, 1))));
  for (Index i = 0; i < std::ssize(forces); ++i) test::load_discs(joint, i, VectorXd::Constant(1, forces[i]));
  test::add_fastener(joint, holes, law, true);
  return joint;
}

TEST(Ground, HoldsAPlateThatHangsOnOneFastener) {
  constexpr double k = 50, P = 10;
  const auto joint = hung({P}, test::linear_law(k));
  const PathStep step = test::solved(joint);
  EXPECT_NEAR(step.F[0], P, 1e-13 * P);
  EXPECT_NEAR(step.delta[0], P / k, 1e-13 * P / k);
  const JointState state = test::state_of(joint, step);
  EXPECT_NEAR(state.plates[0].D[0], P / k, 1e-13 * P / k);
  EXPECT_NEAR(state.plates[0].by_fasteners[0], -P, 1e-13 * P);
  EXPECT_NEAR(state.transferred_second[0], P, 1e-13 * P);
  EXPECT_EQ(shares(joint, state.transferred_first)[0], 100);
  EXPECT_EQ(joint.name(joint.planes[0]), "fastener \"1\"");
  EXPECT_EQ(joint.short_name(joint.planes[0]), "1");
}

TEST(Ground, HoldsPlatesInSeries) {
  constexpr double k1 = 50, k2 = 20, P = 10, Q = 4;
  auto joint = hung({P, Q}, test::linear_law(k1));
  joint.law[1] = test::linear_law(k2);
  const PathStep step = test::solved(joint);
  EXPECT_NEAR(step.delta[0], P / k1, 1e-14);
  EXPECT_NEAR(step.delta[1], (P + Q) / k2, 1e-14);
  const JointState state = test::state_of(joint, step);
  EXPECT_NEAR(state.plates[0].D[0], P / k1 + (P + Q) / k2, 1e-13);
  EXPECT_NEAR(state.plates[1].D[0], (P + Q) / k2, 1e-14);
  EXPECT_LT((shares(joint, state.transferred_first) - Vector2d(100, 100)).norm(), 1e-11) << "each of its own pair";
  EXPECT_EQ(joint.name(joint.planes[1]), "fastener \"1\" between \"b\" and \"ground\"");
  EXPECT_EQ(joint.short_name(joint.planes[1]), "1 (b-ground)");
  EXPECT_EQ(joint.short_name(joint.planes[0]), "1 (a-b)");
}

TEST(Ground, SharesALoadByTheStiffnessOfTheFasteners) {
  // A stiff plate on two fasteners, one to the ground and one to a plate on a spring s.
  constexpr double K = 70, k = 30, s = 55, P = 10, stiff = 1e9;
  auto joint = test::joint_of(
      {test::spring_plate(2, 1, {{0, 2, stiff}, {1, 2, stiff}}), test::spring_plate(1, 0, {{0, test::ground, s}})});
  joint.force[{0, 0}] = P;
  test::add_fastener(joint, {{0, 0}}, test::linear_law(K), true);
  test::add_fastener(joint, {{0, 1}, {1, 0}}, test::linear_law(k));
  const double other = 1 / (1 / k + 1 / s);
  const PathStep step = test::solved(joint);
  EXPECT_NEAR(step.F[0], P * K / (K + other), 1e-6);
  EXPECT_NEAR(step.F[1], P * other / (K + other), 1e-6);
}

/// The joint with one more plate in place of the ground, whose discs springs s hold: planes to it are stiffer, so that
/// both in series are as before.
test::HandMade with_wall(const test::HandMade& grounded, double s) {
  test::HandMade joint = grounded;
  const Index a = joint.n_directions(), n = joint.fasteners.size(), wall = joint.plates.size();
  const std::vector<std::string> directions{"x", "y"};
  joint.plates.push_back(make_plate(
      "wall", "wall.h5",
      test::disc_plate(s * MatrixXd::Identity(n * a, n * a), {directions.begin(), directions.begin() + a}), 8));
  test::load_discs(joint, wall, VectorXd::Zero(n * a));
  for (Index j = 0; j < joint.n_planes(); ++j)
    if (grounded.is_to_ground(joint.planes[j]))
      joint.law[j] = test::linear_law(1 / (1 / test::stiffness_of(*joint.law[j]) - 1 / s));
  for (Index i = 0; i < n; ++i) {
    FastenerModel& fastener = joint.fasteners[i];
    if (!fastener.grounded) continue;
    fastener.grounded = false;
    fastener.holes.push_back({wall, i * a});
  }
  return joint;
}

void expect_same(const test::HandMade& grounded, const test::HandMade& walled, const std::string& what) {
  const PathStep a = test::solved(grounded), b = test::solved(walled);
  EXPECT_LT((a.F - b.F).norm(), 1e-12 * b.F.norm()) << what;
  const JointState at = test::state_of(grounded, a), there = test::state_of(walled, b);
  for (Index i = 0; i < std::ssize(grounded.plates); ++i)
    EXPECT_LT((at.plates[i].D - there.plates[i].D).norm(), 1e-12 * there.plates[i].D.norm()) << what;
  EXPECT_LT((at.transferred_first - there.transferred_first).norm(), 1e-12 * b.F.norm()) << what;
  EXPECT_LT((at.transferred_second - there.transferred_second).norm(), 1e-12 * b.F.norm()) << what;
  EXPECT_LT((shares(grounded, at.transferred_first) - shares(walled, there.transferred_first)).norm(), 1e-8) << what;
  constexpr double rounding = 1e-11;  // the wall's stiffness times its displacements, by any kernel of the BLAS
  EXPECT_LT(std::max(at.out_of_balance, there.out_of_balance), rounding) << what;
  EXPECT_LT(there.fasteners_out_of_balance, 1e-12) << what << ": what the ground gets balances its fasteners";
}

TEST(Ground, IsOneMorePlateThatDoesNotMove) {
  std::mt19937 random(31);
  for (int i = 0; i < 60; ++i) {
    const test::HandMade joint = test::random_stack(random, 2 + i % 3, 1 + i % 4, 1 + i % 2, true);
    expect_same(joint, with_wall(joint, 5000), fmt::format("joint {}", i));
  }
}

TEST(Ground, BearsWithFrictionInThePlatesAlone) {
  std::mt19937 random(32);
  for (int i = 0; i < 40; ++i) {
    test::Lap lap{test::chain(3, 1, 900, {{2, 3, 700}, {1, test::ground, 50}}), test::chain(3, 0, 800, {}), 100};
    test::add_friction(lap.a, random);
    test::add_friction(lap.b, random);
    for (Index side = 0; side < lap.a.friction_resultant.size(); side += 2) lap.a.friction_resultant[side] *= 0.8;
    auto joint = test::joint_of(lap, test::linear_law(1));
    joint.remove_fasteners();
    test::add_fastener(joint, {{0, 0}}, test::linear_law(300), true);
    test::add_fastener(joint, {{0, 1}, {1, 1}}, test::linear_law(200), true);
    test::add_fastener(joint, {{1, 2}, {0, 2}}, test::linear_law(100));
    for (Index j = 0; j < 3; ++j) {
      joint.fasteners[j].law_includes_friction = i % 2 == 1;
      test::set_friction(joint, j, 0.05 + 0.05 * double(j) + 0.001 * i);
    }
    // A wall's hole, without friction, would lower the mean friction of its fastener's holes.
    if (i % 2 == 1) expect_same(joint, with_wall(joint, 5000), fmt::format("joint {}", i));
    const PathStep step = test::solved(joint);
    const JointState state = test::state_of(joint, step);
    const HoleModel& hole = joint.fasteners[0].holes[0];
    const FrictionCase& rim = hole.friction[0][step.F[0] > 0 ? minus_side : plus_side];
    const double Q =
        i % 2 == 1 ? step.F[0] : step.F[0] * (1 + joint.mu.at(joint.at(hole)) * rim.resultant / rim.unit_force);
    EXPECT_NEAR(state.transferred_first[0], Q, 1e-13 * std::abs(Q)) << "F is the bearing force of the only hole";
    EXPECT_LT(state.out_of_balance, 1e-11);
  }
}

TEST(Ground, SensitivitiesAreThoseOfThePlateThatDoesNotMove) {
  std::mt19937 random(33);
  for (int i = 0; i < 20; ++i) {
    const test::HandMade grounded = test::random_stack(random, 2 + i % 3, 1 + i % 4, 1 + i % 2, true);
    const auto of = [](const test::HandMade& joint) {
      const JointEquations equations = make_equations(joint);
      return test::sensitivity_at(joint_numbers(joint, joint.numbers()),
                                  test::point_of(equations, test::solved(joint)));
    };
    const test::Sensitivity a = of(grounded), b = of(with_wall(grounded, 5000));
    EXPECT_LT((a.load_factor - b.load_factor).norm(), 1e-11 * b.load_factor.norm()) << i;
    EXPECT_LT((a.clearance - b.clearance).norm(), 1e-11 * b.clearance.norm()) << i;
  }
}

TEST(Ground, ExactPathsAreThoseOfTheSolver) {
  std::mt19937 random(35);
  for (int i = 0; i < 30; ++i) {
    auto joint = test::random_stack(random, 1 + i % 3 + 1, 1 + i % 4, 1, true);
    for (Index j = 0; j < joint.n_planes(); ++j) {
      joint.law[j] = j % 2 == 0 ? test::law_of(R"({"type": "rigid"})") : test::bilinear_law(60, 5, 9);
      joint.clearance[j] = j % 3 == 0 ? 0.02 : 0;
    }
    const JointEquations equations = make_equations(joint);
    const LoadPath path = follow(equations, {0.2, 0.5, 1}, test::tight);
    ASSERT_FALSE(path.failure) << i;
    for (const auto& step : path.steps)
      EXPECT_LT((exact_forces(equations, step.load_factor) - step.F).norm(), 1e-9 * step.F.norm()) << i;
  }
}

class GroundRun : public Run {};

TEST_F(GroundRun, OnePlateOnTheGroundIsAJoint) {
  write({{"plates", R"({"a": "a.h5"})"},
         {"laws", R"({"bolt": {"type": "rigid"}})"},
         {"fasteners", R"([{"id": "f1", "between": ["a:1", "ground"], "law": "bolt"},
                           {"id": "f2", "between": ["a:2", "ground"], "law": "bolt", "clearance": 0.02}])"}});
  run();
  const auto a = result();
  EXPECT_THAT(a.first_hole, ElementsAre("a:1", "a:2"));
  EXPECT_THAT(a.second_hole, ElementsAre("ground", "ground"));
  EXPECT_NEAR(a.F.sum(), 100, 1e-10);
  EXPECT_NEAR(a.F(0, 0), 20, 1e-10) << "the spring between the holes is stretched by the clearance";
  EXPECT_EQ(a.delta(0, 0), 0);
  EXPECT_DOUBLE_EQ(a.delta(0, 1), 0.02);
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("1 plate, 2 fasteners"), HasSubstr("hybridsj"), HasSubstr("20.000")));
  const std::string csv = test::read_file(csv_);
  EXPECT_THAT(csv, HasSubstr(",a:1,ground,"));
  const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  const std::string head = csv.substr(0, csv.find('\n')),
                    line = csv.substr(head.size() + 1, csv.find('\n', head.size() + 1) - head.size() - 1);
  EXPECT_EQ(commas(line), commas(head));
}

TEST_F(GroundRun, HolesBearOnTheSidesToWhichTheirPlanesPush) {
  std::mt19937 random(36);
  test::Lap lap = test::two_fastener_lap();
  lap.a = test::chain(2, 1, 1000, {{1, 2, 1000}, {0, test::ground, 10}});  // random friction has a resultant of its own
  test::add_friction(lap.a, random);
  test::add_friction(lap.b, random);
  write({{"laws", R"({"lin": {"type": "linear", "k": 1000, "one_sided": true}})"},
         {"fasteners", R"([{"id": "f1", "between": ["a:1", "ground"], "law": "lin", "friction": 0.1},
                           {"id": "f2", "between": ["a:2", "b:2", "ground"], "law": "lin", "friction": 0.1}])"}},
        lap);
  const JointModel joint =
      load_joint(read_joint_scene(input::parse(options_.input, input::read_text_file(options_.input))), 0);
  const auto sides = [&](Index fastener, Index hole) {
    const auto& friction = joint.fasteners[fastener].holes[hole].friction[0];
    return std::pair(friction[plus_side].column >= 0, friction[minus_side].column >= 0);
  };
  EXPECT_EQ(sides(0, 0), std::pair(false, true));
  EXPECT_EQ(sides(1, 0), std::pair(false, true));
  EXPECT_EQ(sides(1, 1), std::pair(true, true)) << "pushed by the first plate, held by the ground";
  run();
  const auto a = result();
  EXPECT_NEAR(a.transferred(0, 1), a.transferred(0, 0), 1e-12 * a.F(0, 0));
}

TEST_F(GroundRun, SaysHowAMechanismMayBeHeld) {
  write({{"plates", R"({"a": "a.h5", "b": "b.h5"})"}},
        {test::chain(2, 1, 1000, {{1, 2, 1000}}), test::chain(2, 0, 1000, {}), 100});
  EXPECT_THAT([&] { run(); },
              testing::ThrowsMessage<NumericalError>(
                  HasSubstr("fix an external with \"displacement\": 0, or connect a fastener to the \"ground\"")));
}

}  // namespace
}  // namespace fastjoint::stage3::ground_test
