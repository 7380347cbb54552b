// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <map>

#include "stage3_nonlinear/output/output.hpp"

namespace fastjoint::stage3 {

std::vector<program::Warning> crack_warnings(const JointModel& joint, const formats::JointResult& result) {
  std::map<std::string, Doubt> closing;  // keys: tips
  for (const auto& plate : result.plates) {
    const auto& a = plate.cracks;
    for (Index step = 0; step < a.K_I.rows(); ++step)
      for (Index t = 0; t < std::ssize(a.tip); ++t) {
        const double K = a.K_I(step, t);
        if (!(-K > a.K_I_error(step, t))) continue;
        const std::string name = plate.name + ":" + a.tip[t];
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
