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

/// Forces of a rim on the moments m of the disc's normal displacement against the sheet, and where the two touch.
struct Touching {
  std::vector<rim::AngleRange> arcs;  ///< counter-clockwise from the start of the rim, radians
  MatrixXd share;                     ///< mean over the rim of the products of the distributions where it touches
};

/// A rim whose springs push but do not pull, with a radial gap between it and its disc (docs/theory.md, section 6.4).
///
/// The unknowns are the moments m of the disc's normal displacement w against the sheet, length: the means over the rim
/// of w times each distribution of pressure; their forces are K A times those of max(w - gap, 0), which is what the
/// springs transmit. The forces are the gradient of a convex function of m.
class RimContact {
 public:
  /// @param stiffness K A: modulus of the springs times area of the rim, force / length. @param mu Friction.
  RimContact(const rim::Harmonics& pressures, double stiffness, double gap, double mu = 0);

  /// The same rim with another gap and friction.
  [[nodiscard]] RimContact with(double gap, double mu) const {
    RimContact other = *this;
    other.gap_ = gap;
    other.mu_ = mu;
    return other;
  }

  [[nodiscard]] Index size() const { return pressures_.size(); }
  [[nodiscard]] double stiffness() const { return stiffness_; }
  [[nodiscard]] double gap() const { return gap_; }
  [[nodiscard]] double mu() const { return mu_; }
  [[nodiscard]] const rim::Harmonics& pressures() const { return pressures_; }

  /// Part of the rim on which w > gap; its ends are exact.
  [[nodiscard]] Touching touching(const VectorXd& m) const;
  /// Forces where it touches so, (size), force.
  [[nodiscard]] VectorXd forces(const Touching& at, const VectorXd& m) const;
  /// Place at which sign * w is largest, radians.
  [[nodiscard]] double deepest(const VectorXd& m, double sign = 1) const;
  /// w - gap, length.
  [[nodiscard]] double depth(const VectorXd& m, double angle) const { return pressures_.sum_at(m, angle).first - gap_; }

 private:
  /// A place on the rim, radians, and w - gap there, length.
  struct Point {
    double angle, depth;
  };
  /// The samples, and between them those largest and least values that touch or open where the samples beside do not.
  [[nodiscard]] std::vector<Point> points(const VectorXd& m, const VectorXd& depth) const;
  /// Place near a sample at which sign * w is largest.
  [[nodiscard]] double extremum(const VectorXd& m, double angle, double sign) const;
  /// Place between two samples at which w - gap changes its sign.
  [[nodiscard]] double end_between(const VectorXd& m, double low, double high, bool rises) const;

  rim::Harmonics pressures_;
  double stiffness_, gap_, mu_;
  /// Places close enough to see every wave.
  struct Samples {
    VectorXd angles;         ///< (points)
    MatrixXd distributions;  ///< (points, size)
  };
  std::shared_ptr<const Samples> samples_;  ///< of all copies
};

}  // namespace fastjoint::stage3
