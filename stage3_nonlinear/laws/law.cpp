// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/laws/law.hpp"

#include <array>
#include <utility>

#include "common/count.hpp"

namespace fastjoint::stage3 {

/// Readers, one for each "type" of a law, defined in the law's own file; "one_sided" is left to the caller.
using LawReader = LawPointer(const input::Value& law);
LawReader read_linear_law, read_power_law, read_cubic_law, read_bilinear_law, read_four_stage_law, read_table_law,
    read_formula_law, read_rigid_law;

LawPointer read_law(const input::Value& law) {
  constexpr auto kinds = std::to_array<std::pair<const char*, LawReader*>>({{"linear", read_linear_law},
                                                                            {"power", read_power_law},
                                                                            {"cubic", read_cubic_law},
                                                                            {"bilinear", read_bilinear_law},
                                                                            {"four stage", read_four_stage_law},
                                                                            {"table", read_table_law},
                                                                            {"formula", read_formula_law},
                                                                            {"rigid", read_rigid_law}});
  std::vector<std::string> types;
  for (const auto& [type, read] : kinds) types.emplace_back(type);
  return kinds[index_of(types, law.at("type").choice(types))].second(law);
}

}  // namespace fastjoint::stage3
