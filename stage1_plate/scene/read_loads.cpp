// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/scene/read_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace fastjoint::stage1 {
namespace {

using input::Value;

bool has_contact(const PlateScene& scene) {
  return std::any_of(scene.holes.begin(), scene.holes.end(),
                     [](const Hole& hole) { return hole.spring && hole.spring->compression_only; });
}

Load read_amount(const Value& item) {
  const auto force = item.find("force");
  const auto displacement = item.find("displacement");
  if (force.has_value() == displacement.has_value()) item.not_allowed("either \"force\" or \"displacement\"");
  return {force.has_value(), (force ? *force : *displacement).number()};
}

class LoadReader {
 public:
  explicit LoadReader(const PlateScene& scene) : scene_(scene), discs_(list_discs(scene)) {
    loads_.external.assign(scene.externals.size(), {true, 0});
    loads_.disc.assign(discs_.size(), {false, 0});
  }

  SceneLoads read(const Value& list) {
    for (const auto& item : list.items(1)) {
      item.only({"external", "disc", "direction", "force", "displacement", "friction"});
      if (item.find("external").has_value() == item.find("disc").has_value())
        item.not_allowed("either \"external\" or \"disc\"");
      item.find("external") ? read_external(item) : read_disc(item);
    }
    const auto nothing = [](const Load& load) { return load.value == 0; };
    if (std::all_of(loads_.external.begin(), loads_.external.end(), nothing) &&
        std::all_of(loads_.disc.begin(), loads_.disc.end(), nothing))
      list.fail("every force and displacement is 0", "at least one that is not");
    return std::move(loads_);
  }

 private:
  void read_external(const Value& item) {
    item.only({"external", "force", "displacement"});
    const Value id = item.at("external");
    const int i = read_id(id, scene_.externals);
    const Load load = read_amount(item);
    if (!load.is_force && scene_.externals[i].kind != ExternalKind::rigid)
      item.at("displacement")
          .fail(fmt::format("external \"{}\" does not move as one", scene_.externals[i].id),
                "\"displacement\" of kind \"rigid\" only");
    put(load, id, loads_.external[i]);
  }

  void read_disc(const Value& item) {
    const Value id = item.at("disc");
    std::vector<std::string> ids;
    for (const auto& disc : discs_)
      if (ids.empty() || ids.back() != disc.id) ids.push_back(disc.id);
    const auto first = index_of(ids, id.choice(ids)) * count_of(scene_.disc_directions);
    const auto direction = item.find("direction");
    if (!direction && scene_.disc_directions.size() > 1)
      item.fail("key \"direction\" is missing", "one of \"disc_directions\", of which there are two");
    const auto i =
        first + (direction ? index_of(scene_.disc_directions, direction->choice(scene_.disc_directions)) : 0);
    Load load = read_amount(item);
    if (const auto friction = item.find("friction")) {
      load.friction = friction->number(input::not_negative);
      if (index_of(scene_.holes, discs_[i].id, &Hole::id) == count_of(scene_.holes))
        friction->fail(fmt::format("\"{}\" is a point, which has no rim", discs_[i].id), "friction at discs of holes");
    }
    put(load, id, loads_.disc[i]);
  }

  void put(const Load& load, const Value& id, Load& place) {
    if (!given_.insert(&place).second)
      id.fail("loaded twice", "one load for each external, and for each disc and direction");
    place = load;
  }

  const PlateScene& scene_;
  std::vector<Disc> discs_;
  SceneLoads loads_;
  std::set<const Load*> given_;  ///< those of loads_ that the list has
};

}  // namespace

std::optional<SceneLoads> read_loads(const Value& root, const PlateScene& scene) {
  const auto list = root.find("loads");
  if (!has_contact(scene)) {
    if (list) list->fail("given, but no hole has springs with \"compression_only\"", "loads with such a hole only");
    return std::nullopt;
  }
  return list ? std::optional(LoadReader(scene).read(*list)) : std::nullopt;
}

}  // namespace fastjoint::stage1
