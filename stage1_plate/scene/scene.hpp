// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>
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

  /// Cell lines across an axis, 0 for x, 1 for y.
  [[nodiscard]] const std::vector<double>& lines(int axis) const { return axis == 0 ? x : y; }
  /// Length of the diagonal.
  [[nodiscard]] double size() const { return std::hypot(x.back() - x.front(), y.back() - y.front()); }
};

/// A cut across the plate next to a hole, along edges of the mesh.
struct MeshSection {
  int hole;                                ///< index into PlateScene::holes
  rim::SignedAxis side;                    ///< side of the hole
  std::vector<std::pair<int, int>> edges;  ///< each given by its two nodes
};

/// The user's mesh with its named sets and sections.
struct MeshGeometry {
  pfem::Mesh mesh;
  std::map<std::string, std::vector<std::pair<int, int>>> edges;  ///< named sets, each edge given by its two nodes
  std::vector<MeshSection> sections;
};

/// The springs of a hole in the scene, by default all around the rim.
struct Spring : rim::HoleSpring {
  Spring() : HoleSpring{.arcs = {{-rim::full_turn / 2, rim::full_turn / 2}}} {}
  double disk_E = 0;              ///< Young's modulus of the disk that the springs model, stress; 0 without one
  rim::ElasticDisk disk{};        ///< elastic pin in place of compression-only springs, if given
  bool has_arc = false;           ///< true if the scene gives the arc with springs
  bool compression_only = false;  ///< true for contact: the springs carry no tension
  /// rim::Harmonics::highest of compression-only springs; the default is high where a closed form adds the waves that
  /// the elements do not resolve
  std::optional<int> harmonics{};
};

struct Hole {
  std::string id;
  Eigen::Vector2d center;
  double radius;
  std::optional<Spring> spring;  ///< empty for an open hole, which has no disc
  int rings;                     ///< extra rings of elements around it (grid only)
  bool has_rings = false;        ///< true if the scene gives their number
  int waves = 0;                 ///< highest order of waves that the elements resolve; 0: determined by needed_orders
  bool stresses = true;          ///< true if stresses at the rim are requested

  /// The spring; throws std::logic_error for an open hole.
  [[nodiscard]] const Spring& sprung() const {
    if (!spring) throw std::logic_error("the hole is open");
    return *spring;
  }
};

/// A spring between a vertex of the mesh and a separate disc. Results depend on the mesh (PlateStiffness::ties).
struct PointSpring {
  std::string id;
  Eigen::Vector2d at;
  double stiffness;  ///< force / length, along each direction of the discs
};

struct Support {
  std::string on;
  std::vector<rim::Axis> fix;
};

/// A rigidly moving edge, an edge under uniform traction, an open hole under cosine pressure, or edges under the
/// traction of a moment without a force.
enum class ExternalKind { rigid, traction, bearing, moment };

struct External {
  std::string id, on;
  rim::Axis direction;  ///< of no meaning for a moment
  ExternalKind kind;
};

/// A crack before the mesh: in a grid a straight line, in an explicit mesh a named set of edges.
struct Crack {
  std::string id;
  std::optional<int> hole{};             ///< hole at whose rim it begins
  Eigen::Vector2d from{0, 0}, to{0, 0};  ///< its ends in a grid
  int tips = 1;                          ///< 1 at `to`; 2 at both ends; 0 from rim to rim
  std::string on{};                      ///< name of the set of edges in an explicit mesh
};

/// The content of PLATE.json, consistent in itself. The meshers check whether the holes fit the geometry.
struct PlateScene {
  std::string file, text;  ///< name and text of the input file
  std::string name;
  Units units;
  std::vector<Eigen::Matrix3d> elasticity;  ///< elasticity of each material, stress
  /// That of a homogeneous sheet which is as stiff in bending as each material, stress; none in plane strain
  std::vector<Eigen::Matrix3d> in_bending{};
  std::optional<Eigen::Matrix2d>
      expansion{};  ///< strain in x and y per degree; none if not given, or not the same of all
  std::vector<std::string> coupled_laminates{};  ///< materials that bend as they stretch, which the model does not
  std::variant<GridGeometry, MeshGeometry> geometry;
  std::vector<Hole> holes;
  std::vector<PointSpring> points;
  std::vector<Crack> cracks;
  std::vector<rim::Axis> disc_directions;  ///< of all discs but those on lines of symmetry
  std::vector<Support> supports;
  std::vector<External> externals;
  pfem::Space space = pfem::Space::product;
  int p_low = 1, p_high = pfem::highest_p;
  /// Tolerance of the truncation of waves: relative strain along a rim of the omitted orders of reflected fields.
  double wave_tolerance = 1e-3;
};

/// Replaces the scene's degrees by those of the option: "8" is one degree, "4..8" a range, "" keeps the scene's.
/// Throws InputError for anything else or outside 1..highest_p.
void set_degrees(PlateScene& scene, const std::string& option);

/// Degrees at which the scene is solved, ascending.
[[nodiscard]] Eigen::VectorXi degrees(const PlateScene& scene);

/// Reads PLATE.json strictly. Throws InputError with the file, the JSON pointer, what was found and what is allowed.
[[nodiscard]] PlateScene read_scene(const input::Document& document);

/// Throws an InputError like those of read_scene, for a place in the file.
[[noreturn]] void reject(const PlateScene& scene, const std::string& pointer, const std::string& found,
                         const std::string& allowed);

}  // namespace fastjoint::stage1
