// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/formats/plate_solution.hpp"
#include "common/pfem/numbering.hpp"

namespace fastjoint::stage2 {

/// The displacement fields of all unit cases at one degree, element by element. Cases: nc controlled displacements
/// (externals, discs), h friction cases, q tractions.
class UnitFields {
 public:
  /// Throws FileError if the map of unknowns does not fit the mesh. The plate must outlive this.
  UnitFields(const formats::PlateSolution& plate, const std::string& file);

  /// Looks at the cases of this level, one of stress_p, from now on.
  void use(std::size_t level);
  [[nodiscard]] Eigen::Index n_cases() const { return X_.cols(); }
  [[nodiscard]] pfem::Space space() const { return numbering_.space; }
  [[nodiscard]] int p() const { return numbering_.p; }
  [[nodiscard]] const pfem::Edges& edges() const { return edges_; }
  [[nodiscard]] const formats::PlateSolution& plate() const { return plate_; }
  [[nodiscard]] const Eigen::Matrix3d& elasticity(int element) const;

  /// Coefficients of some local modes of an element, local signs, shape (2 n_modes, n_cases): first those of u_x.
  [[nodiscard]] Eigen::MatrixXd coefficients(int element, const std::vector<int>& modes) const;
  /// The same for all its modes.
  [[nodiscard]] Eigen::MatrixXd coefficients(int element) const;

 private:
  [[nodiscard]] Eigen::MatrixXd coefficients(const pfem::ElementDofs& dofs) const;

  const formats::PlateSolution& plate_;
  pfem::Edges edges_;
  pfem::Numbering numbering_;
  Eigen::MatrixXd X_;  ///< (n_p, n_cases) free unknowns
};

}  // namespace fastjoint::stage2
