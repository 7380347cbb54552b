// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/plate_solution.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/errors.hpp"

namespace fastjoint::formats {
namespace {

constexpr const char* format = "plate-solution";
constexpr int major = 1;
constexpr int minor = 0;

using Sparse = Eigen::SparseMatrix<double>;

void write_sparse(h5::Writer& file, const std::string& group, const Sparse& A, const h5::Meta& meta) {
  const auto nnz = A.nonZeros();
  file.write(group + "/start", Eigen::VectorXi(Eigen::Map<const Eigen::VectorXi>(A.outerIndexPtr(), A.cols() + 1)),
             {"1", "where each column starts in row and value"});
  file.write(group + "/row", Eigen::VectorXi(Eigen::Map<const Eigen::VectorXi>(A.innerIndexPtr(), nnz)),
             {"1", "row of each entry, ascending within a column"});
  file.write(group + "/value", Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(A.valuePtr(), nnz)), meta);
}

Sparse read_sparse(const h5::Reader& file, const std::string& group, Eigen::Index rows, Eigen::Index cols,
                   const std::string& unit) {
  const Eigen::VectorXi start = file.integers(group + "/start", cols + 1);
  const Eigen::VectorXi row = file.integers(group + "/row", h5::any);
  const Eigen::VectorXd value = file.vector(group + "/value", row.size(), unit);
  const bool steps_up = start[0] == 0 && start[cols] == row.size() && std::is_sorted(start.begin(), start.end());
  const bool fits = row.size() == 0 || (row.minCoeff() >= 0 && row.maxCoeff() < rows);
  if (!steps_up || !fits)
    throw FileError(fmt::format("{}:{}: is not a sparse matrix of {} x {}", file.path(), group, rows, cols));
  return Eigen::Map<const Sparse>(rows, cols, row.size(), start.data(), row.data(), value.data());
}

void write_mesh(h5::Writer& file, const pfem::Mesh& mesh, const std::string& length) {
  Eigen::MatrixXi arc_nodes(static_cast<Eigen::Index>(mesh.arcs.size()), 2);
  Eigen::MatrixXd arc_center(arc_nodes.rows(), 2);
  for (Eigen::Index i = 0; i < arc_nodes.rows(); ++i) {
    const auto& arc = mesh.arcs[static_cast<std::size_t>(i)];
    arc_nodes.row(i) << arc.a, arc.b;
    arc_center.row(i) = arc.center.transpose();
  }
  file.write("mesh/nodes", Eigen::MatrixXd(mesh.nodes.transpose()), {length, "x and y of each node"});
  file.write("mesh/quads", Eigen::MatrixXi(mesh.quads.transpose()), {"1", "nodes of each element, counter-clockwise"});
  file.write("mesh/arc_nodes", arc_nodes, {"1", "ends of each edge that is an arc"});
  file.write("mesh/arc_center", arc_center, {length, "centre of each arc"});
  file.write("mesh/thickness", mesh.thickness, {length, "thickness of each element"});
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
  check_indices(file, "mesh/quads", mesh.quads, mesh.n_nodes());
  check_indices(file, "mesh/arc_nodes", nodes, mesh.n_nodes());
  return mesh;
}

void write_holes(h5::Writer& file, const PlateSolution& a, const std::string& length) {
  const auto n = static_cast<Eigen::Index>(a.hole_id.size());
  Eigen::MatrixXd center(n, 2);
  Eigen::VectorXd radius(n);
  std::vector<int> sides;
  for (Eigen::Index hole = 0; hole < n; ++hole) {
    const auto& rim = a.hole_rim[static_cast<std::size_t>(hole)];
    center.row(hole) = rim.center.transpose();
    radius[hole] = rim.radius;
    for (const auto& side : rim.sides)
      sides.insert(sides.end(), {static_cast<int>(hole), side.element, side.local_edge});
  }
  file.write("hole/id", a.hole_id, {"1", "holes in the order of the input"});
  file.write("hole/center", center, {length, "x and y of each hole's centre"});
  file.write("hole/radius", radius, {length, "radius of each hole"});
  const auto n_sides = static_cast<Eigen::Index>(sides.size()) / 3;
  file.write("hole/rim", Eigen::MatrixXi(Eigen::Map<Eigen::MatrixXi>(sides.data(), 3, n_sides).transpose()),
             {"1", "sides of elements on rims: hole, element, local edge (0 bottom, then counter-clockwise)"});
}

void read_holes(const h5::Reader& file, PlateSolution& a, const std::string& length) {
  a.hole_id = file.strings("hole/id", h5::any);
  const auto n = static_cast<Eigen::Index>(a.hole_id.size());
  const Eigen::MatrixXd center = file.matrix("hole/center", n, 2, length);
  const Eigen::VectorXd radius = file.vector("hole/radius", n, length);
  for (Eigen::Index hole = 0; hole < n; ++hole) a.hole_rim.push_back({center.row(hole), radius[hole], {}});
  const Eigen::MatrixXi sides = file.integer_matrix("hole/rim", h5::any, 3);
  for (Eigen::Index i = 0; i < sides.rows(); ++i) {
    if (sides(i, 0) < 0 || sides(i, 0) >= n || sides(i, 1) < 0 || sides(i, 1) >= a.mesh.n_elements() ||
        sides(i, 2) < 0 || sides(i, 2) >= 4)
      throw FileError(fmt::format("{}:hole/rim: row {} names a side that does not exist", file.path(), i));
    a.hole_rim[static_cast<std::size_t>(sides(i, 0))].sides.push_back({sides(i, 1), sides(i, 2)});
  }
}

void write_names(h5::Writer& file, const PlateSolution& a) {
  file.write("supported", a.supported, {"1", "directions in which a support holds the plate"});
  file.write("p", a.p, {"1", "polynomial degree of the trunk space"});
  file.write("ndof", a.ndof, {"1", "free plate unknowns at that degree"});
  file.write("external/id", a.external_id, {"1", "external boundaries that move as one"});
  file.write("external/direction", a.external_direction, {"1", "their directions"});
  file.write("traction/id", a.traction_id, {"1", "external boundaries under uniform traction"});
  file.write("traction/direction", a.traction_direction, {"1", "their directions"});
  file.write("disc/hole", a.disc_hole, {"1", "hole of each disc unknown"});
  file.write("disc/direction", a.disc_direction, {"1", "direction of each disc unknown"});
  file.write("friction/hole", a.friction_hole, {"1", "hole of each friction case"});
  file.write("friction/bearing", a.friction_bearing, {"1", "side of the rim that bears"});
}

void read_names(const h5::Reader& file, PlateSolution& a) {
  const auto count = [](const std::vector<std::string>& names) { return static_cast<Eigen::Index>(names.size()); };
  a.supported = file.strings("supported", h5::any);
  a.p = file.integers("p", h5::any);
  a.ndof = file.integers("ndof", a.p.size());
  a.external_id = file.strings("external/id", h5::any);
  a.external_direction = file.strings("external/direction", count(a.external_id));
  a.traction_id = file.strings("traction/id", h5::any);
  a.traction_direction = file.strings("traction/direction", count(a.traction_id));
  a.disc_hole = file.strings("disc/hole", h5::any);
  a.disc_direction = file.strings("disc/direction", count(a.disc_hole));
  a.friction_hole = file.strings("friction/hole", h5::any);
  a.friction_bearing = file.strings("friction/bearing", count(a.friction_hole));
  for (const auto& hole : a.friction_hole)
    if (std::find(a.hole_id.begin(), a.hole_id.end(), hole) == a.hole_id.end())
      throw FileError(fmt::format("{}:friction/hole: \"{}\" is not in hole/id", file.path(), hole));
}

std::string case_group(int p) { return fmt::format("p{}/", p); }

}  // namespace

void write(const std::string& path, const PlateSolution& a) {
  const Units& units = a.header.units;
  const std::string length = unit(units, 1, 0);
  const std::string stiffness = unit(units, -1, 1);
  const std::string area = unit(units, 2, 0);
  const std::string compliance = unit(units, 1, -1);
  h5::Writer file(path, format, major, minor);
  write_header(file, a.header);
  write_mesh(file, a.mesh, length);
  write_holes(file, a, length);
  write_names(file, a);
  write_sparse(file, "K_fc", a.K_fc, {stiffness, "couples plate unknowns to externals and discs"});
  file.write("K_cc", a.K_cc, {stiffness, "stiffness among externals and discs with the plate held"});
  write_sparse(file, "L_f", a.L_f, {area, "loads of the unit friction cases on the plate unknowns"});
  file.write("L_c", a.L_c, {area, "loads of the unit friction cases on externals and discs"});
  write_sparse(file, "T_f", a.T_f, {"1", "loads of a unit total force on each traction boundary"});
  file.write("T_c", a.T_c, {"1", "the same on externals and discs"});
  file.write("friction/probe", a.friction_probe, {unit(units, -2, 1), "weights of the friction cases in the probe"});
  for (Eigen::Index i = 0; i < a.p.size(); ++i) {
    const auto& cases = a.cases[static_cast<std::size_t>(i)];
    const std::string group = case_group(a.p[i]);
    file.write_transposed(group + "U", cases.U, {"1", "plate unknowns per unit displacement of an external or disc"});
    file.write_transposed(group + "V", cases.V, {compliance, "plate unknowns per unit force on a traction boundary"});
    file.write(group + "probe", cases.probe, {length, "plate unknowns under the probe"});
  }
  file.commit();
}

PlateSolution read_plate_solution(const std::string& path) {
  const h5::Reader file(path, format, major);
  PlateSolution a;
  a.header = read_header(file);
  const Units& units = a.header.units;
  const std::string length = unit(units, 1, 0);
  a.mesh = read_mesh(file, length);
  read_holes(file, a, length);
  read_names(file, a);
  if (a.p.size() == 0) throw FileError(fmt::format("{}:p: holds no degree", path));
  const auto n = a.ndof[a.p.size() - 1];
  const auto nc = static_cast<Eigen::Index>(a.external_id.size() + a.disc_hole.size());
  const auto h = static_cast<Eigen::Index>(a.friction_hole.size());
  const auto q = static_cast<Eigen::Index>(a.traction_id.size());
  a.K_fc = read_sparse(file, "K_fc", n, nc, unit(units, -1, 1));
  a.K_cc = file.matrix("K_cc", nc, nc, unit(units, -1, 1));
  a.L_f = read_sparse(file, "L_f", n, h, unit(units, 2, 0));
  a.L_c = file.matrix("L_c", nc, h, unit(units, 2, 0));
  a.T_f = read_sparse(file, "T_f", n, q, "1");
  a.T_c = file.matrix("T_c", nc, q, "1");
  a.friction_probe = file.vector("friction/probe", h, unit(units, -2, 1));
  for (Eigen::Index i = 0; i < a.p.size(); ++i) {
    const std::string group = case_group(a.p[i]);
    a.cases.push_back({file.transposed(group + "U", nc, a.ndof[i], "1"),
                       file.transposed(group + "V", q, a.ndof[i], unit(units, 1, -1)),
                       file.vector(group + "probe", a.ndof[i], length)});
  }
  return a;
}

}  // namespace fastjoint::formats
