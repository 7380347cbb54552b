// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "common/plate/plate_factor.hpp"
#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {

/// Bytes that a run takes at its highest degree, known before anything is integrated.
struct MemoryNeed {
  double elements;  ///< matrices of the classes of elements
  double factor;    ///< the skeleton's stiffness and its factor
  double fields;    ///< fields of tractions and of the probe, and what is made of them for the file
  double contact;   ///< fields in the search for contact, which ends before these are solved; 0 without one
  double program;

  [[nodiscard]] double total() const {
    constexpr double gaps = 1.15;  // what the allocator cannot use between them, and what integrating takes
    return gaps * (elements + factor + std::max(fields, contact)) + program;
  }
};
/// @param problem Result of number_unknowns. @param p Degrees to be solved, ascending. @param n_rim Number of unknowns
/// on the rims on which contact is looked for, 0 without.
[[nodiscard]] MemoryNeed memory_need(const PlateProblem& problem, const plate::Skeleton& skeleton,
                                     const Eigen::VectorXi& p, int n_rim = 0);

/// Throws InputError, which says how much degree p needs and for what, if it is more than is available.
void require_memory(const std::string& file, int p, const MemoryNeed& need);

}  // namespace fastjoint::stage1
