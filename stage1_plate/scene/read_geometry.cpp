// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/scene/read_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "common/count.hpp"

namespace fastjoint::stage1 {
namespace {

using input::Value;

/// Returns a reader of a material's name as its index.
auto index_among(const std::vector<Material>& materials) {
  return [&](const Value& value) { return read_id(value, materials); };
}

/// Finds the material's name, which may be omitted if there is only one material.
std::optional<Value> find_material(const Value& geometry, const std::vector<Material>& materials) {
  auto value = geometry.find("material");
  if (!value && materials.size() > 1) return geometry.at("material");
  return value;
}

std::vector<double> read_lines(const Value& value) {
  const auto items = value.items(2);
  std::vector<double> lines;
  for (const auto& item : items) {
    const double line = read_coordinate(item);
    if (!lines.empty() && !(line > lines.back())) item.not_allowed("cell lines in ascending order");
    lines.push_back(line);
  }
  return lines;
}

template <class T, class Read>
Eigen::VectorX<T> read_list(const Value& value, std::size_t n, const Read& read) {
  Eigen::VectorX<T> list(n);
  int i = 0;
  for (const auto& item : value.items(n, n)) list[i++] = read(item);
  return list;
}

/// Reads one value for all cells, or a table with one row per y-interval, bottom to top.
template <class Table, class Read>
void read_cells(const Value& value, Table& table, const Read& read) {
  if (!value.is_array()) {
    table.setConstant(read(value));
    return;
  }
  const std::size_t rows = table.rows();
  int row = 0;
  for (const auto& line : value.items(rows, rows))
    table.row(row++) = read_list<typename Table::Scalar>(line, table.cols(), read).transpose();
}

double read_thickness(const Value& value) { return read_quantity(value); }

GridGeometry read_grid(const Value& value, const std::vector<Material>& materials) {
  value.only({"x", "y", "thickness", "material"});
  GridGeometry grid{read_lines(value.at("x")), read_lines(value.at("y")), {}, {}};
  const int rows = count_of(grid.y) - 1, cols = count_of(grid.x) - 1;
  grid.thickness.resize(rows, cols);
  read_cells(value.at("thickness"), grid.thickness, read_thickness);
  grid.material = Eigen::MatrixXi::Zero(rows, cols);
  if (const auto material = find_material(value, materials))
    read_cells(*material, grid.material, index_among(materials));
  return grid;
}

/// Reads one value for all elements, or a list.
template <class T, class Read>
Eigen::VectorX<T> read_elements(const Value& value, int n, const Read& read) {
  return value.is_array() ? read_list<T>(value, n, read) : Eigen::VectorX<T>::Constant(n, read(value));
}

std::pair<int, int> read_edge(const Value& value, int n_nodes) {
  const auto ends = value.items(2, 2);
  const int a = ends[0].integer(0, n_nodes - 1);
  const int b = ends[1].integer(0, n_nodes - 1);
  if (a == b) value.not_allowed("two different nodes");
  return {a, b};
}

/// Reads a list of at least one edge, each given by its two nodes. Repeated edges are rejected, since their load would
/// count twice.
std::vector<std::pair<int, int>> read_edges(const Value& value, int n_nodes) {
  std::vector<std::pair<int, int>> edges;
  std::map<std::pair<int, int>, std::string> places;  // keys: lower and higher node
  for (const auto& item : value.items(1)) {
    const auto [a, b] = edges.emplace_back(read_edge(item, n_nodes));
    if (const auto [found, is_new] = places.try_emplace(std::minmax(a, b), item.pointer()); !is_new)
      item.fail(fmt::format("the edge between nodes {} and {} stands twice", a, b),
                "each edge once; the other is at " + found->second);
  }
  return edges;
}

Eigen::Vector4i read_quad(const Value& value, int n_nodes) {
  Eigen::Vector4i quad;
  int i = 0;
  for (const auto& item : value.items(4, 4)) {
    quad[i] = item.integer(0, n_nodes - 1);
    if ((quad.head(i).array() == quad[i]).any()) value.not_allowed("four different nodes");
    ++i;
  }
  return quad;
}

MeshGeometry read_mesh(const Value& value, const std::vector<Material>& materials) {
  value.only({"nodes", "quads", "arcs", "thickness", "material", "edges", "sections"});
  MeshGeometry geometry;
  pfem::Mesh& mesh = geometry.mesh;
  const auto nodes = value.at("nodes").items(4);
  mesh.nodes.resize(2, nodes.size());
  for (int i = 0; i < mesh.nodes.cols(); ++i) mesh.nodes.col(i) = read_point(nodes[i]);
  const auto quads = value.at("quads").items(1);
  mesh.quads.resize(4, quads.size());
  for (int i = 0; i < mesh.n_elements(); ++i) mesh.quads.col(i) = read_quad(quads[i], mesh.n_nodes());
  for (const auto& arc : read_items(value, "arcs")) {
    arc.only({"edge", "center"});
    const auto [a, b] = read_edge(arc.at("edge"), mesh.n_nodes());
    mesh.arcs.push_back({a, b, read_point(arc.at("center"))});
  }
  mesh.thickness = read_elements<double>(value.at("thickness"), mesh.n_elements(), read_thickness);
  mesh.material.setZero(mesh.n_elements());
  if (const auto material = find_material(value, materials))
    mesh.material = read_elements<int>(*material, mesh.n_elements(), index_among(materials));
  if (const auto edges = value.find("edges"))
    for (const auto& [name, list] : edges->members()) geometry.edges[name] = read_edges(list, mesh.n_nodes());
  return geometry;
}

int read_hole(const Value& value, const PlateScene& scene) {
  if (scene.holes.empty()) value.fail("the plate has no holes", "sections next to holes");
  return read_id(value, scene.holes);
}

rim::SignedAxis read_side(const Value& value, const PlateScene& scene) {
  const std::string name = value.choice({"+x", "-x", "+y", "-y"});
  const rim::SignedAxis side = rim::signed_axis_named(name);
  const auto& directions = scene.disc_directions;
  if (std::find(directions.begin(), directions.end(), side.axis) == directions.end())
    value.fail(fmt::format("\"{}\", but \"{}\" is not one of \"disc_directions\"", name, rim::name_of(side.axis)),
               fmt::format("\"+{0}\", \"-{0}\"", rim::name_of(directions.front())));
  return side;
}

}  // namespace

std::variant<GridGeometry, MeshGeometry> read_geometry(const Value& value, const std::vector<Material>& materials) {
  value.only({"grid", "mesh"});
  const auto grid = value.find("grid");
  const auto mesh = value.find("mesh");
  if (grid.has_value() == mesh.has_value()) value.not_allowed("either \"grid\" or \"mesh\"");
  if (grid) return read_grid(*grid, materials);
  return read_mesh(*mesh, materials);
}

void read_sections(const Value& root, PlateScene& scene) {
  auto* const geometry = std::get_if<MeshGeometry>(&scene.geometry);
  if (!geometry) return;
  std::set<std::pair<int, rim::SignedAxis>> seen;
  for (const auto& item : read_items(root.at("geometry").at("mesh"), "sections")) {
    item.only({"hole", "side", "edges"});
    MeshSection section{read_hole(item.at("hole"), scene), read_side(item.at("side"), scene),
                        read_edges(item.at("edges"), geometry->mesh.n_nodes())};
    if (!seen.insert({section.hole, section.side}).second)
      item.fail(fmt::format("a second section of hole \"{}\" on its side {}", scene.holes[section.hole].id,
                            rim::name_of(section.side)),
                "one on each side of a hole");
    geometry->sections.push_back(std::move(section));
  }
}

}  // namespace fastjoint::stage1
