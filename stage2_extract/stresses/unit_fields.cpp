// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/stresses/unit_fields.hpp"

#include <fmt/format.h>

#include "common/errors.hpp"

namespace fastjoint::stage2 {

UnitFields::UnitFields(const formats::PlateSolution& plate, const std::string& file)
    : plate_(plate),
      edges_(pfem::find_edges(plate.mesh)),
      numbering_(pfem::number_by_degree(plate.mesh, edges_, plate.space, plate.p[plate.p.size() - 1])) {
  if (plate.unknown.cols() != numbering_.n_functions.back())
    throw FileError(fmt::format("{}:unknown: has {} rows, the mesh has {} functions at p = {} of the {} space", file,
                                plate.unknown.cols(), numbering_.n_functions.back(), numbering_.p,
                                pfem::name_of(numbering_.space)));
}

void UnitFields::use(std::size_t level) {
  const auto& cases = plate_.cases[level];
  X_.resize(cases.V.rows(), cases.U.cols() + cases.W.cols() + cases.V.cols());
  X_ << cases.U, cases.W, cases.V;
}

const Eigen::Matrix3d& UnitFields::elasticity(int element) const {
  return plate_.elasticity[plate_.mesh.material[element]];
}

Eigen::MatrixXd UnitFields::coefficients(const pfem::ElementDofs& dofs) const {
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(dofs.dof.size(), n_cases());
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    const int dof = dofs.dof[i];
    if (pfem::is_free(dof) && dof < X_.rows()) C.row(i) = dofs.sign[i] * X_.row(dof);
    if (pfem::is_controlled(dof)) C(i, pfem::controlled_index(dof)) = dofs.sign[i];
  }
  return C;
}

Eigen::MatrixXd UnitFields::coefficients(int element, const std::vector<int>& modes) const {
  return coefficients(pfem::element_dofs(numbering_, plate_.unknown, element, modes));
}

Eigen::MatrixXd UnitFields::coefficients(int element) const {
  return coefficients(pfem::element_dofs(numbering_, plate_.unknown, element));
}

}  // namespace fastjoint::stage2
