// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/scene/bending_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/count.hpp"
#include "stage3_nonlinear/scene/joint_scene.hpp"

namespace fastjoint::stage3 {

BendingScene read_bending(const input::Value& value, const std::vector<PlateScene>& plates) {
  BendingScene scene;
  if (!value.is_object()) {
    if (!value.is_string() || value.text() != "none") value.not_allowed("\"none\", or an object");
    scene.is_wanted = false;
    return scene;
  }
  value.only({"heads", "way_back", "mismatch", "ends"});
  if (const auto heads = value.find("heads")) {
    const std::string word = heads->choice({"both", "free", "clamped"});
    if (word != "both") scene.heads = {word == "free" ? free_heads : clamped_heads};
  }
  if (const auto back = value.find("way_back")) scene.way_back = back->boolean();
  constexpr input::Range mismatches{.low = 1e-6, .high = 1, .low_allowed = true, .high_allowed = true};
  if (const auto mismatch = value.find("mismatch")) scene.mismatch = mismatch->number(mismatches);
  const auto ends = value.find("ends");
  if (!ends) return scene;
  static const std::vector<std::string> sides{"left", "right", "bottom", "top"},
      holds{"free", "hinged", "clamped", "symmetric"};  // in the order of EndHold
  std::vector<std::string> names;
  for (const auto& plate : plates) names.push_back(plate.name);
  for (const auto& [plate, its] : ends->members()) {
    if (index_of(names, plate) == count_of(names))
      its.fail(fmt::format("no plate is called \"{}\"", plate), fmt::format("{}", fmt::join(names, ", ")));
    its.only({"left", "right", "bottom", "top"});
    auto& held = scene.ends[plate];
    for (std::size_t i = 0; i < sides.size(); ++i)
      if (const auto how = its.find(sides[i].c_str()))
        held[i] = static_cast<EndHold>(index_of(holds, how->choice(holds)));
  }
  return scene;
}

}  // namespace fastjoint::stage3
