// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/scene/spring_law.hpp"

#include <algorithm>
#include <stdexcept>

namespace fastjoint::stage1 {
namespace {

/// Equation (29): a disk under uniform pressure in plane stress, u_r = (1 - nu) p r / E.
double plane_stress(double E, double nu, double d) { return 2 / (1 - nu) * E / d; }

/// The same in plane strain, u_r = (1 + nu) (1 - 2 nu) p r / E.
double plane_strain(double E, double nu, double d) { return 2 * E / ((1 - 2 * nu) * (1 + nu) * d); }

/// A disk in plane stress under the pressure p cos 2 theta without shear: u_r = (3 + nu)/3 p r / E cos 2 theta.
double second_harmonic(double E, double nu, double d) { return 6 * E / ((3 + nu) * d); }

}  // namespace

const std::vector<SpringLaw>& spring_laws() {
  static const std::vector<SpringLaw> laws = {{"plane stress", plane_stress, true},
                                              {"plane strain", plane_strain, false},
                                              {"second harmonic", second_harmonic, true}};
  return laws;
}

const SpringLaw& find_spring_law(const std::string& name) {
  const auto& laws = spring_laws();
  const auto found = std::find_if(laws.begin(), laws.end(), [&](const SpringLaw& law) { return law.name == name; });
  if (found == laws.end()) throw std::logic_error("no spring law has this name: " + name);
  return *found;
}

}  // namespace fastjoint::stage1
