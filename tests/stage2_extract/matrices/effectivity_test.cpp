// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "common/matrices/stiffness_error.hpp"
#include "stage1_plate/run/solve.hpp"
#include "tests/support/random_sheets.hpp"

namespace fastjoint {
namespace {

constexpr pfem::Space spaces[] = {pfem::Space::trunk, pfem::Space::product};

/// S of every degree from 1 to 8, or of 8 alone.
std::vector<Eigen::MatrixXd> stiffnesses(const std::string& json) {
  const auto solution = test::solve(test::make_plate(json));
  std::vector<Eigen::MatrixXd> S;
  for (std::size_t level = 0; level < solution.cases.size(); ++level) S.push_back(solution.cases[level].S);
  return S;
}

std::string with(const std::string& json, pfem::Space space, const std::string& more = "") {
  return std::string(json).insert(json.rfind('}'), test::in_space(space) + more);
}

Eigen::MatrixXd finest(const std::string& json) {
  return stiffnesses(with(json, pfem::Space::product, R"(, "p": [8, 8])")).back();
}

/// True error over estimated one by the Frobenius norm, at degree p of S from degree 1 on.
double effectivity(const std::vector<Eigen::MatrixXd>& S, int p, const Eigen::MatrixXd& exact, double fastest = 5) {
  const std::vector<Eigen::MatrixXd> up_to_p(S.begin(), S.begin() + p);
  const auto estimate = matrices::stiffness_error(up_to_p, Eigen::VectorXi::LinSpaced(p, 1, p), fastest);
  return (up_to_p.back() - exact).norm() / estimate.norm();
}

/// At the degrees from 3 on, in both spaces.
void expect_effectivity(const std::string& name, const std::string& json, const Eigen::MatrixXd& exact, double low,
                        double high) {
  for (const auto space : spaces) {
    const auto S = stiffnesses(with(json, space));
    ASSERT_EQ(S.size(), 8U);
    for (int p = 3; p <= 8; ++p) {
      const double ratio = effectivity(S, p, exact);
      EXPECT_GT(ratio, low) << name << ", " << pfem::name_of(space) << ", p = " << p;
      EXPECT_LT(ratio, high) << name << ", " << pfem::name_of(space) << ", p = " << p;
    }
  }
}

constexpr double least = 0.05, most = 1.5;

void expect_effectivity_of_panel(int nx, int ny) {
  expect_effectivity("panel " + std::to_string(nx), test::panel(nx, ny, 0), finest(test::panel(nx, ny, 3)), least,
                     most);
}

TEST(Effectivity, OfPanels) {
  expect_effectivity_of_panel(1, 1);
  expect_effectivity_of_panel(3, 1);
}
TEST(EffectivitySweep, OfPanels) {
  expect_effectivity_of_panel(3, 3);
  expect_effectivity_of_panel(10, 10);
}

TEST(Effectivity, OfTheSheetsOfThreeFasteners) {
  const std::vector<test::HoleText> holes = {{"1", 2.3, 0, 0.15}, {"2", 1.3, 0, 0.15}, {"3", 0.3, 0, 0.15}};
  const std::string held = R"(, "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}])";
  const test::GridSheet center = {
      {0, 0.8, 1.8, 2.8, 3.3},
      {0, 0.49},
      {{0.005, 0.005, 0.005, 0.005}},
      holes,
      held + R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])"};
  const test::GridSheet doubler = {{0, 0.8, 1.8, 2.8}, {0, 0.49}, {{0.015, 0.01, 0.005}}, holes, held};
  for (const auto& [name, sheet] : {std::pair{"center", center}, {"doubler", doubler}})
    expect_effectivity(name, sheet.json(0, ""), finest(test::graded(sheet, 2).json(3, "")), least, most);
}

void expect_effectivity_of_random_sheets(unsigned n_seeds) {
  for (unsigned seed = 0; seed < n_seeds; ++seed) {
    const auto sheet = test::random_sheet(seed);
    expect_effectivity("random sheet " + std::to_string(seed), sheet.json(0, ""),
                       finest(test::graded(sheet, 2).json(3, "")), least, most);
  }
}

TEST(Effectivity, OfRandomSheets) { expect_effectivity_of_random_sheets(3); }
TEST(EffectivitySweep, OfRandomSheets) { expect_effectivity_of_random_sheets(20); }

const std::string symmetric = R"(, "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}])";
const std::string clamped = R"(, "supports": [{"on": "left", "fix": ["x", "y"]}])";
const std::string pulled = R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])";
const std::string glued = R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                                            {"id": "Q", "on": "right", "direction": "y", "kind": "rigid"}])";

test::GridSheet square(const std::string& extra, const std::vector<std::vector<double>>& thickness) {
  return {{0, 1, 2}, {0, 1, 2}, thickness, {{"1", 0.5, 0.5, 0.15}}, extra};
}

/// A square with a hole whose rate singular points rule sooner or later: never underestimated, and less than 20 times
/// overestimated.
TEST(Effectivity, OfSingularSheets) {
  const std::vector<std::vector<double>> even = {{0.1, 0.1}, {0.1, 0.1}};
  for (const auto& [name, sheet] :
       {std::pair{"clamped edge", square(clamped + pulled, even)},
        {"rigid edge with free neighbours", square(clamped + glued, even)},
        {"step in thickness", square(symmetric + pulled, {{0.1, 0.5}, {0.1, 0.5}})},
        {"re-entrant corner: what is left out is 1e-6 as thick", square(symmetric + pulled, {{0.1, 0.1}, {0.1, 1e-7}})},
        {"chess board of thicknesses: a singularity of about r^0.4", square(symmetric + pulled, {{0.1, 1}, {1, 0.1}})}})
    expect_effectivity(name, sheet.json(0, ""), finest(test::graded(sheet, 4).json(3, "")), least, most);
}

/// Ends of the springs at a rim, between nodes, where the rate is 2 lambda + 1: up to twice underestimated. The
/// exact S is from cells whose corners lie on the rays through the ends.
TEST(Effectivity, OfASpringThatEndsBetweenNodes) {
  const auto with_arc = [](std::string json) {
    const std::string spring = R"("spring": {)";
    return json.insert(json.find(spring) + spring.size(), R"("arc": [-60, 60], )");
  };
  const test::GridSheet sheet = {{0, 1}, {0, 1}, {{0.1}}, {{"1", 0.5, 0.5, 0.15}}, symmetric + pulled};
  test::GridSheet aligned = sheet;
  const double half_width = 0.5 / std::sqrt(3.0);  // tan 60 degrees = sqrt 3
  aligned.x = {0, 0.5 - half_width, 0.5 + half_width, 1};
  aligned.thickness = {{0.1, 0.1, 0.1}};
  expect_effectivity("arc", with_arc(sheet.json(0, "")), finest(with_arc(aligned.json(3, ""))), least, 2);
}

/// A laminate off its axes is singular in the corners of its sheet on rollers, like r^(1/2): its sequence may look
/// smooth for long. Its error is not underestimated all the same.
void expect_effectivity_of_laminates(unsigned n_seeds) {
  const std::string aluminium = R"("al": {"E": 1e7, "nu": 0.3})";
  for (unsigned seed = 0; seed < n_seeds; ++seed) {
    const auto laminate = [&](std::string json) {
      const std::string ply = R"("al": {"E1": 2e7, "E2": 1.3e6, "nu12": 0.3, "G12": 7e5, "angle": )";
      return json.replace(json.find(aluminium), aluminium.size(), ply + std::to_string(20 + 10 * (seed % 4)) + "}");
    };
    const auto sheet = test::random_sheet(seed);
    const auto exact = finest(laminate(test::graded(sheet, 3).json(2, "")));
    const double fastest = matrices::max_rate_of(test::make_plate(laminate(sheet.json(0, ""))).scene.elasticity);
    EXPECT_EQ(fastest, 3);
    for (const auto space : spaces)
      for (const int rings : {0, 1}) {
        const auto S = stiffnesses(with(laminate(sheet.json(rings, "")), space));
        for (int p = 3; p <= 8; ++p) {
          const double ratio = effectivity(S, p, exact, fastest);
          EXPECT_GT(ratio, rings == 0 ? 0.02 : 0.0125)
              << seed << ", " << pfem::name_of(space) << ", rings " << rings << ", p = " << p;
          EXPECT_LT(ratio, most) << seed << ", " << pfem::name_of(space) << ", rings " << rings << ", p = " << p;
        }
      }
  }
}

TEST(Effectivity, OfLaminatesOffTheirAxes) {
  expect_effectivity_of_laminates(1);
  EXPECT_EQ(matrices::max_rate_of(test::make_plate(test::panel(1, 1)).scene.elasticity), 5);
}
TEST(EffectivitySweep, OfLaminatesOffTheirAxes) { expect_effectivity_of_laminates(8); }

}  // namespace
}  // namespace fastjoint
