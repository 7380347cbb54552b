// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/stresses/rim_stress.hpp"

#include <Eigen/LU>
#include <cmath>

#include "common/count.hpp"
#include "common/pfem/legendre.hpp"
#include "common/pfem/shape_functions.hpp"
#include "common/pfem/strain.hpp"
#include "common/rim/bearing.hpp"
#include "stage2_extract/matrices/friction_constants.hpp"

namespace fastjoint::stage2 {
namespace {

/// Displacement and hoop strain at a point of one side in every case.
struct Trace {
  Eigen::RowVectorXd u_n;     ///< along the radial direction, length
  Eigen::RowVectorXd eps_tt;  ///< dimensionless
};

struct Frame {
  Eigen::Vector2d n, t;  ///< radial and hoop direction
};

Frame frame_at(double angle) { return {{std::cos(angle), std::sin(angle)}, {-std::sin(angle), std::cos(angle)}}; }

Trace trace(const UnitFields& fields, const OnSide& at, const Frame& frame, double radius) {
  const auto shape = pfem::integrated_legendre(fields.p(), Eigen::VectorXd::Constant(1, at.s));
  const Eigen::MatrixXd C = fields.coefficients(at.side.element, pfem::modes_on_edge(fields.p(), at.side.local_edge));
  const auto n = shape.N.rows();
  const auto along = [&](const Eigen::Vector2d& e, const Eigen::MatrixXd& values) -> Eigen::RowVectorXd {
    return values.col(0).transpose() * (e.x() * C.topRows(n) + e.y() * C.bottomRows(n));
  };
  return {along(frame.n, shape.N), along(frame.t, shape.dN) * at.ds_dtheta / radius};
}

/// Amount by which each case moves the disc of a hole along n, shape (n_cases).
Eigen::RowVectorXd disc_motion(const UnitFields& fields, std::size_t hole, const Eigen::Vector2d& n) {
  const auto& plate = fields.plate();
  Eigen::RowVectorXd motion = Eigen::RowVectorXd::Zero(fields.n_cases());
  for (std::size_t i = 0; i < plate.disc_hole.size(); ++i)
    if (plate.disc_hole[i] == plate.hole_id[hole])
      motion[plate.external_id.size() + i] = rim::axis(plate.disc_direction[i]).dot(n);
  return motion;
}

Eigen::RowVectorXd radial_stress(const UnitFields& fields, std::size_t hole, double angle, const Eigen::Vector2d& n,
                                 const Eigen::RowVectorXd& u_n) {
  const auto& plate = fields.plate();
  const auto& spring = plate.hole_spring[hole];
  Eigen::RowVectorXd sigma = Eigen::RowVectorXd::Zero(fields.n_cases());
  if (rim::covers(spring.acts, angle)) sigma = spring.modulus * (u_n - disc_motion(fields, hole, n));
  const Eigen::Index q = plate.traction_hole.size();
  for (Eigen::Index i = 0; i < q; ++i) {
    if (plate.traction_hole[i] != plate.hole_id[hole]) continue;
    const Eigen::Vector2d d = rim::axis(plate.traction_direction[i]);
    sigma[fields.n_cases() - q + i] -= rim::cosine_bearing(n, d).contact /
                                       rim::bearing(plate.mesh, fields.edges(), plate.hole_rim[hole], d).unit_force;
  }
  return sigma;
}

/// The friction pulls at the plate by sigma . (-n).
Eigen::RowVectorXd shear_stress(const UnitFields& fields, std::size_t hole, const Frame& frame) {
  const auto& plate = fields.plate();
  Eigen::RowVectorXd sigma = Eigen::RowVectorXd::Zero(fields.n_cases());
  const auto first = plate.K_cc.cols();
  for (std::size_t i = 0; i < plate.friction_hole.size(); ++i) {
    if (plate.friction_hole[i] != plate.hole_id[hole]) continue;
    const auto at = rim::cosine_bearing(frame.n, bearing_direction(plate.friction_bearing[i]));
    sigma[first + i] = -at.contact * at.tangent.dot(frame.t);
  }
  return sigma;
}

}  // namespace

Eigen::MatrixXd rim_stress(const UnitFields& fields, std::size_t hole, const RimPoint& point) {
  const Frame frame = frame_at(point.angle);
  const double radius = fields.plate().hole_rim[hole].radius;
  const Eigen::Matrix3d to_global = pfem::polar_stress(-point.angle);
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(3, fields.n_cases());
  for (const auto& at : point.on) {
    const Trace side = trace(fields, at, frame, radius);
    const Eigen::Matrix3d compliance = to_global.transpose() * fields.elasticity(at.side.element).inverse() * to_global;
    Eigen::MatrixXd sigma(3, fields.n_cases());
    sigma.row(0) = radial_stress(fields, hole, point.angle, frame.n, side.u_n);
    sigma.row(2) = shear_stress(fields, hole, frame);
    sigma.row(1) = (side.eps_tt - compliance(1, 0) * sigma.row(0) - compliance(1, 2) * sigma.row(2)) / compliance(1, 1);
    mean += sigma / count_of(point.on);
  }
  return mean;
}

}  // namespace fastjoint::stage2
