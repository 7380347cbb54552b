// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/scene/read_parts.hpp"

#include "common/pfem/material.hpp"
#include "common/rim/angles.hpp"

namespace fastjoint::stage1 {
namespace {

using input::Value;
using pfem::Analysis;

Eigen::Matrix3d read_isotropic(const Value& value, Analysis analysis) {
  value.only({"E", "nu"});
  const auto constants = pfem::isotropic(value.at("E").number(input::positive), value.at("nu").number(poisson_range));
  if (!pfem::is_stable(constants, analysis))
    value.at("nu").not_allowed(
        "a number > -1 and < 0.5 in plane strain (0.5 is incompressible: its stiffness is infinite)");
  return pfem::elasticity(constants, 0, analysis);
}

Eigen::Matrix3d read_orthotropic(const Value& value, Analysis analysis) {
  value.only({"E1", "E2", "nu12", "G12", "angle", "E3", "nu13", "nu23"});
  pfem::OrthotropicConstants c{};
  c.E1 = value.at("E1").number(input::positive);
  c.E2 = value.at("E2").number(input::positive);
  c.nu12 = value.at("nu12").number();
  c.G12 = value.at("G12").number(input::positive);
  if (analysis == Analysis::plane_strain) {
    c.E3 = value.at("E3").number(input::positive);
    c.nu13 = value.at("nu13").number();
    c.nu23 = value.at("nu23").number();
  } else {
    for (const char* key : {"E3", "nu13", "nu23"})
      if (const auto unused = value.find(key)) unused->fail("given in plane stress", "only in plane strain");
  }
  if (!pfem::is_stable(c, analysis))
    value.fail("these constants give a negative strain energy",
               "a positive definite compliance (nu12^2 < E1/E2 in plane stress)");
  const auto angle = value.find("angle");
  return pfem::elasticity(c, angle ? angle->number() * rim::degree : 0, analysis);
}

}  // namespace

Materials read_materials(const Value& root) {
  const bool stress = root.at("analysis").choice({"plane stress", "plane strain"}) == "plane stress";
  const Analysis analysis = stress ? Analysis::plane_stress : Analysis::plane_strain;
  Materials materials;
  const Value list = root.at("materials");
  for (const auto& [name, value] : list.members()) {
    materials.name.push_back(name);
    materials.elasticity.push_back(value.find("E") || value.find("nu") ? read_isotropic(value, analysis)
                                                                       : read_orthotropic(value, analysis));
  }
  if (materials.name.empty()) list.fail("no material", "at least one");
  return materials;
}

}  // namespace fastjoint::stage1
