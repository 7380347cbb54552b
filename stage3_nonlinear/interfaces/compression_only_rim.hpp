// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "common/rim/harmonics.hpp"

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The arcs on which a rim and its disc touch.
struct Touching {
  std::vector<rim::AngleRange> arcs;  ///< counter-clockwise from the start of the rim, radians
  MatrixXd gram;  ///< Gram matrix: mean over the rim of the products of the distributions on the arcs
};

/// A rim with compression-only springs and a radial gap between it and its disc (docs/theory.md, section 6.4).
///
/// The unknowns are the moments m of the disc's normal displacement w relative to the sheet, length: the means over the
/// rim of w times each distribution of pressure. The forces of the springs on them are K A times the moments of
/// max(w - gap, 0), the gradient of a convex function of m.
class CompressionOnlyRim {
 public:
  /// @param stiffness K A: modulus of the springs times area of the rim, force / length. @param mu Friction.
  CompressionOnlyRim(const rim::Harmonics& pressures, double stiffness, double gap, double mu = 0);

  /// The same rim with another gap and friction.
  [[nodiscard]] CompressionOnlyRim with(double gap, double mu) const {
    CompressionOnlyRim other = *this;
    other.gap_ = gap;
    other.mu_ = mu;
    return other;
  }

  [[nodiscard]] Index size() const { return pressures_.size(); }
  [[nodiscard]] double stiffness() const { return stiffness_; }
  [[nodiscard]] double gap() const { return gap_; }
  [[nodiscard]] double mu() const { return mu_; }
  [[nodiscard]] const rim::Harmonics& pressures() const { return pressures_; }

  /// Part of the rim on which w > gap, with exact ends.
  [[nodiscard]] Touching touching(const VectorXd& m) const;
  /// Forces for given arcs of contact, (size), force.
  [[nodiscard]] VectorXd forces(const Touching& at, const VectorXd& m) const {
    return stiffness_ * (at.gram * m - gap_ * at.gram.col(0));
  }
  /// Angle at which sign * w is largest, radians.
  [[nodiscard]] double deepest(const VectorXd& m, double sign = 1) const;
  /// w - gap, length.
  [[nodiscard]] double depth(const VectorXd& m, double angle) const { return pressures_.sum_at(m, angle).first - gap_; }

 private:
  /// An angle on the rim, radians, and w - gap there, length.
  struct Point {
    double angle, depth;
  };
  /// The samples, and the extrema between them that touch or open where the neighbouring samples do not.
  [[nodiscard]] std::vector<Point> points(const VectorXd& m, const VectorXd& depth) const;
  /// Angle near a sample at which sign * w is largest.
  [[nodiscard]] double extremum(const VectorXd& m, double angle, double sign) const;
  /// Angle between two samples at which w - gap changes its sign.
  [[nodiscard]] double end_between(const VectorXd& m, double low, double high, bool rises) const;

  rim::Harmonics pressures_;
  double stiffness_, gap_, mu_;
  /// Sample points, dense enough to resolve every wave.
  struct Samples {
    VectorXd angles;         ///< (points)
    MatrixXd distributions;  ///< (points, size)
  };
  std::shared_ptr<const Samples> samples_;  ///< common to all copies
};

}  // namespace fastjoint::stage3
