// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/stresses/stresses.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <iterator>

#include "common/count.hpp"
#include "common/pfem/legendre.hpp"
#include "common/pfem/shape_functions.hpp"
#include "common/pfem/strain.hpp"
#include "common/rim/bearing.hpp"
#include "stage2_extract/stresses/rim_stress.hpp"

namespace fastjoint::stage2 {
namespace {

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
  std::vector<double> angle;
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
    for (const auto& point : rims[i]) angle.push_back(point.angle / rim::degree);
    a.rim_start[i + 1] = count_of(angle);
  }
  a.angle = Eigen::Map<const Eigen::VectorXd>(angle.data(), angle.size());
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

/// The side itself, and the same edge seen from the element beyond, if there is one.
std::vector<pfem::Side> both_sides(const pfem::Edges& edges, const pfem::Side& side) {
  const int edge = edges.of_element(side.local_edge, side.element);
  std::vector<pfem::Side> result;
  for (int element = 0; element < edges.of_element.cols(); ++element)
    for (int local = 0; local < pfem::n_local_edges; ++local)
      if (edges.of_element(local, element) == edge) result.push_back({element, local});
  return result;
}

/// int n.sigma.n t ds over one side of an element; n along x or y.
Eigen::RowVectorXd side_force(const UnitFields& fields, const pfem::Side& side, Eigen::Index component) {
  const auto& mesh = fields.plate().mesh;
  const auto rule = pfem::gauss(fields.p() + 3);  // a rational integrand: see element_stiffness.cpp
  const pfem::ElementMap map(mesh, fields.edges(), side.element);
  const auto curve = pfem::edge_curve(mesh, fields.edges(), side.element, side.local_edge);
  const Eigen::Matrix2Xd at = pfem::along_edge(side.local_edge, rule.x);
  const Eigen::MatrixXd B =
      pfem::strain_operator(map, fields.space(), fields.p(), at.row(0).transpose(), at.row(1).transpose());
  Eigen::RowVectorXd per_coefficient = Eigen::RowVectorXd::Zero(B.cols());
  for (Eigen::Index q = 0; q < rule.x.size(); ++q)
    per_coefficient += rule.w[q] * curve.derivative(rule.x[q]).norm() * mesh.thickness[side.element] *
                       fields.elasticity(side.element).row(component) * B.middleRows<3>(3 * q);
  return per_coefficient * fields.coefficients(side.element);
}

/// Normal force over a section in every unit case, shape (n_cases), tension positive: the integral of the stress, mean
/// of the elements on both sides of the section, force per unit of the case.
Eigen::RowVectorXd section_force(const UnitFields& fields, const rim::Section& section) {
  const Eigen::Index component = section.side[1] == 'x' ? 0 : 1;
  Eigen::RowVectorXd force = Eigen::RowVectorXd::Zero(fields.n_cases());
  for (const auto& side : section.sides) {
    const auto sides = both_sides(fields.edges(), side);
    for (const auto& one : sides) force += side_force(fields, one, component) / count_of(sides);
  }
  return force;
}

void add_level(const UnitFields& fields, const Rims& rims, formats::PlateStresses& a) {
  Eigen::MatrixXd rr(a.angle.size(), fields.n_cases()), tt(rr), rt(rr);
  Eigen::Index row = 0;
  for (std::size_t hole = 0; hole < rims.size(); ++hole)
    for (const auto& point : rims[hole]) {
      const Eigen::MatrixXd sigma = rim_stress(fields, hole, point);
      rr.row(row) = sigma.row(0);
      tt.row(row) = sigma.row(1);
      rt.row(row++) = sigma.row(2);
    }
  a.sigma_rr.push_back(std::move(rr));
  a.sigma_tt.push_back(std::move(tt));
  a.sigma_rt.push_back(std::move(rt));
  const auto& sections = fields.plate().sections;
  Eigen::MatrixXd force(sections.size(), fields.n_cases());
  for (Eigen::Index i = 0; i < force.rows(); ++i) force.row(i) = section_force(fields, sections[i]);
  a.section_force.push_back(std::move(force));
}

}  // namespace

formats::PlateStresses extract_stresses(const formats::PlateSolution& plate, const std::string& file) {
  formats::PlateStresses a;
  a.p = plate.stress_p;
  const auto edges = pfem::find_edges(plate.mesh);
  Rims rims(plate.hole_rim.size());
  for (std::size_t i = 0; i < rims.size() && a.p.size() > 0; ++i)
    rims[i] = rim_points(plate.mesh, edges, plate.hole_rim[i]);
  describe_rims(plate, edges, rims, a);
  if (a.p.size() == 0) return a;
  UnitFields fields(plate, file);
  describe_sections(plate, edges, a);
  for (const int p : a.p) {
    fields.use(std::distance(plate.p.begin(), std::find(plate.p.begin(), plate.p.end(), p)));
    add_level(fields, rims, a);
  }
  return a;
}

double stress_bytes(const formats::PlateSolution& plate) {
  constexpr double components = 3;
  const double rows = count_of(plate.hole_rim) * n_points_per_turn;
  const auto& cases = plate.cases.back();
  const auto n_cases = cases.E_c.rows() + cases.E_h.rows() + cases.V.cols();
  return components * rows * sizeof(double) * double(n_cases * plate.stress_p.size());
}

}  // namespace fastjoint::stage2
