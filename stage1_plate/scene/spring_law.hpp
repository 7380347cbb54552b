// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace fastjoint::stage1 {

/// A law by which the modulus of distributed springs follows from the elastic disc that they stand for.
struct SpringLaw {
  std::string name;
  /// @param E, nu Constants of the disc. @param d Its diameter. @return Modulus, force / length^3.
  double (*modulus)(double E, double nu, double d);
  bool incompressible_allowed;  ///< whether nu = 0.5 has a finite modulus
};

/// All laws; the first is the default. Adding one = one line of its table.
[[nodiscard]] const std::vector<SpringLaw>& spring_laws();

/// The law of that name, which must be one of them.
[[nodiscard]] const SpringLaw& find_spring_law(const std::string& name);

}  // namespace fastjoint::stage1
