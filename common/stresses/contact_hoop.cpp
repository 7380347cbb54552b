// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stresses/contact_hoop.hpp"

#include <algorithm>
#include <cmath>

namespace fastjoint::stresses {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int parts = 10;  ///< of the step between two points

/// Pressures that contact adds at points of a rim, (n).
VectorXd added_pressure(const VectorXd& angle, const Contacts& contacts, int rim) {
  Index first = 0;
  for (int i = 0; i < rim; ++i) first += contacts.rims[i].pressures.size();
  const auto& pressures = contacts.rims[rim].pressures;
  const VectorXd amounts = contacts.added.segment(first, pressures.size());
  return angle.unaryExpr([&](double degrees) { return pressures.at(degrees * rim::degree).dot(amounts); });
}

/// Cubic interpolation in equal steps, (n, c) to (n parts, c) around a whole circle, else to ((n - 1) parts + 1, c).
MatrixXd interpolated(const MatrixXd& values, bool is_whole) {
  const Index n = values.rows();
  MatrixXd result((is_whole ? n : n - 1) * parts + (is_whole ? 0 : 1), values.cols());
  for (Index row = 0; row < result.rows(); ++row) {
    const Index before = row / parts - 1, first = is_whole ? before : std::clamp(before, Index{0}, n - 4);
    const double x = double(row) / parts - double(first);
    const Eigen::RowVector4d weights((x - 1) * (x - 2) * (x - 3) / -6, x * (x - 2) * (x - 3) / 2,
                                     x * (x - 1) * (x - 3) / -2, x * (x - 1) * (x - 2) / 6);
    result.row(row).setZero();
    for (int i = 0; i < 4; ++i) result.row(row) += weights[i] * values.row((first + i + n) % n);
  }
  return result;
}

}  // namespace

RimHoop under_contact(const RimHoop& at, const MatrixXd& radial, const VectorXd& share, const Contacts& contacts,
                      int rim) {
  constexpr Index fewest = 4;  // of a cubic; a part of a rim of less than 15 degrees has fewer
  if (at.angle.size() < fewest) return at;
  const Index l = radial.cols();
  const auto& its = contacts.rims[rim];
  MatrixXd smooth(at.angle.size(), 2 * l + 1);  // hoop stress less that of the pressure, K w, share
  smooth << at.hoop - share.asDiagonal() * radial, (-radial).colwise() - added_pressure(at.angle, contacts, rim), share;
  const MatrixXd fine = interpolated(smooth, its.pressures.is_whole());
  const Eigen::ArrayXXd pressure = (fine.middleCols(l, l).array() - its.modulus * contacts.gap[rim]).max(0.0);
  const double step = (at.angle[1] - at.angle[0]) / parts, first = at.angle[0];
  return {VectorXd::LinSpaced(fine.rows(), first, first + step * double(fine.rows() - 1)),
          fine.leftCols(l).array() - pressure.colwise() * fine.col(2 * l).array()};
}

}  // namespace fastjoint::stresses
