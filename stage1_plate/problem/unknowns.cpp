// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/unknowns.hpp"

#include <fmt/format.h>

#include "common/count.hpp"
#include "common/pfem/shape_functions.hpp"

namespace fastjoint::stage1 {
namespace {

constexpr int undecided = 0;

int component_of(const std::string& direction) { return direction == "x" ? 0 : 1; }

/// Coefficients of one displacement component that do not vanish on a side: two vertices, then the edge's modes.
std::vector<std::size_t> side_coefficients(const pfem::Numbering& numbering, const pfem::Side& side, int component) {
  std::vector<std::size_t> result;
  const auto add = [&](int mode) { result.push_back(2 * numbering.function(mode, side.element) + component); };
  const auto [first, second] = pfem::natural_ends(side.local_edge);
  add(first);
  add(second);
  for (int k = 2; k <= numbering.p; ++k) add(pfem::edge_mode(numbering.p, side.local_edge, k));
  return result;
}

class Classifier {
 public:
  Classifier(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering)
      : scene_(scene), plate_(plate), numbering_(numbering) {
    result_.target.assign(2 * numbering.n_functions.back(), undecided);
  }

  Unknowns run() {
    for (const auto& support : scene_.supports) fix(support);
    for (std::size_t i = 0; i < scene_.externals.size(); ++i) {
      auto& list = scene_.externals[i].kind == ExternalKind::rigid ? result_.rigid : result_.traction;
      list.push_back(static_cast<int>(i));
    }
    for (int i = 0; i < result_.n_externals(); ++i) control(i);
    add_discs();
    number_free();
    return std::move(result_);
  }

 private:
  const std::vector<pfem::Side>& sides(const std::string& name) const { return plate_.sets.at(name); }

  void fix(const Support& support) {
    for (const auto& direction : support.fix)
      for (const auto& side : sides(support.on))
        for (const auto coefficient : side_coefficients(numbering_, side, component_of(direction)))
          result_.target[coefficient] = Unknowns::fixed;
  }

  /// The side's vertices move with the external; its edge modes, which would bend it, are zero.
  void control(int index) {
    const External& external = scene_.externals[result_.rigid[index]];
    for (const auto& side : sides(external.on)) {
      const auto list = side_coefficients(numbering_, side, component_of(external.direction));
      for (std::size_t i = 0; i < list.size(); ++i) {
        int& target = result_.target[list[i]];
        const int wanted = i < 2 ? Unknowns::controlled(index) : Unknowns::fixed;
        if (target != undecided && target != wanted) conflict(external, list[i]);
        target = wanted;
      }
    }
  }

  [[noreturn]] void conflict(const External& external, std::size_t coefficient) const {
    const auto function = static_cast<int>(coefficient / 2);
    const std::string where =
        function < plate_.mesh.n_nodes()
            ? fmt::format("at ({:g}, {:g})", plate_.mesh.nodes(0, function), plate_.mesh.nodes(1, function))
            : std::string("along an edge");
    reject(scene_, "/external",
           fmt::format("external \"{}\" moves the plate in {} {}, where a support or another external holds it",
                       external.id, external.direction, where),
           "one support or rigid external for each displacement");
  }

  void add_discs() {
    for (const auto& disc : list_discs(scene_)) {
      result_.disc_hole.push_back(disc.id);
      result_.disc_direction.push_back(disc.direction);
    }
    const auto n_directions = count_of(scene_.disc_directions);
    result_.n_directions = n_directions;
    int disc = 0;
    for (const auto& hole : scene_.holes) {
      result_.disc_of_hole.push_back(hole.spring ? disc : -1);
      if (hole.spring) disc += n_directions;
    }
    for (std::size_t i = 0; i < scene_.points.size(); ++i, disc += n_directions) result_.disc_of_point.push_back(disc);
    result_.n_controlled = result_.n_externals() + result_.n_discs();
  }

  void number_free() {
    int n_free = 0;
    int coefficient = 0;
    for (const int n_functions : numbering_.n_functions) {
      for (; coefficient < 2 * n_functions; ++coefficient)
        if (result_.target[coefficient] == undecided) result_.target[coefficient] = n_free++;
      result_.n_free.push_back(n_free);
    }
  }

  const PlateScene& scene_;
  const PlateMesh& plate_;
  const pfem::Numbering& numbering_;
  Unknowns result_;
};

}  // namespace

Unknowns classify_unknowns(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering) {
  return Classifier(scene, plate, numbering).run();
}

}  // namespace fastjoint::stage1
