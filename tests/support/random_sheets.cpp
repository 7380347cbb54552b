// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/random_sheets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace fastjoint::test {
namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  int among(int n) { return static_cast<int>(between(0, n)); }
  bool happens(double probability) { return between(0, 1) < probability; }

 private:
  std::mt19937 engine_;
};

/// Lines of one axis; what each cell was before.
struct Lines {
  std::vector<double> at;
  std::vector<std::size_t> from;
};

Lines graded_lines(const std::vector<double>& lines, const std::vector<std::pair<double, double>>& taken, int layers) {
  constexpr double share = 0.1;
  Lines result;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    double low = lines[i + 1], high = lines[i];  // of what holes take between the two lines
    for (const auto& [from, to] : taken)
      if (to > lines[i] && from < lines[i + 1]) {
        low = std::min(low, from);
        high = std::max(high, to);
      }
    const double middle = (lines[i] + lines[i + 1]) / 2;
    const double below = std::min(low, middle) - lines[i], above = lines[i + 1] - std::max(high, middle);
    std::vector<double> inner;
    for (int k = layers; k >= 1; --k)
      if (below > 0) inner.push_back(lines[i] + below * std::pow(share, k));
    for (int k = 1; k <= layers; ++k)
      if (above > 0) inner.push_back(lines[i + 1] - above * std::pow(share, k));
    result.at.push_back(lines[i]);
    result.at.insert(result.at.end(), inner.begin(), inner.end());
    result.from.insert(result.from.end(), inner.size() + 1, i);
  }
  result.at.push_back(lines.back());
  return result;
}

}  // namespace

std::string GridSheet::json(int rings, const std::string& more) const {
  std::vector<std::string> list, rows;
  for (const auto& h : holes)
    list.push_back(fmt::format(R"({{"id": "{}", "center": [{}, {}], "radius": {}, "rings": {}{}}})", h.id, h.x, h.y,
                               h.radius, rings, h.sprung ? R"(, "spring": {"disk": {"E": 1e7, "nu": 0.3}})" : ""));
  for (const auto& row : thickness) rows.push_back(fmt::format("[{}]", fmt::join(row, ",")));
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress",{}
    "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
    "geometry": {{"grid": {{"x": [{}], "y": [{}], "thickness": [{}]}}}}, "holes": [{}]{}{}}})",
                     one_direction(extra + more), fmt::join(x, ","), fmt::join(y, ","), fmt::join(rows, ","),
                     fmt::join(list, ","), extra, more);
}

GridSheet graded(const GridSheet& sheet, int layers) {
  std::vector<std::pair<double, double>> taken_x, taken_y;
  for (const auto& h : sheet.holes) {
    taken_x.emplace_back(h.x - h.radius, h.x + h.radius);
    taken_y.emplace_back(h.y - h.radius, h.y + h.radius);
  }
  const Lines x = graded_lines(sheet.x, taken_x, layers), y = graded_lines(sheet.y, taken_y, layers);
  GridSheet result = sheet;
  result.x = x.at;
  result.y = y.at;
  result.thickness.clear();
  for (const auto row : y.from) {
    result.thickness.emplace_back();
    for (const auto column : x.from) result.thickness.back().push_back(sheet.thickness[row][column]);
  }
  return result;
}

GridSheet random_sheet(unsigned seed) {
  Dice dice(seed);
  GridSheet sheet;
  const int nx = 1 + dice.among(4), ny = 1 + dice.among(2);
  sheet.x = sheet.y = {0};
  for (int i = 0; i < nx; ++i) sheet.x.push_back(sheet.x.back() + dice.between(0.7, 1.6));
  for (int j = 0; j < ny; ++j) sheet.y.push_back(sheet.y.back() + dice.between(0.7, 1.6));
  const bool stepped = dice.happens(0.4), half = dice.happens(0.4);
  for (int j = 0; j < ny; ++j) {
    sheet.thickness.emplace_back();
    for (int i = 0; i < nx; ++i) sheet.thickness.back().push_back(stepped ? 0.05 * (1 + dice.among(3)) : 0.1);
  }
  constexpr std::size_t most_holes = 5;
  for (std::size_t j = 0; j + 1 < sheet.y.size(); ++j)
    for (std::size_t i = 0; i + 1 < sheet.x.size(); ++i) {
      const bool last = j + 2 == sheet.y.size() && i + 2 == sheet.x.size();
      const bool wanted = dice.happens(0.7) || (last && sheet.holes.empty());
      const double width = sheet.x[i + 1] - sheet.x[i], height = sheet.y[j + 1] - sheet.y[j];
      const bool on_border = half && j == 0;
      const double radius = dice.between(0.1, 0.25) * std::min(width, on_border ? 2 * height : height);
      const double room_x = width - 3 * radius, room_y = height - 3 * radius;  // half a radius beside the hole at least
      const double x = sheet.x[i] + 1.5 * radius + dice.between(0, room_x);
      const double y = on_border ? 0 : sheet.y[j] + 1.5 * radius + dice.between(0, room_y);
      const bool sprung = sheet.holes.empty() || dice.happens(0.8);
      if (wanted && sheet.holes.size() < most_holes)
        sheet.holes.push_back({fmt::format("{}", sheet.holes.size()), x, y, radius, 0, sprung});
    }
  const bool clamped = dice.happens(0.25);
  sheet.extra = fmt::format(R"(, "supports": [{{"on": "left", "fix": [{}]}}, {{"on": "bottom", "fix": ["y"]}}])",
                            clamped ? R"("x", "y")" : R"("x")");
  const std::vector<std::string> externals = {R"({"id": "P", "on": "right", "direction": "x", "kind": "rigid"})",
                                              R"({"id": "P", "on": "right", "direction": "x", "kind": "traction"})",
                                              R"({"id": "P", "on": "right", "direction": "x", "kind": "rigid"}, )"
                                              R"({"id": "Q", "on": "top", "direction": "y", "kind": "rigid"})",
                                              R"({"id": "P", "on": "top", "direction": "y", "kind": "traction"})"};
  sheet.extra += fmt::format(R"(, "external": [{}])", externals[dice.among(clamped ? 2 : 4)]);
  if (!half && dice.happens(0.5)) sheet.extra += R"(, "disc_directions": ["x", "y"])";
  return sheet;
}

}  // namespace fastjoint::test
