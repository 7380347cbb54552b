// SPDX-License-Identifier: GPL-3.0-or-later
// Which holes have waves, and of what order.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/errors.hpp"
#include "stage1_plate/problem/plate_problem.hpp"
#include "tests/support/message.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint::rim_waves_test {
namespace {

using testing::HasSubstr;
using Waves = std::vector<std::optional<rim::Waves>>;

const char* const metal = R"({"E": 1e7, "nu": 0.3})";
/// Fibres along an angle, degrees.
std::string ply(double angle) {
  return fmt::format(R"({{"E1": 1.4e7, "E2": 1e6, "nu12": 0.3, "G12": 5e5, "angle": {}}})", angle);
}

/// A rectangle with holes; each of `holes` is its members behind the id, "center" first.
struct Sheet {
  std::vector<double> x = {0, 20}, y = {0, 20};
  std::vector<std::string> holes;
  std::string material = metal, thickness = "0.1", more = "";

  [[nodiscard]] test::Plate plate() const {
    std::vector<std::string> list;
    for (const auto& hole : holes)
      list.push_back(fmt::format(R"({{"id": "{}", "radius": 0.5, "rings": 0, {}}})", list.size(), hole));
    const std::string json =
        fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress",
      "materials": {{"m": {}}}, "geometry": {{"grid": {{"x": [{}], "y": [{}], "thickness": {}}}}}, "holes": [{}]{}}})",
                    material, fmt::join(x, ","), fmt::join(y, ","), thickness, fmt::join(list, ","), more);
    test::Plate plate{stage1::read_scene(input::parse("plate.json", json)), {}, {}};
    plate.mesh = stage1::make_mesh(plate.scene);
    return plate;
  }
  [[nodiscard]] Waves waves() const {
    const auto made = plate();
    return stage1::rim_waves(made.scene, made.mesh);
  }
  /// Of the first hole.
  [[nodiscard]] int order() const { return waves().at(0).value().shape.highest; }
};

std::string at(double x, double y, const std::string& more = "") {
  return fmt::format(R"("center": [{}, {}]{})", x, y, more);
}
const std::string sprung = R"(, "spring": {"modulus": 1e6})";
const std::string contact = R"(, "spring": {"modulus": 1e6, "compression_only": true})";
const std::string links = R"(, "spring": {"links": 100})";

/// A hole whose middle is so far from the right edge.
Sheet near_edge(double distance) { return {.holes = {at(20 - distance, 10)}}; }
/// Two holes whose middles are so far from each other.
Sheet pair(double distance) {
  return {.x = {0, 10, 20}, .holes = {at(10 - distance / 2, 10), at(10 + distance / 2, 10)}};
}

TEST(RimWaves, AreOfOrderFourFarFromEverything) {
  EXPECT_EQ(Sheet{.holes = {at(10, 10)}}.order(), 4);
  EXPECT_EQ((Sheet{.x = {0, 400}, .y = {0, 400}, .holes = {at(200, 200)}}.order()), 4);
}

TEST(RimWaves, AreMoreNearerToAnEdge) {
  EXPECT_EQ(near_edge(8).order(), 4);
  EXPECT_GT(near_edge(1.5).order(), near_edge(3).order());
  EXPECT_GT(near_edge(0.9).order(), near_edge(1.5).order());
  EXPECT_EQ((Sheet{.holes = {at(10, 1.5)}}.order()), near_edge(1.5).order()) << "whichever edge it is";
}

TEST(RimWaves, AreMoreNearerToAnotherHole) {
  EXPECT_EQ((Sheet{.x = {-20, 10, 40}, .y = {-20, 40}, .holes = {at(-1, 10), at(21, 10)}}.order()), 4);
  EXPECT_GT(pair(3).order(), 4);
  EXPECT_GT(pair(2).order(), pair(3).order());
  const auto waves = pair(2).waves();
  EXPECT_EQ(waves.at(0)->shape, waves.at(1)->shape);
}

/// What all orders behind the highest leave out of the strain, the sum of n f^(n-1), is below one bound everywhere and
/// would not be with an order less. Reflections between a hole and an edge end at the foci of the two, sqrt(e^2 - a^2)
/// behind the edge, and those between two equal holes likewise.
TEST(RimWaves, LeaveOutWhatFallsBelowOneBound) {
  double most = std::numeric_limits<double>::infinity(), least = 0;
  const auto add = [&](const Sheet& sheet, double half) {
    const double fall = 0.5 / (half + std::sqrt(half * half - 0.25));
    const int order = sheet.order();
    ASSERT_GT(order, 4) << fall;
    double left = 0;
    for (int n = 1000; n > order; --n) left += n * std::pow(fall, n - 1);
    least = std::max(least, left);
    most = std::min(most, left + order * std::pow(fall, order - 1));
  };
  for (const double distance : {0.8, 1.0, 1.2, 1.7}) add(near_edge(distance), distance);
  for (const double distance : {1.3, 2.0, 3.0}) add(pair(distance), distance / 2);
  EXPECT_LE(least, most);
}

TEST(RimWaves, AreMoreAlongTheFibresOfALaminate) {
  const auto order = [](const std::string& material, double x, double y) {
    return Sheet{.holes = {at(x, y)}, .material = material}.order();
  };
  constexpr double near = 20 - 2.5;
  EXPECT_GT(order(ply(0), near, 10), order(metal, near, 10)) << "fibres end at the edge";
  EXPECT_GT(order(ply(0), near, 10), order(ply(90), near, 10));
  EXPECT_EQ(order(ply(0), near, 10), order(ply(90), 10, near)) << "turned with the sheet";
  Sheet neighbours = pair(4), across = pair(4);
  neighbours.material = ply(0);
  across.material = ply(90);
  EXPECT_GT(neighbours.order(), across.order());
}

TEST(RimWaves, SeeWhereTheThicknessSteps) {
  const auto order = [](const char* thickness) {
    return Sheet{.x = {0, 11.5, 20}, .holes = {at(10, 10)}, .thickness = thickness}.order();
  };
  EXPECT_EQ(order("[[0.1, 0.1]]"), 4);
  EXPECT_EQ(order("[[0.1, 0.2]]"), near_edge(1.5).order());
}

TEST(RimWaves, SeeSpringsAtPoints) {
  Sheet sheet{.x = {0, 11.5, 20}, .y = {0, 10, 20}, .holes = {at(9, 9)}};
  const int without = sheet.order();
  sheet.more = R"(, "points": [{"id": "p", "at": [11.5, 10], "stiffness": 1}])";
  EXPECT_GT(sheet.order(), without);
}

/// A line of symmetry through the hole is no edge.
TEST(RimWaves, OfHalfAndQuarterHolesAreThoseOfWholeOnes) {
  for (const double x : {10.0, 18.5}) {
    const int whole = Sheet{.y = {-10, 10}, .holes = {at(x, 0)}}.order();
    const auto half =
        Sheet{.y = {0, 10}, .holes = {at(x, 0)}, .more = R"(, "supports": [{"on": "bottom", "fix": ["y"]}])"}
            .waves()
            .at(0)
            .value();
    EXPECT_EQ(half.shape.highest, whole) << x;
    EXPECT_NEAR(half.shape.sweep, rim::full_turn / 2, 1e-12);
    EXPECT_NEAR(half.shape.start, 0, 1e-12);
  }
  const auto quarter = Sheet{.x = {0, 10}, .y = {0, 10}, .holes = {at(0, 0)}, .more = R"(, "supports":
    [{"on": "bottom", "fix": ["y"]}, {"on": "left", "fix": ["x"]}])"}
                           .waves()
                           .at(0)
                           .value();
  EXPECT_EQ(quarter.shape, (rim::Harmonics{4, quarter.shape.start, quarter.shape.sweep}));
  EXPECT_NEAR(quarter.shape.sweep, rim::full_turn / 4, 1e-12);
}

/// More than elements follow would be noise.
TEST(RimWaves, AreNoMoreThanElementsFollow) {
  const auto order = [](int p) {
    Sheet sheet = near_edge(0.6);
    sheet.more = fmt::format(R"(, "p": [{}, {}])", p, p);
    return sheet.order();
  };
  EXPECT_EQ(order(1), 4);
  EXPECT_GT(order(6), order(4));
  EXPECT_GT(order(8), order(6));
}

TEST(RimWaves, AreOfTheOrderThatTheSceneSays) {
  for (const int n : {1, 3, 9, 60}) {
    EXPECT_EQ(Sheet{.holes = {at(10, 10, fmt::format(R"(, "waves": {})", n))}}.order(), n);
    EXPECT_EQ(Sheet{.holes = {at(10, 10,
                                 fmt::format(R"(, "waves": {}, "spring": {{"modulus": 1e6, "compression_only":
      true, "harmonics": 6}})",
                                             n))}}
                  .order(),
              std::min(n, 6))
        << "those of contact are among stage 3's";
  }
}

TEST(RimWaves, AreLoadedInContact) {
  const auto waves = Sheet{.x = {0, 10, 20, 30}, .holes = {at(5, 10), at(15, 10, sprung), at(25, 10, contact)}}.waves();
  ASSERT_EQ(waves.size(), 3U);
  EXPECT_FALSE(waves[0].value().loaded);
  EXPECT_FALSE(waves[1].value().loaded);
  EXPECT_TRUE(waves[2].value().loaded);
}

TEST(RimWaves, AreLeftOutWhereNoStressesAreWanted) {
  const std::string none = R"(, "stresses": false)";
  const auto waves =
      Sheet{.x = {0, 10, 20, 30}, .holes = {at(5, 10, none), at(15, 10, sprung + none), at(25, 10, contact + none)}}
          .waves();
  EXPECT_FALSE(waves.at(0));
  EXPECT_FALSE(waves.at(1));
  EXPECT_TRUE(waves.at(2).value().loaded) << "contact needs them";
}

TEST(RimWaves, AreLeftOutWhereTheirStressesHaveNoClosedForm) {
  EXPECT_FALSE((Sheet{.holes = {at(10, 10, links)}}.waves().at(0))) << "links press at points";
  for (const std::string& spring : {std::string(), sprung})
    EXPECT_FALSE((Sheet{.holes = {at(10, 0, spring)}}.waves().at(0))) << "a notch in a free border";
  auto stepped = Sheet{.holes = {at(10, 10)}}.plate();
  stepped.mesh.mesh.thickness[stepped.mesh.rims[0].sides[2].element] *= 1.1;
  EXPECT_FALSE(stage1::rim_waves(stepped.scene, stepped.mesh).at(0)) << "several thicknesses";
  EXPECT_TRUE(stage1::rim_compliance(stepped.scene, stepped.mesh, 0).isZero(0));
  auto mixed = Sheet{.holes = {at(10, 10)}}.plate();
  mixed.scene.elasticity.emplace_back(2 * mixed.scene.elasticity[0]);
  mixed.mesh.mesh.material[mixed.mesh.rims[0].sides[2].element] = 1;
  EXPECT_FALSE(stage1::rim_waves(mixed.scene, mixed.mesh).at(0)) << "several materials";
}

/// A joint needs the waves of contact all the same: all of its own, as nothing stands in for the short ones.
TEST(RimWaves, OfContactWithoutAClosedFormAreAllThatTheJointHas) {
  const auto sheet = Sheet{.holes = {at(10, 0, R"(, "waves": 5, "spring": {"modulus": 1e6, "compression_only": true,
    "harmonics": 13})")}}.plate();
  const auto waves = stage1::rim_waves(sheet.scene, sheet.mesh).at(0).value();
  EXPECT_TRUE(waves.loaded);
  EXPECT_EQ(waves.shape.highest, 13);
  EXPECT_TRUE(stage1::rim_compliance(sheet.scene, sheet.mesh, 0).isZero(0));
}

TEST(RimWaves, OfContactNeedOneRimOfOneThickness) {
  auto stepped = Sheet{.holes = {at(10, 10, contact)}}.plate();
  stepped.mesh.mesh.thickness[stepped.mesh.rims[0].sides[2].element] *= 1.1;
  EXPECT_THAT(test::message_of([&] { return stage1::rim_waves(stepped.scene, stepped.mesh); }),
              HasSubstr("plate.json: /holes/0/spring/compression_only: the sheet has several thicknesses around hole "
                        "\"0\""));
}

TEST(RimWaves, HaveTheComplianceOfTheirSheet) {
  const auto plate = Sheet{.holes = {at(10, 10)}, .material = ply(30)}.plate();
  const Eigen::Matrix3d product = stage1::rim_compliance(plate.scene, plate.mesh, 0) * plate.scene.elasticity[0];
  EXPECT_LT((product - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

}  // namespace
}  // namespace fastjoint::rim_waves_test
