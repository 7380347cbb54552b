// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/plate_problem.hpp"

#include <fmt/format.h>

#include <numeric>

#include "common/rim/bearing.hpp"
#include "stage1_plate/problem/assembler.hpp"

namespace fastjoint::stage1 {
namespace {

std::vector<plate::PointTie> tie_points(const PlateScene& scene, const PlateMesh& plate, const Unknowns& unknowns) {
  std::vector<plate::PointTie> ties;
  for (int i = 0; i < count_of(scene.points); ++i)
    for (int a = 0; a < unknowns.n_directions; ++a) {
      const std::string& direction = scene.disc_directions[a];
      const int dof = unknowns.dofs(direction == "x" ? 0 : 1, plate.point_nodes[i]);
      if (dof == pfem::fixed_dof)
        reject(scene, fmt::format("/points/{}/at", i),
               fmt::format("a support holds the vertex along {}, so that the spring cannot load the plate", direction),
               "vertices that are free to move along every one of \"disc_directions\"");
      ties.push_back({plate.point_nodes[i], dof, unknowns.controlled_of_disc(disc_of_point(scene, unknowns, i) + a),
                      scene.points[i].stiffness});
    }
  return ties;
}

/// Adds what elements at rigid externals contribute to K_fc and K_cc.
void add_externals(const PlateMesh& plate, const PlateProblem& problem, Assembler& assembler) {
  std::vector<int> modes(problem.numbering.function.rows());
  std::iota(modes.begin(), modes.end(), 0);
  for (int element = 0; element < plate.mesh.n_elements(); ++element)
    assembler.add_stiffness(element, modes, problem.elements.stiffness[problem.elements.congruent.class_of[element]],
                            plate.mesh.thickness[element]);
}

/// Calls visit(hole, element, terms, scale) for every side of a sprung rim.
template <class Visit>
void for_each_rim_side(const plate::PlateElements& elements, Visit visit) {
  for (int element = 0; element < count_of(elements.class_of); ++element)
    for (const auto& rim : elements.classes[elements.class_of[element]].rims)
      visit(elements.holes[element][rim.hole], element, rim.terms, elements.scale[element]);
}

/// Adds the normal springs between every rim and its rigid disc, equation (6), as far as controlled displacements feel
/// them: -int k t (u.n)(e.n) ds between plate and disc, int k t (e.n)(e'.n) ds of the disc, and what a rim that ends on
/// a rigid external has of int k t (v.n)(u.n) ds; sums over nodes for links.
void add_springs(const PlateScene& scene, const PlateProblem& problem, Assembler& assembler) {
  const Unknowns& unknowns = problem.unknowns;
  std::vector<double> stiffness(scene.holes.size(), 0);
  for_each_rim_side(problem.elements, [&](int hole, int element, const plate::RimTerms& terms, double scale) {
    const int first = unknowns.controlled_of_disc(unknowns.disc_of_hole[hole]);
    stiffness[hole] += terms.stiffness;
    assembler.add_stiffness(element, terms.modes, terms.plate, scale);
    for (int a = 0; a < unknowns.n_directions; ++a) {
      assembler.add_coupling(element, terms.modes, scale * terms.coupling.col(a), first + a);
      for (int b = 0; b < unknowns.n_directions; ++b)
        assembler.add(pfem::controlled_dof(first + a), first + b, scale * terms.disc(a, b));
    }
  });
  for (std::size_t hole = 0; hole < scene.holes.size(); ++hole) {
    const auto& spring = scene.holes[hole].spring;
    if (spring && spring->has_arc && stiffness[hole] == 0)
      reject(scene, fmt::format("/holes/{}/spring/arc", hole),
             fmt::format("the rim of hole \"{}\" that the model has is nowhere in this arc", scene.holes[hole].id),
             "an arc that covers a part of the rim, in degrees counter-clockwise from x");
  }
}

/// Sets L_f and L_c: unit friction cases of every disc of a hole, direction inner, bearing side + then -, tangential
/// traction cos(theta) on the bearing half of the rim that drags the plate along the bearing direction.
void add_friction_loads(PlateProblem& problem) {
  Assembler loads(problem.numbering, problem.unknowns, count_of(problem.friction_hole));
  for_each_rim_side(problem.elements, [&](int hole, int element, const plate::RimTerms& terms, double scale) {
    const int first = 2 * problem.unknowns.disc_of_hole[hole];  // discs of holes come before those of points
    for (int i = 0; i < terms.friction.cols(); ++i)
      loads.add(element, terms.modes, scale * terms.friction.col(i), first + i);
  });
  problem.L_f = loads.free();
  problem.L_c = loads.controlled();
}

/// Uniform traction of unit total force on an edge.
void add_uniform(const PlateMesh& plate, const External& external, int p, int column, Assembler& loads) {
  const auto& sides = plate.sets.at(external.on);
  double area = 0;
  for (const auto& side : sides)
    area += plate.mesh.thickness[side.element] * pfem::side_rule(plate.mesh, plate.edges, side, 1).ds.sum();
  for (const auto& side : sides) {
    const auto rule = pfem::side_rule(plate.mesh, plate.edges, side, p);
    const Eigen::VectorXd spread = plate.mesh.thickness[side.element] / area * (rule.N * rule.ds);
    loads.add(side.element, rule.modes, (spread * rim::axis(external.direction).transpose()).reshaped(), column);
  }
}

/// Cosine pressure on the half of an open hole that bears along the external's direction, of unit force along it.
void add_pressure(const PlateScene& scene, const PlateMesh& plate, int external_index, int p, int column,
                  Assembler& loads) {
  const External& external = scene.externals[external_index];
  const rim::Rim& rim = plate.rims[index_of(scene.holes, external.on, &Hole::id)];
  const Eigen::Vector2d d = rim::axis(external.direction);
  const double unit_force = rim::bearing(plate.mesh, plate.edges, rim, d).unit_force;
  constexpr double nothing = 1e-12;  // of what a whole rim bears; rounding leaves about 1e-16
  if (unit_force < nothing * plate.mesh.thickness.maxCoeff() * rim.radius)
    reject(scene, fmt::format("/external/{}", external_index),
           fmt::format("the model has no rim of hole \"{}\" on the side that bears along +{}", external.on,
                       external.direction),
           "a hole with a rim on that side");
  for (const auto& side : rim.sides) {
    const auto rule = rim::rim_rule(plate.mesh, plate.edges, side, p);
    Eigen::MatrixX2d load = Eigen::MatrixX2d::Zero(rule.N.rows(), 2);
    for (Eigen::Index q = 0; q < rule.ds.size(); ++q) {
      const Eigen::Vector2d n = -rule.normal.col(q);
      const double pressure = rim::cosine_bearing(n, d).contact / unit_force;
      load += plate.mesh.thickness[side.element] * rule.ds[q] * pressure * rule.N.col(q) * n.transpose();
    }
    loads.add(side.element, rule.modes, load.reshaped(), column);
  }
}

/// Sets T_f and T_c: unit total force on every external that is not rigid, as uniform traction on an edge or as cosine
/// pressure on an open hole.
void add_traction_loads(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem) {
  const auto list = traction_externals(scene);
  Assembler loads(problem.numbering, problem.unknowns, count_of(list));
  for (int column = 0; column < count_of(list); ++column) {
    const External& external = scene.externals[list[column]];
    if (external.kind == ExternalKind::bearing)
      add_pressure(scene, plate, list[column], problem.numbering.p, column, loads);
    else
      add_uniform(plate, external, problem.numbering.p, column, loads);
  }
  problem.T_f = loads.free();
  problem.T_c = loads.controlled();
  for (std::size_t column = 0; column < list.size(); ++column) {
    if (Eigen::VectorXd(problem.T_f.col(column)).isZero(0) && problem.T_c.col(column).isZero(0))
      reject(scene, fmt::format("/external/{}", list[column]), "supports hold all that it loads against it",
             "a load along a direction in which the plate can move there");
  }
}

double largest(const Eigen::SparseMatrix<double>& A) { return A.nonZeros() > 0 ? A.coeffs().abs().maxCoeff() : 0; }

}  // namespace

plate::SprungMesh sprung_mesh(const PlateScene& scene, const PlateMesh& plate) {
  plate::SprungMesh sprung{plate.mesh, plate.edges, plate.rims, {}, Eigen::Matrix2Xd(2, scene.disc_directions.size())};
  for (const auto& hole : scene.holes) sprung.springs.emplace_back(hole.spring);
  for (int a = 0; a < count_of(scene.disc_directions); ++a) sprung.axes.col(a) = rim::axis(scene.disc_directions[a]);
  return sprung;
}

Eigen::VectorXd shift(const PlateProblem& problem) {
  return problem.K_cc.diagonal().unaryExpr([](double k) { return k > 0 ? k : 1; });
}

/// The friction cases come last, so that their diagonal changes nothing before them; it must be above L^T K^-1 L
/// (docs/theory.md, section 4.4).
Eigen::VectorXd border_diagonal(const PlateProblem& problem) {
  const auto s = shift(problem);
  const double L = largest(problem.L_f), large = L > 0 ? 1e30 * L * L / s.maxCoeff() : 1;
  Eigen::VectorXd diagonal = Eigen::VectorXd::Constant(s.size() + problem.L_f.cols(), large);
  diagonal.head(s.size()) = s;
  return diagonal;
}

PlateProblem number_unknowns(const PlateScene& scene, const PlateMesh& plate) {
  PlateProblem problem;
  problem.numbering = pfem::number_by_degree(plate.mesh, plate.edges, scene.space, scene.p_high);
  problem.unknowns = classify_unknowns(scene, plate, problem.numbering);
  problem.elements = plate::classify_elements(sprung_mesh(scene, plate), problem.numbering, problem.unknowns);
  problem.n_tractions = count_of(traction_externals(scene));
  problem.ties = tie_points(scene, plate, problem.unknowns);
  for (const auto& hole : scene.holes) {
    if (!hole.spring) continue;
    for (const auto& direction : scene.disc_directions)
      for (const char* sign : {"+", "-"}) {
        problem.friction_hole.push_back(hole.id);
        problem.friction_bearing.push_back(fmt::format("{}{}", sign, direction));
      }
  }
  return problem;
}

void integrate(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem) {
  problem.elements.stiffness =
      pfem::integrate(problem.elements.congruent, plate.mesh, plate.edges, scene.elasticity, scene.space, scene.p_high);
  Assembler assembler(problem.numbering, problem.unknowns, problem.unknowns.n_controlled());
  if (problem.unknowns.n_externals > 0) add_externals(plate, problem, assembler);
  add_springs(scene, problem, assembler);
  for (const auto& tie : problem.ties) assembler.add_spring(tie.dof, tie.controlled, tie.stiffness);
  problem.K_fc = assembler.free();
  problem.K_cc = assembler.controlled();
  add_friction_loads(problem);
  add_traction_loads(scene, plate, problem);
}

PlateProblem assemble(const PlateScene& scene, const PlateMesh& plate) {
  PlateProblem problem = number_unknowns(scene, plate);
  integrate(scene, plate, problem);
  return problem;
}

}  // namespace fastjoint::stage1
