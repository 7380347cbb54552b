// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/run/accuracy.hpp"

#include <gmock/gmock.h>

#include "stage1_plate/problem/plate_problem.hpp"
#include "tests/support/message.hpp"
#include "tests/support/random_sheets.hpp"

namespace fastjoint {
namespace {

using testing::AllOf;
using testing::HasSubstr;

stage1::PlateScene scene(const std::string& json) { return stage1::read_scene(input::parse("plate.json", json)); }

std::string without_rings(std::string json) {
  const std::string rings = R"(, "rings": 0)";
  for (auto at = json.find(rings); at != std::string::npos; at = json.find(rings)) json.erase(at, rings.size());
  return json;
}

test::Plate plate_of(const stage1::PlateScene& chosen) {
  test::Plate plate{chosen, stage1::make_mesh(chosen), {}};
  plate.problem = test::assemble(plate.scene, plate.mesh);
  return plate;
}

Eigen::MatrixXd last_stiffness(const test::Plate& plate) {
  const auto solution = test::solve(plate);
  return solution.cases.back().S;
}

TEST(Accuracy, IsReachedByTheLeastDegree) {
  const auto open = scene(without_rings(test::panel(3, 1)));
  const auto exact = last_stiffness(test::make_plate(test::panel(3, 1, 3, R"(, "space": "product")")));
  for (const double asked : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    const auto chosen = stage1::meet_accuracy(open, {asked});
    EXPECT_TRUE(chosen.is_reached());
    EXPECT_LE((last_stiffness(plate_of(chosen.scene)) - exact).norm(), 1.5 * asked * exact.norm());
    EXPECT_EQ(chosen.scene.space, pfem::Space::product);
    EXPECT_EQ(chosen.scene.p_low, 1);
    for (const auto& hole : chosen.scene.holes) EXPECT_EQ(hole.rings, asked < 1e-6 ? 2 : 1);
    auto lower = chosen.scene;  // its rings are kept: one degree less, and no other rings
    for (auto& hole : lower.holes) hole.has_rings = true;
    ASSERT_GT(--lower.p_high, 1);
    EXPECT_FALSE(stage1::meet_accuracy(lower, {asked}).is_reached());
  }
}

/// Number of random sheets that reach it.
int expect_true_of_random_sheets(unsigned n_seeds) {
  constexpr double asked = 1e-4;
  int reached = 0;
  for (unsigned seed = 0; seed < n_seeds; ++seed) {
    const auto sheet = test::random_sheet(seed);
    const auto chosen = stage1::meet_accuracy(scene(without_rings(sheet.json(0, ""))), {asked});
    const std::string top = R"(, "space": "product", "p": [8, 8])";
    const auto exact = last_stiffness(test::make_plate(test::graded(sheet, 2).json(3, top)));
    const double error = (last_stiffness(plate_of(chosen.scene)) - exact).norm() / exact.norm();
    EXPECT_LE(error, 1.5 * chosen.errors[0].value) << seed;
    if (chosen.is_reached()) ++reached;
  }
  return reached;
}

TEST(Accuracy, IsTrueOfRandomSheets) { EXPECT_GT(expect_true_of_random_sheets(3), 0); }
TEST(AccuracySweep, IsTrueOfRandomSheets) { EXPECT_GT(expect_true_of_random_sheets(20), 15); }

/// What the program says is what stage 2 says.
TEST(Accuracy, IsThatOfTheMatrices) {
  const auto chosen = stage1::meet_accuracy(scene(without_rings(test::panel(2, 1))), {1e-4});
  const auto extraction = test::extract(test::solve(plate_of(chosen.scene)), false);
  ASSERT_EQ(extraction.errors.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i)  // quadrature is of p = 8 in the search
    EXPECT_NEAR(extraction.errors[i].value / chosen.errors[i].value, 1, 1e-3);
  EXPECT_EQ(stage1::to_text(chosen),
            "accuracy 0.0001: product space, p = 6, rings 1: " + matrices::to_text(chosen.errors));
}

TEST(Accuracy, TakesAnotherRingWhereTheHighestDegreeDoesNotDo) {
  auto low = scene(without_rings(test::panel(1, 1)));
  low.p_high = 5;
  const auto one = stage1::meet_accuracy(low, {4e-4}), more = stage1::meet_accuracy(low, {4e-5});
  EXPECT_EQ(one.scene.holes[0].rings, 1);
  EXPECT_EQ(more.scene.holes[0].rings, 2);
  EXPECT_LT(matrices::largest(more.errors), 0.5 * matrices::largest(one.errors));
}

/// What the scene says is as good as 2.4e-3 at its highest degree, by R, whose friction jumps on elements without a
/// ring; S alone would be good for 1e-3.
TEST(Accuracy, KeepsWhatTheSceneSays) {
  for (const double asked : {3e-3, 1e-3}) {
    const auto chosen =
        stage1::meet_accuracy(scene(test::panel(1, 1, 0, R"(, "space": "trunk", "p": [2, 7])")), {asked});
    EXPECT_EQ(chosen.scene.space, pfem::Space::trunk);
    EXPECT_EQ(chosen.scene.holes[0].rings, 0);
    EXPECT_EQ(chosen.scene.p_low, 2);
    EXPECT_EQ(chosen.scene.p_high, 7);
    EXPECT_FALSE(chosen.free_rings);
    EXPECT_EQ(chosen.is_reached(), asked == 3e-3);
    ASSERT_EQ(chosen.errors.size(), 2U);
    EXPECT_LT(chosen.errors[0].value, 2e-4);
    EXPECT_EQ(chosen.errors[1].value, matrices::largest(chosen.errors));
  }
  const auto missed = stage1::meet_accuracy(scene(test::panel(1, 1)), {1e-9});
  EXPECT_FALSE(missed.is_reached());
  EXPECT_EQ(missed.scene.p_high, 8);
  EXPECT_THAT(stage1::to_text(missed),
              AllOf(HasSubstr("accuracy 1e-09: product space, p = 8: error of S about "), HasSubstr(", not reached")));
}

/// Rings do not help at the ends of a clamped edge: the search ends, and keeps the model that costs less.
TEST(Accuracy, GivesUpWhereRingsDoNotHelp) {
  const std::string json = test::grid_scene({0, 1}, {0, 1}, {{"1", 0.5, 0.5, 0.1}},
                                            R"(, "supports": [{"on": "left", "fix": ["x", "y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])");
  const auto chosen = stage1::meet_accuracy(scene(without_rings(json)), {1e-8});
  EXPECT_FALSE(chosen.is_reached());
  EXPECT_EQ(chosen.scene.holes[0].rings, 1);
  EXPECT_EQ(chosen.scene.p_high, 8);
}

/// A sheet that one disc and a support across hold has no stiffness: what its load does must be exact enough.
TEST(Accuracy, IsThatOfTheComplianceWhereTheStiffnessIsZero) {
  const std::string json = test::grid_scene({0, 1, 2}, {0, 1}, {{"1", 0.5, 0.5, 0.125}, {"2", 1.4, 0.6, 0.2, 0, false}},
                                            R"(, "supports": [{"on": "bottom", "fix": ["y"]}],
    "external": [{"id": "T", "on": "right", "direction": "x", "kind": "traction"}])");
  constexpr double asked = 1e-5;
  const auto chosen = stage1::meet_accuracy(scene(without_rings(json)), {asked});
  EXPECT_TRUE(chosen.is_reached());
  EXPECT_GT(chosen.scene.p_high, 3);
  const auto extracted = test::extract(test::solve(plate_of(chosen.scene)), false).matrices;
  EXPECT_EQ(extracted.S_dd.back()(0, 0), 0);
  auto finer = chosen.scene;
  finer.p_high = 8;
  for (auto& hole : finer.holes) hole.rings += 2;
  const auto exact = test::extract(test::solve(plate_of(finer)), false).matrices;
  EXPECT_NEAR(extracted.C_t.back()(0, 0) / exact.C_t.back()(0, 0), 1, asked);
}

/// Friction is exact enough too, where its tractions jump.
TEST(Accuracy, IsThatOfFriction) {
  for (const double asked : {1e-3, 1e-5}) {
    const auto chosen = stage1::meet_accuracy(scene(without_rings(test::panel(2, 1))), {asked});
    EXPECT_TRUE(chosen.is_reached());
    const auto R = [](const test::Plate& plate) {
      return test::extract(test::solve(plate), false).matrices.R_df.back();
    };
    const auto exact = R(test::make_plate(test::panel(2, 1, 3, R"(, "space": "product")")));
    EXPECT_LT((R(plate_of(chosen.scene)) - exact).norm(), asked * exact.norm());
  }
}

TEST(Accuracy, OfHoopStressesNeedsAHoleThatHasThem) {
  const auto none = scene(without_rings(test::grid_scene({0, 1, 2}, {0, 1}, {},
                                                         R"(, "supports": [{"on": "left", "fix": ["x", "y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])")));
  EXPECT_THAT(test::message_of([&] { return stage1::meet_accuracy(none, {.hoop = 1e-3}); }),
              HasSubstr("no hole has any"));
}

/// Of hoop stresses the error is that of the strains along the rims, against a finer mesh with the same waves; fewer
/// waves do where less is asked for.
TEST(Accuracy, IsThatOfHoopStresses) {
  const auto open =
      scene(without_rings(test::grid_scene({0, 1, 2}, {0, 1}, {{"1", 0.5, 0.5, 0.125}, {"2", 1.4, 0.6, 0.15, 0, false}},
                                           R"(, "supports": [{"on": "left", "fix": ["x", "y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                 {"id": "T", "on": "top", "direction": "x", "kind": "traction"}])")));
  int orders = 0, degrees = 0;
  for (const double asked : {1e-1, 1e-2, 1e-3}) {
    const auto chosen = stage1::meet_accuracy(open, {.hoop = asked});
    EXPECT_TRUE(chosen.is_reached()) << asked;
    EXPECT_THAT(stage1::to_text(chosen), HasSubstr("error of hoop stresses about "));
    const auto plate = plate_of(chosen.scene);
    const auto waves = stage1::rim_waves(plate.scene, plate.mesh);
    EXPECT_GE(waves[1].value().shape.highest, orders);
    EXPECT_GT(plate.scene.p_high, degrees);
    orders = waves[1]->shape.highest;
    degrees = plate.scene.p_high;
    auto finer = chosen.scene;
    finer.p_high = 8;
    for (std::size_t i = 0; i < finer.holes.size(); ++i) {
      finer.holes[i].rings += 2;
      finer.holes[i].waves = waves[i].value().shape.highest;
    }
    const Eigen::MatrixXd found = test::solve(plate).cases.back().W;
    const Eigen::MatrixXd exact = test::solve(plate_of(finer)).cases.back().W;
    const auto error = [&](const Eigen::MatrixXd& other) { return stage1::hoop_error(waves, found, other, 2, 1); };
    EXPECT_LT((error(exact) - error(found)) / 2, asked);
    EXPECT_GT((error(exact) - error(found)) / 2, 1e-5 * asked);
  }
  EXPECT_GT(orders, 4);
}

TEST(Accuracy, RefusesWhatHasNone) {
  const auto refused = [](const std::string& json) {
    return test::message_of([&] { return stage1::meet_accuracy(scene(json), {1e-3}); });
  };
  EXPECT_THAT(refused(test::panel(1, 1, 0, R"(, "p": [8, 8])")),
              AllOf(HasSubstr("degree 8 alone"), HasSubstr("allowed: a range")));
  EXPECT_THAT(refused(test::grid_scene({0, 1}, {0, 1}, {}, R"(, "supports": [{"on": "left", "fix": ["x", "y"]}],
    "external": [{"id": "T", "on": "right", "direction": "x", "kind": "traction"}])")),
              AllOf(HasSubstr("plate.json"), HasSubstr("a disc or a rigid external")));
}

}  // namespace
}  // namespace fastjoint
