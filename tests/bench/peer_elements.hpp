// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>

#include <Eigen/Core>

namespace fastjoint::peer {

using Cell = dealii::DoFHandler<2>::active_cell_iterator;

/// The two components of displacement.
inline const dealii::FEValuesExtractors::Vector displacement(0);

/// Stress per strain of the panel's material, force / length^2.
[[nodiscard]] dealii::SymmetricTensor<4, 2> plane_stress();

/// Stiffness of cells and of the springs between them and the disc in their hole, force / length.
class Integrator {
 public:
  /// p + 1 points each way. More of them, or a mapping of a higher degree than p, change the errors of S by about a
  /// tenth.
  Integrator(const dealii::Mapping<2>& mapping, const dealii::FiniteElement<2>& fe);

  /// Shape (n + 1, n + 1) for the cell's n unknowns and, last, the disc's displacement along x.
  [[nodiscard]] dealii::FullMatrix<double> operator()(const Cell& cell);

 private:
  void add_plate(dealii::FullMatrix<double>& K) const;
  void add_springs(dealii::FullMatrix<double>& K) const;

  dealii::FEValues<2> inside_;
  dealii::FEFaceValues<2> side_;
};

/// Eliminates the unknowns first ... last - 1, whose rows and columns become 0.
///
/// @return X of shape (last - first, n): where u holds 0 for the eliminated unknowns, these are -X u.
Eigen::MatrixXd condense(dealii::FullMatrix<double>& K, unsigned int first, unsigned int last);

}  // namespace fastjoint::peer
