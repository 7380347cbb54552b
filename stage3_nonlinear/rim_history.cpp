// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/rim_history.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

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

/// How many sections across x the plate has beside the hole.
int n_sections(const formats::PlateStresses& a, const std::string& hole) {
  int n = 0;
  for (std::size_t i = 0; i < a.section_hole.size(); ++i)
    if (a.section_hole[i] == hole && a.section_side[i].back() == 'x') ++n;
  return n;
}

/// A doubt about rims: how much of it a rim gives cause for, 0 or NaN if none, and what to say where that is most.
struct Doubt {
  double (*amount)(const RimState&, bool loose);
  const char* text;  ///< {at} the hole with the increment and the number of others, other fields as arguments name them
};

constexpr double allowed_pull = 0.05, allowed_across = 0.01;  // of the bearing stress, of the bearing force

constexpr std::array<Doubt, 6> doubts = {{
    {[](const RimState& rim, bool) { return rim.pulls ? rim.bearing_stress : 0; },
     "the springs of {at} pull the sheet instead of pushing it: they act on the arc that does not bear under these "
     "loads; give the hole's spring the other \"arc\" in PLATE.json"},
    {[](const RimState& rim, bool) { return rim.pull > allowed_pull * rim.bearing_stress ? rim.pull : 0; },
     "the springs all around {at} pull on its rim by up to {pull:.4g} {unit}, beside a bearing stress of {stress:.4g}: "
     "a fastener only pushes, and hoop peaks come out too low; give the hole's spring the \"arc\" that bears in "
     "PLATE.json"},
    {[](const RimState& rim, bool loose) { return loose && rim.filled ? std::max(rim.pull, rim.bearing_stress) : 0; },
     "a fastener with a clearance fills {at}, whose springs act all around: the sheet comes out too stiff and its hoop "
     "peak, {peak:.4g} {unit}, too low; give the hole's spring the \"arc\" that bears in PLATE.json"},
    {[](const RimState& rim, bool) { return rim.in_tension ? 1 - rim.net_concentration : 0; },
     "Kt net is {net:.4g} at {at}: no hole's peak hoop stress is below the mean stress of its net section, unless "
     "springs pull on its rim; give the hole's spring the \"arc\" that bears in PLATE.json"},
    {[](const RimState& rim, bool) { return rim.across_share > allowed_across ? std::abs(rim.across) : 0; },
     "the disc of {at} is held across its one direction by {across:.4g} {force}, beside a bearing force of "
     "{bearing:.4g}, and nothing in the joint gives that; let the discs move: \"disc_directions\": [\"x\", \"y\"] in "
     "all PLATE.json"},
    {[](const RimState& rim, bool) { return rim.by_components ? rim.bearing_stress : 0; },
     "friction acts off the axes, by its components along x and y, at {at}: the loads hold, but peak hoop stresses "
     "there may lack what friction adds to them, most of it at 45 degrees"},
}};

std::string stress_row(const PlateModel& plate, std::size_t rim, const RimState& state) {
  const std::string& hole = plate.stresses.rim_hole[rim];
  std::string text = fmt::format("  {:<24} {:>14.6g}", fmt::format("{}:{}", plate.name, hole), state.bearing_stress);
  const bool known = n_sections(plate.stresses, hole) > 0;
  text += known ? fmt::format(" {:>14.6g}", state.bypass_load) : fmt::format(" {:>14}", "-");
  text += fmt::format(" {:>14.6g} {:>9.1f}", state.peak_hoop, state.peak_angle);
  text += std::isfinite(state.peak_error) ? fmt::format(" {:>9.1e}", state.peak_error) : fmt::format(" {:>9}", "?");
  text += known && state.gross_concentration != 0
              ? fmt::format(" {:>8.3f} {:>8.3f}", state.gross_concentration, state.net_concentration)
              : fmt::format(" {:>8} {:>8}", "-", "-");
  return text + (std::isfinite(state.across) ? fmt::format(" {:>12.6g}\n", state.across == 0 ? 0 : state.across)
                                             : fmt::format(" {:>12}\n", "-"));
}

}  // namespace

RimHistory rim_history(const PlateModel& plate, const std::vector<JointState>& states, std::size_t at) {
  RimHistory rims;
  if (plate.stress_level) rims.hole = plate.stresses.rim_hole;
  const auto steps = static_cast<Index>(states.size());
  const auto r = static_cast<Index>(rims.hole.size());
  rims.sections.resize(r);
  for (Index i = 0; i < r; ++i) rims.sections[i] = n_sections(plate.stresses, rims.hole[static_cast<std::size_t>(i)]);
  for (const auto& column : columns) {
    Eigen::MatrixXd& table = rims.*column.table;
    table.resize(steps, r);
    for (Index step = 0; step < steps; ++step)
      for (Index i = 0; i < r; ++i)
        table(step, i) =
            states[static_cast<std::size_t>(step)].plates[at].rims[static_cast<std::size_t>(i)].*column.state;
  }
  return rims;
}

void add_rim_csv_heads(const std::string& end, const formats::Units& units, std::vector<std::string>& heads) {
  for (const auto& column : columns)
    heads.push_back(
        fmt::format(fmt::runtime(column.head), end, formats::unit(units, 0, 1), formats::unit(units, -2, 1)));
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

std::vector<std::string> rim_warnings(const JointModel& joint, const std::vector<JointState>& states) {
  std::set<std::string> loose;
  for (const auto& plane : joint.planes)
    for (const HoleModel* hole : {&joint.first_hole(plane), &joint.second_hole(plane)})
      if (plane.clearance > 0) loose.insert(joint.name(*hole));
  std::vector<std::string> result;
  for (const auto& doubt : doubts) {
    double most = 0;
    std::string at;
    const RimState* worst = nullptr;
    std::set<std::string> holes;
    for (std::size_t step = 0; step < states.size(); ++step)
      for (std::size_t i = 0; i < joint.plates.size(); ++i)
        for (std::size_t rim = 0; rim < states[step].plates[i].rims.size(); ++rim) {
          const RimState& state = states[step].plates[i].rims[rim];
          const std::string hole = joint.plates[i].name + ":" + joint.plates[i].stresses.rim_hole[rim];
          const double amount = doubt.amount(state, loose.contains(hole));
          if (amount > 0) holes.insert(hole);
          if (!(amount > most)) continue;
          most = amount;
          worst = &state;
          at = fmt::format("hole \"{}\" (increment {}", hole, step + 1);
        }
    if (!worst) continue;
    const std::size_t others = holes.size() - 1;
    at += others == 0 ? ")" : fmt::format("; {} other hole{} likewise)", others, others == 1 ? "" : "s");
    using fmt::arg;
    result.push_back(
        fmt::format(fmt::runtime("{file}: " + std::string(doubt.text)), arg("file", joint.file), arg("at", at),
                    arg("pull", worst->pull), arg("stress", worst->bearing_stress), arg("peak", worst->peak_hoop),
                    arg("net", worst->net_concentration), arg("across", std::abs(worst->across)),
                    arg("bearing", std::hypot(worst->bearing_load, worst->bearing_load_y)),
                    arg("force", formats::unit(joint.units, 0, 1)), arg("unit", formats::unit(joint.units, -2, 1))));
  }
  return result;
}

std::string rim_table(const JointModel& joint, const JointState& state) {
  std::string rows;
  for (std::size_t i = 0; i < joint.plates.size(); ++i)
    for (std::size_t rim = 0; rim < state.plates[i].rims.size(); ++rim)
      rows += stress_row(joint.plates[i], rim, state.plates[i].rims[rim]);
  if (rows.empty()) return rows;
  const std::string stress = fmt::format("[{}]", formats::unit(joint.units, -2, 1));
  const std::string force = fmt::format("[{}]", formats::unit(joint.units, 0, 1));
  return fmt::format("  {:<24} {:>14} {:>14} {:>14} {:>9} {:>9} {:>8} {:>8} {:>12}\n", "hole", "bearing stress",
                     "bypass", "peak hoop", "at [deg]", "+-", "Kt gross", "Kt net", "held across") +
         fmt::format("  {:<24} {:>14} {:>14} {:>14} {:>50}\n", "", stress, force, stress, force) + rows;
}

}  // namespace fastjoint::stage3
