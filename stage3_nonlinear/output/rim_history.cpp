// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/rim_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using formats::RimHistory;

/// One quantity of a hole: where it comes from, where it goes.
struct Column {
  const char* head;  ///< in the CSV, {0} for the side of the plane, {1} for the unit of force, {2} for that of stress
  double RimState::*state;
  Eigen::MatrixXd RimHistory::*table;
  bool needs_section;
};

constexpr std::array<Column, 10> columns = {{
    {"bearing_load_{0} [{1}]", &RimState::bearing_load, &RimHistory::bearing_load, false},
    {"bearing_load_y_{0} [{1}]", &RimState::bearing_load_y, &RimHistory::bearing_load_y, false},
    {"bearing_stress_{0} [{2}]", &RimState::bearing_stress, &RimHistory::bearing_stress, false},
    {"bypass_load_{0} [{1}]", &RimState::bypass_load, &RimHistory::bypass_load, true},
    {"bypass_error_{0} [{1}]", &RimState::bypass_error, &RimHistory::bypass_error, true},
    {"peak_hoop_{0} [{2}]", &RimState::peak_hoop, &RimHistory::peak_hoop, false},
    {"peak_angle_{0} [deg]", &RimState::peak_angle, &RimHistory::peak_angle, false},
    {"peak_error_{0} [{2}]", &RimState::peak_error, &RimHistory::peak_error, false},
    {"gross_concentration_{0}", &RimState::gross_concentration, &RimHistory::gross_concentration, true},
    {"net_concentration_{0}", &RimState::net_concentration, &RimHistory::net_concentration, true},
}};

}  // namespace

int n_sections(const formats::PlateStresses& a, const std::string& hole) {
  int n = 0;
  for (std::size_t i = 0; i < a.section_hole.size(); ++i)
    if (a.section_hole[i] == hole && a.section_side[i].back() == 'x') ++n;
  return n;
}

RimHistory rim_history(const PlateModel& plate, const std::vector<JointState>& states, std::size_t at) {
  RimHistory rims;
  if (plate.stress_level) rims.hole = plate.stresses.rim_hole;
  const Index steps = states.size();
  const Index r = rims.hole.size();
  rims.sections.resize(r);
  for (Index i = 0; i < r; ++i) rims.sections[i] = n_sections(plate.stresses, rims.hole[i]);
  for (const auto& column : columns) {
    Eigen::MatrixXd& table = rims.*column.table;
    table.resize(steps, r);
    for (Index step = 0; step < steps; ++step)
      for (Index i = 0; i < r; ++i) table(step, i) = states[step].plates[at].rims[i].*column.state;
  }
  return rims;
}

void add_rim_csv_heads(const std::string& end, const Units& units, std::vector<std::string>& heads) {
  for (const auto& column : columns)
    heads.push_back(fmt::format(fmt::runtime(column.head), end, unit(units, 0, 1), unit(units, -2, 1)));
}

std::string rim_csv_fields(const RimHistory& rims, const std::string& hole, Index step) {
  const auto found = std::find(rims.hole.begin(), rims.hole.end(), hole);
  if (found == rims.hole.end()) return std::string(columns.size(), ',');
  const Index at = found - rims.hole.begin();
  std::string text;
  for (const auto& column : columns) {
    const double value = (rims.*column.table)(step, at);
    const bool known = std::isfinite(value) && (!column.needs_section || rims.sections[at] > 0);
    text += known ? fmt::format(",{}", value) : std::string(",");
  }
  return text;
}

}  // namespace fastjoint::stage3
