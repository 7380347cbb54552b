// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "common/count.hpp"
#include "common/rim/rim_compliance.hpp"
#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {
namespace {

constexpr int lowest_order = 4;
/// Waves that an element of degree p follows along its side, per degree: a side with k waves needs p > pi k, and a
/// little more.
constexpr double waves_per_side = 0.19;

/// Where the field around a hole may stop being smooth, from any hole's view: borders, and edges between elements of
/// unlike thickness or material.
std::vector<pfem::Side> rough_sides(const PlateMesh& plate) {
  const auto& [mesh, edges] = std::tie(plate.mesh, plate.edges);
  std::vector<int> count(edges.size(), 0), first(edges.size(), -1);
  std::vector<bool> unlike(edges.size(), false);
  for (int element = 0; element < mesh.n_elements(); ++element)
    for (int local = 0; local < pfem::n_local_edges; ++local) {
      const int edge = edges.of_element(local, element);
      if (count[edge]++ == 0)
        first[edge] = element;
      else
        unlike[edge] = mesh.thickness[element] != mesh.thickness[first[edge]] ||
                       mesh.material[element] != mesh.material[first[edge]];
    }
  std::vector<pfem::Side> sides;
  for (int element = 0; element < mesh.n_elements(); ++element)
    for (int local = 0; local < pfem::n_local_edges; ++local) {
      const int edge = edges.of_element(local, element);
      if (first[edge] == element && (count[edge] == 1 || unlike[edge])) sides.push_back({element, local});
    }
  return sides;
}

/// The factor by which waves around a hole fall from one order to the next (rim::RimCompliance::fall): the slowest of
/// all that its own waves meet. A border or a step sends back what a mirrored hole would send, another hole what
/// multipoles at the place inverse to this hole's centre would.
double slowest_fall(const PlateScene& scene, const PlateMesh& plate, const std::vector<pfem::Side>& rough, int hole) {
  const rim::Rim& rim = plate.rims[hole];
  const rim::RimCompliance sheet(scene.elasticity[plate.mesh.material[rim.sides[0].element]].inverse(), rim.radius);
  double slowest = 0;
  for (int other = 0; other < count_of(plate.rims); ++other) {
    const Eigen::Vector2d apart = plate.rims[other].center - rim.center;
    const double d = apart.norm(), b = plate.rims[other].radius;
    if (other != hole && d > 0) slowest = std::max(slowest, sheet.fall(apart * (1 - b * b / (d * d))));
  }
  for (const auto& point : scene.points) slowest = std::max(slowest, sheet.fall(point.at - rim.center));
  const double cut = rim::same_place * rim.radius;
  for (const auto& side : rough) {
    const auto curve = pfem::edge_curve(plate.mesh, plate.edges, side.element, side.local_edge);
    if (curve.sweep() != 0) continue;  // arcs are rims, which are among the holes, or outlines far from any
    const Eigen::Vector2d a = curve.point(-1) - rim.center, along = curve.point(1) - rim.center - a;
    const double distance = std::abs(a.x() * along.y() - a.y() * along.x()) / along.norm();
    if (distance < cut) continue;  // a line of symmetry through the hole
    const double nearest = std::clamp(-a.dot(along) / along.squaredNorm(), 0.0, 1.0);
    for (const double at : {0.0, nearest, 1.0}) slowest = std::max(slowest, sheet.fall(2 * (a + at * along)));
  }
  return slowest;
}

/// Throws InputError if the rim of a hole in contact is in several pieces or of several thicknesses.
void check_contact(const PlateScene& scene, const PlateMesh& plate, int hole, std::size_t n_pieces) {
  const auto refuse = [&](const std::string& found, const char* allowed) {
    reject(scene, fmt::format("/holes/{}/spring/compression_only", hole), found, allowed);
  };
  const rim::Rim& rim = plate.rims[hole];
  if (n_pieces > 1)
    refuse(fmt::format("the rim of hole \"{}\" is in {} pieces", scene.holes[hole].id, n_pieces),
           "springs that push but do not pull on a whole rim or one part of it");
  for (const auto& side : rim.sides)
    if (plate.mesh.thickness[side.element] != plate.mesh.thickness[rim.sides[0].element])
      refuse(fmt::format("the sheet has several thicknesses around hole \"{}\"", scene.holes[hole].id),
             "springs that push but do not pull on a rim of one thickness");
}

}  // namespace

Eigen::Matrix3d rim_compliance(const PlateScene& scene, const PlateMesh& plate, int hole) {
  const auto& sides = plate.rims[hole].sides;
  if (sides.empty() || !ends_on_symmetry(scene, plate, hole)) return Eigen::Matrix3d::Zero();
  const int element = sides[0].element, material = plate.mesh.material[element];
  for (const auto& side : sides)
    if (plate.mesh.thickness[side.element] != plate.mesh.thickness[element] ||
        plate.mesh.material[side.element] != material)
      return Eigen::Matrix3d::Zero();
  return scene.elasticity[material].inverse();
}

std::vector<std::optional<rim::Waves>> rim_waves(const PlateScene& scene, const PlateMesh& plate) {
  const auto rough = rough_sides(plate);
  std::vector<std::optional<rim::Waves>> all;
  for (int i = 0; i < count_of(scene.holes); ++i) {
    const Hole& hole = scene.holes[i];
    auto& waves = all.emplace_back();
    const bool in_contact = hole.spring && hole.spring->compression_only;
    const auto pieces = rim::open_pieces(rim::side_angles(plate.mesh, plate.edges, plate.rims[i]));
    if (in_contact) check_contact(scene, plate, i, pieces.size());
    rim::Harmonics shape{in_contact ? hole.spring->harmonics : rim::most_harmonics};
    if (!pieces.empty()) shape.start = pieces[0].from, shape.sweep = pieces[0].to - pieces[0].from;
    const bool is_linked = hole.spring && hole.spring->link > 0;
    if (!(rim_compliance(scene, plate, i)(0, 0) > 0 && shape.repeats())) {
      if (in_contact) waves = {shape, true};
      continue;
    }
    if (!in_contact && (!hole.stresses || is_linked)) continue;
    const double fall = slowest_fall(scene, plate, rough, i);
    const double turn = rim::full_turn / shape.sweep;
    const int followed =
        std::max(lowest_order, static_cast<int>(waves_per_side * scene.p_high * count_of(plate.rims[i].sides) * turn));
    const double wanted = fall < 1 ? 1 + std::log(scene.left_out_of_waves) / std::log(std::max(fall, 1e-9)) : followed;
    const int order =
        hole.waves > 0 ? hole.waves : std::clamp(static_cast<int>(std::ceil(wanted)), lowest_order, followed);
    shape.highest = std::min(shape.highest, order);
    waves = {shape, in_contact};
  }
  return all;
}

}  // namespace fastjoint::stage1
