// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "stage3_nonlinear/interfaces/interface.hpp"
#include "stage3_nonlinear/interfaces/rim_problem.hpp"

namespace fastjoint::stage3 {

/// A rim of contact with its friction as an interface of the joint: the rows are the long waves of the disc's normal
/// displacement relative to the sheet, the friction columns those of shear; the short waves are eliminated by a local
/// problem (docs/theory.md, sections 6.4 and 6.5).
class RimInterface : public Interface {
 public:
  /// @param at Index among all rims of contact of the joint. @param has_friction Whether it has friction columns.
  RimInterface(std::shared_ptr<const RimProblem> rim, Index at, bool has_friction)
      : rim_(std::move(rim)), at_(at), has_friction_(has_friction) {}

  [[nodiscard]] Index size() const override { return rim_->n_long(); }
  [[nodiscard]] Index n_friction() const override { return has_friction_ ? rim_->waves()->n_long_shears : 0; }
  [[nodiscard]] Response respond(const VectorXd& c, const History& history) const override;
  void add_small_stiffness(double small, Response& response) const override;
  [[nodiscard]] std::vector<std::vector<Corner>> corners() const override;
  [[nodiscard]] double position(const VectorXd& c, Index entry) const override;
  [[nodiscard]] VectorXd slope(const VectorXd& c, Index entry) const override;
  /// The coordinates of linear springs, which act in tension too.
  [[nodiscard]] VectorXd coordinates(const VectorXd& F) const override {
    return (1 + rim_->k() / rim_->contact().stiffness()) * F;
  }
  [[nodiscard]] std::vector<Change> changes(const VectorXd& c, const Response& response) const override;

 private:
  std::shared_ptr<const RimProblem> rim_;
  Index at_;
  bool has_friction_;
};

}  // namespace fastjoint::stage3
