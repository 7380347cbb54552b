// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <map>

#include "stage3_nonlinear/output/output.hpp"

namespace fastjoint::stage3 {

std::vector<program::Warning> crack_warnings(const JointModel& joint, const std::vector<JointState>& states,
                                             const std::vector<CrackErrors>& errors) {
  std::map<std::string, Doubt> closing;  // keys: tips
  for (std::size_t i = 0; i < joint.plates.size(); ++i) {
    const PlateModel& plate = joint.plates[i];
    for (Index step = 0; step < std::ssize(states); ++step)
      for (Index t = 0; t < std::ssize(plate.cracks.tip); ++t) {
        const double K = states[step].plates[i].cracks.K_I[t];
        if (!(-K > errors[i].K_I(step, t))) continue;
        const std::string name = plate.name + ":" + plate.cracks.tip[t];
        Doubt& worst = closing[name];
        if (-K > worst.first)
          worst = {-K, fmt::format("{}: crack \"{}\" closes at its tip at increment {}, with K_I = {:.6g} {}: its "
                                   "faces overlap in the model, where they would press on each other; take K_I "
                                   "as 0 and do not rely on K_II",
                                   joint.file, name, step + 1, K, unit(joint.units, -1.5, 1))};
      }
  }
  std::vector<Doubt> all;
  for (const auto& [name, doubt] : closing) all.push_back(doubt);
  std::vector<program::Warning> found;
  add_worst(found, "crack-closes", all);
  return found;
}

}  // namespace fastjoint::stage3
