// SPDX-License-Identifier: GPL-3.0-or-later
// Fasteners through two and more plates whose discs move along x, against closed forms and equations written by hand.
#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <algorithm>
#include <set>
#include <sstream>

#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/run.hpp"
#include "tests/stage3_nonlinear/stacks.hpp"
#include "tests/support/result.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

MatrixXd one(double k) { return MatrixXd::Constant(1, 1, k); }

/// Plates of one disc each, held by these springs and pulled by these forces, one fastener through all.
test::HandMade single_stack(const std::vector<double>& springs, const VectorXd& forces,
                            const std::shared_ptr<const Law>& law) {
  std::vector<formats::PlateMatrices> plates;
  std::vector<std::pair<Index, Index>> holes;
  for (Index i = 0; i < std::ssize(springs); ++i) {
    plates.push_back(test::disc_plate(one(springs[i])));
    holes.emplace_back(i, 0);
  }
  auto joint = test::joint_of(plates);
  for (Index i = 0; i < std::ssize(springs); ++i) test::load_discs(joint, i, VectorXd::Constant(1, forces[i]));
  test::add_fastener(joint, holes, law);
  return joint;
}

TEST(Stack, EachPlaneOfSymmetricDoubleShearTakesHalf) {
  // Straps a and c float and are pulled by P/2 each; b, held by k, bears on F1 - F2 = P.
  constexpr double P = 10, k = 200, K = 50;
  const auto joint = single_stack({0, k, 0}, Vector3d(P / 2, 0, P / 2), test::linear_law(K));
  const PathStep step = test::solved(joint);
  EXPECT_NEAR(step.F[0], P / 2, 1e-13 * P) << "on the second plate, b, along +x";
  EXPECT_NEAR(step.F[1], -P / 2, 1e-13 * P) << "on the second plate, c, along -x";
  EXPECT_NEAR(step.delta[0], P / 2 / K, 1e-15 * P);
  const JointState state = test::state_of(joint, step);
  EXPECT_NEAR(state.plates[1].D[0], P / k, 1e-15 * P);
  EXPECT_NEAR(state.plates[0].D[0], P / k + P / 2 / K, 1e-14 * P);
  EXPECT_NEAR(state.plates[1].by_fasteners[0], P, 1e-13 * P);
  EXPECT_LT((shares(joint, state.transferred_first) - Vector2d(100, 100)).norm(), 1e-11) << "each of its own pair";
}

TEST(Stack, PlanesShareByTheirStiffness) {
  // The ends of both straps, k1 and k2, move by u; each in series with its plane: s = 1/(1/k + 1/K).
  constexpr double u = 0.1, k1 = 300, k2 = 700, K1 = 90, K2 = 40, k = 500;
  auto joint = test::joint_of({test::spring_plate(1, 1, {{0, 1, k1}}), test::spring_plate(1, 0, {{0, test::ground, k}}),
                               test::spring_plate(1, 1, {{0, 1, k2}})});
  test::add_fastener(joint, {{0, 0}, {1, 0}, {2, 0}}, test::linear_law(K1));
  joint.law[1] = test::linear_law(K2);
  for (const Index strap : {0, 2}) joint.displacement[{strap, 0}] = u;
  const double s1 = 1 / (1 / k1 + 1 / K1), s2 = 1 / (1 / k2 + 1 / K2);
  const double middle = (s1 + s2) * u / (k + s1 + s2);
  const PathStep step = test::solved(joint);
  EXPECT_NEAR(step.F[0], s1 * (u - middle), 1e-13);
  EXPECT_NEAR(step.F[1], -s2 * (u - middle), 1e-13);
  const JointState state = test::state_of(joint, step);
  EXPECT_NEAR(state.plates[0].Pe[0], step.F[0], 1e-13);
  EXPECT_NEAR(state.plates[2].Pe[0], -step.F[1], 1e-13);
}

TEST(Stack, EachPlaneHasItsOwnLawAndClearance) {
  // b floats and is pulled by P; a and c hold it by springs. Plane 1 is closed before plane 2: up to P = s1 (g2 - g1)
  // plane 2 is open, then the two share.
  constexpr double k1 = 300, k2 = 700, K1 = 90, K2 = 40, g1 = 0.1, g2 = 0.25;
  const double s1 = 1 / (1 / k1 + 1 / K1), s2 = 1 / (1 / k2 + 1 / K2);
  auto joint = single_stack({k1, 0, k2}, Vector3d(0, 1, 0), test::power_law(K1, 1));
  joint.law[1] = test::power_law(K2, 1);
  joint.clearance[0] = g1;
  joint.clearance[1] = g2;
  const double closes = s1 * (g2 - g1);
  const LoadPath path = follow(make_equations(joint), {0.5 * closes, 0.99 * closes, 1.01 * closes, 30, -30}, {});
  ASSERT_FALSE(path.failure);
  for (const auto& step : path.steps) {
    const double P = std::abs(step.load_factor);
    const double x = P < closes ? g1 + P / s1 : (P + s1 * g1 + s2 * g2) / (s1 + s2);
    const double sign = step.load_factor > 0 ? 1 : -1;
    EXPECT_NEAR(step.F[0], -sign * s1 * (x - g1), 1e-9) << P;
    EXPECT_NEAR(step.F[1], sign * s2 * std::max(x - g2, 0.0), 1e-9) << P;
  }
}

TEST(Stack, FloatingLayersPassTheLoadOn) {
  // a pulled, e held, b, c and d held by nothing but the fastener: every plane carries P, and none of the three bears.
  constexpr double P = 10, k = 200;
  auto joint = single_stack({0, 0, 0, 0, k}, VectorXd::Unit(5, 0) * P, test::power_law(100, 0.5));
  const PathStep step = test::solved(joint);
  const JointState state = test::state_of(joint, step);
  const double slip = (P / 100) * (P / 100);
  for (Index plane = 0; plane < 4; ++plane) {
    EXPECT_NEAR(step.F[plane], P, 1e-11);
    EXPECT_NEAR(step.delta[plane], slip, 1e-13);
  }
  for (Index i = 0; i < 5; ++i) {
    EXPECT_NEAR(state.plates[i].D[0], P / k + static_cast<double>(4 - i) * slip, 1e-12);
    EXPECT_NEAR(state.plates[i].by_fasteners[0], i == 0 ? -P : i == 4 ? P : 0, 1e-11);
  }
}

TEST(Stack, OfThreeAndMoreLayersIsThatOfTheDisplacementMethod) {
  // Linear planes are springs between discs: (S + B K B') u = loads, without any condensation.
  std::mt19937 random(11);
  for (int i = 0; i < 60; ++i) {
    const test::HandMade joint = test::random_stack(random, 2 + i % 5, 1 + i % 4, 1);
    const auto [A, load] = test::loose_plates(joint);
    MatrixXd B = MatrixXd::Zero(joint.n_unknowns(), joint.n_planes());
    VectorXd K(joint.n_planes());
    for (Index j = 0; j < joint.n_planes(); ++j) {
      const ShearPlane& plane = joint.planes[j];
      for (const auto& [hole, sign] : {std::pair{joint.first_hole(plane), 1}, std::pair{joint.second_hole(plane), -1}})
        B(joint.offset(hole.plate) + hole.disc, j) = sign;
      K[j] = test::stiffness_of(*joint.law[j]);
    }
    const VectorXd u = (A + B * K.asDiagonal() * B.transpose()).llt().solve(load);
    const VectorXd F = K.asDiagonal() * (B.transpose() * u);
    const PathStep step = test::solved(joint);
    EXPECT_LT((step.F - F).norm(), 1e-11 * F.norm()) << "joint " << i;
    EXPECT_LT(test::state_of(joint, step).out_of_balance, 1e-11) << "joint " << i;
  }
}

TEST(Stack, OfEqualStrapsIsOneStrapOfTwiceTheStiffness) {
  std::mt19937 random(12);
  const MatrixXd strap = 50 * test::random_stiffness(random, 3), middle = 80 * test::random_stiffness(random, 3);
  const Vector3d load(20, -4, 9);
  auto twin = test::joint_of({test::disc_plate(strap), test::disc_plate(middle), test::disc_plate(strap)});
  auto single = test::joint_of({test::disc_plate(2 * strap), test::disc_plate(middle)});
  test::load_discs(twin, 0, load / 2);
  test::load_discs(twin, 2, load / 2);
  test::load_discs(single, 0, load);
  for (Index hole = 0; hole < 3; ++hole) {
    test::add_fastener(twin, {{0, hole}, {1, hole}, {2, hole}}, test::power_law(30, 0.6, 0.01));
    test::add_fastener(single, {{0, hole}, {1, hole}}, test::power_law(60, 0.6, 0.01));
  }
  const VectorXd F = test::solved(single).F;
  const VectorXd planes = test::solved(twin).F;
  for (Index j = 0; j < 3; ++j) {
    EXPECT_NEAR(planes[2 * j], F[j] / 2, 1e-10);
    EXPECT_NEAR(planes[2 * j + 1], -F[j] / 2, 1e-10);
  }
}

/// R mu / c of the one hole of a plate, by sign of the bearing force.
double friction_at(const test::HandMade& joint, Index plate, double bearing) {
  const HoleModel& hole = joint.fasteners[0].holes[plate];
  const FrictionCase& its = hole.friction[0][bearing < 0 ? minus_side : plus_side];
  return joint.plates[plate].R(0, its.column) * joint.mu.at(joint.at(hole)) / its.unit_force;
}

/// Equations of three plates of one disc each: k D + r |b| = b + P with b = -F1, F1 - F2, F2, and D_a - D_b = F1 / K1,
/// D_b - D_c = F2 / K2: all solutions, by trying all signs of the three bearing forces.
std::vector<Vector2d> by_hand(const test::HandMade& joint, const Vector3d& k, const Vector3d& P, const Vector2d& K) {
  const Eigen::Matrix<double, 3, 2> bearing{{-1, 0}, {1, -1}, {0, 1}};
  std::vector<Vector2d> solutions;
  for (int signs = 0; signs < 8; ++signs) {
    Eigen::Matrix<double, 3, 2> D;  // displacements are D F + P / k
    Vector3d sign;
    for (int i = 0; i < 3; ++i) {
      sign[i] = (signs >> i) % 2 == 0 ? 1 : -1;
      const double r = friction_at(joint, i, sign[i]);
      D.row(i) = (1 - r * sign[i]) / k[i] * bearing.row(i);
    }
    const Vector3d free = P.cwiseQuotient(k);
    Matrix2d A = -Matrix2d(K.cwiseInverse().asDiagonal());
    A.row(0) += D.row(0) - D.row(1);
    A.row(1) += D.row(1) - D.row(2);
    const Vector2d F = A.inverse() * -Vector2d(free[0] - free[1], free[1] - free[2]);
    if (((bearing * F).array() * sign.array() > 0).all()) solutions.push_back(F);
  }
  return solutions;
}

TEST(Stack, FrictionOfAMiddlePlateIsThatOfTheNetBearingForce) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> force(-100, 100);
  const Vector3d k(300, 500, 200);
  const Vector2d K(90, 40);
  std::set<std::vector<bool>> seen;
  for (int i = 0; i < 200; ++i) {
    const Vector3d P(force(random), force(random), force(random));
    auto joint = single_stack({k[0], k[1], k[2]}, P, test::linear_law(K[0]));
    joint.law[1] = test::linear_law(K[1]);
    for (auto& plate : joint.plates) {
      auto rubbing = test::disc_plate(one(1));
      test::add_friction(rubbing, random);
      plate.R = rubbing.R_df[0];
      plate.friction_unit_force = rubbing.friction_unit_force;
      plate.friction_resultant = rubbing.friction_resultant;
      plate.friction_hole = rubbing.friction_hole;
      plate.friction_bearing = rubbing.friction_bearing;
    }
    test::set_friction(joint, 0, 0.3);
    const auto expected = by_hand(joint, k, P, K);
    ASSERT_EQ(expected.size(), 1U);
    const PathStep step = test::solved(joint);
    EXPECT_LT((step.F - expected[0]).norm(), 1e-11 * P.norm());
    seen.insert({step.F[0] > 0, step.F[1] > 0, step.F[0] > step.F[1]});
    // What passes each plane, friction included, balances each plate.
    const JointState state = test::state_of(joint, step);
    const VectorXd &first = state.transferred_first, &second = state.transferred_second;
    EXPECT_NEAR(state.plates[0].by_fasteners[0], -first[0], 1e-11);
    EXPECT_NEAR(state.plates[1].by_fasteners[0], second[0] - first[1], 1e-11);
    EXPECT_NEAR(state.plates[2].by_fasteners[0], second[1], 1e-11);
    EXPECT_LT(state.out_of_balance, 1e-11);
  }
  EXPECT_EQ(seen.size(), 6U) << "all signs of F1, F2 and F1 - F2 that there are";
}

TEST(Stack, HolesInReversedOrderTurnTheSigns) {
  std::mt19937 random(14);
  for (int i = 0; i < 20; ++i) {
    test::HandMade joint = test::random_stack(random, 4, 3, 1);
    joint.law.assign(joint.n_planes(), test::power_law(40, 0.7));
    joint.clearance.assign(joint.n_planes(), 0.01);
    test::HandMade reversed = joint;
    for (auto& fastener : reversed.fasteners) std::reverse(fastener.holes.begin(), fastener.holes.end());
    const PathStep step = test::solved(joint), back = test::solved(reversed);
    const JointState state = test::state_of(joint, step), turned = test::state_of(reversed, back);
    Index first = 0;
    for (const auto& fastener : joint.fasteners) {
      const Index n = std::ssize(fastener.holes) - 1;
      for (Index j = 0; j < n; ++j) {
        const Index here = first + j, there = first + n - 1 - j;
        EXPECT_NEAR(back.F[there], -step.F[here], 1e-9);
        EXPECT_NEAR(back.delta[there], -step.delta[here], 1e-11);
        EXPECT_NEAR(turned.transferred_first[there], -state.transferred_second[here], 1e-9);
      }
      first += n;
    }
  }
}

TEST(Stack, SharesDoNotAskWhichPlateAFastenerNamesFirst) {
  const auto plate = test::disc_plate(100 * MatrixXd::Identity(2, 2));
  auto joint = test::joint_of({plate, plate});
  test::add_fastener(joint, {{0, 0}, {1, 0}}, test::linear_law(1));
  test::add_fastener(joint, {{1, 1}, {0, 1}}, test::linear_law(1));
  EXPECT_LT((shares(joint, Vector2d(30, -10)) - Vector2d(75, 25)).norm(), 1e-13);
  EXPECT_LT((shares(joint, Vector2d(-30, 10)) - Vector2d(75, 25)).norm(), 1e-13);
}

/// Loads of a joint of three plates in files, by fastener and plates.
std::map<std::string, double> loads_of(const test::TemporaryFolder& folder, const std::string& plates,
                                       const std::string& fasteners) {
  const std::string path = folder.write(
      "joint.json", test::joint_text({{"plates", plates},
                                      {"laws", R"({"lin": {"type": "power", "A": 900, "n": 0.8, "delta0": 0.001}})"},
                                      {"fasteners", fasteners}}));
  std::ostringstream out, log;
  program::Timings timings;
  run({path, folder.path("result.h5"), "", true, {}}, out, log, timings);
  const auto a = test::Result(folder.path("result.h5"));
  std::map<std::string, double> loads;
  for (Index j = 0; j < std::ssize(a.fastener_id); ++j)
    loads[a.fastener_id[j] + a.first_hole[j] + a.second_hole[j]] = a.F(0, j);
  return loads;
}

TEST(Stack, OrderOfPlatesAndFastenersInTheFileDoesNotMatter) {
  const test::TemporaryFolder folder;
  const auto lap = test::two_fastener_lap();
  formats::write(folder.path("a.h5"), lap.a);
  formats::write(folder.path("b.h5"), lap.b);
  formats::write(folder.path("c.h5"), test::chain(2, 0, 400, {}));
  const std::string one = R"({"id": "f1", "between": ["a:1", "b:1", "c:1"], "law": "lin"})";
  const std::string two = R"({"id": "f2", "between": ["c:2", "a:2", "b:2"], "law": "lin", "clearance": [0, 0.01]})";
  const auto loads = loads_of(folder, R"({"a": "a.h5", "b": "b.h5", "c": "c.h5"})", "[" + one + "," + two + "]");
  const auto others = loads_of(folder, R"({"c": "c.h5", "a": "a.h5", "b": "b.h5"})", "[" + two + "," + one + "]");
  ASSERT_EQ(loads.size(), 4U);
  for (const auto& [plane, F] : loads) EXPECT_NEAR(others.at(plane), F, 1e-7) << plane;
  EXPECT_NEAR(loads.at("f1a:1b:1") - loads.at("f2c:2a:2") + loads.at("f2a:2b:2"), 100, 1e-7) << "what leaves a";
  EXPECT_NEAR(loads.at("f1b:1c:1"), loads.at("f2c:2a:2"), 1e-7) << "c floats";
}

}  // namespace
}  // namespace fastjoint::stage3
