// SPDX-License-Identifier: GPL-3.0-or-later
// Estimated errors of S, R and C_t against true ones, over sheets of every kind, spaces, rings and ranges of degrees.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <map>

#include "common/matrices/stiffness_error.hpp"
#include "tests/support/random_sheets.hpp"

namespace fastjoint {
namespace {

using Eigen::MatrixXd;
using matrices::CondensedLevels;

/// S, R and C_t of every degree.
CondensedLevels levels(const std::string& json) {
  const auto a = test::extract(json, false).matrices;
  const auto nc = a.n_externals() + a.n_discs();
  CondensedLevels result{{}, {}, a.C_t};
  for (std::size_t i = 0; i < a.S_dd.size(); ++i) {
    MatrixXd S(nc, nc), R(nc, a.n_friction_cases());
    S << a.S_ee[i], a.S_ed[i], a.S_ed[i].transpose(), a.S_dd[i];
    R << a.R_ef[i], a.R_df[i];
    result.S.push_back(S);
    result.R.push_back(R);
  }
  return result;
}

/// The levels of degrees low to high, of levels from degree 1 on.
CondensedLevels between(const CondensedLevels& all, int low, int high) {
  const auto some = [&](const std::vector<MatrixXd>& A) {
    return std::vector<MatrixXd>(A.begin() + low - 1, A.begin() + high);
  };
  return {some(all.S), some(all.R), some(all.C)};
}

/// True errors over estimated ones, by matrix.
using Ratios = std::map<std::string, std::vector<double>>;

const std::map<std::string, std::vector<MatrixXd> CondensedLevels::*> matrices = {
    {"S", &CondensedLevels::S}, {"R", &CondensedLevels::R}, {"C_t", &CondensedLevels::C}};

/// An error that the exact matrices cannot tell, since a tenth of it is what they change by from degree 7 to 8, does
/// not count.
void add_ratios(const CondensedLevels& sheet, const CondensedLevels& exact, int low, int high, double fastest,
                Ratios& ratios) {
  const auto some = between(sheet, low, high);
  const auto degrees = Eigen::VectorXi::LinSpaced(high - low + 1, low, high);
  for (const auto& [of, estimate] : matrices::relative_errors(some, degrees, Eigen::VectorXd(), fastest)) {
    const auto matrix = matrices.at(of);
    const MatrixXd &limit = (exact.*matrix).back(), &last = (some.*matrix).back();
    const double error = (last - limit).norm(), doubt = (limit - (exact.*matrix).front()).norm();
    if (error > std::max(10 * doubt, 1e-11 * limit.norm())) ratios[of].push_back(error / (estimate * last.norm()));
  }
}

struct Sheet {
  test::GridSheet coarse, fine;
  int angle = -1;  ///< of the plies of a laminate, degrees; none of a metal
};

std::string text(const test::GridSheet& sheet, int angle, int rings, const std::string& more) {
  std::string json = sheet.json(rings, more);
  if (angle < 0) return json;
  const std::string aluminium = R"("al": {"E": 1e7, "nu": 0.3})";
  const std::string ply = R"("al": {"E1": 2e7, "E2": 1.3e6, "nu12": 0.3, "G12": 7e5, "angle": )";
  return json.replace(json.find(aluminium), aluminium.size(), ply + std::to_string(angle) + "}");
}

/// The estimates are tried in both spaces, with up to two rings: all degrees up to each from 3 on, the last three and
/// the last four of them.
Ratios ratios(const std::vector<Sheet>& sheets) {
  Ratios result;
  for (const auto& [coarse, fine, angle] : sheets) {
    const std::string finest = test::in_space(pfem::Space::product) + R"(, "p": [7, 8])";
    const auto exact = levels(text(fine, angle, 3, finest));
    const double fastest = matrices::max_rate_of(test::make_plate(text(coarse, angle, 0, "")).scene.elasticity);
    for (const auto space : {pfem::Space::trunk, pfem::Space::product})
      for (const int rings : {0, 1, 2}) {
        const auto sheet = levels(text(coarse, angle, rings, test::in_space(space)));
        for (int p = 3; p <= 8; ++p) {
          add_ratios(sheet, exact, 1, p, fastest, result);
          if (p > 3) add_ratios(sheet, exact, p - 2, p, fastest, result);
          if (p > 4) add_ratios(sheet, exact, p - 3, p, fastest, result);
        }
      }
  }
  return result;
}

/// Lines beside each hole of a sheet of one row.
test::GridSheet with_lines_beside_holes(test::GridSheet sheet) {
  const auto cells = sheet.x;
  const auto thickness = sheet.thickness[0];
  for (const auto& hole : sheet.holes)
    for (const double x : {hole.x - 2 * hole.radius, hole.x + 2 * hole.radius})
      if (std::none_of(sheet.x.begin(), sheet.x.end(),
                       [&](double line) { return std::abs(line - x) < 0.3 * hole.radius; }))
        sheet.x.push_back(x);
  std::sort(sheet.x.begin(), sheet.x.end());
  sheet.thickness[0].clear();
  for (std::size_t i = 0; i + 1 < sheet.x.size(); ++i) {
    const auto cell = std::upper_bound(cells.begin(), cells.end(), (sheet.x[i] + sheet.x[i + 1]) / 2) - cells.begin();
    sheet.thickness[0].push_back(thickness[cell - 1]);
  }
  return sheet;
}

/// Random sheets of one row, two to six times as long as they were: cells up to 14 times as long as high.
std::vector<Sheet> slender_sheets(unsigned number, bool laminated) {
  std::vector<Sheet> result;
  for (unsigned seed = 1000; result.size() < number; ++seed) {
    auto sheet = test::random_sheet(seed);
    if (sheet.thickness.size() > 1) continue;
    const double longer = 2 + 0.4 * (seed % 11);
    for (double& x : sheet.x) x *= longer;
    for (auto& hole : sheet.holes) hole.x *= longer;
    const int angle = laminated ? static_cast<int>(20 + 10 * (seed % 4)) : -1;
    result.push_back({sheet, test::graded(with_lines_beside_holes(sheet), laminated ? 3 : 2), angle});
  }
  return result;
}

std::vector<Sheet> random_sheets(unsigned number, bool laminated) {
  std::vector<Sheet> result;
  for (unsigned seed = 0; seed < number; ++seed) {
    const auto sheet = test::random_sheet(seed);
    const int angle = laminated ? static_cast<int>(20 + 10 * (seed % 4)) : -1;
    result.push_back({sheet, test::graded(sheet, laminated ? 3 : 2), angle});
  }
  return result;
}

/// What is allowed of one matrix.
struct Limits {
  double most;           ///< true error over estimated one
  double share;          ///< of those above 1.5
  double median_excess;  ///< estimated error over true one
};

void check(const std::string& name, Ratios found, const std::map<std::string, Limits>& allowed) {
  for (const auto& [of, limits] : allowed) {
    auto& ratio = found.at(of);
    std::sort(ratio.begin(), ratio.end());
    const auto above = static_cast<double>(ratio.end() - std::upper_bound(ratio.begin(), ratio.end(), 1.5));
    const double share = above / static_cast<double>(ratio.size()), median = 1 / ratio[ratio.size() / 2];
    std::cout << fmt::format(
        "{}, {}: {} ratios; estimated over true: median {:.3g}, largest {:.3g}; true over "
        "estimated: largest {:.3g}, above 1.5: {}\n",
        name, of, ratio.size(), median, 1 / ratio.front(), ratio.back(), above);
    EXPECT_LT(ratio.back(), limits.most) << name << ", " << of;
    EXPECT_LE(share, limits.share) << name << ", " << of;
    EXPECT_LT(median, limits.median_excess) << name << ", " << of;
  }
}

/// What is smooth converges sooner than the estimate believes (relative_errors), the more so the better the mesh.
constexpr Limits of_S = {1.5, 0, 5.2}, of_C = {1.6, 0.005, 5.4}, of_R = {2.5, 0.01, 4.4};

TEST(Errors, OfTwoRandomSheets) {
  constexpr Limits of_few = {1.5, 0, 10};
  check("two random sheets", ratios(random_sheets(2, false)), {{"S", of_few}, {"C_t", of_few}, {"R", of_few}});
}

TEST(ErrorSweep, RandomSheets) {
  check("random sheets", ratios(random_sheets(20, false)), {{"S", of_S}, {"C_t", of_C}, {"R", of_R}});
}

TEST(ErrorSweep, RandomLaminatesOffTheirAxes) {
  check("random laminates", ratios(random_sheets(8, true)), {{"S", of_S}, {"C_t", of_C}, {"R", of_R}});
}

TEST(ErrorSweep, SlenderSheets) {
  check("slender sheets", ratios(slender_sheets(24, false)), {{"S", of_S}, {"C_t", of_C}, {"R", of_R}});
}

/// R of laminates, whose friction fields are the roughest, is where the estimate is worst, at p = 3 in the trunk space.
TEST(ErrorSweep, SlenderLaminatesOffTheirAxes) {
  check("slender laminates", ratios(slender_sheets(12, true)), {{"S", of_S}, {"C_t", of_C}, {"R", {3.8, 0.01, 4.1}}});
}

}  // namespace
}  // namespace fastjoint
