// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/rim_methods.hpp"

#include <cmath>

#include "common/matrices/decompositions.hpp"
#include "common/pfem/element.hpp"
#include "common/pfem/material.hpp"
#include "common/pfem/shape_functions.hpp"

namespace fastjoint::test {
namespace {

int degree(const stage2::Fields& fields) { return fields.solver.numbering().p; }

/// Coefficients of some modes of an element, first those of u_x, shape (2 n_modes, k).
Eigen::MatrixXd coefficients(const stage2::Fields& fields, int element, std::vector<int> modes) {
  const Eigen::MatrixXd C = fields.states.coefficients(element);
  const std::size_t n = modes.size();
  for (std::size_t i = 0; i < n; ++i) modes.push_back(modes[i] + static_cast<int>(C.rows()) / 2);
  return C(modes, Eigen::all);
}

}  // namespace

Eigen::MatrixXd plain_rim_stress(const stage2::Fields& fields, const RimPoint& point) {
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(3, fields.states.size());
  for (const auto& at : point.on) {
    const pfem::ElementMap map(fields.solver.plate().mesh, fields.solver.edges(), at.side.element);
    const Eigen::Matrix2Xd xi = pfem::along_edge(at.side.local_edge, Eigen::VectorXd::Constant(1, at.s));
    const Eigen::MatrixXd B = pfem::strain_operator(map, fields.solver.numbering().space, degree(fields),
                                                    xi.row(0).transpose(), xi.row(1).transpose());
    mean += pfem::polar_stress(point.angle) * fields.solver.elasticity(at.side.element) * B *
            fields.states.coefficients(at.side.element) / static_cast<double>(point.on.size());
  }
  return mean;
}

Eigen::MatrixXd harmonic_hoop_strain(const stage2::Fields& fields, const std::vector<RimPoint>& points, int highest) {
  const auto& plate = fields.solver.plate();
  const auto& rim = plate.hole_rim[0];
  const Eigen::Index n = highest / 2 + 1;
  Eigen::MatrixXd radial = Eigen::MatrixXd::Zero(n, fields.states.size()),
                  hoop = radial;  // of cos m theta, sin m theta
  for (const auto& side : rim.sides) {
    const auto rule = rim::rim_rule(plate.mesh, fields.solver.edges(), side, degree(fields));
    const Eigen::MatrixXd C = coefficients(fields, side.element, rule.modes);
    const auto n_modes = rule.N.rows();
    for (Eigen::Index q = 0; q < rule.ds.size(); ++q) {
      const Eigen::Vector2d r = -rule.normal.col(q);
      const double theta = std::atan2(r.y(), r.x());
      const Eigen::RowVectorXd ux = rule.N.col(q).transpose() * C.topRows(n_modes);
      const Eigen::RowVectorXd uy = rule.N.col(q).transpose() * C.bottomRows(n_modes);
      for (Eigen::Index i = 0; i < n; ++i) {
        const double weight = (i == 0 ? 4 : 8) / rim::full_turn * rule.ds[q] / rim.radius;
        const double m = 2 * static_cast<double>(i);
        radial.row(i) += weight * std::cos(m * theta) * (r.x() * ux + r.y() * uy);
        hoop.row(i) += weight * std::sin(m * theta) * (r.x() * uy - r.y() * ux);
      }
    }
  }
  Eigen::MatrixXd strain = Eigen::MatrixXd::Zero(points.size(), fields.states.size());
  for (Eigen::Index k = 0; k < strain.rows(); ++k)
    for (Eigen::Index i = 0; i < n; ++i) {
      const double m = 2 * static_cast<double>(i);
      strain.row(k) += 1 / rim.radius * std::cos(m * points[k].angle) * (radial.row(i) + m * hoop.row(i));
    }
  return strain;
}

namespace {

/// Hoop strains at the Gauss points of a side, one row each, and where they are.
struct GaussStrains {
  Eigen::VectorXd theta;
  Eigen::MatrixXd strain;
};

GaussStrains gauss_strains(const stage2::Fields& fields, const pfem::Side& side, double radius) {
  const auto gauss = pfem::gauss(degree(fields));
  const auto curve = pfem::edge_curve(fields.solver.plate().mesh, fields.solver.edges(), side.element, side.local_edge);
  const auto [first, second] = pfem::natural_ends(side.local_edge);
  std::vector<int> modes = {first, second};
  for (int k = 2; k <= degree(fields); ++k) modes.push_back(pfem::edge_mode(degree(fields), side.local_edge, k));
  const Eigen::MatrixXd C = coefficients(fields, side.element, modes);
  const Eigen::MatrixXd dN = pfem::integrated_legendre(degree(fields), gauss.x).dN * (2 / curve.sweep() / radius);
  const auto n = dN.rows();
  GaussStrains result{curve.start_angle() + (gauss.x.array() + 1) / 2 * curve.sweep(), {}};
  const Eigen::ArrayXd sine = result.theta.array().sin(), cosine = result.theta.array().cos();
  result.strain = cosine.matrix().asDiagonal() * (dN.transpose() * C.bottomRows(n));
  result.strain -= sine.matrix().asDiagonal() * (dN.transpose() * C.topRows(n));
  return result;
}

/// Powers 0..degree of an angle of the quarter, by its distance from 45 degrees, shape (n, degree + 1).
Eigen::MatrixXd powers(const Eigen::VectorXd& theta, int degree) {
  const Eigen::ArrayXd x = (theta.array() - rim::full_turn / 8) / (rim::full_turn / 8);
  Eigen::MatrixXd P(theta.size(), degree + 1);
  for (int k = 0; k <= degree; ++k) P.col(k) = x.pow(k);
  return P;
}

}  // namespace

Eigen::MatrixXd patch_hoop_strain(const stage2::Fields& fields, const std::vector<RimPoint>& points) {
  const auto& rim = fields.solver.plate().hole_rim[0];
  const Eigen::Index n = std::ssize(rim.sides) * degree(fields);
  Eigen::VectorXd theta(n);
  Eigen::MatrixXd strain(n, fields.states.size());
  for (std::size_t i = 0; i < rim.sides.size(); ++i) {
    const auto side = gauss_strains(fields, rim.sides[i], rim.radius);
    theta.segment(i * degree(fields), degree(fields)) = side.theta;
    strain.middleRows(i * degree(fields), degree(fields)) = side.strain;
  }
  const Eigen::MatrixXd c = matrices::singular_values(powers(theta, degree(fields))).solve(strain, 0);
  Eigen::VectorXd at(points.size());
  for (Eigen::Index k = 0; k < at.size(); ++k) at[k] = points[k].angle;
  return powers(at, degree(fields)) * c;
}

}  // namespace fastjoint::test
