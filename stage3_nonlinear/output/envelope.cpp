// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/envelope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "stage3_nonlinear/output/csv.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using formats::EnvelopeTable;
using formats::JointResult;

/// Table of a quantity, made when its first row is added.
EnvelopeTable& table_of(const std::string& quantity, const std::string& unit, std::vector<EnvelopeTable>& tables) {
  const auto found = std::ranges::find(tables, quantity, &EnvelopeTable::quantity);
  return found != tables.end() ? *found : tables.emplace_back(EnvelopeTable{.quantity = quantity, .unit = unit});
}

/// Takes in the numbers of a thing at all increments; not if they are unknown at each.
void add(const std::string& quantity, const std::string& unit, const std::string& of, const Eigen::VectorXd& values,
         std::vector<EnvelopeTable>& tables) {
  int largest = -1, smallest = -1;
  for (int i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    if (largest < 0 || values[i] > values[largest]) largest = i;
    if (smallest < 0 || values[i] < values[smallest]) smallest = i;
  }
  if (largest >= 0)
    table_of(quantity, unit, tables).rows.push_back({of, values[largest], values[smallest], largest, smallest});
}

/// Takes in all columns of things with these names.
/// @param sections Of each hole, without which some quantities are not known.
void add(const columns::Columns& columns, const Units& units,
         const std::function<std::vector<std::string>(columns::Of)>& names, const Eigen::VectorXi& sections,
         std::vector<EnvelopeTable>& tables) {
  for (const auto& [quantity, of, n, parts, rows, extents] : columns) {
    if (quantity.envelope.empty()) continue;
    const auto things = names(of);
    const Index m = parts ? std::ssize(*parts) : 1;
    for (Index part = 0; part < m; ++part)
      for (Index i = 0; i < n; ++i)
        if (!quantity.needs_section || sections[i] > 0)
          add(quantity.envelope + (parts ? "_" + (*parts)[part] : ""), unit_of(quantity.dimension, units), things[i],
              rows.col(i * m + part), tables);
  }
}

}  // namespace

std::vector<EnvelopeTable> envelope(const JointModel& joint, const JointResult& a) {
  std::vector<EnvelopeTable> tables;
  std::vector<std::string> planes;
  for (const auto& plane : joint.planes) planes.push_back(joint.short_name(plane));
  add(
      a.columns, a.header.units, [&](columns::Of) { return planes; }, {}, tables);
  for (const auto& plate : a.plates) {
    const auto names = [&](columns::Of of) {
      auto all = plate.names(of);
      for (auto& each : all) each.insert(0, plate.name + ":");
      return all;
    };
    add(plate.columns, a.header.units, names, plate.holes.sections, tables);
  }
  return tables;
}

Index increment_number(const JointResult& a, Index row) {
  return 1 + (a.case_of.head(row).array() == a.case_of[row]).count();
}

std::string increment_of(const JointResult& a, Index row) {
  const std::string text = fmt::format("increment {}", increment_number(a, row)), &name = a.case_name[a.case_of[row]];
  return name.empty() ? text : fmt::format("{} of case \"{}\"", text, name);
}

std::string envelope_csv(const JointResult& a) {
  Csv csv("joint,quantity,of,unit,largest,largest in case,at increment,smallest,smallest in case,at increment");
  for (const auto& [quantity, unit, rows] : a.envelope)
    for (const auto& [of, largest, smallest, largest_at, smallest_at] : rows) {
      const auto case_at = [&](Index row) -> const auto& { return a.case_name[a.case_of[row]]; };
      csv.line(a.header.name, quantity, of, unit, largest, case_at(largest_at), increment_number(a, largest_at),
               smallest, case_at(smallest_at), increment_number(a, smallest_at));
    }
  return csv.text();
}

}  // namespace fastjoint::stage3
