// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/plate_matrices.hpp"

#include <fmt/format.h>

#include <limits>

#include "common/errors.hpp"

namespace fastjoint::formats {
namespace {

constexpr const char* format = "plate-matrices";
constexpr int major = 1;
constexpr int minor = 4;

/// A stack that is missing altogether is one of zero-width matrices.
std::vector<Eigen::MatrixXd> stack_if_any(const h5::Reader& file, const char* dataset, Eigen::Index n,
                                          Eigen::Index rows, Eigen::Index cols, const std::string& unit) {
  if (!file.has(dataset) && rows * cols == 0) return std::vector<Eigen::MatrixXd>(n, Eigen::MatrixXd::Zero(rows, cols));
  return file.stack(dataset, n, rows, cols, unit);
}

Eigen::MatrixXd error_if_any(const h5::Reader& file, const char* dataset, Eigen::Index rows, Eigen::Index cols,
                             const std::string& unit) {
  if (file.has(dataset)) {
    Eigen::MatrixXd error = file.matrix(dataset, rows, cols, unit, h5::Infinite::allowed);
    if ((error.array() < 0).any())
      throw FileError(fmt::format("{}:{}: holds {}; allowed: numbers >= 0", file.path(), dataset, error.minCoeff()));
    return error;
  }
  return Eigen::MatrixXd::Constant(rows, cols, std::numeric_limits<double>::infinity());
}

std::vector<std::string> strings_if_any(const h5::Reader& file, const char* dataset) {
  return file.has(dataset) ? file.strings(dataset, h5::any) : std::vector<std::string>{};
}

std::vector<std::string> directions(const h5::Reader& file, const char* dataset, Eigen::Index n) {
  return file.has(dataset) ? file.strings(dataset, n) : std::vector<std::string>(n, "x");
}

void write_names(h5::Writer& file, const PlateMatrices& a) {
  file.write("p", a.p, {"1", "polynomial degree"});
  file.write("ndof", a.ndof, {"1", "free plate unknowns at that degree"});
  file.write("disc/hole", a.disc_hole, {"1", "hole of each disc unknown"});
  file.write("disc/direction", a.disc_direction, {"1", "direction of each disc unknown, x or y"});
  file.write("disc/modulus", a.disc_modulus,
             {unit(a.header.units, -3, 1), "modulus of the springs between disc and sheet, 0 where there are none"});
  file.write("external/id", a.external_id, {"1", "external boundaries that move as one"});
  file.write("external/direction", a.external_direction, {"1", "their directions, x or y"});
  file.write("traction/id", a.traction_id, {"1", "external boundaries under uniform traction"});
  file.write("traction/direction", a.traction_direction, {"1", "their directions, x or y"});
  file.write("friction/hole", a.friction_hole, {"1", "hole of each friction case"});
  file.write("friction/bearing", a.friction_bearing, {"1", "side of the rim that bears: +x, -x, +y or -y"});
}

void write_stiffness(h5::Writer& file, const PlateMatrices& a, const std::string& stiffness) {
  const auto e = a.n_externals();
  const auto m = a.n_discs();
  file.write("S_ee", a.S_ee, e, e, {stiffness, "force on external i per displacement of external j"});
  file.write("S_ed", a.S_ed, e, m, {stiffness, "force on external i per displacement of disc j"});
  file.write("S_dd", a.S_dd, m, m, {stiffness, "force on disc i per displacement of disc j"});
  file.write("S_ee_error", a.S_ee_error, {stiffness, "estimated absolute error of S_ee at the highest p"});
  file.write("S_ed_error", a.S_ed_error, {stiffness, "estimated absolute error of S_ed at the highest p"});
  file.write("S_dd_error", a.S_dd_error, {stiffness, "estimated absolute error of S_dd at the highest p"});
}

void write_contacts(h5::Writer& file, const PlateMatrices& a) {
  const Units& units = a.header.units;
  const Eigen::Index n = a.contacts.size();
  std::vector<std::string> hole, arc_hole;
  Eigen::VectorXi iterations(n);
  Eigen::VectorXd pressure(n), angle(n);
  std::vector<double> arcs;
  for (Eigen::Index i = 0; i < n; ++i) {
    const HoleContact& contact = a.contacts[i];
    hole.push_back(contact.hole);
    iterations[i] = contact.iterations;
    pressure[i] = contact.peak_pressure;
    angle[i] = contact.peak_angle;
    for (const auto& [from, to] : contact.arcs) {
      arc_hole.push_back(contact.hole);
      arcs.insert(arcs.end(), {from, to});
    }
  }
  const Eigen::MatrixXd arc = Eigen::Map<const Eigen::Matrix2Xd>(arcs.data(), 2, arc_hole.size()).transpose();
  file.write("contact/hole", hole, {"1", "holes whose springs push but do not pull, under the loads of the input"});
  file.write("contact/iterations", iterations, {"1", "until the ends of the arcs in contact stood still"});
  file.write("contact/peak_pressure", pressure, {unit(units, -2, 1), "largest pressure on the rim"});
  file.write("contact/peak_angle", angle, {"deg", "where, counter-clockwise from x"});
  file.write("contact/arc_hole", arc_hole, {"1", "hole of each arc in contact"});
  file.write("contact/arc", arc, {"deg", "where it starts and ends, counter-clockwise from x"});
  file.write("loads/displacement", a.load_displacement,
             {unit(units, 1, 0), "displacement of each external, then disc, under the loads of the input"});
  file.write("loads/friction", a.load_friction, {unit(units, -2, 1), "peak stress of each friction case under them"});
  file.write("loads/traction", a.load_traction, {unit(units, 0, 1), "force of each traction under them"});
}

}  // namespace

std::string write(const std::string& path, const PlateMatrices& a) {
  const Units& units = a.header.units;
  const std::string area = unit(units, 2, 0);
  const auto e = a.n_externals();
  const auto m = a.n_discs();
  const auto h = a.n_friction_cases();
  const auto q = a.n_tractions();
  h5::Writer file(path, format, major, minor);
  write_header(file, a.header);
  write_space(file, a.space);
  file.attribute("plate_digest", a.plate_digest);
  write_names(file, a);
  file.write("friction/unit_force", a.friction_unit_force, {area, "bearing force per unit peak contact stress"});
  file.write("friction/resultant", a.friction_resultant,
             {area, "resultant along the direction of a unit friction case, signed"});
  write_stiffness(file, a, unit(units, -1, 1));
  file.write("R_ef", a.R_ef, e, h, {area, "force that holds external i per unit friction case j"});
  file.write("R_df", a.R_df, m, h, {area, "force that holds disc i per unit friction case j"});
  file.write("T_d", a.T_d, m, q, {"1", "force that holds disc i per unit total force on traction boundary j"});
  file.write("T_e", a.T_e, e, q, {"1", "force that holds external i per unit total force on traction boundary j"});
  file.write("C_t", a.C_t, q, q,
             {unit(units, 1, -1), "mean displacement of traction boundary i per unit total force on j, all else held"});
  write_stresses(file, a.stresses, units);
  write_contacts(file, a);
  return file.commit();
}

PlateMatrices read_plate_matrices(const std::string& path) {
  const h5::Reader file(path, format, major);
  PlateMatrices a;
  a.header = read_header(file);
  a.space = read_space(file);
  a.plate_digest = file.attribute("plate_digest", "");
  a.p = file.integers("p", h5::any);
  check_degrees(file, "p", a.p, highest_degree);
  const auto np = a.p.size();
  a.ndof = file.has("ndof") ? file.integers("ndof", np) : Eigen::VectorXi::Zero(np);
  a.disc_hole = file.strings("disc/hole", h5::any);
  const auto m = a.n_discs();
  a.disc_direction = file.strings("disc/direction", m);
  a.disc_modulus = Eigen::VectorXd::Zero(m);
  if (file.has("disc/modulus")) a.disc_modulus = file.vector("disc/modulus", m, expected_unit(a.header.units, -3, 1));
  a.external_id = strings_if_any(file, "external/id");
  a.traction_id = strings_if_any(file, "traction/id");
  a.friction_hole = strings_if_any(file, "friction/hole");
  const auto e = a.n_externals();
  const auto q = a.n_tractions();
  const auto h = a.n_friction_cases();
  a.external_direction = directions(file, "external/direction", e);
  a.traction_direction = directions(file, "traction/direction", q);
  if (h > 0) a.friction_bearing = file.strings("friction/bearing", h);
  check_words(file, "friction/bearing", a.friction_bearing, side_names);
  const std::string area = expected_unit(a.header.units, 2, 0);
  a.friction_unit_force = h > 0 ? file.vector("friction/unit_force", h, area) : Eigen::VectorXd();
  a.friction_resultant = h > 0 ? file.vector("friction/resultant", h, area) : Eigen::VectorXd();
  const std::string stiffness = expected_unit(a.header.units, -1, 1);
  a.S_ee = stack_if_any(file, "S_ee", np, e, e, stiffness);
  a.S_ed = stack_if_any(file, "S_ed", np, e, m, stiffness);
  a.S_dd = file.stack("S_dd", np, m, m, stiffness);
  a.S_ee_error = error_if_any(file, "S_ee_error", e, e, stiffness);
  a.S_ed_error = error_if_any(file, "S_ed_error", e, m, stiffness);
  a.S_dd_error = error_if_any(file, "S_dd_error", m, m, stiffness);
  a.R_ef = stack_if_any(file, "R_ef", np, e, h, area);
  a.R_df = stack_if_any(file, "R_df", np, m, h, area);
  a.T_d = stack_if_any(file, "T_d", np, m, q, expected_unit(a.header.units, 0, 0));
  a.T_e = stack_if_any(file, "T_e", np, e, q, expected_unit(a.header.units, 0, 0));
  a.C_t = stack_if_any(file, "C_t", np, q, q, expected_unit(a.header.units, 1, -1));
  a.stresses = read_stresses(file, a.n_cases(), a.header.units);
  return a;
}

}  // namespace fastjoint::formats
