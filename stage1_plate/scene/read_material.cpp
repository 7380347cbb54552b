// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/scene/read_parts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/count.hpp"
#include "common/pfem/material.hpp"
#include "common/rim/angles.hpp"

namespace fastjoint::stage1 {
namespace {

using input::Value;
using pfem::Analysis;

/// Allowed range of Poisson's ratio of an isotropic body.
constexpr input::Range poisson_range{.low = -1, .high = 0.5, .low_allowed = false, .high_allowed = true};

Eigen::Matrix3d read_isotropic(const Value& value, Analysis analysis) {
  value.only({"E", "nu", "alpha"});
  const auto constants = pfem::isotropic(read_quantity(value.at("E")), value.at("nu").number(poisson_range));
  if (!pfem::is_stable(constants, analysis))
    value.at("nu").not_allowed(
        "a number > -1 and < 0.5 in plane strain (0.5 is incompressible: its stiffness is infinite)");
  return pfem::elasticity(constants, 0, analysis);
}

Eigen::Matrix3d read_orthotropic(const Value& value, Analysis analysis) {
  value.only({"E1", "E2", "nu12", "G12", "angle", "E3", "nu13", "nu23", "alpha1", "alpha2"});
  const auto angle = value.find("angle");
  return pfem::elasticity(read_constants(value, analysis), angle ? angle->number() * rim::degree : 0, analysis);
}

Material read_material(const std::string& id, const Value& value, Analysis analysis) {
  if (value.find("plies")) return read_laminate(id, value, analysis);
  if (value.find("E") || value.find("nu"))
    return {id, read_isotropic(value, analysis), read_expansion(value, "alpha", "alpha", 0, analysis)};
  const auto angle = value.find("angle");
  const Eigen::Matrix3d elasticity = read_orthotropic(value, analysis);
  return {id, elasticity,
          read_expansion(value, "alpha1", "alpha2", angle ? angle->number() * rim::degree : 0, analysis)};
}

/// Modulus for a disc in plane stress under uniform pressure, u_r = (1 - nu) p r / E: equation (29).
double plane_stress(double E, double nu, double d) { return 2 / (1 - nu) * E / d; }

/// Modulus for a disc in plane strain under uniform pressure, u_r = (1 + nu) (1 - 2 nu) p r / E.
double plane_strain(double E, double nu, double d) { return 2 * E / ((1 - 2 * nu) * (1 + nu) * d); }

/// Modulus for a disc in plane stress under the pressure p cos 2 theta without shear: u_r = (3 + nu)/3 p r / E cos 2
/// theta.
double second_harmonic(double E, double nu, double d) { return 6 * E / ((3 + nu) * d); }

/// Sets the modulus of the springs that model an elastic disk, and with the law "elastic" the disk itself, which
/// replaces them in contact.
void read_disk(const Value& disk, double radius, Analysis analysis, Spring& spring) {
  disk.only({"E", "nu", "law"});
  std::vector<std::string> names;
  for (const auto& law : spring_laws()) names.push_back(law.name);
  names.emplace_back("elastic");
  const auto name = disk.find("law");
  std::string word = name ? name->choice(names) : names.front();
  const bool is_elastic = word == "elastic", in_strain = analysis == Analysis::plane_strain;
  if (is_elastic) word = in_strain ? "plane strain" : "plane stress";
  const SpringLaw& law = spring_laws()[index_of(names, word)];
  input::Range range = poisson_range;
  range.high_allowed = law.incompressible_allowed;
  const double E = spring.disk_E = read_quantity(disk.at("E")), nu = disk.at("nu").number(range);
  spring.modulus = law.modulus(E, nu, 2 * radius);
  if (is_elastic)
    spring.disk = in_strain ? rim::ElasticDisk{E / (1 - nu * nu), nu / (1 - nu)} : rim::ElasticDisk{E, nu};
}

/// Reads an arc in degrees, counter-clockwise from x, as radians.
rim::AngleRange read_arc(const Value& value) {
  const auto ends = value.numbers(2, 2, input::any_number);
  constexpr double whole = 360;
  if (!(ends[0] < ends[1] && ends[1] <= ends[0] + whole))
    value.not_allowed("[from, to] in degrees counter-clockwise, from < to <= from + 360");
  return {ends[0] / whole * rim::full_turn, ends[1] / whole * rim::full_turn};
}

}  // namespace

pfem::OrthotropicConstants read_constants(const Value& value, Analysis analysis) {
  pfem::OrthotropicConstants c{};
  c.E1 = read_quantity(value.at("E1"));
  c.E2 = read_quantity(value.at("E2"));
  c.nu12 = value.at("nu12").number();
  c.G12 = read_quantity(value.at("G12"));
  if (analysis == Analysis::plane_strain) {
    c.E3 = read_quantity(value.at("E3"));
    c.nu13 = value.at("nu13").number();
    c.nu23 = value.at("nu23").number();
  } else {
    for (const char* key : {"E3", "nu13", "nu23"})
      if (const auto unused = value.find(key)) unused->fail("given in plane stress", "only in plane strain");
  }
  if (!pfem::is_stable(c, analysis))
    value.fail("these constants give a negative strain energy",
               "a positive definite compliance (nu12^2 < E1/E2 in plane stress)");
  return c;
}

std::optional<Eigen::Matrix2d> read_expansion(const Value& value, const char* along, const char* across, double angle,
                                              Analysis analysis) {
  const auto first = value.find(along), second = value.find(across);
  if (!first && !second) return std::nullopt;
  if (!first || !second) value.fail(fmt::format("\"{}\" alone", first ? along : across), "the other one too, or none");
  if (analysis == Analysis::plane_strain) first->fail("given in plane strain", "only in plane stress");
  Eigen::Matrix2d turned, expansion = Eigen::Vector2d(first->number(), second->number()).asDiagonal();
  turned << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return turned * expansion * turned.transpose();
}

Analysis read_analysis(const Value& root) {
  const bool stress = root.at("analysis").choice({"plane stress", "plane strain"}) == "plane stress";
  return stress ? Analysis::plane_stress : Analysis::plane_strain;
}

std::vector<Material> read_materials(const Value& root) {
  const Analysis analysis = read_analysis(root);
  std::vector<Material> materials;
  const Value list = root.at("materials");
  for (const auto& [name, value] : list.members()) materials.push_back(read_material(name, value, analysis));
  if (materials.empty()) list.fail("no material", "at least one");
  return materials;
}

const std::vector<SpringLaw>& spring_laws() {
  static const std::vector<SpringLaw> laws = {{"plane stress", plane_stress, true},
                                              {"plane strain", plane_strain, false},
                                              {"second harmonic", second_harmonic, true}};
  return laws;
}

Spring read_spring(const Value& value, double radius, Analysis analysis) {
  value.only({"disk", "modulus", "links", "arc", "compression_only", "harmonics"});
  const auto disk = value.find("disk");
  const auto modulus = value.find("modulus");
  const auto links = value.find("links");
  if (disk.has_value() + modulus.has_value() + links.has_value() != 1)
    value.not_allowed("either \"disk\" or \"modulus\" or \"links\"");
  Spring spring;
  if (disk) read_disk(*disk, radius, analysis, spring);
  if (modulus) spring.modulus = read_quantity(*modulus, softest_spring);
  if (links) spring.link = read_quantity(*links, softest_spring);
  const auto arc = value.find("arc");
  if (arc) {
    spring.arcs = {read_arc(*arc)};
    spring.has_arc = true;
  }
  if (const auto only = value.find("compression_only")) {
    spring.compression_only = only->boolean();
    if (links || arc) only->fail(links ? "given with \"links\"" : "given with \"arc\"", "with neither of them");
  }
  if (spring.disk.is_given() && !spring.compression_only)
    disk->at("law").fail("\"elastic\" without contact", "\"elastic\" with \"compression_only\": true, or another law");
  if (const auto harmonics = value.find("harmonics")) {
    if (!spring.compression_only) harmonics->fail("given without contact", "with \"compression_only\": true");
    spring.harmonics = harmonics->integer(1, rim::max_harmonics);
  }
  return spring;
}

}  // namespace fastjoint::stage1
