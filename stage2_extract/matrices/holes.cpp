// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/matrices/holes.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "common/count.hpp"
#include "common/matrices/stiffness_error.hpp"
#include "stage2_extract/matrices/net_section.hpp"

namespace fastjoint::stage2 {
namespace {

/// Sets names, centres and areas of the holes, and thickness and moduli of the plate there.
void describe_rims(const formats::PlateSolution& plate, const pfem::Edges& edges, formats::PlateStresses& a) {
  const Eigen::Index r = plate.hole_rim.size();
  a.rim_hole = plate.hole_id;
  a.rim_center.resize(r, 2);
  a.rim_radius.resize(r);
  a.rim_thickness = Eigen::VectorXd::Zero(r);
  a.rim_modulus = Eigen::MatrixXd::Zero(r, 2);
  a.bearing_area.resize(r, 2);
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
    const auto area = [&](rim::Axis axis, int sign) {
      return rim::bearing(plate.mesh, edges, plate.hole_rim[i], rim::unit_vector({axis, sign})).area;
    };
    for (const rim::Axis axis : rim::both_axes)
      a.bearing_area(i, rim::coordinate(axis)) = std::max(area(axis, 1), area(axis, -1));
  }
}

/// Sets hole, side, gross and net area of the sections.
void describe_sections(const formats::PlateSolution& plate, const pfem::Edges& edges, formats::PlateStresses& a) {
  const Eigen::Index s = plate.sections.size();
  a.gross_area.resize(s);
  a.net_area.resize(s);
  const NetSections net(plate, edges);
  for (Eigen::Index i = 0; i < s; ++i) {
    const auto& section = plate.sections[i];
    a.section_hole.push_back(plate.hole_id[section.hole]);
    a.section_side.push_back(section.side);
    a.gross_area[i] = rim::section_area(plate.mesh, edges, section);
    a.net_area[i] = net.area(section);
  }
}

/// Estimated relative error of S and C_t at some degrees of the plate; infinite at its lowest.
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
                                                            matrices::max_rate_of(plate.elasticity)));
  }
  return errors;
}

}  // namespace

formats::PlateStresses describe_holes(const formats::PlateSolution& plate, bool with_stresses) {
  const auto edges = pfem::find_edges(plate.mesh);
  formats::PlateStresses a;
  describe_rims(plate, edges, a);
  if (!with_stresses) return a;
  describe_sections(plate, edges, a);
  const Eigen::Index k = plate.n_loaded_waves(), n_p = plate.p.size();
  a.p = plate.p.tail(std::min(n_p, formats::n_stress_degrees));
  for (Eigen::Index i = n_p - a.p.size(); i < n_p; ++i) {
    a.other_waves.emplace_back(plate.cases[i].W.bottomRows(plate.n_waves() - k));
    a.section_force.emplace_back(plate.cases[i].N);
    a.section_shear.emplace_back(plate.cases[i].V);
  }
  a.stiffness_error = stiffness_errors(plate, a.p);
  return a;
}

}  // namespace fastjoint::stage2
