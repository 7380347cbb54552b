// SPDX-License-Identifier: GPL-3.0-or-later
// The error that comes with a peak of hoop stress is that of the peak: random sheets against finer ones.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/count.hpp"
#include "common/stresses/rim_state.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

/// A sheet of one or two cells with holes of random size and place, and how much of each of its unit cases acts.
class RandomSheet {
 public:
  explicit RandomSheet(std::mt19937& random) {
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const int n = std::uniform_int_distribution<int>(1, 2)(random);
    const double height = uniform(0.7, 1.3);
    y_ = {0, height};
    for (int i = 0; i < n; ++i) {
      const double width = uniform(0.7, 1.5);
      const double radius = std::min(width, height) * uniform(0.12, 0.3);
      const auto inside = [&](double size) { return uniform(1.4 * radius, size - 1.4 * radius); };
      holes_.push_back({fmt::format("{}", i), x_.back() + inside(width), inside(height), radius});
      x_.push_back(x_.back() + width);
      discs_.push_back(uniform(-1e-7, 1e-7));
    }
    friction_ = uniform(0, 0.5);
  }

  [[nodiscard]] std::vector<stresses::RimState> rims(int rings, int p) const {
    auto holes = holes_;
    for (auto& hole : holes) hole.rings = rings;
    const auto a = test::extract(test::grid_scene(
        x_, y_, holes,
        fmt::format(R"(, "supports": [{{"on": "left", "fix": ["x"]}}, {{"on": "bottom", "fix": ["y"]}}],
    "external": [{{"id": "P", "on": "right", "direction": "x", "kind": "traction"}}], "p": [{}, {}])",
                    p - 1, p)));
    const Eigen::Index m = discs_.size();
    Eigen::VectorXd amounts = Eigen::VectorXd::Zero(a.matrices.n_cases()), friction = Eigen::VectorXd::Zero(m);
    amounts.head(m) = Eigen::Map<const Eigen::VectorXd>(discs_.data(), m);
    amounts[m] = friction_;  // of the first hole, bearing to +x
    amounts.tail(1).setOnes();
    friction[0] = friction_;
    std::vector<std::string> names;
    for (const auto& hole : holes) names.push_back(hole.id);
    const auto& its = a.matrices.stresses;
    return stresses::rim_states(its, count_of(its.p) - 1,
                                [&](const formats::StressRows& cases) { return cases * amounts; },
                                {names, std::vector<int>(m, 0), Eigen::VectorXd::Zero(m), friction});
  }

 private:
  std::vector<double> x_ = {0}, y_;
  std::vector<test::HoleText> holes_;
  std::vector<double> discs_;
  double friction_ = 0;
};

/// True errors over estimated ones, from the smallest on.
std::vector<double> error_ratios(int n_sheets) {
  std::mt19937 random(7);
  std::vector<double> ratio;
  for (int sheet = 0; sheet < n_sheets; ++sheet) {
    const RandomSheet scene(random);
    const auto exact = scene.rims(4, 8);
    for (const int rings : {0, 1})
      for (int p = 4; p <= 8; ++p) {
        const auto states = scene.rims(rings, p);
        for (std::size_t i = 0; i < states.size(); ++i)
          ratio.push_back(std::abs(states[i].peak_hoop - exact[i].peak_hoop) / states[i].peak_error);
      }
  }
  std::sort(ratio.begin(), ratio.end());
  return ratio;
}

TEST(PeakError, IsTheTrueOneOrMore) {
  const auto ratio = error_ratios(3);
  ASSERT_GT(ratio.size(), 30U);
  EXPECT_LT(ratio.back(), 2);
  EXPECT_GT(ratio[ratio.size() / 2], 0.02) << "and not so large that it says nothing";
}

TEST(PeakErrorSweep, IsTheTrueOneOrMore) {
  const auto ratio = error_ratios(12);
  ASSERT_GT(ratio.size(), 150U);
  EXPECT_LT(ratio[ratio.size() * 99 / 100], 1.5);
  EXPECT_LT(ratio.back(), 2);
  EXPECT_GT(ratio[ratio.size() / 2], 0.05) << "and not so large that it says nothing";
}

}  // namespace
}  // namespace fastjoint
