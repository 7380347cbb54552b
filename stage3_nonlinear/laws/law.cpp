// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/laws/law.hpp"

#include <algorithm>
#include <array>

#include "stage3_nonlinear/laws/cubic_law.hpp"
#include "stage3_nonlinear/laws/piecewise_linear_law.hpp"
#include "stage3_nonlinear/laws/power_law.hpp"
#include "stage3_nonlinear/laws/table_law.hpp"

namespace fastjoint::stage3 {
namespace {

struct Kind {
  const char* type;
  std::shared_ptr<const Law> (*read)(const input::Value& law);
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
  types.reserve(kinds.size());
  for (const auto& kind : kinds) types.emplace_back(kind.type);
  const std::string type = law.at("type").choice(types);
  const auto found = std::find(types.begin(), types.end(), type);
  return kinds[found - types.begin()].read(law);
}

}  // namespace fastjoint::stage3
