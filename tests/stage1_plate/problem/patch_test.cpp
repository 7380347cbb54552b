// SPDX-License-Identifier: GPL-3.0-or-later
// Polynomial displacements of the elements' own degree on several distorted elements: they come back to rounding.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numeric>

#include "common/pfem/element.hpp"
#include "common/pfem/shape_functions.hpp"
#include "common/plate/plate_factor.hpp"
#include "stage1_plate/problem/plate_problem.hpp"
#include "tests/support/plates.hpp"
#include "tests/support/stress.hpp"

namespace fastjoint {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// Four quadrilaterals on [0, 2]^2 around an inner node, of a turned ply; the left edge is held.
/// @param bent Whether they are no parallelograms.
std::string four_quads(pfem::Space space, int p, bool bent) {
  const char* nodes = bent ? "[0,0],[0.9,0],[2,0],[0,0.8],[1.15,1.1],[2,1.3],[0,2],[1.1,2],[2,2]"
                           : "[0,0],[0.9,0.18],[2,0.4],[0,0.8],[0.9,0.98],[2,1.2],[0,2],[0.9,2.18],[2,2.4]";
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress", "p": [{1}, {1}],
    "space": "{0}", "materials": {{"ply": {{"E1": 20, "E2": 5, "nu12": 0.3, "G12": 4, "angle": 30}}}},
    "geometry": {{"mesh": {{"nodes": [{2}], "quads": [[0,1,4,3],[4,1,2,5],[7,6,3,4],[8,7,4,5]],
      "thickness": 0.3, "material": "ply", "edges": {{"left": [[0,3],[3,6]]}}}}}},
    "supports": [{{"on": "left", "fix": ["x", "y"]}}]}})",
                     pfem::name_of(space), p, nodes);
}

/// u = a x s^(p - 1) with s = c . x: a polynomial of degree p that vanishes at the held edge x = 0.
struct Wave {
  int p;
  Vector2d a, c;

  [[nodiscard]] double power(const Vector2d& x, int lower) const {
    return lower > p ? 0 : std::pow(c.dot(x), p - lower);
  }
  [[nodiscard]] Vector2d displacement(const Vector2d& x) const { return a * x.x() * power(x, 1); }
  /// Gradient of x s^(p - 1).
  [[nodiscard]] Vector2d slope(const Vector2d& x) const {
    return Vector2d(power(x, 1), 0) + x.x() * (p - 1) * power(x, 2) * c;
  }
  /// Its second derivatives.
  [[nodiscard]] Matrix2d bend(const Vector2d& x) const {
    const Matrix2d mixed = Vector2d(1, 0) * c.transpose();
    return (p - 1) * power(x, 2) * (mixed + mixed.transpose()) +
           x.x() * (p - 1) * (p - 2) * power(x, 3) * c * c.transpose();
  }
};

Matrix2d stress(const Eigen::Matrix3d& D, const Matrix2d& G) {
  const Eigen::Vector3d s = D * Eigen::Vector3d(G(0, 0), G(1, 1), G(0, 1) + G(1, 0));
  return (Matrix2d() << s[0], s[2], s[2], s[1]).finished();
}

/// Force per volume that holds the wave: minus the divergence of its stress.
Vector2d body_force(const Eigen::Matrix3d& D, const Wave& wave, const Vector2d& x) {
  const Matrix2d H = wave.bend(x);
  return -stress(D, wave.a * H.col(0).transpose()).col(0) - stress(D, wave.a * H.col(1).transpose()).col(1);
}

/// Loads of the wave on the free unknowns: its tractions on the whole border and its force per volume.
Eigen::VectorXd load(const test::Plate& plate, const Wave& wave) {
  const auto& [scene, mesh, problem] = plate;
  const int p = problem.numbering.p;
  const Eigen::Matrix3d& D = scene.elasticity[0];
  stage1::Loads loads;
  const auto rule = pfem::gauss(p + 3);
  const auto n = rule.x.size();
  const Eigen::VectorXd xi = rule.x.replicate(n, 1), eta = rule.x.transpose().replicate(n, 1).reshaped();
  const Eigen::VectorXd w = (rule.w * rule.w.transpose()).reshaped();
  const Eigen::MatrixXd N = pfem::shape_values(problem.numbering.space, p, xi, eta).N;
  std::vector<int> modes(N.rows());
  std::iota(modes.begin(), modes.end(), 0);
  for (int element = 0; element < mesh.mesh.n_elements(); ++element) {
    const double thickness = mesh.mesh.thickness[element];
    const pfem::ElementMap map(mesh.mesh, mesh.edges, element);
    Eigen::MatrixX2d g = Eigen::MatrixX2d::Zero(N.rows(), 2);
    for (Eigen::Index q = 0; q < w.size(); ++q)
      g += thickness * w[q] * map.jacobian(xi[q], eta[q]).determinant() * N.col(q) *
           body_force(D, wave, map.point(xi[q], eta[q])).transpose();
    stage1::add_load(problem, element, modes, g.reshaped(), 0, loads);
    for (int edge = 0; edge < 4; ++edge) {
      if (!mesh.edges.is_border(mesh.edges.of({element, edge}))) continue;
      const auto side = pfem::side_rule(mesh.mesh, mesh.edges, {element, edge}, p);
      Eigen::MatrixX2d t = Eigen::MatrixX2d::Zero(side.N.rows(), 2);
      for (Eigen::Index q = 0; q < side.ds.size(); ++q)
        t += thickness * side.ds[q] * side.N.col(q) *
             (stress(D, wave.a * wave.slope(side.x.col(q)).transpose()) * side.normal.col(q)).transpose();
      stage1::add_load(problem, element, side.modes, t.reshaped(), 0, loads);
    }
  }
  return test::on_free(problem, loads);
}

/// Largest error of displacements and stresses at 9 points of each element, over the largest of each.
double error(const test::Plate& plate, const Wave& wave) {
  const auto& [scene, mesh, problem] = plate;
  const auto& numbering = problem.numbering;
  const Eigen::VectorXd free = test::fields_under(problem, numbering.p, load(plate, wave));
  const Eigen::Matrix2Xd u = test::coefficients(plate, free, {});
  Vector2d worst(0, 0), largest(0, 0);
  for (int element = 0; element < mesh.mesh.n_elements(); ++element) {
    const pfem::ElementMap map(mesh.mesh, mesh.edges, element);
    for (const double xi : {-0.8, 0.1, 1.0})
      for (const double eta : {-1.0, 0.3, 0.7}) {
        const auto at = [](double x) { return Eigen::VectorXd::Constant(1, x); };
        const Eigen::MatrixXd N = pfem::shape_values(numbering.space, numbering.p, at(xi), at(eta)).N;
        Vector2d found(0, 0);
        for (Eigen::Index m = 0; m < N.rows(); ++m)
          found += numbering.sign(m, element) * N(m, 0) * u.col(numbering.function(m, element));
        const Vector2d x = map.point(xi, eta), exact = wave.displacement(x);
        const Matrix2d sigma = stress(scene.elasticity[0], wave.a * wave.slope(x).transpose());
        const Eigen::Vector3d components(sigma(0, 0), sigma(1, 1), sigma(0, 1));
        worst[0] = std::max(worst[0], (found - exact).norm());
        worst[1] = std::max(worst[1], (test::stress_at(plate, u, element, xi, eta) - components).norm());
        largest = largest.cwiseMax(Vector2d(exact.norm(), components.norm()));
      }
  }
  return worst.cwiseQuotient(largest).maxCoeff();
}

Wave wave_of(int degree) { return {degree, {0.7, -0.4}, {0.3, 0.35}}; }

class Patch : public testing::TestWithParam<int> {};

/// x^i y^j with i + j <= p is a product of powers of at most p of each coordinate of a bilinear quadrilateral.
TEST_P(Patch, TheProductSpaceHasPolynomialsOfItsDegreeOnAnyQuadrilaterals) {
  const int p = GetParam();
  EXPECT_LT(error(test::make_plate(four_quads(pfem::Space::product, p, true)), wave_of(p)), 1e-11);
}

/// The displacement is a polynomial of degree p in the coordinates of a parallelogram.
TEST_P(Patch, TheTrunkSpaceHasPolynomialsOfItsDegreeOnParallelograms) {
  const int p = GetParam();
  EXPECT_LT(error(test::make_plate(four_quads(pfem::Space::trunk, p, false)), wave_of(p)), 1e-11);
}

/// The displacement has degree p in each coordinate of any other quadrilateral, where the trunk space holds only p/2.
TEST_P(Patch, TheTrunkSpaceHasPolynomialsOfHalfItsDegreeOnAnyQuadrilaterals) {
  const int p = GetParam(), most = std::max(1, p / 2);
  const auto plate = test::make_plate(four_quads(pfem::Space::trunk, p, true));
  EXPECT_LT(error(plate, wave_of(most)), 1e-11);
  EXPECT_GT(error(plate, wave_of(most + 1)), 1e-9);
}

/// The test itself: one degree more is not there.
TEST_P(Patch, NoSpaceHasPolynomialsBeyondItsDegree) {
  const int p = GetParam();
  EXPECT_GT(error(test::make_plate(four_quads(pfem::Space::product, p, true)), wave_of(p + 1)), 1e-9);
  EXPECT_GT(error(test::make_plate(four_quads(pfem::Space::trunk, p, false)), wave_of(p + 1)), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Degrees, Patch, testing::Range(1, 9), testing::PrintToStringParamName());

}  // namespace
}  // namespace fastjoint
