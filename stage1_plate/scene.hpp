// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/formats/header.hpp"
#include "common/input/json.hpp"

namespace fastjoint::stage1 {

/// A rectangle cut into cells by lines; each cell holds at most one hole.
struct GridGeometry {
  std::vector<double> x, y;   ///< cell lines, ascending, length
  Eigen::MatrixXd thickness;  ///< (y cells, x cells), bottom row first, length
  Eigen::MatrixXi material;   ///< (y cells, x cells) index into PlateScene::elasticity
};

/// A named set of edges, each by its two nodes.
struct EdgeSet {
  std::string name;
  std::vector<std::pair<int, int>> edges;
};

/// A mesh that the user made.
struct MeshGeometry {
  struct Arc {
    int a, b;
    Eigen::Vector2d center;
  };
  std::vector<Eigen::Vector2d> nodes;  ///< length
  std::vector<Eigen::Vector4i> quads;  ///< nodes, counter-clockwise
  std::vector<Arc> arcs;
  std::vector<double> thickness;  ///< (quads), length
  std::vector<int> material;      ///< (quads)
  std::vector<EdgeSet> edges;
};

struct Hole {
  std::string id;
  Eigen::Vector2d center;
  double radius;
  std::optional<double> spring_modulus;  ///< force / length^3; none in an open hole, which has no disc
  int rings;                             ///< extra rings of elements around it (grid only)
};

struct Support {
  std::string on;
  std::vector<std::string> fix;  ///< directions
};

enum class ExternalKind { rigid, traction };

struct External {
  std::string id, on, direction;
  ExternalKind kind;
};

/// PLATE.json as it was meant, consistent in itself; whether the holes fit the geometry is for the meshers to say.
struct PlateScene {
  std::string file, text;  ///< where it came from
  std::string name;
  formats::Units units;
  std::vector<Eigen::Matrix3d> elasticity;  ///< of each material, stress
  std::variant<GridGeometry, MeshGeometry> geometry;
  std::vector<Hole> holes;
  std::vector<std::string> disc_directions;
  std::vector<Support> supports;
  std::vector<External> externals;
  int p_low = 1, p_high = 8;
};

inline constexpr int highest_p = 8;

/// Reads PLATE.json strictly. Throws InputError with the file, the JSON pointer, what was found and what is allowed.
[[nodiscard]] PlateScene read_scene(const input::Document& document);

/// Throws the InputError that read_scene would throw at this place of the file.
[[noreturn]] void reject(const PlateScene& scene, const std::string& pointer, const std::string& found,
                         const std::string& allowed);

}  // namespace fastjoint::stage1
