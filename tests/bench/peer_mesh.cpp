// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/peer_mesh.hpp"

#include <deal.II/grid/manifold_lib.h>

#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace fastjoint::peer {
namespace {

using namespace dealii;

constexpr double same = 1e-12;

/// Points on the squares' outlines, at multiples of 1/2, are shared; those of rings are their hole's own.
class Vertices {
 public:
  unsigned int shared(const Point<2>& at) {
    const std::pair key{std::lround(2 * at[0]), std::lround(2 * at[1])};
    const auto [found, is_new] = index_.try_emplace(key, static_cast<unsigned int>(all.size()));
    if (is_new) all.push_back(at);
    return found->second;
  }
  unsigned int own(const Point<2>& at) {
    all.push_back(at);
    return static_cast<unsigned int>(all.size()) - 1;
  }
  std::vector<Point<2>> all;

 private:
  std::map<std::pair<long, long>, unsigned int> index_;
};

/// The cells of one square, ring by ring, each counter-clockwise from the cell below the ray along +x. In all of them
/// edges run outwards or along +x or +y, as deal.II asks of neighbours.
void add_square(const Panel& panel, const Point<2>& center, Vertices& vertices, std::vector<CellData<2>>& cells) {
  constexpr double outline[n_octants][2] = {{.5, -.5}, {.5, 0},  {.5, .5},   {0, .5},
                                            {-.5, .5}, {-.5, 0}, {-.5, -.5}, {0, -.5}};
  std::vector<std::array<unsigned int, n_octants>> layers(panel.rings + 2);
  for (unsigned int i = 0; i < n_octants; ++i) {
    const Tensor<1, 2> ray({outline[i][0], outline[i][1]});
    for (unsigned int k = 0; k <= panel.rings; ++k) {
      const double r = radius * std::pow(0.5 / radius, double(k) / (panel.rings + 1));
      layers[k][i] = vertices.own(center + r / ray.norm() * ray);
    }
    layers.back()[i] = vertices.shared(center + ray);
  }
  for (unsigned int k = 0; k <= panel.rings; ++k)
    for (unsigned int i = 0; i < n_octants; ++i) {
      const auto &in = layers[k], &out = layers[k + 1];
      const unsigned int next = (i + 1) % n_octants;
      const bool falls = i >= 2 && i < 6;  // counter-clockwise is along -x or -y
      cells.emplace_back();
      cells.back().vertices =
          falls ? std::vector{in[next], in[i], out[next], out[i]} : std::vector{in[i], out[i], in[next], out[next]};
    }
}

/// The arcs of a hole have its number as their manifold.
void describe_face(const Panel& panel, unsigned int hole, Triangulation<2>::face_iterator face,
                   Triangulation<2>& mesh) {
  const Point<2> center = panel.center(hole);
  const double first = face->vertex(0).distance(center), second = face->vertex(1).distance(center);
  if (std::abs(first - second) < same && first < 0.5 - same) {
    face->set_manifold_id(hole);
    mesh.set_manifold(hole, SphericalManifold<2>(center));
  }
  if (!face->at_boundary()) return;
  const Point<2> middle = face->center();
  if (first < radius + same && second < radius + same) face->set_boundary_id(rim);
  if (middle[0] < same) face->set_boundary_id(left);
  if (middle[1] < same) face->set_boundary_id(bottom);
  if (middle[0] > panel.nx - same) face->set_boundary_id(right);
}

}  // namespace

void make_mesh(const Panel& panel, Triangulation<2>& mesh) {
  Vertices vertices;
  std::vector<CellData<2>> cells;
  for (unsigned int hole = 0; hole < panel.n_holes(); ++hole) add_square(panel, panel.center(hole), vertices, cells);
  mesh.create_triangulation(vertices.all, cells, {});
  for (const auto& cell : mesh.active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      describe_face(panel, panel.hole_of(cell->active_cell_index()), face, mesh);
}

}  // namespace fastjoint::peer
