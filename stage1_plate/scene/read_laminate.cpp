// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "common/pfem/material.hpp"
#include "common/rim/angles.hpp"
#include "stage1_plate/scene/read_parts.hpp"

namespace fastjoint::stage1 {
namespace {

using input::Value;

/// A ply of a stack.
struct Ply {
  Eigen::Matrix3d elasticity;  ///< stress
  double thickness;            ///< length
  std::optional<Eigen::Matrix2d> expansion;
};

std::vector<Ply> read_plies(const Value& list) {
  constexpr std::size_t max_plies = 10000;
  std::vector<Ply> plies;
  for (const auto& group : list.items(1, max_plies)) {
    group.only({"E1", "E2", "nu12", "G12", "angles", "thickness", "alpha1", "alpha2"});
    const auto c = read_constants(group, pfem::Analysis::plane_stress);
    const double thickness = read_quantity(group.at("thickness"));
    for (const double angle : group.at("angles").numbers(1, max_plies, input::any_number))
      plies.push_back({pfem::elasticity(c, angle * rim::degree, pfem::Analysis::plane_stress), thickness,
                       read_expansion(group, "alpha1", "alpha2", angle * rim::degree, pfem::Analysis::plane_stress)});
  }
  return plies;
}

/// Free strain of the laminate, by the resultant of the plies' stresses that hold them: (x, y, engineering xy).
std::optional<Eigen::Matrix2d> expansion_of(const std::vector<Ply>& plies, const Eigen::Matrix3d& stiffness) {
  Eigen::Vector3d held = Eigen::Vector3d::Zero();
  for (const Ply& ply : plies) {
    if (!ply.expansion) return std::nullopt;
    const Eigen::Matrix2d& strain = *ply.expansion;
    held += ply.thickness * ply.elasticity * Eigen::Vector3d(strain(0, 0), strain(1, 1), 2 * strain(0, 1));
  }
  const Eigen::Vector3d free = stiffness.inverse() * held;
  Eigen::Matrix2d strain;
  strain << free[0], free[2] / 2, free[2] / 2, free[1];
  return strain;
}

}  // namespace

Material read_laminate(const std::string& id, const Value& value, pfem::Analysis analysis) {
  value.only({"plies"});
  if (analysis == pfem::Analysis::plane_strain)
    value.at("plies").fail("a laminate in plane strain", "only in plane stress");
  const auto plies = read_plies(value.at("plies"));
  Material laminate{id, {}, {}};
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero(), coupling = stiffness, bending = stiffness;  // A, B, D
  for (const Ply& ply : plies) laminate.stack += ply.thickness;
  double z = -laminate.stack / 2;
  for (const Ply& ply : plies) {
    stiffness += ply.thickness * ply.elasticity;
    coupling += ply.thickness * (z + ply.thickness / 2) * ply.elasticity;
    bending += (std::pow(z + ply.thickness, 3) - std::pow(z, 3)) / 3 * ply.elasticity;
    z += ply.thickness;
  }
  laminate.elasticity = stiffness / laminate.stack;
  laminate.in_bending = 12 / std::pow(laminate.stack, 3) * bending;
  laminate.expansion = expansion_of(plies, stiffness);
  laminate.coupling = coupling.cwiseAbs().maxCoeff() / (stiffness.maxCoeff() * laminate.stack);
  return laminate;
}

}  // namespace fastjoint::stage1
