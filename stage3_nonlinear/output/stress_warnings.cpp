// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings of stresses: at rims, at crack tips, and at a distance from rims.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "common/program/program.hpp"
#include "stage3_nonlinear/output/output.hpp"
#include "stage3_nonlinear/results/near_peaks.hpp"

namespace fastjoint::stage3 {
namespace {

/// A kind of warning about rims, with its measure for a rim, 0 or NaN if there is no reason for it, and its text.
struct RimDoubt {
  const char* code;
  double (*measure)(const HoleState&, bool has_clearance);
  const char* text;  ///< {at} is the worst hole with its increment and the number of others; see rim_warnings
};

constexpr double allowed_pull = 0.05, allowed_across = 0.01;  // of the bearing stress, of the bearing force
constexpr double allowed_against = 20;                        // of friction against the slip, degrees
constexpr double no_load = 1e-100;                            // stress that rounding leaves of a joint without load

constexpr std::array<RimDoubt, 7> doubts = {{
    {"springs-wrong-arc", [](const HoleState& rim, bool) { return rim.pulls ? rim.bearing_stress : 0; },
     "the springs of {at} are in tension: they are on the arc that does not bear under these loads; give the hole's "
     "spring the other \"arc\" in PLATE.json"},
    {"springs-pull",
     [](const HoleState& rim, bool) { return rim.pull > allowed_pull * rim.bearing_stress ? rim.pull : 0; },
     "the springs all around {at} have a tension of up to {pull:.4g} {unit}, with a bearing stress of {stress:.4g}: a "
     "fastener cannot pull on the rim, and hoop peaks are too low; give the hole's spring \"compression_only\": true "
     "in "
     "PLATE.json"},
    {"hole-filled",
     [](const HoleState& rim, bool has_clearance) {
       return has_clearance && rim.filled ? std::max(rim.pull, rim.bearing_stress) : 0;
     },
     "a fastener with a clearance fills {at}, whose springs act all around: the sheet is too stiff and its hoop "
     "peak, {peak:.4g} {unit}, too low; give the hole's spring \"compression_only\": true in PLATE.json, and the "
     "fastener a \"gap\" instead of \"clearance\""},
    {"kt-below-one",
     [](const HoleState& rim, bool) {
       return rim.in_tension && rim.net_concentration > 0 && rim.pull > 0 ? 1 - rim.net_concentration : 0;
     },
     "Kt net is {net:.4g} at {at}: no hole's peak hoop stress is below the mean stress of its net section, unless "
     "springs pull on its rim; give the hole's spring \"compression_only\": true in PLATE.json"},
    {"disc-held-across",
     [](const HoleState& rim, bool) { return rim.across_ratio > allowed_across ? std::abs(rim.across) : 0; },
     "the {axis} displacement of the disc of {at} is fixed, with a reaction of {across:.4g} {force} next to a bearing "
     "force of {bearing:.4g}, which no other part of the joint carries; let the discs move: \"disc_directions\": "
     "[\"x\", \"y\"] in "
     "all PLATE.json"},
    {"friction-against-slip",
     [](const HoleState& rim, bool) {
       return rim.against_slip > allowed_against && rim.bearing_stress > no_load ? rim.against_slip : 0;
     },
     "friction acts against the slip that it makes on {against:.3g} degrees of the contact at {at}: it is "
     "assumed to slip everywhere, but in reality sticks there; the effect on the loads is small, but the peak hoop "
     "stress {peak:.4g} {unit} is uncertain: compare it with one without friction, and take the larger"},
    {"friction-off-axes", [](const HoleState& rim, bool) { return rim.by_components ? rim.bearing_stress : 0; },
     "friction acts off the axes, by its components along x and y, at {at}: the loads are right, but peak hoop "
     "stresses "
     "there may be too low by the part of friction, most of all at 45 degrees"},
}};

}  // namespace

std::vector<program::Warning> rim_warnings(const JointModel& joint, const Parameters& parameters,
                                           const std::vector<JointState>& states) {
  std::set<std::string> with_clearance;
  for (Index j = 0; j < joint.n_planes(); ++j)
    for (const HoleModel& hole : joint.holes(joint.planes[j]))
      if (parameters.clearance[j] > 0) with_clearance.insert(joint.name(hole));
  const std::string& across = rim::axis_names[1 - joint.axes[0]];
  std::vector<program::Warning> result;
  for (const auto& doubt : doubts) {
    double largest = 0;
    std::string at;
    const HoleState* worst = nullptr;
    std::set<std::string> holes;
    for (Index step = 0; step < std::ssize(states); ++step)
      for (Index i = 0; i < std::ssize(joint.plates); ++i)
        for (Index rim = 0; rim < std::ssize(states[step].plates[i].rims); ++rim) {
          const HoleState& state = states[step].plates[i].rims[rim];
          const std::string hole = joint.plates[i].name + ":" + joint.plates[i].stresses.rim_hole[rim];
          const double measure = doubt.measure(state, with_clearance.contains(hole));
          if (measure > 0) holes.insert(hole);
          if (!(measure > largest)) continue;
          largest = measure;
          worst = &state;
          at = fmt::format("hole \"{}\" (increment {}", hole, step + 1);
        }
    if (!worst) continue;
    at += holes.size() == 1 ? ")" : fmt::format("; {} too)", program::counted(holes.size() - 1, "other hole"));
    using fmt::arg;
    result.push_back(
        {doubt.code,
         fmt::format(fmt::runtime("{file}: " + std::string(doubt.text)), arg("file", joint.file), arg("at", at),
                     arg("axis", across), arg("pull", worst->pull), arg("stress", worst->bearing_stress),
                     arg("peak", worst->peak_hoop), arg("net", worst->net_concentration),
                     arg("against", worst->against_slip), arg("across", std::abs(worst->across)),
                     arg("bearing", std::hypot(worst->bearing_load, worst->bearing_load_y)),
                     arg("force", unit(joint.units, 0, 1)), arg("unit", unit(joint.units, -2, 1)))});
  }
  return result;
}

std::vector<program::Warning> crack_warnings(const JointModel& joint, const std::vector<JointState>& states,
                                             const std::vector<CrackErrors>& errors) {
  std::map<std::string, std::pair<double, std::string>> closing;  // keys: tips; largest -K_I and when it is
  for (std::size_t i = 0; i < joint.plates.size(); ++i) {
    const PlateModel& plate = joint.plates[i];
    for (Index step = 0; step < std::ssize(states); ++step)
      for (Index t = 0; t < std::ssize(plate.cracks.tips); ++t) {
        const double K = states[step].plates[i].cracks.K_I[t];
        if (!(-K > errors[i].K_I(step, t))) continue;
        const std::string name = plate.name + ":" + plate.cracks.tips[t].id;
        auto& worst = closing[name];
        if (-K > worst.first)
          worst = {-K, fmt::format("increment {}, with K_I = {:.6g} {}", step + 1, K, unit(joint.units, -1.5, 1))};
      }
  }
  WarningList list;
  for (const auto& [name, worst] : closing)
    list.doubt("crack-closes", worst.first,
               "{}: crack \"{}\" closes at its tip at {}: its faces overlap in the model, where they would press on "
               "each other; take K_I as 0 and do not rely on K_II",
               joint.file, name, worst.second);
  return list.all();
}

std::vector<program::Warning> distance_warnings(const JointModel& joint, double distance) {
  std::vector<std::string> holes;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& plate : joint.plates) {
    if (!plate.stress_level) continue;
    const VectorXd room = room_around(plate);
    for (Index i = 0; i < room.size(); ++i)
      if (distance >= room[i]) {
        holes.push_back(plate.name + ":" + plate.stresses.rim_hole[i]);
        least = std::min(least, room[i]);
      }
  }
  if (holes.empty()) return {};
  return {{"distance-too-far",
           fmt::format("{}: --distance {:g}: no stresses at this distance from {}, around which the sheet ends or "
                       "another hole begins, the nearest {:g} {} from the rim",
                       joint.file, distance, fmt::join(holes, ", "), least, unit(joint.units, 1, 0))}};
}

}  // namespace fastjoint::stage3
