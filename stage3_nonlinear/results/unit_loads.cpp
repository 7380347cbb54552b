// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/unit_loads.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// @param D_delta Rows of one plate, (m+e, n a).
/// @param load    Forces on its unknowns, (m+e).
void add(std::vector<std::string>& names, MatrixXd& q, const std::string& name, const MatrixXd& D_delta,
         const VectorXd& load) {
  names.push_back(name);
  q.conservativeResize(Eigen::NoChange, q.cols() + 1);
  q.rightCols(1) = without_rounding(D_delta.transpose() * load, load.cwiseAbs().maxCoeff());
}

}  // namespace

UnitLoads unit_loads(const JointModel& joint, const CondensedSystem& system) {
  const Index rows = system.q.size();
  UnitLoads loads{{}, MatrixXd(rows, 0), {}, MatrixXd(rows, 0)};
  for (std::size_t p = 0; p < joint.plates.size(); ++p) {
    const PlateModel& plate = joint.plates[p];
    const MatrixXd D = system.D_delta.middleRows(joint.offset(p), plate.n_unknowns());
    for (Index i = 0; i < plate.n_externals(); ++i) {
      const std::string name = plate.name + ":" + plate.externals[i];
      const Index unknown = plate.n_discs() + i;
      if (plate.external_displacement[i]) {
        add(loads.displacement, loads.q_displacement, name, D, -plate.S.col(unknown));
      } else {
        add(loads.force, loads.q_force, name, D, VectorXd::Unit(plate.n_unknowns(), unknown));
      }
    }
    for (std::size_t i = 0; i < plate.tractions.size(); ++i)
      add(loads.force, loads.q_force, plate.name + ":" + plate.tractions[i], D, -plate.T.col(i));
  }
  return loads;
}

}  // namespace fastjoint::stage3
