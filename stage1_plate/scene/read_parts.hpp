// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/count.hpp"
#include "common/pfem/material.hpp"
#include "stage1_plate/scene/scene.hpp"

namespace fastjoint::stage1 {

/// A material of a scene, for its analysis.
struct Material {
  std::string id;                            ///< name
  Eigen::Matrix3d elasticity;                ///< of a laminate the mean over its thickness, stress
  std::optional<Eigen::Matrix2d> expansion;  ///< strain in x and y per degree, if given
  double stack = 0;                          ///< thickness of a laminate, length; 0 of another material
  /// How much a laminate couples: the largest entry of B over the largest of A and the thickness; 0 of a symmetric
  /// stack.
  double coupling = 0;
  /// Elasticity of a homogeneous sheet that is as stiff in bending as a laminate, 12 D over the cube of its thickness,
  /// stress; none of another material.
  std::optional<Eigen::Matrix3d> in_bending{};
};

/// Strain of free expansion per degree along axis 1 and axis 2, turned to x and y; none if it is not given.
/// @param along, across Keys. @param angle From x to axis 1, radians.
[[nodiscard]] std::optional<Eigen::Matrix2d> read_expansion(const input::Value& value, const char* along,
                                                            const char* across, double angle, pfem::Analysis analysis);

/// Reads the constants of an orthotropic material, which strains make take energy.
[[nodiscard]] pfem::OrthotropicConstants read_constants(const input::Value& value, pfem::Analysis analysis);

/// Reads {"plies": [{constants, "angles", "thickness"}, ...]}, from the bottom of the stack to its top (Jones, section
/// 4.2).
[[nodiscard]] Material read_laminate(const std::string& id, const input::Value& value, pfem::Analysis analysis);

[[nodiscard]] pfem::Analysis read_analysis(const input::Value& root);

/// Reads "analysis" and "materials" of a scene, in the order of their names.
[[nodiscard]] std::vector<Material> read_materials(const input::Value& root);

[[nodiscard]] Eigen::Vector2d read_point(const input::Value& value);

/// Range of quantities in any unit, within which the products and squares in the programs do not overflow.
inline constexpr double smallest = 1e-30, largest = 1e30;
/// Lower bound of spring stiffness, which no formula divides by.
inline constexpr double softest_spring = input::smallest_number;

/// Reads a length, a modulus or a stiffness: a number from `low` to largest.
[[nodiscard]] double read_quantity(const input::Value& value, double low = smallest);
/// Reads a coordinate, any number up to largest.
[[nodiscard]] double read_coordinate(const input::Value& value);

/// Elements of the array at a key, empty if it is missing.
[[nodiscard]] std::vector<input::Value> read_items(const input::Value& value, const char* key);

/// Reads the id of one of these items as its index.
template <class Item>
[[nodiscard]] int read_id(const input::Value& value, const std::vector<Item>& items) {
  std::vector<std::string> ids;
  for (const auto& item : items) ids.push_back(item.id);
  return index_of(ids, value.choice(ids));
}

/// Reads "geometry": {"grid": ...} or {"mesh": ...} without its "sections", which refer to the holes.
[[nodiscard]] std::variant<GridGeometry, MeshGeometry> read_geometry(const input::Value& value,
                                                                     const std::vector<Material>& materials);

/// Reads "sections" of an explicit mesh into the scene's geometry; needs its holes and the directions of its discs.
void read_sections(const input::Value& root, PlateScene& scene);

/// Reads "cracks": straight ones in a grid, named sets of edges in an explicit mesh. Needs geometry and holes.
[[nodiscard]] std::vector<Crack> read_cracks(const input::Value& root, const PlateScene& scene);

/// A law for the modulus of distributed springs that model an elastic disk.
struct SpringLaw {
  std::string name;
  /// @param E, nu Constants of the disk. @param d Its diameter. @return Modulus, force / length^3.
  double (*modulus)(double E, double nu, double d);
  bool incompressible_allowed;  ///< whether nu = 0.5 has a finite modulus
};

/// All laws; the first is the default.
[[nodiscard]] const std::vector<SpringLaw>& spring_laws();

/// Reads "spring" of a hole of this radius.
[[nodiscard]] Spring read_spring(const input::Value& value, double radius, pfem::Analysis analysis);

}  // namespace fastjoint::stage1
