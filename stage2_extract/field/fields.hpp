// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "common/formats/plate_solution.hpp"
#include "common/plate/plate_states.hpp"

namespace fastjoint::stage2 {

class FieldSolver;

/// Displacement fields of k states of a plate at one degree.
struct Fields {
  const FieldSolver& solver;  ///< must outlive this
  /// (n_cases, k) amount of every unit case: nc controlled displacements (externals, discs), k pressures of
  /// contact, h friction cases, q tractions.
  Eigen::MatrixXd amounts;
  plate::PlateStates states;  ///< the fields, element by element
};

/// A plate of which any state can be solved at any degree up to that of its file: its elements are integrated again
/// from the file's mesh and springs, and factorised at one degree after another (schemas/plate-solution.md says why the
/// file holds neither fields nor factor).
class FieldSolver {
 public:
  /// @param plate Must outlive this. @param file Its name, for messages.
  /// Throws FileError if the map of unknowns does not fit the mesh.
  FieldSolver(const formats::PlateSolution& plate, const std::string& file);
  FieldSolver(const FieldSolver&) = delete;
  FieldSolver& operator=(const FieldSolver&) = delete;

  /// Bytes that a factor at this degree takes.
  [[nodiscard]] double factor_bytes(int p) const;
  /// Factorises at this degree: that of all solutions from now on.
  void factorise(int p);
  /// Solves for states given as amounts of the unit cases, shape (n_cases, k); this must outlive the result.
  [[nodiscard]] Fields solve(Eigen::MatrixXd amounts) const;

  [[nodiscard]] const formats::PlateSolution& plate() const { return plate_; }
  [[nodiscard]] const pfem::Edges& edges() const { return edges_; }
  [[nodiscard]] const pfem::Numbering& numbering() const { return stiffness_.numbering; }
  [[nodiscard]] const Eigen::Matrix3d& elasticity(int element) const;
  /// Condenses functions of an element's coefficients at the degree of the factor.
  /// @param weights Shape (2 n_modes, r).
  [[nodiscard]] plate::CondensedFunctions condense(int element, const Eigen::MatrixXd& weights) const {
    return plate::PlateStates::condense(*factor_, element, weights);
  }

 private:
  const formats::PlateSolution& plate_;
  pfem::Edges edges_;
  plate::PlateStiffness stiffness_;
  plate::Skeleton skeleton_;
  std::unique_ptr<plate::PlateFactor> factor_;
  int n_free_ = 0;  ///< at the degree of the factor
};

}  // namespace fastjoint::stage2
