// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/laws/law.hpp"

#include <array>

#include "common/count.hpp"

namespace fastjoint::stage3 {

/// Readers, one for each "type" of a law, each beside the law that it reads; "one_sided" is left to the caller.
using LawReader = std::shared_ptr<const Law>(const input::Value& law);
LawReader read_linear_law, read_power_law, read_cubic_law, read_bilinear_law, read_four_stage_law, read_table_law,
    read_formula_law;

std::shared_ptr<const Law> read_law(const input::Value& law) {
  struct Kind {
    const char* type;
    LawReader* read;
  };
  constexpr std::array kinds{
      Kind{"linear", read_linear_law},          //
      Kind{"power", read_power_law},            //
      Kind{"cubic", read_cubic_law},            //
      Kind{"bilinear", read_bilinear_law},      //
      Kind{"four stage", read_four_stage_law},  //
      Kind{"table", read_table_law},            //
      Kind{"formula", read_formula_law},
  };
  std::vector<std::string> types;
  for (const auto& kind : kinds) types.emplace_back(kind.type);
  return kinds[index_of(types, law.at("type").choice(types))].read(law);
}

}  // namespace fastjoint::stage3
