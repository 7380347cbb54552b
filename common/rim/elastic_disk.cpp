// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/rim/elastic_disk.hpp"

namespace fastjoint::rim {

// The compliances follow from the Kolosov-Muskhelishvili polynomials phi = A z^(n+1) and psi = B z^(n-1) for tractions
// of one order n on the circle. Orders are those of the whole circle; a part between lines of symmetry has a subset of
// them.

namespace {

/// Compliance of each wave of order 2 and above for its own traction, on the whole circle, length / stress.
Eigen::VectorXd own_compliance(const ElasticDisk& disk, double radius, int highest) {
  Eigen::VectorXd whole = Eigen::VectorXd::Zero(2 * Eigen::Index(highest) + 1);
  for (int n = 2; n <= highest; ++n)
    whole.segment<2>(2 * n - 1).setConstant((2 * n - 1 + disk.nu) / (double(n) * n - 1) * radius / disk.E);
  return whole;
}

}  // namespace

Eigen::VectorXd ElasticDisk::yield(double radius, const Harmonics& waves) const {
  Eigen::VectorXd whole = own_compliance(*this, radius, waves.highest);
  whole[0] = (1 - nu) * radius / E;
  return waves.pressures_of_whole().cwiseAbs2().transpose() * whole;
}

Eigen::VectorXd ElasticDisk::give_way(double radius, const Harmonics& waves) const {
  return waves.shears_of_whole().cwiseAbs2().transpose() * own_compliance(*this, radius, waves.highest);
}

Eigen::MatrixXd ElasticDisk::yield_by_shear(double radius, const Harmonics& waves) const {
  const Eigen::Index size = 2 * Eigen::Index(waves.highest) + 1;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size, size);
  for (int n = 2; n <= waves.highest; ++n) {
    const Eigen::Index sine = 2 * Eigen::Index(n), cosine = sine - 1;
    whole(cosine, sine) = ((1 - nu) * n - 2) / (double(n) * n - 1) * radius / E;
    whole(sine, cosine) = -whole(cosine, sine);
  }
  return waves.pressures_of_whole().transpose() * whole * waves.shears_of_whole();
}

}  // namespace fastjoint::rim
