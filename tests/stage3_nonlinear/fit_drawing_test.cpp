// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/fit_drawing.hpp"

#include <gmock/gmock.h>

#include <regex>

namespace fastjoint::stage3 {
namespace {

using testing::HasSubstr;
using testing::Not;

const TestPoints points{{0, 0}, {0.05, 300}, {0.1, 520}, {0.15, 640}, {0.2, 770}, {0.25, 850}};

std::vector<std::smatch> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  return {std::sregex_iterator(text.begin(), text.end(), regex), {}};
}

/// Pixels of an axis as a line through its first and last tick labels.
struct Axis {
  double origin, scale;
  [[nodiscard]] double at(double value) const { return origin + scale * value; }
};
Axis axis(const std::string& svg, const std::string& name) {
  const std::string where = name == "delta" ? R"rx(x="([0-9.]+)" y="[0-9.]+")rx" : R"rx(x="[0-9.]+" y="([0-9.]+)")rx";
  const auto labels = matches(svg, "<text class=\"" + name + "\" " + where + "[^>]*>([0-9.]+)<");
  if (labels.size() < 3) throw std::runtime_error("an axis has less than three ticks");
  const double first = std::stod(labels.front()[1]), last = std::stod(labels.back()[1]);
  return {first, (last - first) / std::stod(labels.back()[2])};
}

TEST(Drawing, HasThePointsWhereTheTicksSay) {
  for (const Fit& fit : {fit_power(points), fit_cubic(points)}) {
    const std::string svg = drawing(fit, points);
    const Axis delta = axis(svg, "delta"), F = axis(svg, "F");
    const double baseline = 4.8;  // labels of F stand below the middle of their tick
    const auto circles = matches(svg, R"rx(<circle cx="([0-9.]+)" cy="([0-9.]+)")rx");
    ASSERT_EQ(circles.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(std::stod(circles[i][1]), delta.at(points[i][0]), 0.02);
      EXPECT_NEAR(std::stod(circles[i][2]), F.at(points[i][1]) - baseline, 0.02);
    }
    const auto line = matches(svg, R"rx(<polyline points="([^"]*)")rx");
    ASSERT_EQ(line.size(), 1U);
    const std::string path = line[0][1];
    const auto curve = matches(path, "([0-9.]+),([0-9.]+) ");
    ASSERT_GT(curve.size(), 100U);
    for (const auto& at : curve) {
      const double where = (std::stod(at[1]) - delta.origin) / delta.scale;
      EXPECT_NEAR(std::stod(at[2]), F.at(force(fit, where)) - baseline, 1.5) << where;
    }
    const auto& last = curve.back();
    EXPECT_NEAR(std::stod(last[1]), delta.at(0.25), 0.02);
  }
}

/// The band ends at the last delta, one uncertainty above and below the curve.
TEST(Drawing, HasABandOfOneUncertainty) {
  const Fit fit = fit_cubic(points);
  const std::string svg = drawing(fit, points);
  const Axis F = axis(svg, "F");
  const auto band = matches(svg, R"rx(<polygon points="([^"]*)")rx");
  ASSERT_EQ(band.size(), 1U);
  const std::string outline = band[0][1];
  double highest = 1e9, end = 0;
  std::vector<double> at_end;
  for (const auto& at : matches(outline, "([0-9.]+),([0-9.]+) ")) {
    end = std::max(end, std::stod(at[1]));
    highest = std::min(highest, std::stod(at[2]));
  }
  for (const auto& at : matches(outline, "([0-9.]+),([0-9.]+) "))
    if (std::stod(at[1]) == end) at_end.push_back(std::stod(at[2]));
  ASSERT_EQ(at_end.size(), 2U);
  EXPECT_NEAR(at_end[1] - at_end[0], -2 * F.scale * force_uncertainty(fit, 0.25), 0.02);
  EXPECT_EQ(highest, at_end[0]);
}

TEST(Drawing, HasNoBandWithoutUncertainty) {
  const TestPoints few{{0.1, 1}, {0.2, 1.5}, {0.3, 1.8}};
  const std::string svg = drawing(fit_cubic(few), few);
  EXPECT_THAT(svg, Not(HasSubstr("polygon")));
  EXPECT_THAT(svg, HasSubstr(">cubic law fitted to 3 points<"));
  EXPECT_THAT(drawing(fit_power(points), points),
              HasSubstr(">power law fitted to 6 points, band of one standard uncertainty<"));
}

}  // namespace
}  // namespace fastjoint::stage3
