// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/stresses/stresses.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <iterator>

#include "common/count.hpp"
#include "common/matrices/stiffness_error.hpp"
#include "common/pfem/element.hpp"
#include "common/pfem/material.hpp"
#include "common/pfem/shape_functions.hpp"
#include "common/program/progress.hpp"
#include "stage2_extract/stresses/rim_stress.hpp"

namespace fastjoint::stage2 {
namespace {

/// Number of states at a time: what an element has of them fits into the cache.
constexpr Eigen::Index block = 64;

/// Every point of every rim.
using Rims = std::vector<std::vector<RimPoint>>;

/// Names, places, areas and what the plate is there.
void describe_rims(const formats::PlateSolution& plate, const pfem::Edges& edges, const Rims& rims,
                   formats::PlateStresses& a) {
  const Eigen::Index r = rims.size();
  a.rim_hole = plate.hole_id;
  a.rim_center.resize(r, 2);
  a.rim_radius.resize(r);
  a.rim_thickness = Eigen::VectorXd::Zero(r);
  a.rim_modulus = Eigen::MatrixXd::Zero(r, 2);
  a.bearing_area.resize(r, 2);
  a.rim_start = Eigen::VectorXi::Zero(r + 1);
  std::vector<double> angle, hoop_by_pressure;
  for (Eigen::Index i = 0; i < r; ++i) {
    a.rim_center.row(i) = plate.hole_rim[i].center.transpose();
    a.rim_radius[i] = plate.hole_rim[i].radius;
    const auto& sides = plate.hole_rim[i].sides;
    const int n = count_of(sides);
    for (const auto& side : sides) {
      const auto& D = plate.elasticity[plate.mesh.material[side.element]];
      a.rim_thickness[i] += plate.mesh.thickness[side.element] / n;
      a.rim_modulus.row(i) += D.inverse().diagonal().head<2>().cwiseInverse().transpose() / n;
    }
    const auto area = [&](const char* side) {
      return rim::bearing(plate.mesh, edges, plate.hole_rim[i], bearing_direction(side)).area;
    };
    a.bearing_area.row(i) << std::max(area("+x"), area("-x")), std::max(area("+y"), area("-y"));
    const auto share = [&](const RimPoint& point) {
      const auto& D = plate.elasticity[plate.mesh.material[point.on[0].side.element]];
      return plate.hole_spring[i].contact ? pfem::hoop_by_pressure(D.inverse(), point.angle) : 0;
    };
    for (const auto& point : rims[i]) {
      angle.push_back(point.angle / rim::degree);
      hoop_by_pressure.push_back(share(point));
    }
    a.rim_start[i + 1] = count_of(angle);
  }
  a.angle = Eigen::Map<const Eigen::VectorXd>(angle.data(), angle.size());
  a.hoop_by_pressure = Eigen::Map<const Eigen::VectorXd>(hoop_by_pressure.data(), angle.size());
}

/// Sets the places of the sections and their areas, net of what the hole takes.
void describe_sections(const formats::PlateSolution& plate, const pfem::Edges& edges, formats::PlateStresses& a) {
  const Eigen::Index s = plate.sections.size();
  a.gross_area = Eigen::VectorXd::Zero(s);
  a.net_area.resize(s);
  for (Eigen::Index i = 0; i < s; ++i) {
    const auto& section = plate.sections[i];
    a.section_hole.push_back(plate.hole_id[section.hole]);
    a.section_side.push_back(section.side);
    for (const auto& side : section.sides)
      a.gross_area[i] += plate.mesh.thickness[side.element] * pfem::side_rule(plate.mesh, edges, side, 1).ds.sum();
    const auto& rim = plate.hole_rim[section.hole];
    a.net_area[i] = a.gross_area[i] - rim::bearing(plate.mesh, edges, rim, bearing_direction(section.side)).area;
  }
}

/// The elements on both sides of every edge of a mesh.
std::vector<std::vector<pfem::Side>> sides_of_edges(const pfem::Edges& edges) {
  std::vector<std::vector<pfem::Side>> sides(edges.size());
  for (int element = 0; element < edges.of_element.cols(); ++element)
    for (int local = 0; local < pfem::n_local_edges; ++local)
      sides[edges.of_element(local, element)].push_back({element, local});
  return sides;
}

/// int n.sigma.n t ds over one side of an element as a function of the element's coefficients; n along x or y.
Eigen::RowVectorXd side_force(const FieldSolver& solver, const pfem::Side& side, Eigen::Index component) {
  const auto& mesh = solver.plate().mesh;
  const auto& [space, p] = std::tie(solver.numbering().space, solver.numbering().p);
  const auto rule = pfem::gauss(p + 3);  // a rational integrand: see ElementStiffness
  const pfem::ElementMap map(mesh, solver.edges(), side.element);
  const auto curve = pfem::edge_curve(mesh, solver.edges(), side.element, side.local_edge);
  const Eigen::Matrix2Xd at = pfem::along_edge(side.local_edge, rule.x);
  const Eigen::MatrixXd B = pfem::strain_operator(map, space, p, at.row(0).transpose(), at.row(1).transpose());
  Eigen::RowVectorXd per_coefficient = Eigen::RowVectorXd::Zero(B.cols());
  for (Eigen::Index q = 0; q < rule.x.size(); ++q)
    per_coefficient += rule.w[q] * curve.derivative(rule.x[q]).norm() * mesh.thickness[side.element] *
                       solver.elasticity(side.element).row(component) * B.middleRows<3>(3 * q);
  return per_coefficient;
}

/// Normal force over every section, tension positive: the integral of the stress, mean of the elements on both sides of
/// the section.
std::vector<std::vector<plate::CondensedFunctions>> section_forces(const FieldSolver& solver) {
  const auto both = sides_of_edges(solver.edges());
  std::vector<std::vector<plate::CondensedFunctions>> forces;
  for (const auto& section : solver.plate().sections) {
    forces.emplace_back();
    for (const auto& side : section.sides) {
      const auto& sides = both[solver.edges().of_element(side.local_edge, side.element)];
      for (const auto& one : sides) {
        const auto force = side_force(solver, one, section.side[1] == 'x' ? 0 : 1);
        forces.back().push_back(solver.condense(one.element, force.transpose() / count_of(sides)));
      }
    }
  }
  return forces;
}

/// Adds the stresses at the rims and the forces over the sections at one degree in states given as amounts of the unit
/// cases, (n_cases, k).
void add_level(const FieldSolver& solver, const Rims& rims, const Eigen::MatrixXd& amounts, formats::PlateStresses& a) {
  const auto n_states = amounts.cols();
  std::vector<RimStress> stresses;
  for (int hole = 0; hole < count_of(rims); ++hole) stresses.emplace_back(solver, hole, rims[hole]);
  const auto sections = section_forces(solver);
  for (auto* sigma : {&a.sigma_rr, &a.sigma_tt, &a.sigma_rt}) sigma->emplace_back(a.angle.size(), n_states);
  a.section_force.emplace_back(Eigen::MatrixXd::Zero(std::ssize(sections), n_states));
  for (Eigen::Index first = 0; first < n_states; first += block) {
    const double level = double(a.section_force.size()) - 1 + double(first) / double(n_states);
    program::report_share(level / double(a.p.size()));
    const auto columns = Eigen::seqN(first, std::min(block, n_states - first));
    const Fields fields = solver.solve(amounts(Eigen::all, columns));
    for (int i = 0; i < count_of(rims); ++i) {
      const auto points = Eigen::seq(a.rim_start[i], a.rim_start[i + 1] - 1);
      const auto [rr, tt, rt] = stresses[i](fields);
      a.sigma_rr.back()(points, columns) = rr.transpose();
      a.sigma_tt.back()(points, columns) = tt.transpose();
      a.sigma_rt.back()(points, columns) = rt.transpose();
    }
    for (int i = 0; i < count_of(sections); ++i)
      for (const auto& part : sections[i])
        a.section_force.back().row(i)(columns) += fields.states.values(part).transpose();
  }
}

/// Estimated relative error of S and C_t at each of some degrees of the plate, infinite at its lowest.
Eigen::VectorXd stiffness_errors(const formats::PlateSolution& plate, const Eigen::VectorXi& degrees) {
  Eigen::VectorXd errors(degrees.size());
  matrices::CondensedLevels levels;
  levels.rounding = plate.probe.rounding;
  Eigen::Index at = 0;
  for (Eigen::Index i = 0; i < degrees.size(); ++i) {
    for (; at < plate.p.size() && plate.p[at] <= degrees[i]; ++at) {
      levels.S.push_back(plate.cases[at].S);
      levels.R.emplace_back();
      levels.C.push_back(plate.cases[at].C_t);
    }
    errors[i] = matrices::largest(matrices::relative_errors(levels, plate.p.head(at), plate.held_stiffness,
                                                            matrices::fastest_rate(plate.elasticity)));
  }
  return errors;
}

}  // namespace

formats::PlateStresses extract_stresses(const formats::PlateSolution& plate, FieldSolver* solver) {
  const auto n = plate.n_cases();
  if (solver) return extract_stresses(*solver, plate.p[plate.p.size() - 1], Eigen::MatrixXd::Identity(n, n));
  formats::PlateStresses a;
  describe_rims(plate, pfem::find_edges(plate.mesh), Rims(plate.hole_rim.size()), a);
  return a;
}

formats::PlateStresses extract_stresses(FieldSolver& solver, int p, const Eigen::MatrixXd& amounts) {
  constexpr Eigen::Index n_levels = 2;  // their difference estimates the error
  const auto& plate = solver.plate();
  const Eigen::Index up_to_p = std::upper_bound(plate.p.begin(), plate.p.end(), p) - plate.p.begin();
  formats::PlateStresses a;
  a.p = plate.p.head(up_to_p).tail(std::min(up_to_p, n_levels));
  Rims rims;
  for (const auto& rim : plate.hole_rim) rims.push_back(rim_points(plate.mesh, solver.edges(), rim));
  describe_rims(plate, solver.edges(), rims, a);
  describe_sections(plate, solver.edges(), a);
  for (const int degree : a.p) {
    solver.factorise(degree);
    add_level(solver, rims, amounts, a);
  }
  a.stiffness_error = stiffness_errors(plate, a.p);
  program::report_share(1);
  return a;
}

double stress_bytes(const formats::PlateSolution& plate, Eigen::Index n_states) {
  constexpr double components = 3;
  const double levels = std::min(count_of(plate.p), 2);
  const double rows = count_of(plate.hole_rim) * n_points_per_turn;
  return components * rows * sizeof(double) * double(n_states) * levels;
}

double block_bytes(const formats::PlateSolution& plate, Eigen::Index n_states) {
  return sizeof(double) * plate.ndof[plate.ndof.size() - 1] * double(std::min(block, n_states));
}

}  // namespace fastjoint::stage2
