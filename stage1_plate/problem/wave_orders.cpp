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

constexpr int min_order = 4;

/// Sides where the field may lose smoothness: edges of the plate, and edges between elements of different thickness or
/// material.
std::vector<pfem::Side> rough_sides(const PlateMesh& plate) {
  const pfem::Mesh& mesh = plate.mesh;
  const auto differ = [&](int one, int other) {
    return mesh.thickness[one] != mesh.thickness[other] || mesh.material[one] != mesh.material[other];
  };
  std::vector<pfem::Side> rough;
  for (const auto& sides : plate.edges.sides)
    if (sides.size() == 1 || differ(sides[0].element, sides[1].element)) rough.push_back(sides[0]);
  return rough;
}

/// Distance of the image source of a hole behind a straight edge, in the limit of all reflections between the two: of
/// the mirrored hole, of its image in that one, and so on.
double image_of_line(double distance, double radius) {
  return distance + std::sqrt(std::max(distance * distance - radius * radius, 0.0));
}

/// Distance of the image source inside another hole.
double image_in_hole(double distance, double radius, double other) {
  double at = distance;
  for (int i = 0; i < 20; ++i) at = distance - other * other / (distance - radius * radius / at);
  return at;
}

/// Ratio of successive orders of the waves around a hole (rim::RimCompliance::fall): the maximum over all reflecting
/// edges, steps, other holes and point springs.
double slowest_fall(const PlateScene& scene, const PlateMesh& plate, const std::vector<pfem::Side>& rough, int hole) {
  const rim::Rim& rim = plate.rims[hole];
  const rim::RimCompliance sheet(scene.elasticity[plate.mesh.material[rim.sides[0].element]].inverse(), rim.radius);
  double slowest = 0;
  for (int other = 0; other < count_of(plate.rims); ++other) {
    const Eigen::Vector2d apart = plate.rims[other].center - rim.center;
    if (const double d = apart.norm(); other != hole && d > 0)
      slowest = std::max(slowest, sheet.fall(apart / d * image_in_hole(d, rim.radius, plate.rims[other].radius)));
  }
  for (const auto& point : scene.points) slowest = std::max(slowest, sheet.fall(point.at - rim.center));
  const double cut = rim::same_place * rim.radius;
  for (const auto& side : rough) {
    const auto curve = pfem::edge_curve(plate.mesh, plate.edges, side.element, side.local_edge);
    if (curve.sweep() != 0) continue;  // arcs are rims of holes, treated above, or outlines far from any hole
    const Eigen::Vector2d a = curve.point(-1) - rim.center, along = curve.point(1) - rim.center - a;
    const double distance = std::abs(a.x() * along.y() - a.y() * along.x()) / along.norm();
    if (distance < cut) continue;  // it is a line of symmetry through the hole
    const double nearest = std::clamp(-a.dot(along) / along.squaredNorm(), 0.0, 1.0);
    for (const double at : {0.0, nearest, 1.0}) {
      const Eigen::Vector2d place = a + at * along;
      slowest = std::max(slowest, sheet.fall(place.normalized() * image_of_line(place.norm(), rim.radius)));
    }
  }
  return slowest;
}

/// Strain along a rim of all orders n > `order`, relative to order 1: the sum of n fall^(n-1).
double truncation_error(int order, double fall) {
  return fall < 1 ? (order + 1 - order * fall) * std::pow(fall, order) / ((1 - fall) * (1 - fall)) : HUGE_VAL;
}

/// Lowest order whose truncation is within the scene's tolerance.
int determined_order(const PlateScene& scene, const PlateMesh& plate, const std::vector<pfem::Side>& rough, int hole) {
  const double fall = slowest_fall(scene, plate, rough, hole);
  int order = min_order;
  while (order < rim::max_harmonics && truncation_error(order, fall) > scene.wave_tolerance) ++order;
  return order;
}

}  // namespace

int resolved_order(int p, double n_sides) {
  constexpr double waves_per_side_and_degree = 0.19;  // a side with k waves needs a degree p somewhat above pi k
  return std::max(min_order, static_cast<int>(waves_per_side_and_degree * p * n_sides));
}

std::vector<int> needed_orders(const PlateScene& scene, const PlateMesh& plate) {
  const auto rough = rough_sides(plate);
  std::vector<int> orders;
  for (int i = 0; i < count_of(scene.holes); ++i)
    orders.push_back(scene.holes[i].waves > 0 ? scene.holes[i].waves : determined_order(scene, plate, rough, i));
  return orders;
}

std::vector<std::string> few_waves(const PlateScene& scene, const PlateMesh& plate) {
  const auto rough = rough_sides(plate);
  std::vector<std::string> found;
  for (int i = 0; i < count_of(scene.holes); ++i)
    if (const int waves = scene.holes[i].waves; waves > 0)
      if (const int needed = determined_order(scene, plate, rough, i); waves < needed)
        found.push_back(
            fmt::format("/holes/{}/waves: hole \"{}\" has {} waves; its neighbours need {}: the stresses on "
                        "its rim may be off by more than their error bars",
                        i, scene.holes[i].id, waves, needed));
  return found;
}

}  // namespace fastjoint::stage1
