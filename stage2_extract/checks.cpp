// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/checks.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "common/errors.hpp"

namespace fastjoint::stage2 {
namespace {

using formats::PlateMatrices;
using formats::PlateSolution;

/// Far above the rounding of good scenes (1e-15 to 1e-11, see the tests), far below any modelling error.
constexpr double worst_allowed = 1e-7;

double ratio(double x, double scale) { return scale > 0 ? x / scale : x; }

/// The largest stiffness, or, of a sheet that offers next to none, such that what rounding leaves of K_cc is allowed.
double scale_of(const PlateSolution& plate, const Eigen::MatrixXd& S) {
  constexpr double least = 1e-5;
  return std::max(largest(S), least * largest(plate.K_cc));
}

Eigen::MatrixXd stacked(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below) {
  Eigen::MatrixXd A(above.rows() + below.rows(), above.cols());
  A << above, below;
  return A;
}

/// Forces that the probe's displacements need, by its field, against those by S.
std::optional<double> energy(const PlateSolution& plate, const Eigen::MatrixXd& S) {
  if (S.size() == 0) return std::nullopt;
  const auto& probe = plate.probe;
  const Eigen::VectorXd solved = plate.K_fc.transpose() * probe.u + plate.K_cc * probe.displacement;
  return ratio(largest(solved - S * probe.displacement), scale_of(plate, S));
}

/// What friction and tractions do to externals and discs, by the probe's fields, against R and T.
std::optional<double> reciprocity(const PlateSolution& plate, const PlateMatrices& matrices) {
  const auto& probe = plate.probe;
  if (plate.K_cc.size() == 0 || plate.L_c.cols() + plate.T_c.cols() == 0) return std::nullopt;
  double worst = 0;
  if (plate.L_c.cols() > 0) {
    const Eigen::MatrixXd R = stacked(matrices.R_ef.back(), matrices.R_df.back());
    const Eigen::VectorXd solved = plate.K_fc.transpose() * probe.w - plate.L_c * probe.friction;
    worst = ratio(largest(solved - R * probe.friction), largest(R));
  }
  if (plate.T_c.cols() > 0) {
    const Eigen::MatrixXd T = stacked(matrices.T_e.back(), matrices.T_d.back());
    const Eigen::VectorXd solved = -(plate.T_f.transpose() * probe.u + plate.T_c.transpose() * probe.displacement);
    worst = std::max(worst, ratio(largest(solved - T.transpose() * probe.displacement), std::max(largest(T), 1e-3)));
  }
  return worst;
}

/// The smallest eigenvalue if it is too far below zero. A factor of S, raised by what is allowed, costs a tenth of the
/// eigenvalues.
std::optional<double> negative_eigenvalue(const Eigen::MatrixXd& S, double scale) {
  if (S.size() == 0) return std::nullopt;
  const Eigen::MatrixXd raised = S + worst_allowed * scale * Eigen::MatrixXd::Identity(S.rows(), S.rows());
  if (Eigen::LLT<Eigen::MatrixXd>(raised).info() == Eigen::Success) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(S, Eigen::EigenvaluesOnly);
  return ratio(eigen.eigenvalues()[0], scale);
}

/// Force left along one direction that nothing supports, over all unit cases and loads.
double residual_force(const PlateSolution& plate, const PlateMatrices& matrices, const Eigen::MatrixXd& S,
                      const std::string& direction) {
  Eigen::VectorXd together(S.rows());
  Eigen::Index i = 0;
  for (const auto& d : plate.external_direction) together[i++] = d == direction ? 1 : 0;
  for (const auto& d : plate.disc_direction) together[i++] = d == direction ? 1 : 0;
  double worst = ratio(largest(S * together), scale_of(plate, S));
  const Eigen::MatrixXd R = stacked(matrices.R_ef.back(), matrices.R_df.back());
  for (Eigen::Index j = 0; j < R.cols(); ++j)
    if (matrices.friction_bearing[static_cast<std::size_t>(j)].substr(1) == direction)
      worst = std::max(worst, ratio(std::abs(R.col(j).dot(together) + matrices.friction_resultant[j]), largest(R)));
  const Eigen::MatrixXd T = stacked(matrices.T_e.back(), matrices.T_d.back());
  for (Eigen::Index k = 0; k < T.cols(); ++k) {
    const double applied = plate.traction_direction[static_cast<std::size_t>(k)] == direction ? 1 : 0;
    worst = std::max(worst, std::abs(T.col(k).dot(together) + applied));
  }
  return worst;
}

/// A direction is free if no support fixes it and every disc can move along it.
std::optional<double> equilibrium(const PlateSolution& plate, const PlateMatrices& matrices, const Eigen::MatrixXd& S) {
  std::optional<double> worst;
  for (const std::string direction : {"x", "y"}) {
    const bool supported =
        std::find(plate.supported.begin(), plate.supported.end(), direction) != plate.supported.end();
    const bool discs_follow =
        plate.disc_direction.empty() ||
        std::find(plate.disc_direction.begin(), plate.disc_direction.end(), direction) != plate.disc_direction.end();
    if (!supported && discs_follow) worst = std::max(worst.value_or(0), residual_force(plate, matrices, S, direction));
  }
  return worst;
}

std::string shown(const std::optional<double>& value, const char* otherwise) {
  return value ? fmt::format("{:.1e}", *value) : otherwise;
}

}  // namespace

double largest(const Eigen::MatrixXd& A) { return A.size() == 0 ? 0 : A.cwiseAbs().maxCoeff(); }

Checks check(const PlateSolution& plate, const PlateMatrices& matrices, const Eigen::MatrixXd& S) {
  return {energy(plate, S), reciprocity(plate, matrices), negative_eigenvalue(S, scale_of(plate, S)),
          equilibrium(plate, matrices, S), ratio(plate.probe.rounding, scale_of(plate, S))};
}

void require_good(const Checks& checks, const std::string& file) {
  const auto fail = [&](const char* what, double value) {
    throw NumericalError(
        fmt::format("{}: {} is {:.1e} of the largest entry, allowed {:.0e}; the plate's stiffness is too "
                    "badly conditioned (check moduli, thicknesses and element shapes)",
                    file, what, value, worst_allowed));
  };
  if (checks.negative_eigenvalue) fail("smallest eigenvalue of S", *checks.negative_eigenvalue);
  if (!(checks.energy.value_or(0) < worst_allowed)) fail("error of S", checks.energy.value_or(0));
  if (!(checks.reciprocity.value_or(0) < worst_allowed)) fail("error of reciprocity", checks.reciprocity.value_or(0));
  if (!(checks.equilibrium.value_or(0) < worst_allowed))
    fail("error of global equilibrium", checks.equilibrium.value_or(0));
}

std::string report(const Checks& checks) {
  return fmt::format(
      "  relative errors of the checks: S against the energy of its fields {}, R and T against reciprocity {}, "
      "equilibrium {}; rounding may change S by {:.0e}\n",
      shown(checks.energy, "not applicable (no discs)"), shown(checks.reciprocity, "not applicable (no loads)"),
      shown(checks.equilibrium, "not applicable (supported)"), checks.rounding);
}

}  // namespace fastjoint::stage2
