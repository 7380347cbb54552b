// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "common/count.hpp"
#include "common/rim/angles.hpp"
#include "stage1_plate/mesh/grid_cracks.hpp"

namespace fastjoint::stage1 {
namespace {

using Point = Eigen::Vector2d;

/// The rays from a hole's centre to the outline of its cell, with a measure s of places on them.
///
/// From the rim (s = 0) to a last circle (s = 1) it goes as the radius, and from there to the outline (s = 2) as the
/// distance on the ray. Lines of constant s are circles, then go over to the outline, and do not cross: edges between
/// any of them are those of convex elements.
class CellRays {
 public:
  CellRays(double radius, const Point& center, const std::vector<Point>& outline, double nearest)
      : radius_(radius),
        last_circle_(radius + 0.9 * (nearest - radius)),
        angle_(std::ssize(outline)),
        reach_(std::ssize(outline)) {
    for (Eigen::Index i = 0; i < angle_.size(); ++i) {
      const Point ray = outline[i] - center;
      angle_[i] = std::atan2(ray.y(), ray.x());
      reach_[i] = ray.norm();
    }
  }

  [[nodiscard]] const Eigen::VectorXd& angles() const { return angle_; }

  [[nodiscard]] Eigen::Index at_angle(double angle) const {
    Eigen::Index nearest = 0;
    (angle_.array() - angle).unaryExpr([](double x) { return std::abs(rim::wrapped(x)); }).minCoeff(&nearest);
    return nearest;
  }

  [[nodiscard]] double s_at(Eigen::Index ray, double radius) const {
    return radius <= last_circle_ ? (radius - radius_) / (last_circle_ - radius_)
                                  : 1 + (radius - last_circle_) / (reach_[ray] - last_circle_);
  }

  /// @param s A value for each ray.
  [[nodiscard]] RingLine line(const Eigen::VectorXd& s) const {
    const Eigen::Index n = s.size();
    RingLine line{Eigen::VectorXd(n), Eigen::VectorXd::Ones(n - 1)};
    for (Eigen::Index i = 0; i < n; ++i)
      line.radii[i] = s[i] <= 1 ? radius_ + s[i] * (last_circle_ - radius_)
                                : last_circle_ + (s[i] - 1) * (reach_[i] - last_circle_);
    for (Eigen::Index i = 0; i + 1 < n; ++i)
      if (const double mean = (s[i] + s[i + 1]) / 2; mean > 1)
        line.roundness[i] = (2 - mean) * last_circle_ * 2 / (line.radii[i] + line.radii[i + 1]);
    return line;
  }

 private:
  double radius_, last_circle_;
  Eigen::VectorXd angle_, reach_;  ///< of each ray; the distance of the outline
};

/// Value at an angle of a function given at several ones, linear between them.
double between(const std::vector<double>& angles, const std::vector<double>& values, double angle) {
  int before = 0, after = 0;
  double to_before = rim::full_turn, to_after = rim::full_turn;
  for (int i = 0; i < count_of(angles); ++i) {
    const double ahead = rim::wrapped(angles[i] - angle, 0), behind = rim::wrapped(angle - angles[i], 0);
    if (ahead < to_after) to_after = ahead, after = i;
    if (behind < to_before) to_before = behind, before = i;
  }
  const double sum = to_before + to_after;
  return sum < rim::same_angle ? values[before] : (values[before] * to_after + values[after] * to_before) / sum;
}

/// From there on a place counts as on the outline.
constexpr double on_outline = 2 - 1e-6;

/// A line around a hole that the mesh should have.
struct WantedLine {
  Eigen::VectorXd s;  ///< on each ray
  double step;        ///< to the line before, in s; 0 for a line through a tip
  double clear;       ///< distance to leave to it, in s
};

/// Lines around a hole through its tips: one for those so near to each other in s that lines of their own would be
/// slivers. Each is followed by lines beside it whose distances grow.
std::vector<WantedLine> wanted_lines(std::vector<CellTip> tips, const CellRays& rays) {
  const auto s_of = [&](const CellTip& tip, double offset = 0) {
    return rays.s_at(rays.at_angle(tip.angle), tip.radius + offset);
  };
  std::ranges::sort(tips, {}, [&](const CellTip& tip) { return s_of(tip); });
  std::vector<WantedLine> wanted;
  for (std::size_t first = 0, end = 0; first < tips.size(); first = end) {
    std::vector<double> angles, places;
    double near = 2;
    for (; end < tips.size(); ++end) {
      const double s = s_of(tips[end]), size = tips[end].size;
      near = std::min({near, sliver * (s - s_of(tips[end], -size)), sliver * (s_of(tips[end], size) - s)});
      if (end > first && (s - places.back() > near || s > on_outline)) break;
      angles.push_back(tips[end].angle);
      places.push_back(s);
    }
    const Eigen::VectorXd line = rays.angles().unaryExpr([&](double angle) { return between(angles, places, angle); });
    const CellTip& tip = *std::ranges::min_element(tips.begin() + first, tips.begin() + end, {}, &CellTip::size);
    wanted.push_back({line, 0, near});
    for (const double sign : {-1.0, 1.0}) {
      double before = s_of(tip);
      for (double width = tip.size, offset = width; before > 0 && before < 2; width *= growth, offset += width) {
        const double s = s_of(tip, sign * offset);
        wanted.push_back({line.array() + (s - s_of(tip)), std::abs(s - before), 0});
        before = s;
      }
    }
  }
  return wanted;
}

}  // namespace

std::vector<RingLine> tip_layers(const std::vector<CellTip>& tips, double radius, const Point& center,
                                 const std::vector<Point>& outline, double nearest) {
  const CellRays rays(radius, center, outline, nearest);
  auto wanted = wanted_lines(tips, rays);
  std::ranges::stable_sort(wanted, {}, &WantedLine::step);
  std::vector<WantedLine> kept{{Eigen::VectorXd::Zero(std::ssize(outline)), 0, 0}};
  for (const auto& line : wanted) {
    const double clear = sliver * line.step;
    const auto is_apart = [&](const WantedLine& other) {
      const Eigen::VectorXd gap = line.s - other.s;
      const double least = line.step == 0 ? 0 : std::max(clear, other.clear);
      return gap.minCoeff() > least || -gap.maxCoeff() > least;
    };
    if (line.s.minCoeff() > 0 && line.s.maxCoeff() < on_outline - clear && std::ranges::all_of(kept, is_apart))
      kept.push_back(line);
  }
  std::ranges::sort(kept, {}, [](const WantedLine& line) { return line.s[0]; });
  std::vector<RingLine> lines;
  for (const auto& line : kept) lines.push_back(rays.line(line.s));
  return lines;
}

}  // namespace fastjoint::stage1
