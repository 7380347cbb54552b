// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/cracks.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "common/count.hpp"
#include "common/pfem/element.hpp"
#include "common/pfem/material.hpp"

namespace fastjoint::plate {
namespace {

using Complex = std::complex<double>;

/// Kolosov's potentials of a field at one point: phi, phi', phi'', psi, psi'.
struct Potentials {
  Complex phi, phi1, phi2, psi, psi1;
};

/// Potentials a z^s and b z^s.
Potentials powers(Complex z, double s, Complex a, Complex b) {
  const Complex f = std::pow(z, s), f1 = s * f / z, f2 = (s - 1) * f1 / z;
  return {a * f, a * f1, a * f2, b * f, b * f1};
}

/// Muskhelishvili 1953, section 32.
TipField field(const Potentials& at, const Isotropic& material, Complex z) {
  const Complex u = (material.kappa * at.phi - z * std::conj(at.phi1) - std::conj(at.psi)) / (2 * material.mu);
  const double sum = 4 * at.phi1.real();
  const Complex difference = 2.0 * (std::conj(z) * at.phi2 + at.psi1);  // sigma_yy - sigma_xx + 2 i sigma_xy
  const double xx = (sum - difference.real()) / 2, yy = (sum + difference.real()) / 2, xy = difference.imag() / 2;
  return {{u.real(), u.imag()}, Eigen::Matrix2d{{xx, xy}, {xy, yy}}};
}

/// Ends of intervals of eta, ascending from -1 to 1, in each of which the dual field is smooth on an element of a
/// layer.
///
/// The layer shrinks towards the tip, so that the dual field is a power of xi times a function of eta, which is steep
/// around the place nearest to the tip where that is much nearer than the element is long.
std::vector<double> smooth_intervals(const pfem::ElementMap& map, const Eigen::Vector2d& tip) {
  constexpr double growth = 2;
  const Eigen::Vector2d first = map.point(-1, -1) - tip, side = map.point(-1, 1) - map.point(-1, -1);
  const double nearest = std::clamp(-first.dot(side) / side.squaredNorm(), 0.0, 1.0);
  const double width = (first + nearest * side).norm() / side.norm();
  std::vector<double> ends{0, 1};  // of the side
  for (const double sign : {-1.0, 1.0})
    for (double step = width, at = nearest + sign * step; at > 0 && at < 1; step *= growth, at += sign * step)
      ends.push_back(at);
  std::ranges::sort(ends);
  for (double& end : ends) end = 2 * end - 1;
  return ends;
}

/// Points and weights for functions of eta on an element of a layer.
pfem::Rule rule_around(const pfem::ElementMap& map, const Eigen::Vector2d& tip, const pfem::Rule& gauss) {
  const auto ends = smooth_intervals(map, tip);
  const Eigen::Index n = gauss.x.size(), intervals = std::ssize(ends) - 1;
  pfem::Rule rule{Eigen::VectorXd(n * intervals), Eigen::VectorXd(n * intervals)};
  for (Eigen::Index k = 0; k < intervals; ++k) {
    const double half = (ends[k + 1] - ends[k]) / 2, middle = (ends[k + 1] + ends[k]) / 2;
    rule.x.segment(k * n, n) = middle + half * gauss.x.array();
    rule.w.segment(k * n, n) = half * gauss.w;
  }
  return rule;
}

}  // namespace

Isotropic isotropic(const Eigen::Matrix3d& D) {
  if (!pfem::is_isotropic(D)) throw std::domain_error("stress intensity factors need an isotropic material");
  const double mu = D(2, 2), lambda = D(0, 1);  // lambda of plane strain, or its counterpart of plane stress
  return {mu, (lambda + 3 * mu) / (lambda + mu)};
}

TipField dual_field(Mode mode, const Isotropic& material, const Eigen::Vector2d& x) {
  const Complex z{x.x(), x.y()};
  constexpr Complex i{0, 1};
  return field(mode == Mode::I ? powers(z, -0.5, 1, 1.5) : powers(z, -0.5, i, -0.5 * i), material, z);
}

Eigen::MatrixX2d stress_intensity_weights(const pfem::ElementMap& map, pfem::Space space, int p,
                                          const Eigen::Matrix3d& D, const pfem::CrackTip& tip) {
  const Isotropic material = isotropic(D);
  const double scale = material.mu / (material.kappa + 1) * std::sqrt(2 / std::numbers::pi);
  const auto rule = pfem::gauss(p + 8);  // the dual field is smooth in a layer, which ends well away from the tip
  const auto across = rule_around(map, tip.at, rule);
  const Eigen::Index n = rule.x.size(), n_eta = across.x.size();
  const Eigen::VectorXd xi = rule.x.replicate(n_eta, 1);
  const Eigen::VectorXd eta = across.x.transpose().replicate(n, 1).reshaped();
  const Eigen::MatrixXd B = pfem::strain_operator(map, space, p, xi, eta);
  const Eigen::MatrixXd N = pfem::shape_values(space, p, xi, eta).N;
  const Eigen::Index n_modes = N.rows();
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(tip.angle).toRotationMatrix();
  Eigen::MatrixX2d weights = Eigen::MatrixX2d::Zero(2 * n_modes, 2);
  for (Eigen::Index q = 0; q < xi.size(); ++q) {
    const Eigen::Matrix2d J = map.jacobian(xi[q], eta[q]);
    // The cutoff function 1 - s^3, s = (1 + xi) / 2, is flat where the dual field is steep: with 1 - s errors are 4
    // times as large.
    const double s = (1 + xi[q]) / 2;
    const Eigen::Vector2d slope = -1.5 * s * s * J.inverse().transpose().col(0);
    const double dA = J.determinant() * rule.w[q % n] * across.w[q / n];
    const Eigen::Vector2d x = turn.transpose() * (map.point(xi[q], eta[q]) - tip.at);
    for (const Mode mode : {Mode::I, Mode::II}) {
      const TipField dual = dual_field(mode, material, x);
      const Eigen::Vector2d u = turn * dual.u;
      const Eigen::Vector2d traction = turn * dual.sigma * turn.transpose() * slope;
      const double factor = (mode == Mode::I ? 1 : -1) * scale * dA;
      auto row = weights.col(mode == Mode::I ? 0 : 1);
      const Eigen::RowVector3d by_stress(slope.x() * u.x(), slope.y() * u.y(), slope.x() * u.y() + slope.y() * u.x());
      row += factor * (by_stress * D * B.middleRows<3>(3 * q)).transpose();
      row.head(n_modes) -= factor * traction.x() * N.col(q);
      row.tail(n_modes) -= factor * traction.y() * N.col(q);
    }
  }
  return weights;
}

PlateFactor::Functions stress_intensities(const PlateFactor& factor, const pfem::Mesh& mesh, const pfem::Edges& edges,
                                          const pfem::Numbering& numbering,
                                          const std::vector<Eigen::Matrix3d>& elasticity,
                                          const std::vector<pfem::CrackTip>& tips, int layer) {
  PlateFactor::Functions functions(2 * tips.size());
  for (int t = 0; t < count_of(tips); ++t)
    for (const int element : tips[t].layers[layer]) {
      const Eigen::MatrixX2d weights =
          stress_intensity_weights(pfem::ElementMap(mesh, edges, element), numbering.space, numbering.p,
                                   elasticity[mesh.material[element]], tips[t]);
      for (const int mode : {0, 1})
        functions[mode * count_of(tips) + t].push_back(factor.condense_functions(element, weights.col(mode)));
    }
  return functions;
}

}  // namespace fastjoint::plate
