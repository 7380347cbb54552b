// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/scene/scene_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

namespace fastjoint::stage3 {
namespace {

using Names = std::set<std::pair<std::string, std::string>>;

void check_plate_exists(const JointScene& scene, const Reference& reference) {
  std::vector<std::string> names;
  names.reserve(scene.plates.size());
  for (const auto& plate : scene.plates) names.push_back(plate.name);
  if (std::find(names.begin(), names.end(), reference.plate) == names.end())
    refuse(reference.where, fmt::format("plate \"{}\" does not exist", reference.plate),
           fmt::format("{}", fmt::join(names, ", ")));
}

void check_fasteners(const JointScene& scene) {
  std::set<std::string> ids;
  Names used;
  for (const auto& fastener : scene.fasteners) {
    if (!ids.insert(fastener.id).second)
      refuse(fastener.where + "/id", fmt::format("\"{}\" stands twice", fastener.id), "each id once");
    std::set<std::string> plates;
    for (const auto& hole : fastener.between) {
      check_plate_exists(scene, hole);
      if (!used.emplace(hole.plate, hole.name).second)
        refuse(hole.where, fmt::format("hole \"{}:{}\" has a fastener already", hole.plate, hole.name),
               "one fastener per hole");
      if (!plates.insert(hole.plate).second)
        refuse(fastener.where + "/between", fmt::format("goes through plate \"{}\" twice", hole.plate),
               "holes of different plates");
    }
  }
}

void check_plates_used(const JointScene& scene) {
  std::set<std::string> plates;
  for (const auto& fastener : scene.fasteners)
    for (const auto& hole : fastener.between) plates.insert(hole.plate);
  for (const auto& plate : scene.plates)
    if (!plates.contains(plate.name))
      refuse(plate.where, "no fastener holds this plate", "plates that a fastener names in \"between\"");
}

void check_loads(const JointScene& scene) {
  Names loaded;
  for (const auto& load : scene.loads) {
    check_plate_exists(scene, load.external);
    if (!loaded.emplace(load.external.plate, load.external.name).second)
      refuse(load.external.where, fmt::format("\"{}:{}\" is loaded already", load.external.plate, load.external.name),
             "one load per external boundary");
  }
}

}  // namespace

void check_scene(const JointScene& scene) {
  check_fasteners(scene);
  check_plates_used(scene);
  check_loads(scene);
}

}  // namespace fastjoint::stage3
