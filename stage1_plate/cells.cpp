// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/cells.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>

#include "common/pfem/shape_functions.hpp"

namespace fastjoint::stage1 {
namespace {

/// A cell with more elements is taken element by element: dense condensation of many would cost more than it saves.
constexpr int most_elements = 32;

/// A side of a rim by hole.
struct HoleSide {
  int hole;
  pfem::Side side;
};

class CellFinder {
 public:
  CellFinder(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering,
             const Unknowns& unknowns)
      : scene_(scene),
        plate_(plate),
        numbering_(numbering),
        unknowns_(unknowns),
        result_{pfem::find_congruent(plate.mesh, plate.edges), {}, {}, {}},
        cell_of_element_(static_cast<std::size_t>(plate.mesh.n_elements())),
        rims_(cell_of_element_.size()) {}

  PlateCells run() {
    cut();
    find_kept();
    for (std::size_t cell = 0; cell + 1 < start_.size(); ++cell) add(start_[cell], start_[cell + 1]);
    return std::move(result_);
  }

 private:
  using Key = std::vector<std::int64_t>;

  void cut() {
    for (std::size_t i = 0; i + 1 < plate_.cell_start.size(); ++i) {
      const int first = plate_.cell_start[i], last = plate_.cell_start[i + 1];
      const int step = last - first > most_elements ? 1 : last - first;
      for (int element = first; element < last; element += step) start_.push_back(element);
    }
    start_.push_back(plate_.mesh.n_elements());
    for (std::size_t cell = 0; cell + 1 < start_.size(); ++cell)
      std::fill(cell_of_element_.begin() + start_[cell], cell_of_element_.begin() + start_[cell + 1],
                static_cast<int>(cell));
    for (std::size_t hole = 0; hole < scene_.holes.size(); ++hole)
      for (const auto& side : plate_.rims[hole].sides)
        rims_[static_cast<std::size_t>(side.element)].push_back({static_cast<int>(hole), side});
  }

  /// Vertices and edges on outlines: between two cells, or on the border of the plate but not on a rim.
  void find_kept() {
    kept_vertex_.assign(static_cast<std::size_t>(plate_.mesh.n_nodes()), false);
    kept_edge_.assign(static_cast<std::size_t>(plate_.edges.size()), false);
    std::vector<int> cell_at_edge(kept_edge_.size(), -1);
    std::vector<bool> on_rim(kept_edge_.size(), false);
    const auto edge_of = [&](const pfem::Side& side) {
      return static_cast<std::size_t>(plate_.edges.of_element(side.local_edge, side.element));
    };
    for (const auto& rim : plate_.rims)
      for (const auto& side : rim.sides) on_rim[edge_of(side)] = true;
    for (int element = 0; element < plate_.mesh.n_elements(); ++element)
      for (int local = 0; local < pfem::n_local_edges; ++local) {
        const auto edge = edge_of({element, local});
        const int cell = cell_of_element_[static_cast<std::size_t>(element)];
        if (plate_.edges.n_elements[edge] == 1 ? !on_rim[edge] : cell_at_edge[edge] >= 0 && cell_at_edge[edge] != cell)
          keep_edge(edge);
        cell_at_edge[edge] = cell;
      }
    for (std::size_t function = 0; function < kept_vertex_.size(); ++function)
      if (!is_free(function)) kept_vertex_[function] = true;
    for (const int node : plate_.point_nodes) kept_vertex_[static_cast<std::size_t>(node)] = true;
    for (std::size_t edge = 0; edge < kept_edge_.size() && numbering_.p > 1; ++edge)
      if (!is_free(static_cast<std::size_t>(numbering_.n_functions[1]) + edge)) keep_edge(edge);
  }

  void keep_edge(std::size_t edge) {
    kept_edge_[edge] = true;
    for (const int node : plate_.edges.nodes.col(static_cast<Eigen::Index>(edge)))
      kept_vertex_[static_cast<std::size_t>(node)] = true;
  }

  [[nodiscard]] bool is_free(std::size_t function) const {
    return Unknowns::is_free(unknowns_.target[2 * function]) && Unknowns::is_free(unknowns_.target[2 * function + 1]);
  }

  void add(int first, int last) {
    Cell cell{0, first, 1, {}, {}, {}};
    for (int element = first; element < last; ++element)
      for (const auto& [hole, side] : rims_[static_cast<std::size_t>(element)])
        if (scene_.holes[static_cast<std::size_t>(hole)].spring &&
            std::find(cell.holes.begin(), cell.holes.end(), hole) == cell.holes.end())
          cell.holes.push_back(hole);
    const pfem::Mesh mesh = own_mesh(first, last);
    const auto [found, is_new] = index_.try_emplace(key(mesh, cell, first), static_cast<int>(result_.shapes.size()));
    if (is_new) add_shape(mesh, cell);
    cell.shape = found->second;
    place(cell);
    result_.cells.push_back(std::move(cell));
  }

  /// Its vertices numbered as its elements meet them. Only what numbering needs: no coordinates.
  [[nodiscard]] pfem::Mesh own_mesh(int first, int last) const {
    pfem::Mesh mesh;
    mesh.quads.resize(4, last - first);
    std::vector<int> nodes;
    for (int element = first; element < last; ++element)
      for (int v = 0; v < 4; ++v) {
        const auto at = std::find(nodes.begin(), nodes.end(), plate_.mesh.quads(v, element));
        mesh.quads(v, element - first) = static_cast<int>(at - nodes.begin());
        if (at == nodes.end()) nodes.push_back(plate_.mesh.quads(v, element));
      }
    mesh.nodes.resize(2, static_cast<Eigen::Index>(nodes.size()));
    mesh.thickness = plate_.mesh.thickness.segment(first, last - first);
    return mesh;
  }

  /// Equal keys, equal matrices up to the thickness.
  [[nodiscard]] Key key(const pfem::Mesh& mesh, const Cell& cell, int first) {
    Key key{mesh.n_elements()};
    const auto bits = [&](double x) { key.push_back(std::bit_cast<std::int64_t>(x)); };
    for (int i = 0; i < mesh.n_elements(); ++i) {
      const int element = first + i;
      key.push_back(result_.elements.shape[static_cast<std::size_t>(element)]);
      bits(mesh.thickness[i] / mesh.thickness[0]);
      for (int v = 0; v < 4; ++v) key.push_back(mesh.quads(v, i));
      for (int v = 0; v < 4; ++v) {
        const auto edge = static_cast<std::size_t>(plate_.edges.of_element(v, element));
        key.push_back(2 * kept_edge_[edge] + kept_vertex_[static_cast<std::size_t>(plate_.mesh.quads(v, element))]);
      }
      for (const auto& [hole, side] : rims_[static_cast<std::size_t>(element)]) {
        const auto at = std::find(cell.holes.begin(), cell.holes.end(), hole);
        if (at == cell.holes.end()) continue;
        key.insert(key.end(), {-1 - (at - cell.holes.begin()), side.local_edge});
        const Spring& spring = scene_.holes[static_cast<std::size_t>(hole)].sprung();
        bits(spring.modulus);
        bits(spring.link / mesh.thickness[0]);
        for (const auto& arc : spring.acts) bits(arc.from), bits(arc.to);
      }
    }
    return key;
  }

  void add_shape(const pfem::Mesh& mesh, const Cell& cell) {
    CellShape shape;
    const auto edges = pfem::find_edges(mesh);
    shape.numbering = pfem::number_by_degree(mesh, edges, numbering_.space, numbering_.p);
    shape.thickness = mesh.thickness;
    const auto n = static_cast<std::size_t>(shape.numbering.n_functions.back());
    shape.interior.assign(n, true);
    shape.kept.assign(n, false);
    for (int i = 0; i < mesh.n_elements(); ++i) {
      const int element = cell.first_element + i;
      shape.element_shape.push_back(result_.elements.shape[static_cast<std::size_t>(element)]);
      for (int m = 0; m < pfem::edge_mode(numbering_.p, pfem::n_local_edges, 2); ++m) {
        const auto function = static_cast<std::size_t>(shape.numbering.function(m, i));
        shape.interior[function] = false;
        shape.kept[function] = is_kept(element, m);
      }
      for (const auto& [hole, side] : rims_[static_cast<std::size_t>(element)]) {
        const auto at = std::find(cell.holes.begin(), cell.holes.end(), hole);
        if (at != cell.holes.end())
          shape.rims.push_back({static_cast<int>(at - cell.holes.begin()), i,
                                rim_terms(scene_, plate_, static_cast<std::size_t>(hole), side, numbering_.p)});
      }
    }
    result_.shapes.push_back(std::move(shape));
  }

  [[nodiscard]] bool is_kept(int element, int mode) const {
    if (mode < 4) return kept_vertex_[static_cast<std::size_t>(plate_.mesh.quads(mode, element))];
    const int edge = (mode - 4) / (numbering_.p - 1);
    return kept_edge_[static_cast<std::size_t>(plate_.edges.of_element(edge, element))];
  }

  void place(Cell& cell) const {
    const CellShape& shape = result_.shapes[static_cast<std::size_t>(cell.shape)];
    const auto& own = shape.numbering;
    cell.scale = plate_.mesh.thickness[cell.first_element] / shape.thickness[0];
    cell.function.resize(static_cast<std::size_t>(own.n_functions.back()));
    cell.sign.resize(own.n_functions.back());
    for (Eigen::Index i = 0; i < own.function.cols(); ++i)
      for (Eigen::Index m = 0; m < own.function.rows(); ++m) {
        const int function = own.function(m, i);
        cell.function[static_cast<std::size_t>(function)] = numbering_.function(m, cell.first_element + i);
        cell.sign[function] = own.sign(m, i) * numbering_.sign(m, cell.first_element + i);
      }
  }

  const PlateScene& scene_;
  const PlateMesh& plate_;
  const pfem::Numbering& numbering_;
  const Unknowns& unknowns_;
  PlateCells result_;
  std::vector<int> cell_of_element_;
  std::vector<std::vector<HoleSide>> rims_;  ///< sides on rims of each element
  std::vector<int> start_;                   ///< first element of each cell, and the end
  std::vector<bool> kept_vertex_, kept_edge_;
  std::map<Key, int> index_;
};

}  // namespace

PlateCells find_cells(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering,
                      const Unknowns& unknowns) {
  return CellFinder(scene, plate, numbering, unknowns).run();
}

}  // namespace fastjoint::stage1
