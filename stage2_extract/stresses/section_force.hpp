// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "stage2_extract/stresses/unit_fields.hpp"

namespace fastjoint::stage2 {

/// Normal force over a section in every unit case, shape (n_cases), tension positive: the integral of the stress, mean
/// of the elements on both sides of the section, force per unit of the case.
[[nodiscard]] Eigen::RowVectorXd section_force(const UnitFields& fields, const rim::Section& section);

/// Area of a section, length^2.
struct SectionArea {
  double gross, net;  ///< net: less the area that the hole takes of it
};
[[nodiscard]] SectionArea section_area(const UnitFields& fields, const rim::Section& section);

}  // namespace fastjoint::stage2
