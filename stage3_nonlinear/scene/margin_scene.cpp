// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/scene/margin_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

namespace fastjoint::stage3 {
namespace {

constexpr double at_rim = 0.5;  ///< e/D at which the rim touches the edge

using input::Value;

/// Keys of each kind of check besides those of all; the first is that of its allowable.
const std::array<std::vector<const char*>, 6> own_keys{{{"F_br", "edge_distance"},
                                                        {"F_su", "P_su", "diameter"},
                                                        {"F_tu"},
                                                        {"F_su", "edge_distance"},
                                                        {"polygon"},
                                                        {"limit", "bending"}}};

Allowable read_allowable(const Value& value) {
  if (!value.is_array()) return {{}, {value.number(input::positive)}};
  Allowable table;
  for (const auto& point : value.items(2)) {
    const auto pair = point.numbers(2, 2, input::positive);
    if (!table.edge_ratio.empty() && !(pair[0] > table.edge_ratio.back()))
      point.fail("an e/D that does not rise", "points [e/D, stress] with ascending e/D");
    if (!(pair[0] > at_rim))
      point.fail(fmt::format("e/D = {:g}", pair[0]), "more than 0.5, where the rim touches the edge");
    table.edge_ratio.push_back(pair[0]);
    table.value.push_back(pair[1]);
  }
  return table;
}

std::vector<std::pair<double, double>> read_polygon(const Value& value) {
  std::vector<std::pair<double, double>> points;
  for (const auto& point : value.items(3)) {
    const auto pair = point.numbers(2, 2, input::any_number);
    points.emplace_back(pair[0], pair[1]);
  }
  // Seen from the origin the corners turn one way and once around, so that each ray meets one side.
  double turned = 0;
  int rising = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [x, y] = points[i];
    const auto& [u, v] = points[(i + 1) % points.size()];
    const double area = x * v - y * u;
    rising += area > 0 ? 1 : area < 0 ? -1 : 0;
    turned += std::atan2(area, x * u + y * v);
  }
  const bool once = std::abs(std::abs(turned) - 2 * std::numbers::pi) < 1e-6;
  if (!once || std::size_t(std::abs(rising)) != points.size())
    value.fail("a polygon that does not go once around the origin, corner after corner as seen from there",
               "corners [bypass stress, bearing stress] in order around [0, 0]");
  return points;
}

void check_keys(const Value& value, CheckKind kind) {
  std::set<std::string> allowed{"check", "name", "of", "cases", "safety_factor", "fitting_factor"};
  allowed.insert(own_keys[int(kind)].begin(), own_keys[int(kind)].end());
  for (const auto& [key, member] : value.members())
    if (!allowed.contains(key))
      member.fail("unknown key", fmt::format("{} of a check \"{}\"", fmt::join(allowed, ", "), check_names[int(kind)]));
}

double factor(const Value& value, const char* key, double otherwise) {
  const auto given = value.find(key);
  return given ? given->number(input::positive) : otherwise;
}

/// @param known Names of the joint's cases.
CheckScene read_check(const Value& value, const std::vector<std::string>& known, double safety_factor,
                      double fitting_factor) {
  const std::string kind = value.at("check").choice(check_names);
  CheckScene check;
  check.kind = static_cast<CheckKind>(std::ranges::find(check_names, kind) - check_names.begin());
  check_keys(value, check.kind);
  check.where = fmt::format("{}: {}", value.file(), value.pointer());
  const auto name = value.find("name"), of = value.find("of"), cases = value.find("cases");
  check.name = name ? name->text() : kind;
  if (of)
    for (const auto& item : of->items(1)) check.of.push_back(item.text());
  if (cases)
    for (const auto& item : cases->items(1)) check.cases.push_back(item.choice(known));
  check.safety_factor = factor(value, "safety_factor", safety_factor);
  check.fitting_factor = factor(value, "fitting_factor", fitting_factor);
  const auto force = value.find("P_su");
  if (force && value.find("F_su")) force->fail("given together with \"F_su\"", "one of them");
  check.is_force = force.has_value();
  if (check.kind == CheckKind::bearing_bypass)
    check.polygon = read_polygon(value.at("polygon"));
  else if (check.kind == CheckKind::bearing)
    check.allowable = read_allowable(value.at("F_br"));
  else
    check.allowable = {{}, {(force ? *force : value.at(own_keys[int(check.kind)].front())).number(input::positive)}};
  if (const auto e = value.find("edge_distance")) check.edge_distance = e->number(input::positive);
  if (const auto bending = value.find("bending")) check.with_bending = bending->boolean();
  if (const auto d = value.find("diameter")) check.diameter = d->number(input::positive);
  return check;
}

}  // namespace

double Allowable::at(double ratio) const {
  if (edge_ratio.empty()) return value.front();
  const auto above = std::ranges::upper_bound(edge_ratio, ratio);
  if (above == edge_ratio.begin()) return value.front() * std::max(ratio - at_rim, 0.0) / (edge_ratio.front() - at_rim);
  if (above == edge_ratio.end()) return value.back();
  const auto i = above - edge_ratio.begin();
  const double fraction = (ratio - edge_ratio[i - 1]) / (edge_ratio[i] - edge_ratio[i - 1]);
  return value[i - 1] + fraction * (value[i] - value[i - 1]);
}

std::vector<CheckScene> read_margins(const Value& value, const std::vector<std::string>& cases) {
  value.only({"safety_factor", "fitting_factor", "checks"});
  const double safety_factor = factor(value, "safety_factor", 1), fitting_factor = factor(value, "fitting_factor", 1);
  std::vector<CheckScene> checks;
  for (const auto& item : value.at("checks").items(1))
    checks.push_back(read_check(item, cases, safety_factor, fitting_factor));
  return checks;
}

}  // namespace fastjoint::stage3
