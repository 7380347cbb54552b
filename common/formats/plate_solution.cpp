// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/plate_solution.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/formats/plate_solution_geometry.hpp"

namespace fastjoint::formats {
namespace {

constexpr const char* format = "plate-solution";
constexpr int major = 3;
constexpr int minor = 1;

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
  bool fits = row.size() == 0 || (row.minCoeff() >= 0 && row.maxCoeff() < rows);
  for (Eigen::Index j = 0; steps_up && fits && j < cols; ++j)
    fits = ascends(row.segment(start[j], start[j + 1] - start[j]));
  if (!steps_up || !fits)
    throw FileError(fmt::format("{}:{}: is not a sparse matrix of {} x {}", file.path(), group, rows, cols));
  return Eigen::Map<const Sparse>(rows, cols, row.size(), start.data(), row.data(), value.data());
}

void write_names(h5::Writer& file, const PlateSolution& a) {
  file.write("supported", a.supported, {"1", "directions in which a support holds the plate"});
  file.write("p", a.p, {"1", "polynomial degree"});
  file.write("ndof", a.ndof, {"1", "free plate unknowns at that degree"});
  file.write("stress_p", a.stress_p, {"1", "degrees whose stresses are to be extracted"});
  file.write("external/id", a.external_id, {"1", "external boundaries that move as one"});
  file.write("external/direction", a.external_direction, {"1", "their directions"});
  file.write("traction/id", a.traction_id, {"1", "external boundaries under uniform traction"});
  file.write("traction/direction", a.traction_direction, {"1", "their directions"});
  file.write("traction/hole", a.traction_hole, {"1", "hole under cosine pressure, empty for an edge"});
  file.write("disc/hole", a.disc_hole, {"1", "hole of each disc unknown"});
  file.write("disc/direction", a.disc_direction, {"1", "direction of each disc unknown"});
  file.write("friction/hole", a.friction_hole, {"1", "hole of each friction case"});
  file.write("friction/bearing", a.friction_bearing, {"1", "side of the rim that bears"});
}

/// The unknowns of each degree are the first of those of any higher one.
void check_levels(const h5::Reader& file, const PlateSolution& a) {
  constexpr int highest = 8;
  check_degrees(file, "p", a.p, highest);
  if (!std::is_sorted(a.ndof.begin(), a.ndof.end()) || a.ndof[0] < 0)
    throw FileError(
        fmt::format("{}:ndof: is {}, expected numbers that do not fall", file.path(), fmt::join(a.ndof, ", ")));
  if (a.stress_p.size() > 0) check_degrees(file, "stress_p", a.stress_p, highest);
  for (const int p : a.stress_p)
    if (std::find(a.p.begin(), a.p.end(), p) == a.p.end())
      throw FileError(fmt::format("{}:stress_p: {} is not in p", file.path(), p));
}

void read_names(const h5::Reader& file, PlateSolution& a) {
  a.supported = file.strings("supported", h5::any);
  a.p = file.integers("p", h5::any);
  a.ndof = file.integers("ndof", a.p.size());
  a.stress_p = file.integers("stress_p", h5::any);
  a.external_id = file.strings("external/id", h5::any);
  a.external_direction = file.strings("external/direction", count_of(a.external_id));
  a.traction_id = file.strings("traction/id", h5::any);
  a.traction_direction = file.strings("traction/direction", count_of(a.traction_id));
  a.traction_hole = file.strings("traction/hole", count_of(a.traction_id));
  a.disc_hole = file.strings("disc/hole", h5::any);
  a.disc_direction = file.strings("disc/direction", count_of(a.disc_hole));
  a.friction_hole = file.strings("friction/hole", h5::any);
  a.friction_bearing = file.strings("friction/bearing", count_of(a.friction_hole));
  const auto check_hole = [&](const char* dataset, const std::string& hole) {
    if (std::find(a.hole_id.begin(), a.hole_id.end(), hole) == a.hole_id.end())
      throw FileError(fmt::format("{}:{}: \"{}\" is not in hole/id", file.path(), dataset, hole));
  };
  for (const auto& hole : a.friction_hole) check_hole("friction/hole", hole);
  for (const auto& hole : a.traction_hole)
    if (!hole.empty()) check_hole("traction/hole", hole);
  for (const auto& section : a.sections) check_words(file, "section/side", {section.side}, side_names);
  const std::vector<std::string> axes = {"x", "y"};
  check_words(file, "external/direction", a.external_direction, axes);
  check_words(file, "traction/direction", a.traction_direction, axes);
  check_words(file, "disc/direction", a.disc_direction, axes);
  check_words(file, "friction/bearing", a.friction_bearing, side_names);
  check_levels(file, a);
}

void write_loads(h5::Writer& file, const PlateSolution& a) {
  const Units& units = a.header.units;
  const Eigen::Index n = a.contacts.size();
  Eigen::VectorXi hole(n), iterations(n);
  Eigen::VectorXd pressure(n), angle(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Contact& contact = a.contacts[i];
    hole[i] = contact.hole;
    iterations[i] = contact.iterations;
    pressure[i] = contact.peak_pressure;
    angle[i] = contact.peak_angle;
  }
  file.write("contact/hole", hole, {"1", "index in hole/id of each hole whose springs push but do not pull"});
  file.write("contact/iterations", iterations, {"1", "until the ends of its sprung arcs stood still under the loads"});
  file.write("contact/peak_pressure", pressure, {unit(units, -2, 1), "largest pressure on its rim under the loads"});
  file.write("contact/peak_angle", angle, {"rad", "where, counter-clockwise from x"});
  file.write("loads/displacement", a.load_displacement,
             {unit(units, 1, 0), "displacement of each external, then disc, under the loads of the input"});
  file.write("loads/friction", a.load_friction, {unit(units, -2, 1), "peak stress of each friction case under them"});
  file.write("loads/traction", a.load_traction, {unit(units, 0, 1), "force of each traction under them"});
}

void read_loads(const h5::Reader& file, PlateSolution& a) {
  const Units& units = a.header.units;
  const Eigen::VectorXi hole = file.integers("contact/hole", h5::any);
  const auto n = hole.size();
  const Eigen::VectorXi iterations = file.integers("contact/iterations", n);
  const Eigen::VectorXd pressure = file.vector("contact/peak_pressure", n, unit(units, -2, 1));
  const Eigen::VectorXd angle = file.vector("contact/peak_angle", n, "rad");
  for (Eigen::Index i = 0; i < n; ++i) {
    if (hole[i] < 0 || hole[i] >= count_of(a.hole_id))
      throw FileError(fmt::format("{}:contact/hole: {} is not a hole", file.path(), hole[i]));
    a.contacts.push_back({hole[i], iterations[i], pressure[i], angle[i]});
  }
  a.load_displacement = file.matrix("loads/displacement", h5::any, a.K_cc.rows(), unit(units, 1, 0));
  const auto l = a.load_displacement.rows();
  a.load_friction = file.matrix("loads/friction", l, a.L_c.cols(), unit(units, -2, 1));
  a.load_traction = file.matrix("loads/traction", l, a.T_c.cols(), unit(units, 0, 1));
}

std::string case_group(int p) { return fmt::format("p{}/", p); }

void write_cases(h5::Writer& file, const Units& units, const std::string& group, const PlateCases& cases) {
  file.write(group + "E_c", cases.E_c,
             {unit(units, -0.5, 0.5), "unit fields of externals and discs in a basis orthonormal in energy"});
  file.write(group + "E_h", cases.E_h, {unit(units, 2.5, -0.5), "the same of unit friction cases"});
  file.write_transposed(group + "U", cases.U, {"1", "plate unknowns per unit displacement of an external or disc"});
  file.write_transposed(group + "V", cases.V,
                        {unit(units, 1, -1), "plate unknowns per unit force on a traction boundary"});
  file.write_transposed(group + "W", cases.W, {unit(units, 1, 0), "plate unknowns under each unit friction case"});
}

/// The fields of all cases are there where stresses are wanted, else none of externals, discs and friction.
void check_fields(const h5::Reader& file, const PlateSolution& a, int p, const PlateCases& cases) {
  const bool wanted = std::find(a.stress_p.begin(), a.stress_p.end(), p) != a.stress_p.end();
  const auto check = [&](const char* name, Eigen::Index stored, Eigen::Index all) {
    if (const auto expected = wanted ? all : 0; stored != expected)
      throw FileError(fmt::format("{}:{}{}: holds {} fields, expected {}, since stress_p has {}p = {}", file.path(),
                                  case_group(p), name, stored, expected, wanted ? "" : "no ", p));
  };
  check("U", cases.U.cols(), a.K_cc.rows());
  check("W", cases.W.cols(), a.L_c.cols());
}

PlateCases read_cases(const h5::Reader& file, const PlateSolution& a, Eigen::Index level) {
  const Units& units = a.header.units;
  const auto nc = a.K_cc.rows();
  const std::string group = case_group(a.p[level]);
  PlateCases cases{file.matrix(group + "E_c", nc, nc, unit(units, -0.5, 0.5)),
                   file.matrix(group + "E_h", a.L_c.cols(), nc, unit(units, 2.5, -0.5)),
                   file.transposed(group + "U", h5::any, a.ndof[level], "1"),
                   file.transposed(group + "V", a.T_c.cols(), a.ndof[level], unit(units, 1, -1)),
                   file.transposed(group + "W", h5::any, a.ndof[level], unit(units, 1, 0))};
  check_fields(file, a, a.p[level], cases);
  return cases;
}

}  // namespace

void write(const std::string& path, const PlateSolution& a) {
  const Units& units = a.header.units;
  const std::string length = unit(units, 1, 0);
  const std::string stiffness = unit(units, -1, 1);
  const std::string area = unit(units, 2, 0);
  h5::Writer file(path, format, major, minor);
  write_header(file, a.header);
  write_space(file, a.space);
  write_geometry(file, a);
  write_names(file, a);
  write_sparse(file, "K_fc", a.K_fc, {stiffness, "couples plate unknowns to externals and discs"});
  file.write("K_cc", a.K_cc, {stiffness, "stiffness among externals and discs with the plate held"});
  write_sparse(file, "L_f", a.L_f, {area, "loads of the unit friction cases on the plate unknowns"});
  file.write("L_c", a.L_c, {area, "loads of the unit friction cases on externals and discs"});
  write_sparse(file, "T_f", a.T_f, {"1", "loads of a unit total force on each traction boundary"});
  file.write("T_c", a.T_c, {"1", "the same on externals and discs"});
  file.write("shift", a.shift, {stiffness, "what E_c E_c^T has more than S on its diagonal"});
  write_loads(file, a);
  for (Eigen::Index i = 0; i < a.p.size(); ++i) write_cases(file, units, case_group(a.p[i]), a.cases[i]);
  file.write("probe/displacement", a.probe.displacement, {length, "amounts of externals, then discs, in the field u"});
  file.write("probe/friction", a.probe.friction, {unit(units, -2, 1), "amounts of friction cases in the field w"});
  file.write("probe/u", a.probe.u, {length, "plate unknowns of the highest degree under these displacements"});
  file.write("probe/w", a.probe.w, {length, "plate unknowns of the highest degree under these friction cases"});
  file.write("probe/rounding", Eigen::VectorXd(Eigen::VectorXd::Constant(1, a.probe.rounding)),
             {stiffness, "what rounding may change of S, estimated by the field u"});
  file.commit();
}

PlateSolution read_plate_solution(const std::string& path) {
  const h5::Reader file(path, format, major);
  PlateSolution a;
  a.header = read_header(file);
  a.space = read_space(file);
  const Units& units = a.header.units;
  const std::string length = unit(units, 1, 0);
  read_geometry(file, a);
  read_names(file, a);
  const auto n = a.ndof[a.p.size() - 1];
  const Eigen::Index nc = a.external_id.size() + a.disc_hole.size();
  const Eigen::Index h = a.friction_hole.size();
  const Eigen::Index q = a.traction_id.size();
  const int least = -1 - static_cast<int>(nc);
  if (a.unknown.size() == 0 || a.unknown.maxCoeff() >= n || a.unknown.minCoeff() < least)
    throw FileError(fmt::format("{}:unknown: an index is outside {}..{}", path, least, n - 1));
  a.K_fc = read_sparse(file, "K_fc", n, nc, unit(units, -1, 1));
  a.K_cc = file.matrix("K_cc", nc, nc, unit(units, -1, 1));
  a.L_f = read_sparse(file, "L_f", n, h, unit(units, 2, 0));
  a.L_c = file.matrix("L_c", nc, h, unit(units, 2, 0));
  a.T_f = read_sparse(file, "T_f", n, q, "1");
  a.T_c = file.matrix("T_c", nc, q, "1");
  a.shift = file.vector("shift", nc, unit(units, -1, 1));
  read_loads(file, a);
  for (Eigen::Index i = 0; i < a.p.size(); ++i) a.cases.push_back(read_cases(file, a, i));
  a.probe = {file.vector("probe/displacement", nc, length), file.vector("probe/friction", h, unit(units, -2, 1)),
             file.vector("probe/u", n, length), file.vector("probe/w", n, length),
             file.has("probe/rounding") ? file.vector("probe/rounding", 1, unit(units, -1, 1))[0] : 0};
  return a;
}

}  // namespace fastjoint::formats
