// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/totals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "stage3_nonlinear/output/csv.hpp"
#include "stage3_nonlinear/output/envelope.hpp"
#include "stage3_nonlinear/output/table.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using formats::JointResult;
using formats::PlateHistory;

/// A number of a sheet: what it is of, where along the direction, what it is.
struct Total {
  std::string direction, of, at, quantity;
  double value;
  std::string unit;
};

std::vector<Total> totals(const PlateHistory& plate, const Units& units, Index step) {
  const std::string force = unit(units, 0, 1), length = unit(units, 1, 0), moment = unit(units, 1, 1);
  const auto at = [&](const char* path, Index i) { return plate.columns[path](step, i); };
  std::vector<Total> all;
  for (int axis = 0; axis < 2; ++axis)
    for (const auto& [quantity, path] :
         {std::pair("applied", "total/applied"), std::pair("by fasteners", "total/by_fasteners"),
          std::pair("by supports", "total/by_supports")})
      all.push_back({axis == 0 ? "x" : "y", "sheet", "", quantity, at(path, axis), force});
  for (Index i = 0; i < std::ssize(plate.rows.direction); ++i)
    for (const auto& [quantity, path] :
         {std::pair("by fasteners", "row/force"), std::pair("in sheet before", "row/before"),
          std::pair("in sheet after", "row/after")})
      all.push_back(
          {plate.rows.direction[i], "row", fmt::format("{}", plate.rows.at[i]), quantity, at(path, i), force});
  for (Index i = 0; i < std::ssize(plate.external_id); ++i) {
    all.push_back({"", plate.external_id[i], "", "force", at("Pe", i), force});
    all.push_back({"", plate.external_id[i], "", "displacement", at("De", i), length});
  }
  const Index n = std::ssize(plate.traction_id);
  for (Index i = 0; i < n; ++i) {
    const double arm = plate.traction_arm[i], f = at("traction/force", i), u = at("traction/displacement", i);
    // A hole that is pressed has two sides: the one that bears is shown, or the first if none does.
    const auto is_same = [&](Index other) { return other < n && plate.traction_id[other] == plate.traction_id[i]; };
    if (f == 0 && ((i > 0 && is_same(i - 1)) || (is_same(i + 1) && at("traction/force", i + 1) != 0))) continue;
    all.push_back(
        {"", plate.traction_id[i], "", arm > 0 ? "moment" : "force", arm > 0 ? f * arm : f, arm > 0 ? moment : force});
    all.push_back({"", plate.traction_id[i], "", arm > 0 ? "rotation" : "displacement", arm > 0 ? u / arm : u,
                   arm > 0 ? "rad" : length});
  }
  std::erase_if(all, [](const Total& each) { return !std::isfinite(each.value); });
  return all;
}

}  // namespace

std::string totals_csv(const JointResult& a) {
  Csv csv("increment,load_factor,plate,direction,of,at,quantity,value,unit,joint,case");
  for (Index step = 0; step < a.load_factor.size(); ++step)
    for (const auto& plate : a.plates)
      for (const auto& [direction, of, at, quantity, value, unit] : totals(plate, a.header.units, step))
        csv.line(increment_number(a, step), a.load_factor[step], plate.name, direction, of, at, quantity, value, unit,
                 a.header.name, a.case_name[a.case_of[step]]);
  return csv.text();
}

std::string row_table(const JointResult& a, const Units& units, Index step) {
  std::map<std::string, double> carried;
  for (const auto& plate : a.plates)
    for (Index i = 0; i < std::ssize(plate.rows.direction); ++i)
      carried[plate.rows.direction[i]] += std::abs(plate.columns["row/force"](step, i));
  if (carried.empty()) return {};
  const std::string along = std::ranges::max_element(carried, {}, [](const auto& each) { return each.second; })->first;
  const std::string force = fmt::format("[{}]", unit(units, 0, 1)), length = fmt::format("[{}]", unit(units, 1, 0));
  Table table("{:<24} {:>12.6g} {:>6} {:>16.8g} {:>16.8g} {:>16.8g}",
              {{"rows of holes on", along, "holes", "fasteners", "sheet before", "sheet after"},
               {"", length, "", force, force, force}});
  for (const auto& plate : a.plates) {
    const auto& rows = plate.rows;
    const auto at = [&](const char* path, Index i) { return plate.columns[path](step, i) + 0.0; };
    if (std::ranges::count(rows.direction, along) < 2) continue;
    for (Index i = 0; i < std::ssize(rows.direction); ++i)
      if (rows.direction[i] == along)
        table.row({plate.name, rows.at[i], fmt::to_string(rows.holes[i]), at("row/force", i), at("row/before", i),
                   at("row/after", i)});
  }
  return table.text();
}

std::string external_table(const JointResult& a, const Units& units, Index step) {
  Table table("{:<24} {:<14} {:>16.8g} {}", {{"external boundaries"}});
  for (const auto& plate : a.plates)
    for (const auto& [direction, of, at, quantity, value, its_unit] : totals(plate, units, step))
      if (direction.empty()) table.row({plate.name + ":" + of, quantity, value + 0.0, its_unit});
  return table.text();
}

}  // namespace fastjoint::stage3
