// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/rim_couplings.hpp"

#include <fmt/format.h>

#include "common/count.hpp"

namespace fastjoint::stage1 {
namespace {

/// visit(hole, element, terms, scale) for every side of a rim.
template <class Visit>
void for_each_rim_side(const PlateElements& elements, Visit visit) {
  for (std::size_t element = 0; element < elements.kind.size(); ++element)
    for (const auto& rim : elements.kinds[elements.kind[element]].rims)
      visit(elements.holes[element][rim.hole], static_cast<int>(element), rim.terms, elements.scale[element]);
}

ElementVector element_vector(const RimTerms& terms, const Eigen::VectorXd& coefficients) {
  return {terms.modes, coefficients.reshaped(coefficients.size() / 2, 2).transpose()};
}

}  // namespace

void add_springs(const PlateScene& scene, const PlateProblem& problem, Assembler& assembler) {
  const Unknowns& unknowns = problem.unknowns;
  std::vector<double> stiffness(scene.holes.size(), 0);
  for_each_rim_side(problem.elements, [&](std::size_t hole, int element, const RimTerms& terms, double scale) {
    const int first = unknowns.controlled_of_disc(unknowns.disc_of_hole[hole]);
    stiffness[hole] += terms.stiffness;
    assembler.add_stiffness(element, terms.modes, terms.plate, scale);
    for (int a = 0; a < terms.coupling.cols(); ++a) {
      assembler.add_coupling(element, element_vector(terms, scale * terms.coupling.col(a)), first + a);
      for (int b = 0; b < terms.coupling.cols(); ++b)
        assembler.add_controlled(first + a, first + b, scale * terms.disc(a, b));
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

void add_friction_loads(PlateProblem& problem) {
  LoadAssembler loads(problem.numbering, problem.unknowns, count_of(problem.friction_hole));
  for_each_rim_side(problem.elements, [&](std::size_t hole, int element, const RimTerms& terms, double scale) {
    const int first = 2 * problem.unknowns.disc_of_hole[hole];  // discs of holes come before those of points
    for (int i = 0; i < terms.friction.cols(); ++i)
      loads.add(element, element_vector(terms, scale * terms.friction.col(i)), first + i);
  });
  problem.L_f = loads.free();
  problem.L_c = loads.controlled();
}

}  // namespace fastjoint::stage1
