// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/input/value.hpp"
#include "common/pfem/mesh.hpp"
#include "common/pfem/shape_functions.hpp"
#include "common/rim/elastic_disk.hpp"
#include "common/rim/rim.hpp"
#include "common/units.hpp"

namespace fastjoint::stage1 {

/// A rectangle cut into cells by lines; each cell holds at most one hole.
struct GridGeometry {
  std::vector<double> x, y;   ///< cell lines, ascending, length
  Eigen::MatrixXd thickness;  ///< (y cells, x cells), bottom row first, length
  Eigen::MatrixXi material;   ///< (y cells, x cells) index into PlateScene::elasticity
};

/// A cut across the plate beside a hole, along edges of the mesh.
struct MeshSection {
  int hole;                                ///< index into PlateScene::holes
  std::string side;                        ///< on which side of the hole, "+x", "-x", "+y" or "-y"
  std::vector<std::pair<int, int>> edges;  ///< each by its two nodes
};

/// The user's mesh and what is named in it.
struct MeshGeometry {
  pfem::Mesh mesh;
  std::map<std::string, std::vector<std::pair<int, int>>> edges;  ///< named sets, each edge by its two nodes
  std::vector<MeshSection> sections;
};

/// The springs of a hole as the scene has them: all around, unless it says where they act.
struct Spring : rim::HoleSpring {
  Spring() : HoleSpring{.arcs = {{-rim::full_turn / 2, rim::full_turn / 2}}} {}
  double disk_E = 0;              ///< Young's modulus of the disc that the springs stand for, stress; 0 without one
  rim::ElasticDisk disk{};        ///< that presses in place of springs that only push; none: springs do
  bool has_arc = false;           ///< whether the scene says on which part of the rim they act
  bool compression_only = false;  ///< it pushes but does not pull
  /// rim::Harmonics::highest of a spring that only pushes; not given: many where a closed form holds for those that the
  /// elements do not carry
  std::optional<int> harmonics{};
};

struct Hole {
  std::string id;
  Eigen::Vector2d center;
  double radius;
  std::optional<Spring> spring;  ///< none in an open hole, which has no disc
  int rings;                     ///< extra rings of elements around it (grid only)
  bool has_rings = false;        ///< whether the scene says how many
  int waves = 0;                 ///< highest order of waves that the elements carry; 0: by what is around the hole
  bool stresses = true;          ///< whether stresses at the rim are wanted

  /// The spring of a hole that has one.
  [[nodiscard]] const Spring& sprung() const {
    if (!spring) throw std::logic_error("the hole is open");
    return *spring;
  }
};

/// A spring between a vertex of the mesh and a disc of its own: what results depend on the mesh with.
struct PointSpring {
  std::string id;
  Eigen::Vector2d at;
  double stiffness;  ///< force / length, along each direction of the discs
};

struct Support {
  std::string on;
  std::vector<std::string> fix;  ///< directions
};

/// An edge that moves as one, an edge under uniform traction, an open hole under cosine pressure.
enum class ExternalKind { rigid, traction, bearing };

struct External {
  std::string id, on, direction;
  ExternalKind kind;
};

/// PLATE.json as it was meant, consistent in itself; whether the holes fit the geometry is for the meshers to say.
struct PlateScene {
  std::string file, text;  ///< where it came from
  std::string name;
  Units units;
  std::vector<Eigen::Matrix3d> elasticity;  ///< of each material, stress
  std::variant<GridGeometry, MeshGeometry> geometry;
  std::vector<Hole> holes;
  std::vector<PointSpring> points;
  std::vector<std::string> disc_directions;  ///< of all discs but those on lines of symmetry
  std::vector<Support> supports;
  std::vector<External> externals;
  pfem::Space space = pfem::Space::product;
  int p_low = 1, p_high = pfem::highest_p;
  /// Part of the strain along a rim below which short waves of what comes back to it from elsewhere are left out.
  double left_out_of_waves = 1e-3;
};

/// Replaces the scene's degrees by the option's: "8" is that degree alone, "4..8" a range, "" leaves the scene's.
/// Throws InputError for anything else or outside 1..highest_p.
void set_degrees(PlateScene& scene, const std::string& option);

/// Degrees at which the scene is solved, ascending.
[[nodiscard]] Eigen::VectorXi degrees(const PlateScene& scene);

/// Reads PLATE.json strictly. Throws InputError with the file, the JSON pointer, what was found and what is allowed.
[[nodiscard]] PlateScene read_scene(const input::Document& document);

/// Throws the InputError that read_scene would throw at this place of the file.
[[noreturn]] void reject(const PlateScene& scene, const std::string& pointer, const std::string& found,
                         const std::string& allowed);

}  // namespace fastjoint::stage1
