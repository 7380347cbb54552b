// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/joint_result.hpp"

namespace fastjoint::formats {
namespace {

constexpr const char* format = "joint-result";
constexpr int major = 1;
constexpr int minor = 4;

/// (steps, n a) as (steps, n, a).
std::vector<Eigen::MatrixXd> unfolded(const Eigen::MatrixXd& table, Eigen::Index a) {
  std::vector<Eigen::MatrixXd> stack;
  for (Eigen::Index step = 0; step < table.rows(); ++step)
    stack.emplace_back(table.row(step).reshaped(a, table.cols() / a).transpose());
  return stack;
}

Eigen::MatrixXd folded(const std::vector<Eigen::MatrixXd>& stack, Eigen::Index columns) {
  Eigen::MatrixXd table(stack.size(), columns);
  for (std::size_t step = 0; step < stack.size(); ++step)
    table.row(step) = stack[step].transpose().reshaped().transpose();
  return table;
}

/// (steps, n) twice as (steps, n, 2).
std::vector<Eigen::MatrixXd> paired(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second) {
  std::vector<Eigen::MatrixXd> stack;
  for (Eigen::Index step = 0; step < first.rows(); ++step) {
    stack.emplace_back(first.cols(), 2);
    stack.back() << first.row(step).transpose(), second.row(step).transpose();
  }
  return stack;
}

/// Every (steps, r) dataset of the rims, once for writing and reading.
template <class Rims, class Each>
void for_each_table(Rims& a, const Units& units, Each each) {
  const std::string force = unit(units, 0, 1);
  const std::string stress = unit(units, -2, 1);
  each("bearing_load", a.bearing_load, force, "bearing force of the fastener on the plate along x");
  each("bearing_load_y", a.bearing_load_y, force, "the same along y");
  each("bearing_stress", a.bearing_stress, stress, "its amount over the projected area d t");
  each("bypass_load", a.bypass_load, force, "force along x that passes the fastener by, tension positive");
  each("bypass_error", a.bypass_error, force, "estimated error of the bypass load");
  each("peak_hoop", a.peak_hoop, stress, "largest hoop stress at the rim");
  each("peak_angle", a.peak_angle, std::string("deg"), "where it is, counter-clockwise from x");
  each("peak_error", a.peak_error, stress, "estimated error of that peak");
  each("gross_concentration", a.gross_concentration, std::string("1"), "peak over the stress of the gross section");
  each("net_concentration", a.net_concentration, std::string("1"), "peak over the stress of the net section");
}

void write_rims(h5::Writer& file, const std::string& group, const RimHistory& rims, const Units& units) {
  file.write(group + "hole", rims.hole, {"1", "holes, open ones included"});
  file.write(group + "sections", rims.sections, {"1", "how many sections beside the hole the plate has"});
  for_each_table(rims, units,
                 [&](const char* name, const Eigen::MatrixXd& table, const std::string& unit, const char* what) {
                   file.write(group + name, table, {unit, what});
                 });
}

RimHistory read_rims(const h5::Reader& file, const std::string& group, Eigen::Index steps, const Units& units) {
  RimHistory rims;
  rims.hole = file.strings(group + "hole", h5::any);
  const Eigen::Index r = rims.hole.size();
  rims.sections = file.integers(group + "sections", r);
  for_each_table(rims, units, [&](const char* name, Eigen::MatrixXd& table, const std::string& unit, const char*) {
    const bool may_be_unknown = &table == &rims.peak_error || &table == &rims.bypass_error;
    table = file.matrix(group + name, steps, r, unit, may_be_unknown ? h5::Infinite::allowed : h5::Infinite::refused);
  });
  return rims;
}

void write_plate(h5::Writer& file, const PlateHistory& plate, const Units& units) {
  const std::string group = "plates/" + plate.name + "/";
  file.write(group + "disc/hole", plate.disc_hole, {"1", "hole of each disc unknown"});
  file.write(group + "disc/direction", plate.disc_direction, {"1", "direction of each disc unknown"});
  file.write(group + "external/id", plate.external_id, {"1", "external boundaries that move as one"});
  file.write(group + "D", plate.D, {unit(units, 1, 0), "disc displacement"});
  file.write(group + "De", plate.De, {unit(units, 1, 0), "displacement of the external boundary"});
  file.write(group + "Pe", plate.Pe, {unit(units, 0, 1), "force on the external boundary"});
  file.write(group + "friction/hole", plate.friction_hole, {"1", "hole of each friction case"});
  file.write(group + "friction/bearing", plate.friction_bearing, {"1", "side of the rim that bears"});
  file.write(group + "Lambda", plate.Lambda, {unit(units, -2, 1), "peak stress of each friction case"});
  file.write(group + "traction/id", plate.traction_id, {"1", "boundaries under traction"});
  file.write(group + "traction/force", plate.traction, {unit(units, 0, 1), "force on each"});
  write_rims(file, group + "rim/", plate.rims, units);
}

PlateHistory read_plate(const h5::Reader& file, const std::string& name, Eigen::Index steps, const Units& units) {
  const std::string group = "plates/" + name + "/";
  PlateHistory plate;
  plate.name = name;
  plate.disc_hole = file.strings(group + "disc/hole", h5::any);
  const Eigen::Index m = plate.disc_hole.size();
  plate.disc_direction = file.strings(group + "disc/direction", m);
  plate.external_id = file.strings(group + "external/id", h5::any);
  const Eigen::Index e = plate.external_id.size();
  plate.D = file.matrix(group + "D", steps, m, unit(units, 1, 0));
  plate.De = file.matrix(group + "De", steps, e, unit(units, 1, 0));
  plate.Pe = file.matrix(group + "Pe", steps, e, unit(units, 0, 1));
  plate.friction_hole = file.strings(group + "friction/hole", h5::any);
  const Eigen::Index h = plate.friction_hole.size();
  plate.friction_bearing = file.strings(group + "friction/bearing", h);
  plate.Lambda = file.matrix(group + "Lambda", steps, h, unit(units, -2, 1));
  plate.traction_id = file.strings(group + "traction/id", h5::any);
  const Eigen::Index q = plate.traction_id.size();
  plate.traction = file.matrix(group + "traction/force", steps, q, unit(units, 0, 1));
  plate.rims = read_rims(file, group + "rim/", steps, units);
  return plate;
}

void write_sensitivity(h5::Writer& file, const SensitivityHistory& a, const Units& units) {
  const std::string group = "sensitivity/";
  const std::string force = unit(units, 0, 1), stiffness = unit(units, -1, 1);
  const Eigen::Index n = a.load_factor.cols();
  const auto tables = [&](const char* name, const std::vector<Eigen::MatrixXd>& stack, Eigen::Index columns,
                          const std::string& each_unit, const char* what) {
    file.write(group + name, stack, n, columns, {each_unit, what});
  };
  file.write(group + "load_factor", a.load_factor, {force, "dF by the load factor"});
  tables("clearance", a.clearance, n, stiffness, "dF by the clearance of each shear plane");
  file.write(group + "mu_hole", a.mu_hole, {"1", "plate:hole, each with friction"});
  tables("mu", a.mu, std::ssize(a.mu_hole), force, "dF by the coefficient of friction of each hole");
  file.write(group + "law_name", a.law_name, {"1", "law of each number"});
  file.write(group + "law_number", a.law_number, {"1", "its name in the law"});
  file.write(group + "law_unit", a.law_unit, {"1", "unit of the derivative by it"});
  tables("law", a.law, std::ssize(a.law_name), "law_unit", "dF by each number of the laws");
  file.write(group + "force_external", a.force_external, {"1", "plate:external that may carry a force"});
  tables("force", a.force, std::ssize(a.force_external), "1", "dF by the force on each at load factor 1");
  file.write(group + "displacement_external", a.displacement_external,
             {"1", "plate:external with a given displacement"});
  tables("displacement", a.displacement, std::ssize(a.displacement_external), stiffness,
         "dF by the displacement of each at load factor 1");
}

SensitivityHistory read_sensitivity(const h5::Reader& file, Eigen::Index steps, Eigen::Index n, const Units& units) {
  const std::string group = "sensitivity/";
  const std::string force = unit(units, 0, 1), stiffness = unit(units, -1, 1);
  SensitivityHistory a;
  const auto strings = [&](const char* name) { return file.strings(group + name, h5::any); };
  const auto tables = [&](const char* name, Eigen::Index columns, const std::string& each_unit) {
    return file.stack(group + name, steps, n, columns, each_unit, h5::Infinite::allowed);
  };
  a.load_factor = file.matrix(group + "load_factor", steps, n, force, h5::Infinite::allowed);
  a.clearance = tables("clearance", n, stiffness);
  a.mu_hole = strings("mu_hole");
  a.mu = tables("mu", std::ssize(a.mu_hole), force);
  a.law_name = strings("law_name");
  a.law_number = file.strings(group + "law_number", std::ssize(a.law_name));
  a.law_unit = file.strings(group + "law_unit", std::ssize(a.law_name));
  a.law = tables("law", std::ssize(a.law_name), "law_unit");
  a.force_external = strings("force_external");
  a.force = tables("force", std::ssize(a.force_external), "1");
  a.displacement_external = strings("displacement_external");
  a.displacement = tables("displacement", std::ssize(a.displacement_external), stiffness);
  return a;
}

}  // namespace

void write(const std::string& path, const JointResult& a) {
  const Units& units = a.header.units;
  const std::string force = unit(units, 0, 1);
  h5::Writer file(path, format, major, minor);
  write_header(file, a.header);
  file.attribute("complete", a.complete ? 1 : 0);
  file.attribute("p", a.p);
  file.write("load_factor", a.load_factor, {"1", "share of the loads that acts at this increment"});
  file.write("converged", a.converged, {"1", "1 where the increment converged"});
  file.write(
      "iterations", a.iterations,
      {"1", "iterations of the nonlinear solver, failed tries included; on an exact path its pieces from no load on"});
  file.write("residual", a.residual, {"1", "largest residual, relative to the largest force of the increment"});
  file.write("event", a.event, {"1", "fasteners that close, open, slip or yield exactly there"});
  file.write("fastener/id", a.fastener_id, {"1", "fastener of each shear plane, in the order of the input"});
  file.write("fastener/first", a.first_hole, {"1", "plate:hole on its first side"});
  file.write("fastener/second", a.second_hole, {"1", "plate:hole on its second side"});
  file.write("direction", a.direction, {"1", "directions of the discs"});
  file.write("delta", a.delta, {unit(units, 1, 0), "displacement of the first plate's disc relative to the second's"});
  file.write("F", a.F, {force, "force of the fastener's law: of bearing, or transferred if it includes friction"});
  if (a.F_error) file.write("F_error", *a.F_error, {force, "estimated error of F by those of the plates' matrices"});
  const Eigen::Index n_directions = a.direction.size();
  file.write("delta_vector", unfolded(a.delta_vector, n_directions), a.F.cols(), n_directions,
             {unit(units, 1, 0), "components of delta"});
  file.write("F_vector", unfolded(a.F_vector, n_directions), a.F.cols(), n_directions, {force, "components of F"});
  file.write("transferred", paired(a.transferred_first, a.transferred_second), a.F.cols(), 2,
             {force, "bearing and friction together, on the first and on the second plate"});
  const auto write_each = [&](const char* dataset, std::string PlateHistory::*text, const char* what) {
    std::vector<std::string> texts;
    for (const auto& plate : a.plates) texts.push_back(plate.*text);
    file.write(dataset, texts, {"1", what});
  };
  write_each("plate/name", &PlateHistory::name, "plates of the joint; group plates/<name> holds what each did");
  write_each("plate/matrices_digest", &PlateHistory::matrices_digest, "digest of each MATRICES.h5, empty without one");
  write_each("plate/plate_digest", &PlateHistory::plate_digest, "digest of the PLATE.h5 that each was made of");
  for (const auto& plate : a.plates) write_plate(file, plate, units);
  if (a.sensitivity) write_sensitivity(file, *a.sensitivity, units);
  file.commit();
}

JointResult read_joint_result(const std::string& path) {
  const h5::Reader file(path, format, major);
  JointResult a;
  a.header = read_header(file);
  a.complete = file.integer_attribute("complete") == 1;
  a.p = file.integer_attribute("p");
  const Units& units = a.header.units;
  a.load_factor = file.vector("load_factor", h5::any, "1");
  const auto steps = a.load_factor.size();
  a.converged = file.integers("converged", steps);
  a.iterations = file.integers("iterations", steps);
  a.residual = file.vector("residual", steps, "1");
  a.event = file.strings("event", steps);
  a.fastener_id = file.strings("fastener/id", h5::any);
  const Eigen::Index n = a.fastener_id.size();
  a.first_hole = file.strings("fastener/first", n);
  a.second_hole = file.strings("fastener/second", n);
  a.direction = file.strings("direction", h5::any);
  const Eigen::Index directions = a.direction.size();
  a.delta_vector = folded(file.stack("delta_vector", steps, n, directions, unit(units, 1, 0)), n * directions);
  a.F_vector = folded(file.stack("F_vector", steps, n, directions, unit(units, 0, 1)), n * directions);
  a.delta = file.matrix("delta", steps, n, unit(units, 1, 0));
  a.F = file.matrix("F", steps, n, unit(units, 0, 1));
  if (file.has("F_error")) a.F_error = file.matrix("F_error", steps, n, unit(units, 0, 1), h5::Infinite::allowed);
  a.transferred_first.resize(steps, n);
  a.transferred_second.resize(steps, n);
  Eigen::Index step = 0;
  for (const auto& pair : file.stack("transferred", steps, n, 2, unit(units, 0, 1))) {
    a.transferred_first.row(step) = pair.col(0).transpose();
    a.transferred_second.row(step++) = pair.col(1).transpose();
  }
  for (const auto& name : file.strings("plate/name", h5::any)) a.plates.push_back(read_plate(file, name, steps, units));
  if (file.has("plate/plate_digest")) {
    const auto digests = file.strings("plate/plate_digest", std::ssize(a.plates));
    for (std::size_t i = 0; i < a.plates.size(); ++i) a.plates[i].plate_digest = digests[i];
  }
  if (file.has("sensitivity")) a.sensitivity = read_sensitivity(file, steps, n, units);
  return a;
}

}  // namespace fastjoint::formats
