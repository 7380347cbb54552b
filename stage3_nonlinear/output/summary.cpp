// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/program/program.hpp"
#include "stage3_nonlinear/output/secondary_bending.hpp"
#include "stage3_nonlinear/output/totals.hpp"
#include "stage3_nonlinear/results/section_stress.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr std::size_t min_name_width = 12;
constexpr const char* legend =
    "  forces on a plate are positive along +x, +y; delta = D(first plate) - D(second plate), and F > 0 (F_x, F_y > 0 "
    "where there are two) pushes the second along +\n  share: of what all fasteners transfer between the same two "
    "plates, friction included\n";

/// Width of the column of names: fasteners and plates share it.
std::size_t name_width(const JointModel& joint) {
  std::size_t width = min_name_width;
  for (const auto& plane : joint.planes) width = std::max(width, joint.short_name(plane).size());
  for (const auto& plate : joint.plates) width = std::max(width, plate.name.size());
  return width;
}

/// A column head with its unit, "delta [in]".
std::string head(const std::string& name, const std::string& unit) { return fmt::format("{} [{}]", name, unit); }

/// Force, or zero instead of rounding.
double rounded(double force, double largest) {
  constexpr double rounding = 1e-10;
  return std::abs(force) <= rounding * largest ? 0 : force;
}

/// Name of the solver of the increments.
const std::string& method(const JointScene& scene, const JointModel& joint) {
  const Method chosen =
      iterative_method(scene.solver.method, joint.n_planes() * joint.n_directions() + joint.n_moments());
  return method_names[static_cast<std::size_t>(chosen) - 1];
}

/// Estimated error of a plate's S over its largest entry; none if the file has no estimate, p is not its highest
/// degree, or S is zero.
std::optional<double> relative_error(const PlateModel& plate) {
  if (!plate.S_error.allFinite() || plate.S.isZero(0)) return std::nullopt;
  return plate.S_error.cwiseAbs().maxCoeff() / plate.S.cwiseAbs().maxCoeff();
}

std::string fastener_table(const JointModel& joint, const PathStep& step, const JointState& state, std::size_t width) {
  const std::string length = unit(joint.units, 1, 0), force = unit(joint.units, 0, 1);
  const Index a = joint.n_directions(), n_components = a > 1 ? a : 0;
  std::string text = fmt::format("  {:<{}} {:>16} {:>16}", "fastener", width, head("delta", length), head("F", force));
  for (Index d = 0; d < n_components; ++d)
    text += fmt::format(" {:>14}", head(fmt::format("F_{}", joint.axis_name(d)), force));
  text += fmt::format(" {:>20} {:>9}\n", head("transferred", force), "share [%]");
  const VectorXd share = shares(joint, state.transferred_first);
  const VectorXd delta = magnitudes(step.delta, a), F = magnitudes(step.F, a);
  for (Index j = 0; j < std::ssize(F); ++j) {
    text += fmt::format("  {:<{}} {:>16.8g} {:>16.8g}", joint.short_name(joint.planes[j]), width, delta[j], F[j]);
    for (Index d = 0; d < n_components; ++d)
      text += fmt::format(" {:>14.6g}", rounded(step.F[j * a + d], state.largest_force));
    text += fmt::format(" {:>20.8g} {:>9}\n", state.transferred_first[j],
                        std::isfinite(share[j]) ? fmt::format("{:.3f}", share[j]) : "-");
  }
  return text;
}

std::string plate_table(const JointModel& joint, const JointState& state, std::size_t width) {
  const std::string force = unit(joint.units, 0, 1);
  std::string text = fmt::format("  {:<{}} {:>16} {:>16} {:>20}\n", "on plate", width, head("applied", force),
                                 head("fasteners", force), head("supports", force));
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    for (const int axis : joint.axes) {
      const PlateState& plate = state.plates[i];
      const auto shown = [&](const Eigen::Vector2d& sum) { return rounded(sum[axis], state.largest_force); };
      const std::string along = joint.n_directions() == 1 ? "" : fmt::format(" {}", rim::axis_names[axis]);
      text += fmt::format("  {:<{}} {:>16.8g} {:>16.8g} {:>20.8g}\n", joint.plates[i].name + along, width,
                          shown(plate.applied), shown(plate.by_fasteners), shown(plate.by_supports));
    }
  text += fmt::format("  equilibrium: worst row out of balance by {:.1e} of the largest force, fastener by {:.1e}",
                      state.out_of_balance, state.fasteners_out_of_balance);
  if (state.plates_out_of_balance)
    text += fmt::format(", sheet along axes without supports by {:.1e}", *state.plates_out_of_balance);
  return text + "\n";
}

/// Lines of the planes that have kept a set or dissipated energy.
std::string memory_lines(const JointModel& joint, const PathStep& step) {
  std::string text;
  for (Index j = 0; j < std::ssize(step.memories); ++j) {
    const PlaneMemory& memory = step.memories[j];
    if (memory.dissipated == 0) continue;
    text +=
        fmt::format("  {} keeps a set of {:.6g} {}, has dissipated {:.6g} {}\n", joint.short_name(joint.planes[j]),
                    fmt::join(memory.set, ", "), unit(joint.units, 1, 0), memory.dissipated, unit(joint.units, 1, 1));
  }
  return text;
}

/// Arm of a moment, "plate:external"; 0 of other boundaries.
double arm_of(const JointModel& joint, const std::string& name) {
  for (const auto& plate : joint.plates)
    for (Index i = 0; i < std::ssize(plate.tractions); ++i)
      if (plate.is_moment(i) && plate.name + ":" + plate.tractions[i] == name) return plate.traction_arm[i];
  return 0;
}

/// The largest force of all increments with its error bar.
std::string error_bar(const JointModel& joint, const formats::JointResult& result) {
  Index step = 0, plane = 0;
  const auto& F = result.columns["F"];
  F.transpose().cwiseAbs().maxCoeff(&plane, &step);  // the first of several
  return fmt::format("the largest F is {:.8g} +- {:.1g} {} ({}, increment {}), by the errors of the plates' matrices\n",
                     F(step, plane) + 0.0, result.columns["F_error"](step, plane), unit(joint.units, 0, 1),
                     joint.name(joint.planes[plane]), step + 1);
}

/// The highest peak hoop stress of an increment with its error, and the holes whose peaks are not known; empty if no
/// hole has one.
std::string highest_peak(const JointModel& joint, const JointState& state) {
  double highest = 0;
  std::string text;
  std::vector<std::string> unknown;
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    for (Index rim = 0; rim < std::ssize(state.plates[i].rims); ++rim) {
      const RimState& at = state.plates[i].rims[rim];
      if (std::isnan(at.peak_hoop))
        unknown.push_back(joint.plates[i].name + ":" + joint.plates[i].stresses.rim_hole[rim]);
      if (!(at.peak_hoop > highest)) continue;
      highest = at.peak_hoop;
      text = fmt::format(
          "the highest peak is {:.6g} +- {:.1g} {} at {}:{}, {:.1f} degrees; the error is that of the sheets' "
          "solutions, "
          "not of the model\n",
          at.peak_hoop, at.peak_error, unit(joint.units, -2, 1), joint.plates[i].name,
          joint.plates[i].stresses.rim_hole[rim], at.peak_angle);
    }
  if (!unknown.empty())
    text += fmt::format("the peak is not known at {}{}\n", program::listed(unknown),
                        text.empty() ? "" : ", which may be higher");
  return text;
}

/// The highest hoop stress at a distance from the rims at the last increment; empty if none is wanted or found.
std::string highest_near(const formats::JointResult& result, const Units& units) {
  double highest = 0;
  std::string text;
  for (const auto& plate : result.plates) {
    const Index last = result.load_factor.size() - 1;
    if (!plate.holes.near_distance || last < 0) continue;
    const auto at = [&](const char* quantity, Index i) { return plate.columns[quantity](last, i); };
    for (Index i = 0; i < std::ssize(plate.holes.hole); ++i)
      if (at("rim/near/peak_hoop", i) > highest) {
        highest = at("rim/near/peak_hoop", i);
        text = fmt::format("{:g} {} from the rims the highest is {:.6g} +- {:.1g} {} at {}:{}, {:.1f} degrees\n",
                           *plate.holes.near_distance, unit(units, 1, 0), highest, at("rim/near/peak_error", i),
                           unit(units, -2, 1), plate.name, plate.holes.hole[i], at("rim/near/peak_angle", i));
      }
  }
  return text;
}

/// Column of the summary's table.
struct Column {
  double RimState::*value;
  const char* heading;
  int width;
  const char* format;
  columns::Dimension unit = columns::ratio;  ///< printed below the heading, if it has one
  bool needs_section = false, is_concentration = false;
  const char* unknown = "-";
};

constexpr auto table_columns = std::to_array<Column>({
    {&RimState::bearing_stress, "bearing stress", 14, "{:.6g}", columns::stress},
    {&RimState::bypass_load, "bypass", 14, "{:.6g}", columns::force, true},
    {&RimState::peak_hoop, "peak hoop", 14, "{:.6g}", columns::stress},
    {&RimState::peak_angle, "at [deg]", 9, "{:.1f}"},
    {&RimState::peak_error, "+-", 9, "{:.1e}", columns::ratio, false, false, "?"},
    {&RimState::gross_concentration, "Kt gross", 8, "{:.3f}", columns::ratio, true, true},
    {&RimState::net_concentration, "Kt net", 8, "{:.3f}", columns::ratio, true, true},
    {&RimState::across, "reaction", 12, "{:.6g}", columns::force},
});

/// A row of the table. @param cell Text in each column, right-aligned.
template <class Cell>
std::string row(const std::string& name, Cell cell) {
  std::string text = fmt::format("  {:<24}", name);
  for (const auto& column : table_columns) text += fmt::format(" {:>{}}", cell(column), column.width);
  return text + "\n";
}

/// Table of all holes of all plates at one increment; empty if no plate has stresses.
std::string rim_table(const JointModel& joint, const JointState& state) {
  std::string rows;
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    for (Index rim = 0; rim < std::ssize(state.plates[i].rims); ++rim) {
      const std::string& hole = joint.plates[i].stresses.rim_hole[rim];
      const bool sections = HoleSections(joint.plates[i].stresses, rim).number() > 0;
      rows += row(joint.plates[i].name + ":" + hole, [&](const Column& column) {
        const double value = state.plates[i].rims[rim].*column.value;
        if (column.value == &RimState::peak_error && std::isnan(state.plates[i].rims[rim].peak_hoop))
          return std::string("-");
        if (!std::isfinite(value) || (column.is_concentration && value == 0) || (column.needs_section && !sections))
          return std::string(column.unknown);
        return fmt::format(fmt::runtime(column.format), value == 0 ? 0 : value);
      });
    }
  const auto unit_below = [&](const Column& each) {
    const std::string unit = unit_of(each.unit, joint.units);
    return unit == "1" ? "" : fmt::format("[{}]", unit);
  };
  return rows.empty() ? rows : row("hole", std::mem_fn(&Column::heading)) + row("", unit_below) + rows;
}

/// Table of all rims of contact at one increment; empty if there is none.
std::string contact_table(const JointModel& joint, const formats::JointResult& result, Index step) {
  std::string rows;
  for (const auto& plate : result.plates)
    for (Index i = 0; i < std::ssize(plate.contact); ++i) {
      const auto at = [&](const char* quantity) { return plate.columns[quantity](step, i); };
      rows += fmt::format("  {:<24} {:>14.6g} {:>10.2f} {:>10.2f} {:>10.2f} {:>14.6g} {:>9.1f} {:>14.6g}\n",
                          plate.name + ":" + plate.contact[i].hole, plate.at_no_load.gap[i], at("contact/touching"),
                          at("contact/from"), at("contact/to"), at("contact/peak_pressure"), at("contact/peak_angle"),
                          at("contact/least_gap"));
    }
  if (rows.empty()) return rows;
  return fmt::format("  {:<24} {:>14} {:>10} {:>10} {:>10} {:>14} {:>9} {:>14}\n", "contact", "gap", "touches", "from",
                     "to", "peak pressure", "at", "gap left") +
         fmt::format("  {:<24} {:>14} {:>10} {:>10} {:>10} {:>14} {:>9} {:>14}\n", "",
                     head("", unit(joint.units, 1, 0)), "[deg]", "[deg]", "[deg]", head("", unit(joint.units, -2, 1)),
                     "[deg]", head("", unit(joint.units, 1, 0))) +
         rows;
}

/// Table of all crack tips at one increment; empty if there is none.
std::string crack_table(const JointModel& joint, const formats::JointResult& result, Index step) {
  std::string rows;
  for (const auto& plate : result.plates)
    for (Index t = 0; t < std::ssize(plate.tips.tip); ++t) {
      const auto at = [&](const char* quantity) { return plate.columns[quantity](step, t); };
      rows += fmt::format("  {:<24} {:>12.6g} {:>14.6g} {:>9.1e} {:>14.6g} {:>9.1e}\n",
                          plate.name + ":" + plate.tips.tip[t], plate.tips.length[t], at("crack/K_I"),
                          at("crack/K_I_error"), at("crack/K_II"), at("crack/K_II_error"));
    }
  if (rows.empty()) return rows;
  const std::string intensity = head("", unit(joint.units, -1.5, 1));
  return fmt::format("  {:<24} {:>12} {:>14} {:>9} {:>14} {:>9}\n", "crack", "length", "K_I", "+-", "K_II", "+-") +
         fmt::format("  {:<24} {:>12} {:>14} {:>9} {:>14}\n", "", head("", unit(joint.units, 1, 0)), intensity, "",
                     intensity) +
         rows;
}

/// A line for each rim with interference.
std::string interference_lines(const JointModel& joint, const LoadPath& path, const formats::JointResult& result) {
  std::string text;
  for (const auto& plate : result.plates)
    for (Index i = 0; i < std::ssize(plate.contact); ++i) {
      const auto& a = plate.at_no_load;
      if (!path.interference || a.gap[i] >= 0) continue;
      text +=
          fmt::format("interference at {}:{}: pressure {:.6g} to {:.6g} {} at no load, {}\n", plate.name,
                      plate.contact[i].hole, a.least[i], a.peak[i], unit(joint.units, -2, 1),
                      std::isfinite(a.full_until[i])
                          ? fmt::format("full contact is lost at load factor {:.6g}", a.full_until[i])
                          : fmt::format("full contact is kept up to load factor {:.6g}", path.interference->followed));
    }
  return text;
}

std::string stress_tables(const JointModel& joint, const LoadPath& path, const std::vector<JointState>& states,
                          const formats::JointResult& result, bool all) {
  std::string text;
  for (const auto& plate : joint.plates) {
    if (plate.stress_level) continue;
    if (plate.stresses.p.size() > 0 || !plate.plate_digest.empty())
      text += fmt::format(
          "{} holds no stresses of {} at p = {}; stage2_extract without --loads-only writes those of the two highest "
          "degrees of PLATE.h5\n",
          plate.file, plate.name, joint.p);
    if (joint.n_directions() == 1)
      text +=
          fmt::format("the {} displacement of the discs of {} is fixed; the reaction is not known without stresses\n",
                      rim::axis_names[1 - joint.axes[0]], plate.name);
  }
  const double last = std::abs(path.steps.back().load_factor);
  const bool past_peak =
      !all && std::ranges::any_of(path.steps, [&](const PathStep& step) { return std::abs(step.load_factor) > last; });
  for (Index i = all ? 0 : states.size() - 1; i < std::ssize(states); ++i)
    if (const std::string table =
            rim_table(joint, states[i]) + contact_table(joint, result, i) + crack_table(joint, result, i);
        !table.empty())
      text += fmt::format("stresses at {}{}\n{}", all ? fmt::format("increment {}", i + 1) : "the last increment",
                          past_peak ? ", whose load is not the largest (--all-stresses prints every increment)" : "",
                          table);
  return text;
}

}  // namespace

std::string summary_title(const JointScene& scene, const JointModel& joint) {
  std::string text =
      fmt::format("joint{}: {}, {}, p = {}, {}\n", scene.name.empty() ? "" : fmt::format(" \"{}\"", scene.name),
                  program::counted(joint.plates.size(), "plate"), program::counted(joint.fasteners.size(), "fastener"),
                  joint.p, method(scene, joint));
  for (const auto& [name, law] : scene.laws)
    if (const auto source = law.law->source()) text += fmt::format("law {}: {}\n", name, source->text);
  for (const auto& plate : joint.plates)
    if (const auto error = relative_error(plate))
      text += fmt::format("the stiffness of {} is known to {:.1e} of its largest entry\n", plate.name, *error);
    else if (plate.S.isZero(0))
      text += fmt::format("the stiffness of {} is zero: its loads and fasteners balance without it\n", plate.name);
  return text;
}

std::string summary(const JointScene& scene, const JointModel& joint, const LoadPath& path,
                    const std::vector<JointState>& states, const formats::JointResult& result, bool all_stresses) {
  const std::size_t width = name_width(joint);
  std::string text = summary_title(scene, joint);
  for (Index i = 0; i < std::ssize(states); ++i) {
    const PathStep& step = path.steps[i];
    text +=
        fmt::format("increment {} of {}: load factor {:.6g}, {}, residual {:.1e} of the largest force\n", i + 1,
                    path.n_increments, step.load_factor, program::counted(step.iterations, "iteration"), step.residual);
    if (!step.events.empty()) text += fmt::format("  {}\n", event_text(joint, step.events));
    text += fastener_table(joint, step, states[i], width) + memory_lines(joint, step) +
            plate_table(joint, states[i], width);
  }
  if (states.empty()) return text;
  if (result.columns.find("F_error")) text += error_bar(joint, result);
  const Index last = std::ssize(states) - 1;
  text += external_table(result, joint.units, last) + row_table(result, joint.units, last);
  constexpr std::size_t few = 4;
  for (std::size_t i = 0; i < result.load_external.size() && result.load_external.size() <= few; ++i) {
    const double arm = arm_of(joint, result.load_external[i]), stiffness = result.columns["stiffness/tangent"](last, i);
    text += fmt::format("  tangent stiffness at {}: {:.6g} {}\n", result.load_external[i],
                        arm > 0 ? stiffness * arm * arm : stiffness,
                        arm > 0 ? unit(joint.units, 1, 1) + "/rad" : unit(joint.units, -1, 1));
  }
  return text + legend + interference_lines(joint, path, result) +
         stress_tables(joint, path, states, result, all_stresses) + highest_peak(joint, states.back()) +
         highest_near(result, joint.units) + secondary_bending(joint, states.back());
}

}  // namespace fastjoint::stage3
