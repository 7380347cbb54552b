// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/laws/law.hpp"

#include <algorithm>
#include <array>

#include "stage3_nonlinear/laws/laws.hpp"

namespace fastjoint::stage3 {
namespace {

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

}  // namespace

std::shared_ptr<const Law> read_law(const input::Value& law) {
  std::vector<std::string> types;
  for (const auto& kind : kinds) types.emplace_back(kind.type);
  const std::string type = law.at("type").choice(types);
  return kinds[std::find(types.begin(), types.end(), type) - types.begin()].read(law);
}

}  // namespace fastjoint::stage3
