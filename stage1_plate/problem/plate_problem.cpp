// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/plate_problem.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

#include "common/pfem/shape_functions.hpp"

namespace fastjoint::stage1 {
namespace {

constexpr int undecided = 0;

/// Global functions that do not vanish on a side: two vertices, then the edge's modes.
std::vector<int> functions_on(const pfem::Numbering& numbering, const pfem::Side& side) {
  std::vector<int> list = pfem::modes_on_edge(numbering.p, side.local_edge);
  for (int& mode : list) mode = numbering.function(mode, side.element);
  return list;
}

[[noreturn]] void conflict(const PlateScene& scene, const PlateMesh& plate, const External& external, int function) {
  const std::string where =
      function < plate.mesh.n_nodes()
          ? fmt::format("at ({:g}, {:g})", plate.mesh.nodes(0, function), plate.mesh.nodes(1, function))
          : std::string("along an edge");
  reject(scene, "/external",
         fmt::format("external \"{}\" moves the plate in {} {}, where a support or another external prescribes it",
                     external.id, rim::name_of(external.direction), where),
         "one support or rigid external for each displacement");
}

/// Ties the vertices of an external's sides to its displacement, and fixes their edge modes, which would bend it, at
/// zero.
void control(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering, int external_index,
             int index, Unknowns& unknowns) {
  const External& external = scene.externals[external_index];
  for (const auto& side : plate.sets.at(external.on))
    for (const int function : functions_on(numbering, side)) {
      int& dof = unknowns.dofs(rim::coordinate(external.direction), function);
      const int wanted = function < plate.mesh.n_nodes() ? pfem::controlled_dof(index) : pfem::fixed_dof;
      if (dof != undecided && dof != wanted) conflict(scene, plate, external, function);
      dof = wanted;
    }
}

/// Directions in which the disc of a hole moves: that of the line of symmetry for half a hole, the first direction for
/// a quarter hole, which is on two such lines.
std::vector<rim::Axis> directions_of(const PlateScene& scene, const PlateMesh& plate, int hole) {
  const auto& all = scene.disc_directions;
  const auto pieces = rim::open_pieces(rim::side_angles(plate.mesh, plate.edges, plate.rims[hole]));
  if (pieces.size() != 1 || all.size() == 1) return all;
  const auto is = [](double angle, double other) { return std::abs(angle - other) < rim::same_angle; };
  const auto [from, to] = pieces[0];
  if (is(to - from, rim::full_turn / 4)) return {all[0]};
  if (!is(to - from, rim::full_turn / 2)) return all;
  for (const rim::Axis direction : all)
    if (rim::is_along(from, direction)) return {direction};
  return all;
}

void add_discs(const PlateScene& scene, const PlateMesh& plate, Unknowns& unknowns) {
  const auto add = [&](const std::string& id, const std::vector<rim::Axis>& directions) {
    unknowns.disc_hole.insert(unknowns.disc_hole.end(), directions.size(), id);
    unknowns.disc_direction.insert(unknowns.disc_direction.end(), directions.begin(), directions.end());
  };
  unknowns.first_disc = {0};
  for (int hole = 0; hole < count_of(scene.holes); ++hole) {
    if (scene.holes[hole].spring) add(scene.holes[hole].id, directions_of(scene, plate, hole));
    unknowns.first_disc.push_back(unknowns.n_discs());
  }
  for (const auto& point : scene.points) add(point.id, scene.disc_directions);
}

/// Holds a sheet that has no support, spring or rigid external against rigid motions: one vertex along both axes, and
/// the vertex farthest from it across the way between them. Loads in balance cause no forces there.
void hold_free_body(const PlateScene& scene, const PlateMesh& plate, Unknowns& unknowns) {
  const bool is_free = scene.supports.empty() && scene.points.empty() && rigid_externals(scene).empty() &&
                       std::ranges::none_of(scene.holes, [](const Hole& hole) { return hole.spring.has_value(); });
  if (!is_free) return;
  const auto farthest_from = [&](const Eigen::Vector2d& at) {
    int vertex = 0;
    (plate.mesh.nodes.colwise() - at).colwise().squaredNorm().maxCoeff(&vertex);
    return vertex;
  };
  const int one = farthest_from(plate.mesh.nodes.rowwise().mean());
  unknowns.held_at = plate.mesh.nodes.col(one);
  const int other = farthest_from(*unknowns.held_at);
  const Eigen::Vector2d way = plate.mesh.nodes.col(other) - *unknowns.held_at;
  unknowns.dofs.col(one).setConstant(pfem::fixed_dof);
  unknowns.dofs(std::abs(way.x()) > std::abs(way.y()) ? 1 : 0, other) = pfem::fixed_dof;
}

void number_free(Unknowns& unknowns) {
  int n_free = 0;
  for (int& dof : unknowns.dofs.reshaped())
    if (dof == undecided) dof = n_free++;
}

/// Applies supports and rigid externals. Throws InputError where two of them prescribe the same displacement.
Unknowns classify_unknowns(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering) {
  Unknowns unknowns;
  unknowns.dofs.setConstant(2, numbering.n_functions.back(), undecided);
  for (const auto& support : scene.supports)
    for (const rim::Axis direction : support.fix)
      for (const auto& side : plate.sets.at(support.on))
        for (const int function : functions_on(numbering, side))
          unknowns.dofs(rim::coordinate(direction), function) = pfem::fixed_dof;
  for (const int external : rigid_externals(scene))
    control(scene, plate, numbering, external, unknowns.n_externals++, unknowns);
  add_discs(scene, plate, unknowns);
  hold_free_body(scene, plate, unknowns);
  number_free(unknowns);
  unknowns.n_free = plate::count_free(numbering, unknowns.dofs);
  return unknowns;
}

/// The loads in the order of the externals.
std::vector<TractionCase> traction_cases(const PlateScene& scene, const PlateMesh& plate) {
  constexpr double negligible = 1e-12;  // relative to a whole rim; rounding is about 1e-16
  std::vector<TractionCase> list;
  for (int i = 0; i < count_of(scene.externals); ++i) {
    const External& external = scene.externals[i];
    if (external.kind == ExternalKind::traction || external.kind == ExternalKind::moment) list.push_back({i});
    if (external.kind != ExternalKind::bearing) continue;
    const rim::Rim& rim = plate.rims[index_of(scene.holes, external.on, &Hole::id)];
    for (const int side : {1, -1}) {
      const auto d = rim::unit_vector({external.direction, side});
      const double force = rim::bearing(plate.mesh, plate.edges, rim, d).unit_force;
      const bool is_there = force >= negligible * plate.mesh.thickness.maxCoeff() * rim.radius;
      if (is_there || side > 0) list.push_back({i, side, is_there ? force : 0});
    }
  }
  return list;
}

std::vector<rim::PointSpring> tie_points(const PlateScene& scene, const PlateMesh& plate, const Unknowns& unknowns) {
  std::vector<rim::PointSpring> ties;
  for (int i = 0; i < count_of(scene.points); ++i)
    for (int a = 0; a < count_of(scene.disc_directions); ++a) {
      const rim::Axis direction = scene.disc_directions[a];
      const int disc = unknowns.first_disc.back() + i * count_of(scene.disc_directions) + a;  // after those of holes
      ties.push_back({plate.point_nodes[i], disc, scene.points[i].stiffness});
      if (unknowns.dof_of(ties.back()) == pfem::fixed_dof)
        reject(scene, fmt::format("/points/{}/at", i),
               fmt::format("a support fixes the vertex along {}, so that the spring cannot load the plate",
                           rim::name_of(direction)),
               "vertices that are free to move along every one of \"disc_directions\"");
    }
  return ties;
}

/// Rejects an arc that contains no part of the rim.
void check_arcs(const PlateScene& scene, const plate::PlateElements& elements) {
  std::vector<double> stiffness(scene.holes.size(), 0);
  for (int element = 0; element < count_of(elements.class_of); ++element)
    for (const auto& rim : elements.classes[elements.class_of[element]].rims)
      stiffness[elements.holes[element][rim.hole]] += rim.terms.stiffness;
  for (int hole = 0; hole < count_of(scene.holes); ++hole) {
    const auto& spring = scene.holes[hole].spring;
    if (spring && spring->has_arc && stiffness[hole] == 0)
      reject(scene, fmt::format("/holes/{}/spring/arc", hole),
             fmt::format("no part of the rim of hole \"{}\" in the model is in this arc", scene.holes[hole].id),
             "an arc that covers a part of the rim, in degrees counter-clockwise from x");
  }
}

/// Adds a uniform traction of unit total force on an edge, or that of a moment: as the displacements of a small
/// rotation about the edge's centroid, so without a force, and linear along a straight edge as in bending.
void add_edge_load(const PlateMesh& plate, const External& external, const PlateProblem& problem, int column,
                   Loads& loads) {
  const EdgeMoments edge = edge_moments(plate, external.on);
  const auto traction = [&](const Eigen::Vector2d& x) -> Eigen::Vector2d {
    if (external.kind != ExternalKind::moment) return rim::unit_vector(external.direction) / edge.area;
    return Eigen::Vector2d(edge.centroid.y() - x.y(), x.x() - edge.centroid.x()) / (edge.area * edge.arm);
  };
  for (const auto& side : plate.sets.at(external.on)) {
    const auto rule = pfem::side_rule(plate.mesh, plate.edges, side, problem.numbering.p);
    Eigen::MatrixX2d load = Eigen::MatrixX2d::Zero(rule.N.rows(), 2);
    for (int q = 0; q < rule.ds.size(); ++q)
      load += plate.mesh.thickness[side.element] * rule.ds[q] * rule.N.col(q) * traction(rule.x.col(q)).transpose();
    add_load(problem, side.element, rule.modes, load.reshaped(), column, loads);
  }
}

/// Adds the cosine pressure on the bearing half of an open hole, of unit force along the external's direction; it is
/// negative on the half against that direction.
void add_pressure(const PlateScene& scene, const PlateMesh& plate, const TractionCase& of, const PlateProblem& problem,
                  int column, Loads& loads) {
  const External& external = scene.externals[of.external];
  const rim::Rim& rim = plate.rims[index_of(scene.holes, external.on, &Hole::id)];
  const Eigen::Vector2d d = rim::unit_vector({external.direction, of.side});
  if (of.unit_force == 0)
    reject(scene, fmt::format("/external/{}", of.external),
           fmt::format("the model has no rim of hole \"{}\" on the side that bears along +{}", external.on,
                       rim::name_of(external.direction)),
           "a hole with a rim on that side");
  for (const auto& side : rim.sides) {
    const auto rule = rim::rim_rule(plate.mesh, plate.edges, side, problem.numbering.p);
    Eigen::MatrixX2d load = Eigen::MatrixX2d::Zero(rule.N.rows(), 2);
    for (int q = 0; q < rule.ds.size(); ++q) {
      const Eigen::Vector2d n = -rule.normal.col(q);
      const double pressure = of.side * rim::cosine_bearing(n, d).contact / of.unit_force;
      load += plate.mesh.thickness[side.element] * rule.ds[q] * pressure * rule.N.col(q) * n.transpose();
    }
    add_load(problem, side.element, rule.modes, load.reshaped(), column, loads);
  }
}

/// Displacements by the rigid motions of a sheet: along x, along y, and a rotation by a unit angle about a place.
Eigen::Matrix<double, 2, 3> rigid_motions(const Eigen::Vector2d& at, const Eigen::Vector2d& place) {
  Eigen::Matrix<double, 2, 3> u;
  u << 1, 0, place.y() - at.y(), 0, 1, at.x() - place.x();
  return u;
}

/// Adds to each unit load of a free body what balances it: tractions on its straight border that vary as a rigid motion
/// does. Loads that are in balance together add none, and the fields of each stay smooth where the body is held.
void balance_loads(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem, Loads& loads) {
  const Eigen::Vector2d& place = *problem.unknowns.held_at;
  struct OnSide {
    int element;
    std::vector<int> modes;
    std::array<Eigen::MatrixX2d, 3> load;  ///< of a traction as each motion
  };
  std::vector<OnSide> all;
  Eigen::Matrix3d resistance = Eigen::Matrix3d::Zero();
  for (const auto& sides : plate.edges.sides) {
    const pfem::Side& side = sides[0];
    if (sides.size() > 1 || plate.edges.arc[plate.edges.of(side)] >= 0) continue;
    const auto rule = pfem::side_rule(plate.mesh, plate.edges, side, problem.numbering.p);
    OnSide& its = all.emplace_back(OnSide{side.element, rule.modes, {}});
    its.load.fill(Eigen::MatrixX2d::Zero(rule.N.rows(), 2));
    for (int q = 0; q < rule.ds.size(); ++q) {
      const auto u = rigid_motions(rule.x.col(q), place);
      const double area = plate.mesh.thickness[side.element] * rule.ds[q];
      resistance += area * u.transpose() * u;
      for (int k = 0; k < 3; ++k) its.load[k] += area * rule.N.col(q) * u.col(k).transpose();
    }
  }
  const Eigen::Matrix3Xd amplitude = -resistance.ldlt().solve(resultants(scene, plate, problem.tractions, place));
  for (const auto& its : all)
    for (int column = 0; column < amplitude.cols(); ++column) {
      const Eigen::MatrixX2d sum =
          amplitude(0, column) * its.load[0] + amplitude(1, column) * its.load[1] + amplitude(2, column) * its.load[2];
      add_load(problem, its.element, its.modes, sum.reshaped(), column, loads);
    }
}

/// Sets T_f and T_c: loads of a unit total force of every traction case, uniform on an edge or as cosine pressure on
/// half of an open hole.
void add_traction_loads(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem) {
  const auto& list = problem.tractions;
  Loads loads;
  for (int column = 0; column < count_of(list); ++column) {
    if (list[column].side != 0)
      add_pressure(scene, plate, list[column], problem, column, loads);
    else
      add_edge_load(plate, scene.externals[list[column].external], problem, column, loads);
  }
  if (problem.unknowns.held_at) balance_loads(scene, plate, problem, loads);
  const int n_f = problem.unknowns.n_free.back(), nc = problem.unknowns.n_controlled();
  Eigen::SparseMatrix<double> T(n_f + nc, count_of(list));
  T.setFromTriplets(loads.begin(), loads.end());
  problem.T_f = T.topRows(n_f);
  problem.T_c = T.bottomRows(nc);
  constexpr double negligible = 1e-12;  // of the unit force; rounding is about 1e-16
  for (int column = 0; column < count_of(list); ++column) {
    if (Eigen::VectorXd(problem.T_f.col(column)).isZero(negligible) && problem.T_c.col(column).isZero(negligible))
      reject(scene, fmt::format("/external/{}", list[column].external),
             "supports fix all displacements that it loads, or another external moves all that a moment would turn",
             "a load along a direction in which the plate is free to move there");
  }
}

}  // namespace

EdgeMoments edge_moments(const PlateMesh& plate, const std::string& edge) {
  EdgeMoments all;
  const auto sum_over = [&](const auto& add) {
    for (const auto& side : plate.sets.at(edge)) {
      const auto rule = pfem::side_rule(plate.mesh, plate.edges, side, 2);
      for (int q = 0; q < rule.ds.size(); ++q) add(plate.mesh.thickness[side.element] * rule.ds[q], rule.x.col(q));
    }
  };
  sum_over([&](double area, const Eigen::Vector2d& x) { all.area += area, all.centroid += area * x; });
  all.centroid /= all.area;
  double second = 0;
  sum_over([&](double area, const Eigen::Vector2d& x) { second += area * (x - all.centroid).squaredNorm(); });
  all.arm = std::sqrt(second / all.area);
  return all;
}

Eigen::Matrix3Xd resultants(const PlateScene& scene, const PlateMesh& plate, const std::vector<TractionCase>& tractions,
                            const Eigen::Vector2d& place) {
  Eigen::Matrix3Xd all = Eigen::Matrix3Xd::Zero(3, std::ssize(tractions));
  for (Eigen::Index i = 0; i < all.cols(); ++i) {
    const auto& [at, side, unit_force] = tractions[i];
    const External& external = scene.externals[at];
    if (external.kind == ExternalKind::moment) {
      all(2, i) = edge_moments(plate, external.on).arm;
      continue;
    }
    Eigen::Vector2d force = rim::unit_vector(external.direction), middle;
    if (external.kind == ExternalKind::bearing) {
      const rim::Rim& rim = plate.rims[index_of(scene.holes, external.on, &Hole::id)];
      const auto d = rim::unit_vector({external.direction, side});
      force[1 - rim::coordinate(external.direction)] =
          side * rim::bearing(plate.mesh, plate.edges, rim, d).force_across / unit_force;
      middle = rim.center;
    } else {
      middle = edge_moments(plate, external.on).centroid;
    }
    all.col(i) = rigid_motions(middle, place).transpose() * force;
  }
  return all;
}

std::vector<int> rigid_externals(const PlateScene& scene) {
  std::vector<int> list;
  for (int i = 0; i < count_of(scene.externals); ++i)
    if (scene.externals[i].kind == ExternalKind::rigid) list.push_back(i);
  return list;
}

void add_load(const plate::PlateStiffness& plate, int element, const std::vector<int>& modes,
              const Eigen::VectorXd& values, int column, Loads& loads) {
  const auto [dof, sign] = pfem::element_dofs(plate.numbering, plate.unknowns.dofs, element);
  const int n_free = plate.unknowns.n_free.back(), n = count_of(modes);
  for (const int component : {0, 1})
    for (int i = 0; i < n; ++i) {
      const auto at = modes[i] + component * plate.numbering.function.rows();
      if (dof[at] != pfem::fixed_dof)
        loads.emplace_back(pfem::is_free(dof[at]) ? dof[at] : n_free + pfem::controlled_index(dof[at]), column,
                           sign[at] * values[component * n + i]);
    }
}

plate::SprungMesh sprung_mesh(const PlateScene& scene, const PlateMesh& plate) {
  plate::SprungMesh sprung{plate.mesh, plate.edges, plate.rims, {}, rim_waves(scene, plate), {}};
  for (int i = 0; i < count_of(scene.holes); ++i) {
    const auto& spring = sprung.springs.emplace_back(scene.holes[i].spring);
    const auto directions = spring ? directions_of(scene, plate, i) : std::vector<rim::Axis>();
    auto& axes = sprung.axes.emplace_back(2, directions.size());
    for (int d = 0; d < count_of(directions); ++d) axes.col(d) = rim::unit_vector(directions[d]);
  }
  return sprung;
}

PlateProblem number_unknowns(const PlateScene& scene, const PlateMesh& plate) {
  PlateProblem problem;
  problem.numbering = pfem::number_by_degree(plate.mesh, plate.edges, scene.space, scene.p_high);
  problem.unknowns = classify_unknowns(scene, plate, problem.numbering);
  const plate::SprungMesh sprung = sprung_mesh(scene, plate);
  plate::count_rim_cases(sprung, problem.unknowns);
  problem.elements = plate::classify_elements(sprung, problem.numbering, problem.unknowns);
  problem.tractions = traction_cases(scene, plate);
  problem.waves = sprung.waves;
  problem.ties = tie_points(scene, plate, problem.unknowns);
  for (int i = 0; i < count_of(scene.holes); ++i) {
    if (problem.unknowns.n_cases[i] == 0) continue;
    const int first = problem.unknowns.first_disc[i], n = problem.unknowns.first_disc[i + 1] - first;
    const auto names = rim::friction_cases(std::span(problem.unknowns.disc_direction).subspan(first, n));
    problem.friction_hole.insert(problem.friction_hole.end(), names.size(), scene.holes[i].id);
    problem.friction_bearing.insert(problem.friction_bearing.end(), names.begin(), names.end());
  }
  return problem;
}

void integrate(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem) {
  problem.elements.stiffness =
      pfem::integrate(problem.elements.congruent, plate.mesh, plate.edges, scene.elasticity, scene.space, scene.p_high);
  check_arcs(scene, problem.elements);
  add_traction_loads(scene, plate, problem);
}

}  // namespace fastjoint::stage1
