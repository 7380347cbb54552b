// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/checks.hpp"

#include <fmt/format.h>

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

Eigen::MatrixXd stacked(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below) {
  Eigen::MatrixXd A(above.rows() + below.rows(), above.cols());
  A << above, below;
  return A;
}

/// Forces that hold externals and discs, by the fields that the loads themselves cause.
std::optional<double> reciprocity(const PlateSolution& plate, const PlateMatrices& matrices) {
  const auto& cases = plate.cases.back();
  const auto n = cases.U.rows();
  const Eigen::SparseMatrix<double> K_cf = plate.K_fc.topRows(n).transpose();
  double worst = 0;
  if (cases.W.cols() > 0) {
    const Eigen::MatrixXd solved = K_cf * cases.W - plate.L_c * plate.friction_mixture;
    const Eigen::MatrixXd R = stacked(matrices.R_ef.back(), matrices.R_df.back());
    worst = ratio(largest(solved - R * plate.friction_mixture), largest(R));
  }
  if (cases.V.cols() > 0) {
    const Eigen::MatrixXd T = stacked(matrices.T_e.back(), matrices.T_d.back());
    worst = std::max(worst, ratio(largest(K_cf * cases.V - plate.T_c - T), std::max(largest(T), 1e-3)));
  }
  if (cases.W.cols() + cases.V.cols() == 0 || plate.K_cc.size() == 0) return std::nullopt;
  return worst;
}

/// Force left along one direction that nothing supports, over all unit cases and loads.
double residual_force(const PlateSolution& plate, const PlateMatrices& matrices, const Eigen::MatrixXd& S,
                      const std::string& direction) {
  Eigen::VectorXd together(S.rows());
  Eigen::Index i = 0;
  for (const auto& d : plate.external_direction) together[i++] = d == direction ? 1 : 0;
  for (const auto& d : plate.disc_direction) together[i++] = d == direction ? 1 : 0;
  double worst = ratio(largest(S * together), largest(S));
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
  Checks checks{};
  checks.symmetry = ratio(largest(S - S.transpose()), largest(S));
  if (S.size() > 0) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen((S + S.transpose()) / 2, Eigen::EigenvaluesOnly);
    checks.smallest_eigenvalue = ratio(eigen.eigenvalues()[0], eigen.eigenvalues()[S.rows() - 1]);
  }
  checks.reciprocity = reciprocity(plate, matrices);
  checks.equilibrium = equilibrium(plate, matrices, S);
  return checks;
}

void require_good(const Checks& checks, const std::string& file) {
  const auto fail = [&](const char* what, double value) {
    throw NumericalError(
        fmt::format("{}: {} is {:.1e} of the largest entry, allowed {:.0e}; the plate's stiffness is too "
                    "badly conditioned (check moduli, thicknesses and element shapes)",
                    file, what, value, worst_allowed));
  };
  if (!(checks.symmetry < worst_allowed)) fail("asymmetry of S", checks.symmetry);
  if (!(checks.smallest_eigenvalue > -worst_allowed)) fail("smallest eigenvalue of S", checks.smallest_eigenvalue);
  if (!(checks.reciprocity.value_or(0) < worst_allowed)) fail("error of reciprocity", checks.reciprocity.value_or(0));
  if (!(checks.equilibrium.value_or(0) < worst_allowed))
    fail("error of global equilibrium", checks.equilibrium.value_or(0));
}

std::string report(const Checks& checks) {
  return fmt::format("  symmetry {:.1e}, smallest eigenvalue {:.1e}, reciprocity {}, equilibrium {}\n", checks.symmetry,
                     checks.smallest_eigenvalue, shown(checks.reciprocity, "not applicable (no loads)"),
                     shown(checks.equilibrium, "not applicable (supported)"));
}

}  // namespace fastjoint::stage2
