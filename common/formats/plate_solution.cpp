// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/plate_solution.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/count.hpp"
#include "common/errors.hpp"

namespace fastjoint::formats {
namespace {

using Eigen::Index;
using h5::any;
using h5::Column;

const h5::Format solution_format{"plate-solution", 5, 7};
constexpr const char* per_case = "per unit of the case";

template <class File, class Mesh>
void mesh_datasets(File& file, Mesh& a, Index n_materials, const std::string& length) {
  file("mesh/nodes", a.nodes.transpose(), {any, 2}, length, "x and y of each node");
  const h5::Allowed node = h5::index_into(a.n_nodes());
  file("mesh/quads", a.quads.transpose(), {any, 4}, "1", "nodes of each element, counter-clockwise", node);
  file("mesh/arc_nodes", Column{a.arcs, [](auto& arc) { return std::tie(arc.a, arc.b); }}, {any, 2}, "1",
       "nodes at both ends of each edge that is an arc", node);
  file("mesh/arc_center", Column{a.arcs, &pfem::Arc::center}, {std::ssize(a.arcs), 2}, length, "centre of each arc");
  file("mesh/thickness", a.thickness, {a.n_elements()}, length, "thickness of each element");
  file("mesh/material", a.material, {a.n_elements()}, "1", "material of each element, index into elasticity",
       h5::index_into(n_materials));
}

/// An item of a list, with the index of its owner.
template <class Item>
struct Owned {
  int owner;
  Item item;
};

/// Concatenates the lists that are members of `owners`.
template <class Owners, class Owner, class Item>
std::vector<Owned<Item>> joined(const Owners& owners, std::vector<Item> Owner::*list) {
  std::vector<Owned<Item>> result;
  for (int i = 0; i < count_of(owners); ++i)
    for (const Item& item : owners[i].*list) result.push_back({static_cast<int>(i), item});
  return result;
}

/// One dataset of the sides of elements of all holes or sections: owner, element, local edge.
template <class File, class Owners, class Owner>
void side_dataset(File& file, const char* name, Owners& owners, std::vector<pfem::Side> Owner::*sides, int n_elements,
                  const char* meaning) {
  auto rows = joined(owners, sides);
  const auto numbers = [](auto& row) { return std::tie(row.owner, row.item.element, row.item.local_edge); };
  file(name, Column{rows, numbers}, {any, 3}, "1", meaning);
  if constexpr (File::reads)
    for (const auto& [owner, side] : rows) {
      constexpr int n_edges = 4;
      if (std::min({owner, side.element, side.local_edge}) < 0 || owner >= std::ssize(owners) ||
          side.element >= n_elements || side.local_edge >= n_edges)
        throw FileError(fmt::format("{}:{}: names side {} of element {} for item {}, which do not all exist",
                                    file.path(), name, side.local_edge, side.element, owner));
      (owners[owner].*sides).push_back(side);
    }
}

template <class File, class Solution>
void hole_datasets(File& file, Solution& a, const std::string& length) {
  file("hole/id", a.hole_id, {any}, "1", "holes in the order of the input");
  const Index n = a.hole_id.size();
  file("hole/center", Column{a.hole_rim, &rim::Rim::center}, {n, 2}, length, "x and y of each hole's centre");
  file("hole/radius", Column{a.hole_rim, &rim::Rim::radius}, {n}, length, "radius of each hole");
  side_dataset(
      file, "hole/rim", a.hole_rim, &rim::Rim::sides, a.mesh.n_elements(),
      "each side of an element on a rim: index in hole/id, element, local edge (0 bottom, then counter-clockwise)");
  file("hole/modulus", Column{a.hole_spring, &rim::HoleSpring::modulus}, {n}, unit(a.header.units, -3, 1),
       "modulus of the distributed springs, 0 if none");
  file("hole/link", Column{a.hole_spring, &rim::HoleSpring::link}, {n}, unit(a.header.units, -1, 1),
       "stiffness of the link at each node of the rim, 0 if none");
  auto arcs = joined(a.hole_spring, &rim::HoleSpring::arcs);
  using Arc = Owned<rim::AngleRange>;
  file("hole/sprung", Column{arcs, &Arc::owner}, {any}, "1",
       "index in hole/id of the hole of each arc on which springs act", h5::index_into(n));
  file("hole/arc", Column{arcs, [](auto& arc) { return std::tie(arc.item.from, arc.item.to); }}, {std::ssize(arcs), 2},
       "rad", "start and end of each arc on which springs act, counter-clockwise from x");
  if constexpr (File::reads)
    for (const auto& [hole, range] : arcs) a.hole_spring[hole].arcs.push_back(range);
}

template <class File, class Solution>
void geometry_datasets(File& file, Solution& a) {
  const std::string length = unit(a.header.units, 1, 0);
  file("elasticity", a.elasticity, {any, 3, 3}, unit(a.header.units, -2, 1),
       "stress (x, y, xy) per strain (x, y, engineering xy) of each material");
  mesh_datasets(file, a.mesh, std::ssize(a.elasticity), length);
  hole_datasets(file, a, length);
  file("section/hole", Column{a.sections, &rim::Section::hole}, {any}, "1",
       "index in hole/id of the hole that each section is next to", h5::index_into(std::ssize(a.hole_id)));
  file("section/side", Column{a.sections, &rim::Section::side}, {std::ssize(a.sections)}, "1",
       "side of the hole that each section lies on", h5::one_of(side_names));
  tip_datasets(file, a.tips, a.header.units);
  side_dataset(file, "section/sides", a.sections, &rim::Section::sides, a.mesh.n_elements(),
               "each side of an element along a section: index in section/hole, element, local edge");
}

template <class File, class Solution>
void name_datasets(File& file, Solution& a) {
  file("supported", a.supported, {any}, "1", "directions in which a support fixes the plate");
  unit_case_datasets(file, a, &a.hole_id);
  file("point/vertex", Column{a.points, &rim::PointSpring::vertex}, {any}, "1",
       "vertex of the mesh of each point spring", h5::index_into(a.mesh.n_nodes()));
  const Index n_points = a.points.size();
  file("point/disc", Column{a.points, &rim::PointSpring::disc}, {n_points}, "1",
       "index in disc/hole of the disc that the spring connects it to, along the disc's direction",
       h5::index_into(std::ssize(a.disc_hole)));
  file("point/stiffness", Column{a.points, &rim::PointSpring::stiffness}, {n_points}, unit(a.header.units, -1, 1),
       "stiffness of each of these springs");
}

/// A group of three datasets.
template <class File, class Sparse>
void sparse_datasets(File& file, const std::string& group, Sparse& A, Index rows, Index cols, const std::string& unit,
                     const char* meaning) {
  Eigen::VectorXi start, row;
  Eigen::VectorXd value;
  if constexpr (!File::reads) {
    start = Eigen::Map<const Eigen::VectorXi>(A.outerIndexPtr(), cols + 1);
    row = Eigen::Map<const Eigen::VectorXi>(A.innerIndexPtr(), A.nonZeros());
    value = Eigen::Map<const Eigen::VectorXd>(A.valuePtr(), A.nonZeros());
  }
  file(group + "/start", start, {cols + 1}, "1", "where each column starts in row and value");
  file(group + "/row", row, {any}, "1", "row of each entry, ascending within a column");
  file(group + "/value", value, {row.size()}, unit, meaning);
  if constexpr (File::reads) {
    bool fits = start[0] == 0 && start[cols] == row.size() && std::is_sorted(start.begin(), start.end()) &&
                (row.size() == 0 || (row.minCoeff() >= 0 && row.maxCoeff() < rows));
    for (Index j = 0; fits && j < cols; ++j)
      fits = std::adjacent_find(&row[0] + start[j], &row[0] + start[j + 1], std::greater_equal<>()) ==
             &row[0] + start[j + 1];
    if (!fits) throw FileError(fmt::format("{}:{}: is not a sparse matrix of {} x {}", file.path(), group, rows, cols));
    A = Eigen::Map<const Sparse>(rows, cols, row.size(), start.data(), row.data(), value.data());
  }
}

/// Datasets of one degree.
/// @param w, s, t Numbers of its waves, sections and crack tips.
template <class File, class Cases>
void case_datasets(File& file, const std::string& group, Cases& a, Index nc, Index h, Index q, Index n_cases, Index w,
                   Index s, Index t, const Units& units) {
  file(group + "S", a.S, {nc, nc}, unit(units, -1, 1),
       "force on externals, then discs, per unit displacement of each, before rounding is taken out");
  file(group + "R", a.R, {nc, h}, unit(units, 2, 0), "force on externals, then discs, by each unit friction case");
  file(group + "T", a.T, {nc, q}, "1", "force on externals, then discs, by a unit force of each traction");
  file(group + "C_t", a.C_t, {q, q}, unit(units, 1, -1),
       "mean displacement of each traction boundary by a unit force of each");
  file(group + "W", a.W, {w, n_cases}, per_case,
       "integral over the rim of the disc's displacement relative to the sheet times the distribution of each wave, "
       "normal "
       "for pressures and tangential for shears, in each unit case");
  file(group + "N", a.N, {s, n_cases}, per_case, "normal force over each section in each unit case, tension positive");
  file(group + "V", a.V, {s, n_cases}, per_case,
       "shear force over each section in each unit case, positive where the shear stress xy is",
       h5::infinite_too.or_else(h5::infinite));
  file(group + "K", a.K, {2 * t, n_cases}, per_case,
       "stress intensity factors of each crack tip in each unit case, K_I of all tips, then K_II", h5::or_else(0));
}

template <class File, class Solution>
void solution_datasets(File& file, Solution& a) {
  header(file, a.header);
  const Units& units = a.header.units;
  const std::string length = unit(units, 1, 0), force = unit(units, 0, 1);
  const std::string stress = unit(units, -2, 1), stiffness = unit(units, -1, 1);
  geometry_datasets(file, a);
  name_datasets(file, a);
  const Index n = a.ndof[a.ndof.size() - 1], nc = std::ssize(a.external_id) + std::ssize(a.disc_hole);
  const Index k = a.n_loaded_waves(), w = a.n_waves(), h = a.friction_hole.size(), q = a.traction_id.size();
  file("unknown", a.unknown.transpose(), {h5::some, 2}, "1",
       "what u_x and u_y of each function are: >= 0 plate unknown, -1 zero, -2 - i displacement i",
       h5::integers(-1 - nc, n - 1));
  file("held_stiffness", a.held_stiffness, {nc}, stiffness,
       "stiffness of each external, then disc, with all plate unknowns fixed");
  sparse_datasets(file, "T_f", a.T_f, n, q, "1", "load on plate unknowns by a unit force of each traction");
  if constexpr (File::reads) a.cases.resize(a.p.size());
  for (int i = 0; i < count_of(a.cases); ++i)
    case_datasets(file, fmt::format("p{}/", a.p[i]), a.cases[i], nc, h, q, a.n_cases(), a.has_stresses(i) ? w : k,
                  a.has_stresses(i) ? std::ssize(a.sections) : 0, std::ssize(a.tips), units);
  file("probe/displacement", a.probe.displacement, {nc}, length,
       "displacements of externals, then discs, in a state that is solved separately to check S and T");
  file("probe/wave", a.probe.wave, {k}, stress, "amplitudes of loaded waves in a second state, to check W");
  file("probe/friction", a.probe.friction, {h}, stress, "amplitudes of friction cases in the second state, to check R");
  file("probe/force", a.probe.force, {nc}, force, "force on externals, then discs, in the first");
  file("probe/friction_force", a.probe.friction_force, {nc}, force, "force on externals, then discs, in the second");
  file("probe/moment", a.probe.moment, {w}, unit(units, 3, 0),
       "integral over the rim of the disc's displacement relative to the sheet times the distribution of each wave, in "
       "the "
       "first");
  file("probe/friction_moment", a.probe.friction_moment, {w}, unit(units, 3, 0), "the same in the second");
  file("probe/traction_work", a.probe.traction_work, {q}, length, "work of each unit traction in the first");
  file("probe/rounding", a.probe.rounding, {1}, stiffness, "what rounding may change of S, estimated by the first",
       h5::or_else(0));
}

}  // namespace

void write(const std::string& path, const PlateSolution& a) {
  h5::Writer file(path, solution_format);
  solution_datasets(file, a);
  file.commit();
}

PlateSolution read_plate_solution(const std::string& path) {
  h5::Reader file(path, solution_format);
  PlateSolution a;
  solution_datasets(file, a);
  check_consistent(path, a);
  return a;
}

}  // namespace fastjoint::formats
