// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/plate_mesh.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <tuple>

#include "common/pfem/element.hpp"
#include "common/plate/cracks.hpp"
#include "common/plate/skeleton.hpp"
#include "stage1_plate/problem/plate_problem.hpp"
#include "tests/support/message.hpp"

namespace fastjoint::crack_mesh_test {
namespace {

using testing::HasSubstr;

stage1::PlateScene scene(const std::string& lines, const std::string& holes, const std::string& cracks) {
  return stage1::read_scene(input::parse("plate.json", fmt::format(R"({{"format": "plate", "version": 1,
    "analysis": "plane stress", "materials": {{"m": {{"E": 1000, "nu": 0.3}}}},
    "geometry": {{"grid": {{{}, "thickness": 1}}}}, "holes": [{}], "cracks": [{}],
    "supports": [{{"on": "bottom", "fix": ["x", "y"]}}],
    "external": [{{"id": "P", "on": "top", "direction": "y", "kind": "rigid"}}]}})",
                                                                   lines, holes, cracks)));
}

constexpr const char* square = R"("x": [-6, -2, 2, 6], "y": [-6, -2, 2, 6])";
constexpr const char* hole = R"({"id": "h", "center": [0, 0], "radius": 0.5})";

double area(const stage1::PlateMesh& plate) {
  constexpr int n = 12;
  const auto rule = pfem::gauss(n);
  double sum = 0;
  for (int element = 0; element < plate.mesh.n_elements(); ++element) {
    const pfem::ElementMap map(plate.mesh, plate.edges, element);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) sum += rule.w[i] * rule.w[j] * map.jacobian(rule.x[i], rule.x[j]).determinant();
  }
  return sum;
}

/// Length of all edges that only one element has and that belong neither to the border nor to a rim.
double length_of_faces(const stage1::PlateMesh& plate) {
  std::vector<pfem::Side> named;
  for (const auto& [name, sides] : plate.sets) named.insert(named.end(), sides.begin(), sides.end());
  for (const auto& rim : plate.rims) named.insert(named.end(), rim.sides.begin(), rim.sides.end());
  double sum = 0;
  for (int element = 0; element < plate.mesh.n_elements(); ++element)
    for (int edge = 0; edge < 4; ++edge) {
      const bool alone = plate.edges.is_border(plate.edges.of({element, edge}));
      if (alone && std::ranges::find(named, pfem::Side{element, edge}) == named.end())
        sum += pfem::side_rule(plate.mesh, plate.edges, {element, edge}, 1).ds.sum();
    }
  return sum;
}

/// The sheet is whole but for the crack, whose two faces are its only edges inside.
void expect_open(const stage1::PlateMesh& plate, double expected_area, double crack) {
  EXPECT_NEAR(area(plate), expected_area, 1e-9 * expected_area);
  EXPECT_NEAR(length_of_faces(plate), 2 * crack, 1e-9);
}

class RandomCracks : public testing::TestWithParam<int> {};

TEST_P(RandomCracks, OpenASheetThatIsWholeOtherwise) {
  std::mt19937 random(GetParam());
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double low = uniform(1, 3), high = uniform(1, 3), radius = uniform(0.2, 0.7);
  const double angle = uniform(-180, 180), length = uniform(0.03, 0.8) * (std::min(low, high) - radius);
  const auto plate = stage1::make_mesh(
      scene(fmt::format(R"("x": [-6, {0}, {1}, 6], "y": [-5, {0}, {1}, 5])", -low, high),
            fmt::format(R"({{"id": "h", "center": [0, 0], "radius": {}}})", radius),
            fmt::format(R"({{"id": "c", "from": "hole:h", "angle": {}, "length": {}}})", angle, length)));
  expect_open(plate, 120 - std::numbers::pi * radius * radius, length);
  ASSERT_EQ(plate.tips.size(), 1U);
  const double turn = angle * std::numbers::pi / 180, reach = radius + length;
  EXPECT_NEAR((plate.tips[0].at - reach * Eigen::Vector2d(std::cos(turn), std::sin(turn))).norm(), 0, 1e-12);
  EXPECT_NEAR(std::remainder(plate.tips[0].angle - turn, 2 * std::numbers::pi), 0, 1e-9);
  EXPECT_NEAR(plate.tips[0].length, length, 1e-12);
  EXPECT_TRUE(plate.is_cracked[0]);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomCracks, testing::Range(0, 40));

TEST(CrackMesh, CracksGoOnThroughCells) {
  const auto plate = stage1::make_mesh(scene(square, hole, R"({"from": "hole:h", "angle": 0, "length": 3.5})"));
  expect_open(plate, 144 - std::numbers::pi / 4, 3.5);
  EXPECT_NEAR(plate.tips[0].at.x(), 4, 1e-12);
}

TEST(CrackMesh, CracksOfEachKindInOneSheet) {
  const auto plate = stage1::make_mesh(scene(
      R"("x": [-6, -2, 2, 6], "y": [-6, -2, 2, 6])",
      R"({"id": "h", "center": [-4, 0], "radius": 0.5}, {"id": "g", "center": [0, 0], "radius": 0.5})",
      R"({"id": "link", "from": "hole:h", "to": "hole:g"}, {"id": "short", "from": "hole:g", "angle": 0, "length": 0.2},
         {"id": "edge", "from": "right", "at": 4, "length": 1}, {"id": "inside", "from": [-5, -4], "to": [-3, -4]})"));
  expect_open(plate, 144 - std::numbers::pi / 2, 3 + 0.2 + 1 + 2);
  std::vector<std::string> names;
  for (const auto& tip : plate.tips) names.push_back(tip.id);
  EXPECT_THAT(names, testing::ElementsAre("short", "edge", "inside start", "inside end"));
  EXPECT_EQ(plate.tips[2].length, 1);
}

/// Lengths of cracks, by turns evenly spread, spread over powers of ten from a hundredth of a radius, and nearly equal.
class RandomLengths {
 public:
  /// @param room From the rim to what the crack must not reach.
  double next(double room) {
    const double most = 0.98 * room, at = share_(random_);
    const double even = least + at * (most - least), by_powers = least * std::pow(most / least, at);
    const double again =
        std::min(last_ * (1 + std::array{0.0, 1e-9, 1e-6, 1e-3, 1e-2}[int(5 * share_(random_))]), most);
    return last_ = std::array{even, by_powers, again}[int(3 * share_(random_))];
  }
  double share() { return share_(random_); }
  static constexpr double least = 0.01;  ///< of holes of radius 1

 private:
  std::mt19937 random_{66};
  std::uniform_real_distribution<double> share_{0, 1};
  double last_ = least;
};

std::string crack_from(int at, double angle, double length) {
  return fmt::format(R"({{"from": "hole:{}", "angle": {}, "length": {:.17g}}})", at, angle, length);
}

std::string hole_at(int name, double x, double y) {
  return fmt::format(R"({{"id": "{}", "center": [{:.17g}, {:.17g}], "radius": 1}})", name, x, y);
}

TEST(CrackMesh, TakesAnyTwoLengthsAtAHole) {
  RandomLengths random;
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(i);
    const double y = i % 3 == 0 ? 0 : 2.5 * (2 * random.share() - 1), slant = i % 4 == 3 ? 360 * random.share() : 90;
    const bool is_upright = slant == 90;
    const double a = random.next(is_upright ? 4 - y : 3.5), b = random.next(is_upright ? 4 + y : 3.5);
    const double other = is_upright ? -90 : slant + 30 + 300 * random.share();
    const auto plate = stage1::make_mesh(scene(R"("x": [-12, 12], "y": [-5, 5])", hole_at(1, 0, is_upright ? y : 0),
                                               crack_from(1, slant, a) + "," + crack_from(1, other, b)));
    expect_open(plate, 240 - std::numbers::pi, a + b);
    ASSERT_EQ(plate.tips.size(), 2);
  }
}

TEST(CrackMesh, TakesAnyLengthsInARow) {
  RandomLengths random;
  constexpr double pitch = 5;
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(i);
    const int n = 2 + i % 3;
    std::string lines, holes, cracks;
    double total = 0, room = pitch / 2 - 1;  // what is left of the ligament below the hole
    const auto add = [&](int at, double angle, double length) {
      cracks += (cracks.empty() ? "" : ",") + crack_from(at, angle, length);
      total += length;
    };
    for (int at = 0; at < n; ++at) {
      lines += fmt::format("{}{}", at == 0 ? "" : ", ", pitch * at);
      holes += (at == 0 ? "" : ",") + hole_at(at, 0, pitch * (at + 0.5));
      if (room > 0.05 && random.share() < 0.7) add(at, -90, random.next(room));
      room = at + 1 < n ? pitch - 2 : pitch / 2 - 1;
      if (random.share() < 0.2) continue;
      const double length = random.next(room);
      add(at, 90, length);
      room -= length;
    }
    lines += fmt::format(", {}", pitch * n);
    if (cracks.empty()) add(0, 90, 0.5);
    const auto plate = stage1::make_mesh(scene(fmt::format(R"("x": [-10, 10], "y": [{}])", lines), holes, cracks));
    expect_open(plate, 20 * pitch * n - n * std::numbers::pi, total);
  }
}

/// Along a cell line between two holes' cells, across their sides, and with tips on sides: the sections stay whole.
TEST(CrackMesh, TipsMayLieOnTheSidesOfCells) {
  const std::string holes =
      R"({"id": "h", "center": [2.1, 6.1], "radius": 1}, {"id": "g", "center": [14.1, 9.9], "radius": 1.5})";
  using Case = std::tuple<const char*, double, double>;  // crack, its length, and where the cell line at 9 is then
  for (const auto& [crack, length, line] : {Case{R"({"from": "bottom", "at": 9, "length": 3.55})", 3.55, 9},
                                            {R"({"from": [9, 12], "to": [9, 16.3]})", 4.3, 9},
                                            {R"({"from": "hole:h", "angle": 0, "length": 5.9})", 5.9, 9},
                                            {R"({"from": "hole:g", "angle": 180, "length": 5})", 5, 7.6},
                                            {R"({"from": "bottom", "at": 9, "length": 12})", 12, 9}}) {
    SCOPED_TRACE(crack);
    const auto plate = stage1::make_mesh(scene(R"("x": [0, 9, 20, 40], "y": [0, 20])", holes, crack));
    expect_open(plate, 800 - std::numbers::pi * (1 + 1.5 * 1.5), length);
    for (const auto& section : plate.sections) {
      const double across_y = section.hole == 0 ? line : 20 - line;
      EXPECT_NEAR(rim::section_area(plate.mesh, plate.edges, section), section.side.ends_with('x') ? 20 : across_y,
                  1e-9)
          << section.side << " of hole " << section.hole;
    }
  }
}

TEST(CrackMesh, RefusesWhatItCannotMesh) {
  const auto message = [](const char* lines, const char* cracks) {
    return test::message_of([&] { return stage1::make_mesh(scene(lines, hole, cracks)); });
  };
  EXPECT_THAT(message(square, R"({"from": "left", "at": 0, "length": 8})"), HasSubstr("it runs through hole \"h\""));
}

/// The field of the stress intensity factor 1, as textbooks have it (Williams 1957; T. L. Anderson, Fracture Mechanics,
/// tables 2.1 and 2.2).
plate::TipField singular_field(plate::Mode mode, const plate::Isotropic& material, const Eigen::Vector2d& x) {
  const double r = x.norm(), t = std::atan2(x.y(), x.x()), c = std::cos(t / 2), s = std::sin(t / 2);
  const double c3 = std::cos(1.5 * t), s3 = std::sin(1.5 * t), two_pi = 2 * std::numbers::pi;
  const double u = std::sqrt(r / two_pi) / (2 * material.mu), sigma = 1 / std::sqrt(two_pi * r), k = material.kappa;
  if (mode == plate::Mode::I)
    return {u * Eigen::Vector2d(c * (k - 1 + 2 * s * s), s * (k + 1 - 2 * c * c)),
            sigma * Eigen::Matrix2d{{c * (1 - s * s3), s * c * c3}, {s * c * c3, c * (1 + s * s3)}}};
  return {u * Eigen::Vector2d(s * (k + 1 + 2 * c * c), -c * (k - 1 - 2 * s * s)),
          sigma * Eigen::Matrix2d{{-s * (2 + c * c3), c * (1 - s * s3)}, {c * (1 - s * s3), s * c * c3}}};
}

TEST(TipFields, AreNormalised) {
  const plate::Isotropic material{400, 2.2};
  constexpr int n = 400;
  for (const auto mode : {plate::Mode::I, plate::Mode::II})
    for (const auto other : {plate::Mode::I, plate::Mode::II}) {
      // The contour integral around the tip, with the midpoint rule in cos: the fields are smooth up to the faces.
      double sum = 0;
      for (int i = 0; i < n; ++i) {
        const double t = std::numbers::pi * (2 * (i + 0.5) / n - 1);
        const Eigen::Vector2d normal(std::cos(t), std::sin(t));
        const auto dual = plate::dual_field(mode, material, 0.7 * normal);
        const auto field = singular_field(other, material, 0.7 * normal);
        sum += (field.sigma * normal).dot(dual.u) - (dual.sigma * normal).dot(field.u);
      }
      sum *= 0.7 * 2 * std::numbers::pi / n * material.mu / (material.kappa + 1) * std::sqrt(2 / std::numbers::pi);
      const double sign = mode == plate::Mode::I ? -1 : 1;
      EXPECT_NEAR(sign * sum, mode == other ? 1 : 0, 1e-4);
    }
  // Faces are free.
  for (const double side : {1e-12, -1e-12})
    for (const auto mode : {plate::Mode::I, plate::Mode::II})
      EXPECT_LT(plate::dual_field(mode, material, {-1, side}).sigma.col(1).norm(), 1e-9);
}

TEST(StressIntensities, DoNotDependOnThePath) {
  const auto a = scene(square, hole, R"({"from": "hole:h", "angle": 30, "length": 0.4})");
  const auto mesh = stage1::make_mesh(a);
  auto problem = stage1::number_unknowns(a, mesh);
  stage1::integrate(a, mesh, problem);
  const plate::Skeleton skeleton(problem);
  const plate::PlateFactor K(problem, skeleton, 8, true);
  std::vector<Eigen::MatrixXd> by_layer;
  for (const int layer : {0, 1, 2})
    by_layer.push_back(K.condensed(plate::stress_intensities(K, mesh.mesh, mesh.edges, problem.numbering, a.elasticity,
                                                             mesh.tips, layer))
                           .bottomRows(2));
  for (const int layer : {1, 2})
    EXPECT_LT((by_layer[layer] - by_layer[0]).lpNorm<Eigen::Infinity>(), 1e-6 * by_layer[0].lpNorm<Eigen::Infinity>());
}

TEST(CrackMesh, RefusesAPointOnBothFaces) {
  const auto with_point_at = [](const char* at) {
    return test::message_of([&] {
      return stage1::make_mesh(scene(square, hole,
                                     fmt::format(R"({{"id": "c", "from": [-4, 2], "to": [4, 2]}}],
          "points": [{{"id": "p", "at": [{}], "stiffness": 1}})",
                                                 at)));
    });
  };
  EXPECT_THAT(with_point_at("2, 2"),
              HasSubstr("/points/0/at: (2, 2) is on both faces of a crack; allowed: a vertex beside cracks"));
  EXPECT_EQ(with_point_at("2, -2"), "no error");
}

}  // namespace
}  // namespace fastjoint::crack_mesh_test
