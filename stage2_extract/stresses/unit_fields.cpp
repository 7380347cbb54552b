// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/stresses/unit_fields.hpp"

#include <fmt/format.h>

#include <numeric>

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

Eigen::MatrixXd UnitFields::coefficients(int element, const std::vector<int>& modes) const {
  const Eigen::Index n = modes.size();
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(2 * n, n_cases());
  for (Eigen::Index i = 0; i < n; ++i) {
    const int mode = modes[i];
    const int function = numbering_.function(mode, element);
    for (Eigen::Index component = 0; component < 2; ++component) {
      const int unknown = plate_.unknown(component, function);
      const auto row = component * n + i;
      if (unknown >= 0 && unknown < X_.rows()) C.row(row) = numbering_.sign(mode, element) * X_.row(unknown);
      if (unknown < -1) C(row, -2 - unknown) = numbering_.sign(mode, element);
    }
  }
  return C;
}

Eigen::MatrixXd UnitFields::coefficients(int element) const {
  std::vector<int> modes(numbering_.function.rows());
  std::iota(modes.begin(), modes.end(), 0);
  return coefficients(element, modes);
}

}  // namespace fastjoint::stage2
