// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/plate_solution_geometry.hpp"

#include <fmt/format.h>

#include "common/count.hpp"
#include "common/errors.hpp"

namespace fastjoint::formats {
namespace {

constexpr int n_sides_of_quad = 4;

void write_mesh(h5::Writer& file, const pfem::Mesh& mesh, const std::string& length) {
  Eigen::MatrixXi arc_nodes(mesh.arcs.size(), 2);
  Eigen::MatrixXd arc_center(arc_nodes.rows(), 2);
  for (Eigen::Index i = 0; i < arc_nodes.rows(); ++i) {
    const auto& arc = mesh.arcs[i];
    arc_nodes.row(i) << arc.a, arc.b;
    arc_center.row(i) = arc.center.transpose();
  }
  file.write("mesh/nodes", Eigen::MatrixXd(mesh.nodes.transpose()), {length, "x and y of each node"});
  file.write("mesh/quads", Eigen::MatrixXi(mesh.quads.transpose()), {"1", "nodes of each element, counter-clockwise"});
  file.write("mesh/arc_nodes", arc_nodes, {"1", "ends of each edge that is an arc"});
  file.write("mesh/arc_center", arc_center, {length, "centre of each arc"});
  file.write("mesh/thickness", mesh.thickness, {length, "thickness of each element"});
  file.write("mesh/material", mesh.material, {"1", "material of each element, index into elasticity"});
}

void check_indices(const h5::Reader& file, const char* dataset, const Eigen::MatrixXi& indices, int n) {
  if (indices.size() > 0 && (indices.minCoeff() < 0 || indices.maxCoeff() >= n))
    throw FileError(fmt::format("{}:{}: an index is outside 0..{}", file.path(), dataset, n - 1));
}

pfem::Mesh read_mesh(const h5::Reader& file, const std::string& length) {
  pfem::Mesh mesh;
  mesh.nodes = file.matrix("mesh/nodes", h5::any, 2, length).transpose();
  mesh.quads = file.integer_matrix("mesh/quads", h5::any, 4).transpose();
  const Eigen::MatrixXi nodes = file.integer_matrix("mesh/arc_nodes", h5::any, 2);
  const Eigen::MatrixXd center = file.matrix("mesh/arc_center", nodes.rows(), 2, length);
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) mesh.arcs.push_back({nodes(i, 0), nodes(i, 1), center.row(i)});
  mesh.thickness = file.vector("mesh/thickness", mesh.n_elements(), length);
  mesh.material = file.integers("mesh/material", mesh.n_elements());
  check_indices(file, "mesh/quads", mesh.quads, mesh.n_nodes());
  check_indices(file, "mesh/arc_nodes", nodes, mesh.n_nodes());
  return mesh;
}

void write_elasticity(h5::Writer& file, const PlateSolution& a) {
  const std::vector<Eigen::MatrixXd> stack(a.elasticity.begin(), a.elasticity.end());
  file.write("elasticity", stack, 3, 3,
             {unit(a.header.units, -2, 1), "stress (x, y, xy) per strain (x, y, engineering xy) of each material"});
}

void read_elasticity(const h5::Reader& file, PlateSolution& a) {
  for (const auto& D : file.stack("elasticity", h5::any, 3, 3, unit(a.header.units, -2, 1))) a.elasticity.push_back(D);
  const int n = count_of(a.elasticity);
  check_indices(file, "mesh/material", Eigen::MatrixXi(a.mesh.material), n);
}

/// Sides of elements in rows (owner, element, side) of a dataset, owners ascending.
class SideTable {
 public:
  void add(std::size_t owner, const std::vector<pfem::Side>& sides) {
    for (const auto& side : sides) rows_.insert(rows_.end(), {static_cast<int>(owner), side.element, side.local_edge});
  }
  [[nodiscard]] Eigen::MatrixXi matrix() const {
    return Eigen::Map<const Eigen::MatrixXi>(rows_.data(), 3, std::ssize(rows_) / 3).transpose();
  }
  /// Calls add(owner, side) for every row of a file.
  template <class Add>
  static void read(const h5::Reader& file, const char* dataset, std::size_t n_owners, int n_elements, Add add) {
    const Eigen::MatrixXi rows = file.integer_matrix(dataset, h5::any, 3);
    const Eigen::RowVector3i limit(static_cast<int>(n_owners), n_elements, n_sides_of_quad);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      if ((rows.row(i).array() < 0).any() || (rows.row(i).array() >= limit.array()).any())
        throw FileError(fmt::format("{}:{}: row {} names a side that does not exist", file.path(), dataset, i));
      add(rows(i, 0), pfem::Side{rows(i, 1), rows(i, 2)});
    }
  }

 private:
  std::vector<int> rows_;
};

void write_holes(h5::Writer& file, const PlateSolution& a, const std::string& length) {
  const Eigen::Index n = a.hole_id.size();
  Eigen::MatrixXd center(n, 2);
  Eigen::VectorXd radius(n), modulus(n);
  std::vector<double> arcs;
  SideTable rims;
  for (Eigen::Index i = 0; i < n; ++i) {
    center.row(i) = a.hole_rim[i].center.transpose();
    radius[i] = a.hole_rim[i].radius;
    modulus[i] = a.hole_spring[i].modulus;
    for (const auto& range : a.hole_spring[i].acts)
      arcs.insert(arcs.end(), {static_cast<double>(i), range.from, range.to});
    rims.add(i, a.hole_rim[i].sides);
  }
  const Eigen::MatrixXd rows = Eigen::Map<const Eigen::MatrixXd>(arcs.data(), 3, std::ssize(arcs) / 3).transpose();
  file.write("hole/id", a.hole_id, {"1", "holes in the order of the input"});
  file.write("hole/center", center, {length, "x and y of each hole's centre"});
  file.write("hole/radius", radius, {length, "radius of each hole"});
  file.write("hole/rim", rims.matrix(),
             {"1", "sides of elements on rims: hole, element, local edge (0 bottom, then counter-clockwise)"});
  file.write("hole/modulus", modulus, {unit(a.header.units, -3, 1), "modulus of the distributed springs, 0 if none"});
  file.write("hole/sprung", Eigen::VectorXi(rows.col(0).cast<int>()), {"1", "hole of each arc on which springs act"});
  file.write("hole/arc", Eigen::MatrixXd(rows.rightCols(2)), {"rad", "where it starts and ends, counter-clockwise"});
}

void read_springs(const h5::Reader& file, PlateSolution& a) {
  const Eigen::Index n = a.hole_id.size();
  const Eigen::VectorXd modulus = file.vector("hole/modulus", n, unit(a.header.units, -3, 1));
  for (const double k : modulus) a.hole_spring.push_back({k, {}});
  const Eigen::VectorXi sprung = file.integers("hole/sprung", h5::any);
  check_indices(file, "hole/sprung", Eigen::MatrixXi(sprung), static_cast<int>(n));
  const Eigen::MatrixXd arc = file.matrix("hole/arc", sprung.size(), 2, "rad");
  for (Eigen::Index i = 0; i < sprung.size(); ++i) a.hole_spring[sprung[i]].acts.push_back({arc(i, 0), arc(i, 1)});
}

/// Where the rim of a hole runs follows from the mesh as well.
void check_rims(const h5::Reader& file, const PlateSolution& a) {
  const auto edges = pfem::find_edges(a.mesh);
  for (std::size_t hole = 0; hole < a.hole_rim.size(); ++hole) {
    const rim::Rim& rim = a.hole_rim[hole];
    if (!(rim.sides == rim::find_rim(a.mesh, edges, rim.center, rim.radius).sides))
      throw FileError(fmt::format(
          "{}:hole/rim: the sides of hole \"{}\" are not those arcs of the mesh that have its centre and its radius {}",
          file.path(), a.hole_id[hole], rim.radius));
  }
}

void read_holes(const h5::Reader& file, PlateSolution& a, const std::string& length) {
  a.hole_id = file.strings("hole/id", h5::any);
  const Eigen::Index n = a.hole_id.size();
  const Eigen::MatrixXd center = file.matrix("hole/center", n, 2, length);
  const Eigen::VectorXd radius = file.vector("hole/radius", n, length);
  for (Eigen::Index hole = 0; hole < n; ++hole) a.hole_rim.push_back({center.row(hole), radius[hole], {}});
  SideTable::read(file, "hole/rim", a.hole_id.size(), a.mesh.n_elements(),
                  [&](std::size_t hole, const pfem::Side& side) { a.hole_rim[hole].sides.push_back(side); });
  check_rims(file, a);
  read_springs(file, a);
}

void write_sections(h5::Writer& file, const PlateSolution& a) {
  const Eigen::Index n = a.sections.size();
  Eigen::VectorXi hole(n);
  std::vector<std::string> side;
  SideTable sides;
  for (std::size_t i = 0; i < a.sections.size(); ++i) {
    hole[i] = a.sections[i].hole;
    side.push_back(a.sections[i].side);
    sides.add(i, a.sections[i].sides);
  }
  file.write("section/hole", hole, {"1", "index in hole/id of the hole that each section lies beside"});
  file.write("section/side", side, {"1", "on which side of it: +x, -x, +y or -y"});
  file.write("section/sides", sides.matrix(), {"1", "sides of elements: section, element, local edge"});
}

void read_sections(const h5::Reader& file, PlateSolution& a) {
  const Eigen::VectorXi hole = file.integers("section/hole", h5::any);
  check_indices(file, "section/hole", Eigen::MatrixXi(hole), count_of(a.hole_id));
  const auto side = file.strings("section/side", hole.size());
  for (Eigen::Index i = 0; i < hole.size(); ++i) a.sections.push_back({hole[i], side[i], {}});
  SideTable::read(file, "section/sides", a.sections.size(), a.mesh.n_elements(),
                  [&](std::size_t section, const pfem::Side& s) { a.sections[section].sides.push_back(s); });
}

}  // namespace

void write_geometry(h5::Writer& file, const PlateSolution& a) {
  const std::string length = unit(a.header.units, 1, 0);
  write_mesh(file, a.mesh, length);
  write_elasticity(file, a);
  file.write("unknown", Eigen::MatrixXi(a.unknown.transpose()),
             {"1", "of u_x and u_y of each function: >= 0 plate unknown, -1 zero, -2 - i displacement i"});
  write_holes(file, a, length);
  write_sections(file, a);
}

void read_geometry(const h5::Reader& file, PlateSolution& a) {
  const std::string length = unit(a.header.units, 1, 0);
  a.mesh = read_mesh(file, length);
  read_elasticity(file, a);
  a.unknown = file.integer_matrix("unknown", h5::any, 2).transpose();
  read_holes(file, a, length);
  read_sections(file, a);
}

}  // namespace fastjoint::formats
