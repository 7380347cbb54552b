// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>

#include "common/formats/plate_solution.hpp"
#include "common/plate/plate_states.hpp"

namespace fastjoint::stage2 {

class FieldSolver;

/// Displacement fields of a plate in n_states states at one degree.
struct Fields {
  const FieldSolver& solver;  ///< must outlive this
  /// (n_cases, n_states) coefficient of every unit case: controlled displacements (externals, discs), loaded waves,
  /// friction cases, tractions
  Eigen::MatrixXd coefficients;
  plate::PlateStates states;  ///< the fields, element by element
};

/// Solves any state of a plate at any degree up to that of its file. The elements are integrated again from the file's
/// mesh and springs, and factorised at one degree at a time; schemas/plate-solution.md explains why the file has
/// neither fields nor factor.
class FieldSolver {
 public:
  /// @param plate Must outlive this. @param file Name of its file, for messages.
  /// Throws FileError if the map of unknowns does not fit the mesh.
  FieldSolver(const formats::PlateSolution& plate, const std::string& file);
  FieldSolver(const FieldSolver&) = delete;
  FieldSolver& operator=(const FieldSolver&) = delete;

  /// Memory in bytes of a factor at this degree.
  [[nodiscard]] double factor_bytes(int p) const;
  /// Factorises at this degree, which then applies to all solutions.
  void factorise(int p);
  /// Solves for states given by coefficients of the unit cases, shape (n_cases, n_states); this must outlive the
  /// result.
  [[nodiscard]] Fields solve(Eigen::MatrixXd coefficients) const;

  [[nodiscard]] const formats::PlateSolution& plate() const { return plate_; }
  [[nodiscard]] const pfem::Edges& edges() const { return edges_; }
  [[nodiscard]] const pfem::Numbering& numbering() const { return stiffness_.numbering; }
  [[nodiscard]] const Eigen::Matrix3d& elasticity(int element) const;
  /// The factor at the degree that was chosen.
  [[nodiscard]] const plate::PlateFactor& factor() const { return *factor_; }

 private:
  const formats::PlateSolution& plate_;
  std::string file_;
  pfem::Edges edges_;
  plate::PlateStiffness stiffness_;
  plate::Skeleton skeleton_;
  std::unique_ptr<plate::PlateFactor> factor_;
  int n_free_ = 0;  ///< number of free unknowns at the degree of the factor
};

}  // namespace fastjoint::stage2
