// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "stage3_nonlinear/output/warnings.hpp"

namespace fastjoint::stage3 {
namespace {

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

}  // namespace

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
    result.push_back(fmt::format(fmt::runtime("{file}: " + std::string(doubt.text)), arg("file", joint.file),
                                 arg("at", at), arg("pull", worst->pull), arg("stress", worst->bearing_stress),
                                 arg("peak", worst->peak_hoop), arg("net", worst->net_concentration),
                                 arg("across", std::abs(worst->across)),
                                 arg("bearing", std::hypot(worst->bearing_load, worst->bearing_load_y)),
                                 arg("force", unit(joint.units, 0, 1)), arg("unit", unit(joint.units, -2, 1))));
  }
  return result;
}

}  // namespace fastjoint::stage3
