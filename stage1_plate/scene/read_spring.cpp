// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/scene/read_parts.hpp"

#include "common/count.hpp"

namespace fastjoint::stage1 {
namespace {

using input::Value;

/// Modulus for a disc in plane stress under uniform pressure, u_r = (1 - nu) p r / E: equation (29).
double plane_stress(double E, double nu, double d) { return 2 / (1 - nu) * E / d; }

/// Modulus for a disc in plane strain under uniform pressure, u_r = (1 + nu) (1 - 2 nu) p r / E.
double plane_strain(double E, double nu, double d) { return 2 * E / ((1 - 2 * nu) * (1 + nu) * d); }

/// Modulus for a disc in plane stress under the pressure p cos 2 theta without shear: u_r = (3 + nu)/3 p r / E cos 2
/// theta.
double second_harmonic(double E, double nu, double d) { return 6 * E / ((3 + nu) * d); }

double read_disk(const Value& disk, double radius) {
  disk.only({"E", "nu", "law"});
  std::vector<std::string> names;
  for (const auto& law : spring_laws()) names.push_back(law.name);
  const auto name = disk.find("law");
  const SpringLaw& law = spring_laws()[name ? index_of(names, name->choice(names)) : 0];
  const double E = disk.at("E").number(input::positive);
  input::Range range = poisson_range;
  range.high_allowed = law.incompressible_allowed;
  return law.modulus(E, disk.at("nu").number(range), 2 * radius);
}

/// Degrees, counter-clockwise from x, to radians.
rim::AngleRange read_arc(const Value& value) {
  const auto ends = value.numbers(2, 2, input::any_number);
  constexpr double whole = 360;
  if (!(ends[0] < ends[1] && ends[1] <= ends[0] + whole))
    value.not_allowed("[from, to] in degrees counter-clockwise, from < to <= from + 360");
  return {ends[0] / whole * rim::full_turn, ends[1] / whole * rim::full_turn};
}

}  // namespace

const std::vector<SpringLaw>& spring_laws() {
  static const std::vector<SpringLaw> laws = {{"plane stress", plane_stress, true},
                                              {"plane strain", plane_strain, false},
                                              {"second harmonic", second_harmonic, true}};
  return laws;
}

Spring read_spring(const Value& value, double radius) {
  value.only({"disk", "modulus", "links", "arc", "compression_only"});
  const auto disk = value.find("disk");
  const auto modulus = value.find("modulus");
  const auto links = value.find("links");
  if (disk.has_value() + modulus.has_value() + links.has_value() != 1)
    value.not_allowed("either \"disk\" or \"modulus\" or \"links\"");
  Spring spring;
  if (disk) {
    spring.modulus = read_disk(*disk, radius);
    spring.disk_E = disk->at("E").number();
  }
  if (modulus) spring.modulus = modulus->number(input::positive);
  if (links) spring.link = links->number(input::positive);
  const auto arc = value.find("arc");
  if (arc) {
    spring.acts = {read_arc(*arc)};
    spring.has_arc = true;
  }
  if (const auto only = value.find("compression_only")) {
    spring.compression_only = only->boolean();
    if (links || arc) only->fail(links ? "given with \"links\"" : "given with \"arc\"", "with neither of them");
  }
  return spring;
}

}  // namespace fastjoint::stage1
