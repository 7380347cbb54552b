// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/stresses/stresses.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <iterator>

#include "common/count.hpp"
#include "common/rim/bearing.hpp"
#include "stage2_extract/matrices/friction_constants.hpp"
#include "stage2_extract/stresses/rim_stress.hpp"
#include "stage2_extract/stresses/section_force.hpp"

namespace fastjoint::stage2 {
namespace {

/// Every point of every rim.
using Rims = std::vector<std::vector<RimPoint>>;

/// Names, places, areas and what the sheet is there.
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

void describe_sections(const UnitFields& fields, formats::PlateStresses& a) {
  const auto& plate = fields.plate();
  const Eigen::Index s = plate.sections.size();
  a.gross_area.resize(s);
  a.net_area.resize(s);
  for (Eigen::Index i = 0; i < s; ++i) {
    const auto& section = plate.sections[i];
    a.section_hole.push_back(plate.hole_id[section.hole]);
    a.section_side.push_back(section.side);
    const auto area = section_area(fields, section);
    a.gross_area[i] = area.gross;
    a.net_area[i] = area.net;
  }
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
  describe_sections(fields, a);
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
