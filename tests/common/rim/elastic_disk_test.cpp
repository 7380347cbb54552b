// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/rim/elastic_disk.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <utility>

#include "common/pfem/material.hpp"
#include "common/rim/rim_compliance.hpp"

namespace fastjoint::rim::elastic_disk_test {

constexpr double E = 70e3, nu = 0.3, a = 2.5;
using Complex = std::complex<double>;

/// Displacement of a disk in plane stress, any pair of analytic functions of Kolosov and Muskhelishvili.
struct Displacement {
  std::function<Complex(Complex)> phi, d_phi, psi;

  [[nodiscard]] Complex at(Complex z) const {
    return (1 + nu) / E * ((3 - nu) / (1 + nu) * phi(z) - z * std::conj(d_phi(z)) - std::conj(psi(z)));
  }
  /// Radial stress and shear, through Hooke's law from differences of the displacement.
  [[nodiscard]] Complex traction(double angle) const {
    constexpr double step = 1e-5;
    const Complex turn = std::polar(1.0, angle), z = a * turn;
    const Complex by_x = (at(z + step) - at(z - step)) / (2 * step);
    const Complex by_y = (at(z + Complex(0, step)) - at(z - Complex(0, step))) / (2 * step);
    const double xx = by_x.real(), yy = by_y.imag(), xy = 0.5 * (by_x.imag() + by_y.real());
    const double c = E / (1 - nu * nu), s_xx = c * (xx + nu * yy), s_yy = c * (yy + nu * xx), s_xy = E / (1 + nu) * xy;
    return Complex(s_xx, s_xy) * turn.real() * std::conj(turn) + Complex(s_xy, s_yy) * turn.imag() * std::conj(turn);
  }
};

/// Amounts of the waves of a function of the angle.
Eigen::VectorXd waves_of(const Harmonics& waves, const std::function<double(double)>& f) {
  constexpr int n = 64;
  Eigen::VectorXd result = Eigen::VectorXd::Zero(waves.size());
  for (int i = 0; i < n; ++i) result += f(full_turn * i / n) * waves.at(full_turn * i / n) / n;
  return result;
}

/// Against a field that Hooke's law alone ties to its tractions, any mix of pressure and shear: what the rim yields is
/// the inward displacement, but for orders 0 and 1 of a motion of the whole disk.
TEST(ElasticDisk, YieldsAsAFieldInEquilibriumDoes) {
  const Harmonics waves{8};
  for (int n = 2; n <= 7; ++n)
    for (const Complex amount : {Complex(1, 0), Complex(0.3, -0.7)}) {
      const Displacement u{[&](Complex z) { return amount * std::pow(z / a, n + 1); },
                           [&](Complex z) { return amount * double(n + 1) / a * std::pow(z / a, n); },
                           [&](Complex z) { return Complex(-0.4, 2) * std::pow(z / a, n - 1); }};
      const auto inward = [&](double angle) { return -(u.at(std::polar(a, angle)) * std::polar(1.0, -angle)).real(); };
      const auto pressure = waves_of(waves, [&](double angle) { return -u.traction(angle).real(); });
      const auto on_sheet = waves_of(waves, [&](double angle) { return -u.traction(angle).imag(); });
      const ElasticDisk disk{E, nu};
      const Eigen::VectorXd found =
          disk.yield(a, waves).cwiseProduct(pressure) + disk.yield_by_shear(a, waves) * on_sheet;
      const Eigen::VectorXd truth = waves_of(waves, inward);
      EXPECT_LT((found - truth).norm(), 1e-8 * truth.norm()) << "n = " << n;
      const Eigen::VectorXd moved =
          -disk.yield_by_shear(a, waves).transpose() * pressure - disk.give_way(a, waves).cwiseProduct(on_sheet);
      const Eigen::VectorXd along =
          waves_of(waves, [&](double angle) { return (u.at(std::polar(a, angle)) * std::polar(1.0, -angle)).imag(); });
      EXPECT_LT((moved - along).norm(), 1e-8 * along.norm()) << "n = " << n;
    }
}

TEST(ElasticDisk, YieldsToEvenPressureByEquation29) {
  EXPECT_NEAR((ElasticDisk{E, nu}.yield(a, {4})[0]), a * (1 - nu) / E, 1e-18);
}

/// Short waves see a plane border: between bodies of one material shear then opens nothing (Dundurs' second constant is
/// zero), and what is left is 4 a / (E n^2) of the curved rim.
TEST(ElasticDisk, OfTheSheetsMaterialFeelsShearAsBordersOfOneMaterialDo) {
  const Harmonics waves{60};
  const Eigen::Matrix3d sheet = pfem::elasticity(pfem::isotropic(E, nu), 0, pfem::Analysis::plane_stress).inverse();
  const Eigen::MatrixXd of_sheet = RimCompliance(sheet, a).displacements(waves).topRightCorner(121, 121);
  const Eigen::MatrixXd of_disk = ElasticDisk{E, nu}.yield_by_shear(a, waves);
  for (int n = 2; n <= 60; ++n)
    for (const auto& [cosine, sine] : {std::pair(2 * n - 1, 2 * n), {2 * n, 2 * n - 1}}) {
      EXPECT_NEAR(std::abs(of_sheet(cosine, sine) + of_disk(cosine, sine)), 4 * a / (E * (n * n - 1)), 1e-16) << n;
    }
}

/// Parts of a rim between lines of symmetry have the waves of the whole that these lines leave.
TEST(ElasticDisk, YieldsOnPartsOfARimAsOnTheWhole) {
  const ElasticDisk disk{E, nu};
  for (const double sweep : {std::numbers::pi, std::numbers::pi / 2})
    for (const double start : {0.0, std::numbers::pi / 2, -std::numbers::pi / 2}) {
      const Harmonics part{9, start, sweep}, whole{9};
      const Eigen::MatrixXd P = part.pressures_of_whole(), T = part.shears_of_whole();
      const Eigen::VectorXd p = Eigen::VectorXd::LinSpaced(part.size(), 1, 2), t = p.head(part.n_shears());
      const Eigen::VectorXd of_whole =
          disk.yield(a, whole).cwiseProduct(P * p) + disk.yield_by_shear(a, whole) * (T * t);
      const Eigen::VectorXd of_part = disk.yield(a, part).cwiseProduct(p) + disk.yield_by_shear(a, part) * t;
      EXPECT_LT((P * of_part - of_whole).norm(), 1e-14 * of_whole.norm()) << sweep << " from " << start;
    }
}

}  // namespace fastjoint::rim::elastic_disk_test
