// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/plate_stiffness.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>

#include "common/count.hpp"
#include "common/pfem/shape_functions.hpp"

namespace fastjoint::plate {
namespace {

/// A side of an element on the rim of a hole.
struct HoleSide {
  int hole;
  pfem::Side side;
};

class ElementClassifier {
 public:
  ElementClassifier(const SprungMesh& sprung, const pfem::Numbering& numbering, const Unknowns& unknowns)
      : sprung_(sprung), numbering_(numbering), unknowns_(unknowns), rims_(sprung.mesh.n_elements()) {}

  PlateElements run() {
    const int n = sprung_.mesh.n_elements();
    result_.congruent = pfem::find_congruent(sprung_.mesh, sprung_.edges);
    result_.scale.resize(n);
    for (int hole = 0; hole < count_of(sprung_.rims); ++hole)
      for (const auto& side : sprung_.rims[hole].sides) rims_[side.element].push_back({hole, side});
    for (int element = 0; element < n; ++element) add(element);
    return std::move(result_);
  }

 private:
  using Key = std::vector<std::int64_t>;

  void add(int element) {
    result_.holes.push_back(holes_on(element));
    const auto [found, is_new] = index_.try_emplace(key(element), count_of(result_.classes));
    if (is_new) add_class(element);
    result_.class_of.push_back(found->second);
    result_.scale[element] = sprung_.mesh.thickness[element] / result_.classes[found->second].thickness;
  }

  [[nodiscard]] bool has_terms(int hole) const { return sprung_.springs[hole] || sprung_.waves[hole]; }

  [[nodiscard]] std::vector<int> holes_on(int element) const {
    std::vector<int> holes;
    for (const auto& [hole, side] : rims_[element])
      if (has_terms(hole) && std::find(holes.begin(), holes.end(), hole) == holes.end()) holes.push_back(hole);
    return holes;
  }

  /// True if the functions of an edge are boundary unknowns in static condensation. Those of a free rim are interior:
  /// neither a neighbour nor a support shares them.
  [[nodiscard]] bool is_edge_kept(int element, int edge) const {
    const auto& sides = rims_[element];
    const bool on_rim =
        std::any_of(sides.begin(), sides.end(), [&](const HoleSide& at) { return at.side.local_edge == edge; });
    if (!on_rim || numbering_.p == 1) return true;
    const auto function = numbering_.function(pfem::edge_mode(numbering_.p, edge, 2), element);
    return unknowns_.dofs.col(function).minCoeff() < 0;
  }

  /// Elements with equal keys have equal matrices up to the thickness.
  [[nodiscard]] Key key(int element) const {
    Key key{result_.congruent.class_of[element]};
    const auto bits = [&](double x) { key.push_back(std::bit_cast<std::int64_t>(x)); };
    for (int edge = 0; edge < pfem::n_local_edges; ++edge) key.push_back(is_edge_kept(element, edge));
    for (const auto& [hole, side] : rims_[element]) {
      if (!has_terms(hole)) continue;
      key.insert(key.end(), {index_of(result_.holes[element], hole), side.local_edge});
      if (const auto& waves = sprung_.waves[hole]) {
        key.insert(key.end(), {waves->shape.highest, waves->loaded});
        bits(waves->shape.start);
        bits(waves->shape.sweep);
      }
      const auto& spring = sprung_.springs[hole];
      if (!spring) continue;
      bits(spring->modulus);
      bits(spring->link / sprung_.mesh.thickness[element]);
      for (const double each : sprung_.axes[hole].reshaped()) bits(each);
      for (const auto& arc : spring->arcs) {
        bits(arc.from);
        bits(arc.to);
      }
    }
    return key;
  }

  void add_class(int element) {
    ElementClass added{element, result_.congruent.class_of[element], sprung_.mesh.thickness[element], {}, {}};
    added.kept.assign(numbering_.function.rows(), false);
    std::fill_n(added.kept.begin(), 4, true);
    for (int edge = 0; edge < pfem::n_local_edges; ++edge)
      for (int k = 2; k <= numbering_.p; ++k)
        added.kept[pfem::edge_mode(numbering_.p, edge, k)] = is_edge_kept(element, edge);
    for (const auto& [hole, side] : rims_[element])
      if (has_terms(hole))
        added.rims.push_back({index_of(result_.holes[element], hole), rim_terms(sprung_, hole, side, numbering_.p)});
    result_.classes.push_back(std::move(added));
  }

  const SprungMesh& sprung_;
  const pfem::Numbering& numbering_;
  const Unknowns& unknowns_;
  PlateElements result_;
  std::vector<std::vector<HoleSide>> rims_;  ///< sides on rims of each element
  std::map<Key, int> index_;
};

}  // namespace

PlateElements classify_elements(const SprungMesh& sprung, const pfem::Numbering& numbering, const Unknowns& unknowns) {
  return ElementClassifier(sprung, numbering, unknowns).run();
}

std::vector<int> Unknowns::border_of(const std::vector<int>& holes) const {
  std::vector<int> list;
  for (const int hole : holes) {
    for (int disc = first_disc[hole]; disc < first_disc[hole + 1]; ++disc) list.push_back(controlled_of_disc(disc));
    for (int k = 0; k < n_waves[hole]; ++k) list.push_back(first_wave[hole] + k);
    for (int k = 0; k < n_cases[hole]; ++k) list.push_back(first_friction[hole] + k);
  }
  return list;
}

void count_rim_cases(const SprungMesh& sprung, Unknowns& unknowns) {
  const int n_holes = count_of(sprung.springs);
  for (auto* list : {&unknowns.first_wave, &unknowns.first_friction, &unknowns.n_waves, &unknowns.n_cases})
    list->assign(n_holes, 0);
  int next = unknowns.n_controlled();
  const auto number_waves = [&](bool loaded) {
    const int first = next;
    for (int hole = 0; hole < n_holes; ++hole)
      if (const auto& waves = sprung.waves[hole]; waves && waves->loaded == loaded) {
        unknowns.first_wave[hole] = next;
        next += unknowns.n_waves[hole] = waves->size();
      }
    return next - first;
  };
  unknowns.n_loaded = number_waves(true);
  const int first = next;
  for (int hole = 0; hole < n_holes; ++hole) {
    unknowns.first_friction[hole] = next;
    next += unknowns.n_cases[hole] = sprung.n_friction_cases(hole);
  }
  unknowns.n_friction = next - first;
  unknowns.n_other = number_waves(false);
}

std::vector<int> count_free(const pfem::Numbering& numbering, const Eigen::Matrix2Xi& dofs) {
  std::vector<int> n_free;
  for (const int n : numbering.n_functions) n_free.push_back(static_cast<int>((dofs.leftCols(n).array() >= 0).count()));
  return n_free;
}

std::vector<double> spring_stiffnesses(const PlateStiffness& plate) {
  std::vector<double> all;
  for (const auto& each : plate.elements.classes)
    for (const auto& rim : each.rims) all.push_back(rim.terms.stiffness);
  for (const auto& tie : plate.ties) all.push_back(tie.stiffness);
  return all;
}

}  // namespace fastjoint::plate
