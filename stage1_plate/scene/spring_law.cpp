// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/scene/spring_law.hpp"

#include <stdexcept>

#include "common/count.hpp"

namespace fastjoint::stage1 {
namespace {

/// Modulus for a disc in plane stress under uniform pressure, u_r = (1 - nu) p r / E: equation (29).
double plane_stress(double E, double nu, double d) { return 2 / (1 - nu) * E / d; }

/// Modulus for a disc in plane strain under uniform pressure, u_r = (1 + nu) (1 - 2 nu) p r / E.
double plane_strain(double E, double nu, double d) { return 2 * E / ((1 - 2 * nu) * (1 + nu) * d); }

/// Modulus for a disc in plane stress under the pressure p cos 2 theta without shear: u_r = (3 + nu)/3 p r / E cos 2
/// theta.
double second_harmonic(double E, double nu, double d) { return 6 * E / ((3 + nu) * d); }

}  // namespace

const std::vector<SpringLaw>& spring_laws() {
  static const std::vector<SpringLaw> laws = {{"plane stress", plane_stress, true},
                                              {"plane strain", plane_strain, false},
                                              {"second harmonic", second_harmonic, true}};
  return laws;
}

const SpringLaw& find_spring_law(const std::string& name) {
  const int found = index_of(spring_laws(), name, &SpringLaw::name);
  if (found == count_of(spring_laws())) throw std::logic_error("no spring law has this name: " + name);
  return spring_laws()[found];
}

}  // namespace fastjoint::stage1
