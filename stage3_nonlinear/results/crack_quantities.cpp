// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/crack_quantities.hpp"

#include "common/infinite.hpp"

namespace fastjoint::stage3 {

PlateGroup crack_quantities(const PlateModel& plate) {
  const std::string factor = "stress intensity factor of the ", at_tips = " mode at each tip";
  const columns::Output I{"K_I", "cracks", "K_I of each crack tip", "largest K_I of all"},
      II{"K_II", "cracks", "K_II of each crack tip"};
  return {columns::Of::tip,
          std::ssize(plate.cracks.tips),
          {{"crack/K_I", columns::intensity, factor + "opening" + at_tips, "K_I", {}, I},
           {"crack/K_II", columns::intensity, factor + "sliding" + at_tips, "K_II", {}, II}},
          [](const PlateAt& at) {
            return side_by_side({at.state().cracks.K_I, at.state().cracks.K_II});
          }};
}

PlateGroup crack_error_quantities(const PlateModel& plate, const CrackErrors& errors) {
  return {columns::Of::tip,
          std::ssize(plate.cracks.tips),
          {{"crack/K_I_error", columns::intensity, "estimated error of K_I", "", h5::infinite_too},
           {"crack/K_II_error", columns::intensity, "estimated error of K_II", "", h5::infinite_too}},
          [errors, t = std::ssize(plate.cracks.tips)](const PlateAt& at) -> MatrixXd {
            if (errors.K_I.rows() == 0) return MatrixXd::Constant(t, 2, infinite);  // not known
            return side_by_side({errors.K_I.row(at.of.increment), errors.K_II.row(at.of.increment)});
          }};
}

}  // namespace fastjoint::stage3
