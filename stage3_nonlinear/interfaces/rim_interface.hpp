// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage3_nonlinear/interfaces/interface.hpp"
#include "stage3_nonlinear/interfaces/rim_contact.hpp"

namespace fastjoint::stage3 {

/// A rim of contact with its friction: the rows are the moments of the disc's normal displacement against the sheet
/// times the rim's stiffness, the friction columns the waves of shear (docs/theory.md, sections 6.4 and 6.5).
class RimInterface : public Interface {
 public:
  /// @param area Of the rim, length^2. @param at Among all rims of contact of the joint.
  /// @param rubs Whether it has friction columns.
  RimInterface(const RimContact& rim, double area, Index at, bool rubs)
      : rim_(rim), area_(area), at_(at), rubs_(rubs) {}

  [[nodiscard]] Index size() const override { return rim_.size(); }
  [[nodiscard]] Index n_friction() const override { return rubs_ ? rim_.pressures().n_shears() : 0; }
  [[nodiscard]] Response respond(const VectorXd& c, const History& history) const override;
  void add_trace(double trace, Response& response) const override { response.dF.diagonal().array() += trace; }
  [[nodiscard]] std::vector<std::vector<Corner>> corners() const override;
  [[nodiscard]] double position(const VectorXd& c, Index entry) const override;
  [[nodiscard]] VectorXd slope(const VectorXd& c, Index entry) const override;
  /// Those of springs that also pull.
  [[nodiscard]] VectorXd coordinates(const VectorXd& F) const override { return F; }
  [[nodiscard]] std::vector<Change> changes(const VectorXd& c, const Response& response) const override;

 private:
  RimContact rim_;
  double area_;
  Index at_;
  bool rubs_;
};

}  // namespace fastjoint::stage3
