// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/csv.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/count.hpp"
#include "stage3_nonlinear/output/envelope.hpp"
#include "stage3_nonlinear/output/output.hpp"
#include "stage3_nonlinear/results/joint_quantities.hpp"

namespace fastjoint::stage3 {
namespace {

/// Heads of the columns with their units, with components of delta and F if there are two directions.
std::vector<std::string> heads(const JointModel& joint, const formats::JointResult& a) {
  const std::string length = unit(joint.units, 1, 0), force = unit(joint.units, 0, 1);
  const auto with_unit = [](const std::string& name, const std::string& unit) { return name + " [" + unit + "]"; };
  std::vector<std::string> heads{"increment", "load_factor", "fastener", with_unit("delta", length)};
  for (const char* name : {"F", "transferred_first", "transferred_second"}) heads.push_back(with_unit(name, force));
  heads.insert(heads.end(), {"share [%]", "iterations", "residual", "first", "second"});
  for (const auto& [vector, unit] : {std::pair("delta_", length), std::pair("F_", force)})
    for (const auto& direction : a.direction)
      if (a.direction.size() > 1) heads.push_back(with_unit(vector + direction, unit));
  for (const char* side : {"_first", "_second"})
    for (const auto& group : plate_quantities(joint.plates[0]))
      for (const auto& each : group.quantities) {
        if (group.of != columns::Of::hole || each.envelope.empty()) continue;
        const std::string unit = unit_of(each.dimension, joint.units);
        heads.push_back(unit == "1" ? each.envelope + side : with_unit(each.envelope + side, unit));
      }
  heads.insert(heads.end(), {with_unit("F_error", force), "event", "joint", "case"});
  return heads;
}

/// Adds the quantities of a hole at a step; nothing of those that are not known.
void add_hole(const formats::PlateHistory& plate, const std::string& hole, Index step, Csv& csv) {
  const int at = index_of(plate.holes.hole, hole);
  for (const auto& each : plate.columns) {
    if (each.of != columns::Of::hole || each.quantity.envelope.empty()) continue;
    const bool has = at < each.n && (!each.quantity.needs_section || plate.holes.sections[at] > 0);
    csv.add(has ? each.rows(step, at) : std::nan(""));
  }
}

}  // namespace

void Csv::add(const std::string& text) { put(csv_field(text)); }

void Csv::add(double number) { put(std::isfinite(number) ? fmt::to_string(number) : ""); }

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csv(const JointModel& joint, const formats::JointResult& a) {
  Csv csv;
  for (const auto& head : heads(joint, a)) csv.add(head);
  csv.end();
  const auto &delta = a.columns["delta"], &F = a.columns["F"], &transferred = a.columns["transferred"];
  const auto* F_error = a.columns.find("F_error");
  const Index n = joint.n_directions();
  for (Index i = 0; i < F.rows(); ++i) {
    const VectorXd share =
        shares(joint, VectorXd::NullaryExpr(F.cols(), [&](Index j) { return transferred(i, 2 * j); }));
    for (Index j = 0; j < F.cols(); ++j) {
      const auto cells = [&](const auto&... cell) { (csv.add(cell), ...); };
      cells(increment_number(a, i), a.load_factor[i], a.fastener_id[j], delta(i, j), F(i, j), transferred(i, 2 * j),
            transferred(i, 2 * j + 1), share[j], a.iterations[i], a.residual[i], a.first_hole[j], a.second_hole[j]);
      for (const char* vectors : {"delta_vector", "F_vector"})
        for (Index d = 0; n > 1 && d < n; ++d) csv.add(a.columns[vectors](i, j * n + d));
      for (const HoleModel& hole : joint.holes(joint.planes[j]))
        add_hole(a.plates[hole.plate], joint.plates[hole.plate].hole_of(hole.disc), i, csv);
      if (joint.is_to_ground(joint.planes[j])) add_hole(a.plates[0], "", i, csv);
      csv.line(F_error ? F_error->rows(i, j) : std::nan(""), a.event[i], a.header.name, a.case_name[a.case_of[i]]);
    }
  }
  return csv.text();
}

}  // namespace fastjoint::stage3
