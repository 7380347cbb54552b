// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stage1_plate/mesh/grid_cells.hpp"
#include "stage1_plate/mesh/plate_mesh.hpp"

namespace fastjoint::stage1 {

/// Distance of places that count as one, relative to the plate's size.
inline constexpr double same = 1e-9;

/// Ratio of the sizes of neighbouring elements away from a tip.
inline constexpr double growth = 3.5;

/// A tip of a crack in a grid.
struct TipPlace {
  Eigen::Vector2d at;
  double size;  ///< of the elements around it: the distance to the nearest hole, border or crack, or the crack's length
};

/// The tips of each crack, 0 to 2. Throws InputError for a crack that leaves the plate or meets another, and for a tip
/// in a hole or too near to what is around it.
[[nodiscard]] std::vector<std::vector<TipPlace>> place_tips(const PlateScene& scene, const GridGeometry& grid);

/// A grid whose lines have been moved, and what has been done, "x = 86 to 86.5, through a tip".
struct MovedGrid {
  GridGeometry grid;
  std::vector<std::string> moves{};
};

/// Moves cell lines that pass a tip more closely than elements around it are large: through the tip, or so that a
/// corner of a hole's cell lies on the ray of its crack, since slivers between the two would spoil the stress intensity
/// factors.
///
/// The elements around the tip become smaller instead where a line cannot move: it is the border, the thickness or the
/// material changes there, a hole or another tip is in its way. Throws InputError if they would become too small.
[[nodiscard]] MovedGrid lines_through_tips(const PlateScene& scene, const GridGeometry& grid,
                                           std::vector<std::vector<TipPlace>>& tips);

/// Throws InputError for the place of a crack in the file.
[[noreturn]] void reject_crack(const PlateScene& scene, int crack, const std::string& found,
                               const std::string& allowed);

/// A tip inside the cell of a hole, on a ray from the hole's centre.
struct CellTip {
  double angle;   ///< of the ray, radians
  double radius;  ///< distance from the centre, length
  double size;    ///< of the elements around the tip, length
};

/// What cracks ask of the mesh of a grid.
struct GridCracks {
  OfSides<std::vector<CrackNode>> nodes;   ///< where they and their tips need mesh lines
  std::vector<std::vector<CellTip>> tips;  ///< inside the cell of each hole, in the order of the cells
};

/// Plans the mesh lines of the scene's cracks. Throws InputError for a crack that runs through a hole, or that runs
/// through the cell of a hole but not towards its centre.
[[nodiscard]] GridCracks plan_cracks(const PlateScene& scene, const GridGeometry& grid,
                                     const std::vector<HoleCell>& holes,
                                     const std::vector<std::vector<TipPlace>>& tips);

/// A line of edges of elements around a hole.
struct RingLine {
  Eigen::VectorXd radii;      ///< distance from the centre on each ray, length
  Eigen::VectorXd roundness;  ///< from each ray to the next: 1 for an arc about the centre, 0 for a straight edge
};

/// The lines in the cell of a hole with tips, outwards from the rim; the outline is not among them.
/// @param outline Points of the cell's outline, one on each ray. @param nearest Distance to the nearest side.
[[nodiscard]] std::vector<RingLine> tip_layers(const std::vector<CellTip>& tips, double radius,
                                               const Eigen::Vector2d& center,
                                               const std::vector<Eigen::Vector2d>& outline, double nearest);

/// The edges of the mesh along each crack.
[[nodiscard]] std::vector<CrackPath> crack_paths(const PlateScene& scene, const PlateMesh& plate);

}  // namespace fastjoint::stage1
