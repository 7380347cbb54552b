// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "common/program/program.hpp"
#include "stage3_nonlinear/output/secondary_bending.hpp"
#include "stage3_nonlinear/output/table.hpp"
#include "stage3_nonlinear/output/totals.hpp"
#include "stage3_nonlinear/strength/section_stress.hpp"

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
  if (plate.S_error.size() == 0 || plate.S.isZero(0)) return std::nullopt;
  return plate.S_error.cwiseAbs().maxCoeff() / plate.S.cwiseAbs().maxCoeff();
}

std::string fastener_table(const JointModel& joint, const PathStep& step, const JointState& state, std::size_t width) {
  const std::string length = unit(joint.units, 1, 0), force = unit(joint.units, 0, 1);
  const Index a = joint.n_directions(), n_components = a > 1 ? a : 0;
  std::string format = fmt::format("{{:<{}}} {{:>16.8g}} {{:>16.8g}}", width);
  Table::Cells headings{"fastener", head("delta", length), head("F", force)};
  for (Index d = 0; d < n_components; ++d) {
    format += " {:>14.6g}";
    headings.emplace_back(head("F_" + joint.axis_name(d), force));
  }
  headings.insert(headings.end(), {head("transferred", force), "share [%]"});
  Table table(format + " {:>20.8g} {:>9.3f}", {headings});
  const VectorXd share = shares(joint, state.transferred_first);
  const VectorXd delta = magnitudes(step.delta, a), F = magnitudes(step.F, a);
  for (Index j = 0; j < std::ssize(F); ++j) {
    Table::Cells cells{joint.short_name(joint.planes[j]), delta[j] + 0.0, F[j] + 0.0};
    for (Index d = 0; d < n_components; ++d) cells.emplace_back(rounded(step.F[j * a + d], state.largest_force));
    cells.insert(cells.end(), {state.transferred_first[j], share[j]});
    table.row(cells);
  }
  return table.text();
}

std::string plate_table(const JointModel& joint, const JointState& state, std::size_t width) {
  const std::string force = unit(joint.units, 0, 1);
  Table table(fmt::format("{{:<{}}} {{:>16.8g}} {{:>16.8g}} {{:>20.8g}}", width),
              {{"on plate", head("applied", force), head("fasteners", force), head("supports", force)}});
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    for (const int axis : joint.axes) {
      const PlateState& plate = state.plates[i];
      const auto shown = [&](const Eigen::Vector2d& sum) { return rounded(sum[axis], state.largest_force); };
      const std::string along = joint.n_directions() == 1 ? "" : " " + rim::axis_names[axis];
      table.row(
          {joint.plates[i].name + along, shown(plate.applied), shown(plate.by_fasteners), shown(plate.by_supports)});
    }
  const auto& sheets = state.plates_out_of_balance;
  return table.text() +
         fmt::format("  equilibrium: worst row out of balance by {:.1e} of the largest force, fastener by {:.1e}{}\n",
                     state.out_of_balance, state.fasteners_out_of_balance,
                     sheets ? fmt::format(", sheet along axes without supports by {:.1e}", *sheets) : "");
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
    for (Index i = 0; i < plate.n_tractions(); ++i)
      if (plate.is_moment(i) && plate.name + ":" + plate.traction_id[i] == name) return plate.traction_arm[i];
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

/// Value, error and place of the highest peak at an increment, the first of several; empty if none is above 0.
/// @param group Of its columns, "rim/" or "rim/near/".
std::string highest(const formats::JointResult& result, const Units& units, const std::string& group, Index step) {
  double value = 0;
  std::string text;
  for (const auto& plate : result.plates)
    for (Index i = 0; i < std::ssize(plate.holes.hole) && plate.columns.find(group + "peak_hoop"); ++i) {
      const auto at = [&](const char* quantity) { return plate.columns[group + quantity](step, i); };
      if (!(at("peak_hoop") > value)) continue;
      value = at("peak_hoop");
      text = fmt::format("{:.6g} +- {:.1g} {} at {}:{}, {:.1f} degrees", value, at("peak_error"), unit(units, -2, 1),
                         plate.name, plate.holes.hole[i], at("peak_angle"));
    }
  return text;
}

/// The highest peak hoop stress at an increment, the holes whose peaks are not known, and the highest hoop stress at a
/// distance from the rims; each only if there is one.
std::string highest_peaks(const formats::JointResult& result, const Units& units, Index step) {
  std::string text;
  const std::string peak = highest(result, units, "rim/", step), near = highest(result, units, "rim/near/", step);
  std::vector<std::string> unknown;
  std::optional<double> distance;
  for (const auto& plate : result.plates) {
    if (plate.holes.near_distance) distance = plate.holes.near_distance;
    for (Index i = 0; i < std::ssize(plate.holes.hole); ++i)
      if (std::isnan(plate.columns["rim/peak_hoop"](step, i)))
        unknown.push_back(plate.name + ":" + plate.holes.hole[i]);
  }
  if (!peak.empty())
    text = fmt::format("the highest peak is {}; the error is that of the sheets' solutions, not of the model\n", peak);
  if (!unknown.empty())
    text += fmt::format("the peak is not known at {}{}\n", program::listed(unknown),
                        peak.empty() ? "" : ", which may be higher");
  if (!near.empty())
    text += fmt::format("{:g} {} from the rims the highest is {}\n", *distance, unit(units, 1, 0), near);
  return text;
}

/// Table of all holes of all plates at one increment; empty if no plate has stresses.
std::string rim_table(const JointModel& joint, const JointState& state, const formats::JointResult& result,
                      Index step) {
  const std::string force = fmt::format("[{}]", unit(joint.units, 0, 1)),
                    stress = fmt::format("[{}]", unit(joint.units, -2, 1));
  Table table("{:<24} {:>14.6g} {:>14.6g} {:>14.6g} {:>9.1f} {:>9.1e} {:>8.3f} {:>8.3f} {:>10.3f} {:>12.6g}",
              {{"hole", "bearing stress", "bypass", "peak hoop", "at [deg]", "+-", "Kt gross", "Kt net", "Kt bearing",
                "reaction"},
               {"", stress, force, stress, "", "", "", "", "", force}});
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    for (Index rim = 0; rim < std::ssize(state.plates[i].rims); ++rim) {
      const HoleState& at = state.plates[i].rims[rim];
      const double by_bearing = result.plates[i].columns["rim/bearing_concentration"](step, rim);
      const bool sections = HoleSections(joint.plates[i].stresses, rim).number() > 0;
      const auto known = [](double value, bool is_known) { return is_known ? value + 0.0 : NAN; };
      const auto Kt = [&](double value) { return known(value, sections && value != 0); };
      const bool lacks_error = std::isinf(at.peak_error) && !std::isnan(at.peak_hoop);
      table.row({joint.plates[i].name + ":" + joint.plates[i].stresses.rim_hole[rim], at.bearing_stress + 0.0,
                 known(at.bypass_load, sections), at.peak_hoop + 0.0, at.peak_angle + 0.0,
                 lacks_error ? Table::Cell("?") : at.peak_error, Kt(at.gross_concentration), Kt(at.net_concentration),
                 known(by_bearing, by_bearing != 0), at.across + 0.0});
    }
  return table.text();
}

/// Table of all rims of contact at one increment; empty if there is none.
std::string contact_table(const formats::JointResult& result, const Units& units, Index step) {
  const std::string length = head("", unit(units, 1, 0)), stress = head("", unit(units, -2, 1));
  Table table("{:<24} {:>14.6g} {:>10.2f} {:>10.2f} {:>10.2f} {:>14.6g} {:>9.1f} {:>14.6g}",
              {{"contact", "gap", "touches", "from", "to", "peak pressure", "at", "gap left"},
               {"", length, "[deg]", "[deg]", "[deg]", stress, "[deg]", length}});
  for (const auto& plate : result.plates)
    for (Index i = 0; i < std::ssize(plate.contact); ++i) {
      const auto at = [&](const char* quantity) { return plate.columns[quantity](step, i); };
      table.row({plate.name + ":" + plate.contact[i].hole, plate.at_no_load.gap[i], at("contact/touching"),
                 at("contact/from"), at("contact/to"), at("contact/peak_pressure"), at("contact/peak_angle"),
                 at("contact/least_gap")});
    }
  return table.text();
}

/// Table of all crack tips at one increment; empty if there is none.
std::string crack_table(const formats::JointResult& result, const Units& units, Index step) {
  const std::string length = head("", unit(units, 1, 0)), intensity = head("", unit(units, -1.5, 1));
  Table table("{:<24} {:>12.6g} {:>14.6g} {:>9.1e} {:>14.6g} {:>9.1e}",
              {{"crack", "length", "K_I", "+-", "K_II", "+-"}, {"", length, intensity, "", intensity}});
  const auto error = [](double value) { return std::isfinite(value) ? Table::Cell(value) : "inf"; };
  for (const auto& plate : result.plates)
    for (Index t = 0; t < std::ssize(plate.tips); ++t) {
      const auto at = [&](const char* quantity) { return plate.columns[quantity](step, t); };
      table.row({plate.name + ":" + plate.tips[t].id, plate.tips[t].length, at("crack/K_I"),
                 error(at("crack/K_I_error")), at("crack/K_II"), error(at("crack/K_II_error"))});
    }
  return table.text();
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
    if (const std::string table = rim_table(joint, states[i], result, i) + contact_table(result, joint.units, i) +
                                  crack_table(result, joint.units, i);
        !table.empty())
      text += fmt::format("stresses at {}{}\n{}", all ? fmt::format("increment {}", i + 1) : "the last increment",
                          past_peak ? ", whose load is not the largest (--all-stresses prints every increment)" : "",
                          table);
  return text;
}

}  // namespace

std::string summary_title(const JointScene& scene, const JointModel& joint) {
  const bool is_solved = joint.n_planes() + joint.n_moments() > 0;
  std::string text =
      fmt::format("joint{}: {}, {}, p = {}{}\n", scene.name.empty() ? "" : fmt::format(" \"{}\"", scene.name),
                  program::counted(joint.plates.size(), "plate"), program::counted(joint.fasteners.size(), "fastener"),
                  joint.p, is_solved ? ", " + method(scene, joint) : "");
  for (const auto& [name, law] : scene.laws)
    if (const auto source = law.law->source()) text += fmt::format("law {}: {}\n", name, source->text);
  for (const auto& plate : joint.plates)
    if (const auto error = relative_error(plate))
      text += fmt::format("the stiffness of {} is known to {:.1e} of its largest entry\n", plate.name, *error);
    else if (joint.n_planes() > 0 && plate.S.isZero(0))
      text += fmt::format("the stiffness of {} is zero: its loads and fasteners balance without it\n", plate.name);
  for (const auto& plate : joint.plates)
    if (plate.is_free_body())
      text += fmt::format(
          "{} has no support: its loads are in balance, and displacements are those beyond the mean motion of "
          "its border\n",
          plate.name);
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
    if (joint.n_planes() > 0) text += fastener_table(joint, step, states[i], width);
    text += memory_lines(joint, step) + plate_table(joint, states[i], width);
  }
  if (states.empty()) return text;
  if (joint.n_planes() > 0 && result.columns.find("F_error")) text += error_bar(joint, result);
  const Index last = std::ssize(states) - 1;
  text += external_table(result, joint.units, last) + row_table(result, joint.units, last);
  constexpr std::size_t few = 4;
  for (std::size_t i = 0; i < result.load_external.size() && result.load_external.size() <= few; ++i) {
    const double arm = arm_of(joint, result.load_external[i]), stiffness = result.columns["stiffness/tangent"](last, i);
    text += fmt::format("  tangent stiffness at {}: {:.6g} {}\n", result.load_external[i],
                        arm > 0 ? stiffness * arm * arm : stiffness,
                        arm > 0 ? unit(joint.units, 1, 1) + "/rad" : unit(joint.units, -1, 1));
  }
  return text + (joint.n_planes() > 0 ? legend : "") + interference_lines(joint, path, result) +
         stress_tables(joint, path, states, result, all_stresses) + highest_peaks(result, joint.units, last) +
         secondary_bending(joint, states.back());
}

}  // namespace fastjoint::stage3
