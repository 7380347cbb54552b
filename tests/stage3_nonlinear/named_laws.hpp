// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::test {

/// A law as the input has it, so that its numbers can be changed one by one.
struct LawText {
  std::string type;
  std::vector<std::pair<std::string, double>> numbers;  ///< as Law::parameters names them
  double last_delta = 1;                                ///< of a cubic, whose displacements are no parameters

  [[nodiscard]] double& number(const std::string& name);
  [[nodiscard]] std::shared_ptr<const stage3::Law> law() const;
};

/// A joint with named laws at a load factor.
struct NamedJoint {
  HandMade model;
  std::map<std::string, LawText> laws;
  double load_factor = 1;

  /// The model with its laws as they stand.
  [[nodiscard]] stage3::JointEquations equations();
};

/// Random joints of all kinds: one of them per number from 0 to n_kinds - 1.
inline constexpr int n_kinds = 10;
[[nodiscard]] NamedJoint named_joint(std::mt19937& random, int kind);

/// Changes the coefficient of friction of one of its holes by this, and balances the fastener again.
void add_to_mu(stage3::FastenerModel& fastener, Eigen::Index hole, double change);

}  // namespace fastjoint::test
