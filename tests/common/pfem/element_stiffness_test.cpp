// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/element.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "common/errors.hpp"
#include "common/matrices/decompositions.hpp"
#include "common/pfem/material.hpp"
#include "common/pfem/mesh.hpp"
#include "common/pfem/numbering.hpp"
#include "tests/support/meshes.hpp"
#include "tests/support/spaces.hpp"

namespace fastjoint::pfem::element_stiffness_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// General anisotropy: every entry of D counts.
const Eigen::Matrix3d D = elasticity({3, 1, 1, 0.25, 0.25, 0.25, 0.6}, 0.5, Analysis::plane_stress);

/// Dense stiffness of a mesh without constraints, coefficient 2 f + component, and the loads of a constant stress.
struct Body {
  Numbering numbering;
  MatrixXd K;
  VectorXd load;
};

Body assemble(const Mesh& mesh, Space space, int p, const Eigen::Matrix2d& stress, int extra_points = 0) {
  const Edges edges = find_edges(mesh);
  Body body{number_by_degree(mesh, edges, space, p), {}, {}};
  const auto& n = body.numbering;
  body.K = MatrixXd::Zero(2 * n.n_functions.back(), 2 * n.n_functions.back());
  body.load = VectorXd::Zero(body.K.rows());
  const ElementStiffness stiffness(space, p, extra_points);
  for (int element = 0; element < mesh.n_elements(); ++element) {
    const MatrixXd K = stiffness(ElementMap(mesh, edges, element), D, mesh.thickness[element]);
    const auto n_modes = n.function.rows();
    for (Eigen::Index i = 0; i < 2 * n_modes; ++i)
      for (Eigen::Index j = 0; j < 2 * n_modes; ++j)
        body.K(2 * n.function(i % n_modes, element) + i / n_modes,
               2 * n.function(j % n_modes, element) + j / n_modes) +=
            n.sign(i % n_modes, element) * n.sign(j % n_modes, element) * K(i, j);
    for (int edge = 0; edge < n_local_edges; ++edge) {
      if (!edges.is_border(edges.of({element, edge}))) continue;
      const SideRule rule = side_rule(mesh, edges, {element, edge}, p);
      const MatrixXd traction =
          stress * rule.normal * (mesh.thickness[element] * rule.ds).asDiagonal() * rule.N.transpose();
      for (std::size_t m = 0; m < rule.modes.size(); ++m)
        body.load.segment<2>(2 * n.function(rule.modes[m], element)) +=
            n.sign(rule.modes[m], element) * traction.col(m);
    }
  }
  return body;
}

/// Coefficients of the field u = G x on a mesh of straight edges: its values at the vertices.
VectorXd linear_field(const Mesh& mesh, const Body& body, const Eigen::Matrix2d& G) {
  VectorXd u = VectorXd::Zero(body.K.rows());
  u.head(2 * mesh.n_nodes()) = (G * mesh.nodes).reshaped();
  return u;
}

Eigen::Matrix2d stress_of(const Eigen::Matrix2d& G) {
  const Eigen::Vector3d s = D * Eigen::Vector3d(G(0, 0), G(1, 1), G(0, 1) + G(1, 0));
  return (Eigen::Matrix2d() << s[0], s[2], s[2], s[1]).finished();
}

const Eigen::Matrix2d gradient = (Eigen::Matrix2d() << 0.3, -0.2, 0.5, 0.1).finished();

class StiffnessP : public testing::TestWithParam<std::tuple<Space, int>> {};

TEST_P(StiffnessP, ElementIsSymmetricWithThreeRigidModes) {
  const auto [space, p] = GetParam();
  const Mesh mesh = test::distorted_mesh();
  const MatrixXd K = ElementStiffness(space, p)(ElementMap(mesh, find_edges(mesh), 0), D, 0.3);
  EXPECT_LT((K - K.transpose()).norm(), 1e-14 * K.norm());
  const VectorXd values = matrices::symmetric_eigenvalues(K);
  EXPECT_LT(values.head(3).cwiseAbs().maxCoeff(), 1e-13 * values.maxCoeff());
  EXPECT_GT(values[3], 1e-4 * values.maxCoeff());
}

TEST_P(StiffnessP, PatchTestOnADistortedMesh) {
  const auto [space, p] = GetParam();
  const Mesh mesh = test::distorted_mesh();
  const Body body = assemble(mesh, space, p, stress_of(gradient));
  EXPECT_LT((body.K * linear_field(mesh, body, gradient) - body.load).norm(), 1e-13 * body.load.norm() * p);
}

/// Displacement of node 8 against u = G x, with the rigid motions taken out at nodes 0 and 2.
double patch_error(const Mesh& mesh, Space space, int p) {
  const Body body = assemble(mesh, space, p, stress_of(gradient));
  Eigen::VectorXi kept(body.K.rows() - 3);
  for (int i = 0, n = 0; i < body.K.rows(); ++i)
    if (i != 0 && i != 1 && i != 5) kept[n++] = i;
  const VectorXd exact = (gradient * mesh.nodes).reshaped();
  VectorXd held = VectorXd::Zero(body.K.rows());
  for (const int i : {0, 1, 5}) held[i] = exact[i];
  const VectorXd right = (body.load - body.K * held)(kept);
  const VectorXd u = MatrixXd(body.K(kept, kept)).ldlt().solve(right);
  held(kept) = u;
  return (held.head(exact.size()) - exact).norm() / exact.norm();
}

/// With exact arcs, x and y are no longer in the space that the map carries over (the map is transcendental), so
/// constant strain is not reproduced but approached exponentially; on straight elements it is exact.
TEST(Stiffness, PatchTestOnACurvedMeshConvergesExponentially) {
  EXPECT_LT(patch_error(test::distorted_mesh(), Space::trunk, 1), 1e-13);
  double previous = patch_error(test::curved_mesh(), Space::trunk, 1);
  EXPECT_GT(previous, 1e-4);
  for (int p = 2; p <= 8; ++p) {
    const double error = patch_error(test::curved_mesh(), Space::trunk, p);
    EXPECT_LT(error, 0.45 * previous) << "p=" << p;
    previous = error;
  }
  EXPECT_LT(previous, 1e-8);
}

/// At the same rate over two degrees: in the product space the displacement of these vertices gains most at even ones.
TEST(Stiffness, PatchTestOnACurvedMeshConvergesExponentiallyInTheProductSpace) {
  for (const int first : {1, 2}) {
    double previous = patch_error(test::curved_mesh(), Space::product, first);
    for (int p = first + 2; p <= 8; p += 2) {
      const double error = patch_error(test::curved_mesh(), Space::product, p);
      EXPECT_LT(error, 0.45 * 0.45 * previous) << "p=" << p;
      previous = error;
    }
  }
  EXPECT_LT(patch_error(test::curved_mesh(), Space::product, 8), 1e-8);
}

/// The rigid rotation is in the same position: two eigenvalues vanish at every p, the third as p grows.
TEST(Stiffness, RotationOfACurvedElementCostsNoEnergyInTheLimit) {
  const Mesh mesh = test::curved_mesh();
  const Edges edges = find_edges(mesh);
  double third = 1;
  for (int p = 2; p <= 8; p += 2) {
    const MatrixXd K = ElementStiffness(Space::trunk, p)(ElementMap(mesh, edges, 0), D, 1);
    const VectorXd values = matrices::symmetric_eigenvalues(K) / K.norm();
    EXPECT_LT(values.head(2).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT(std::abs(values[2]), third) << "p=" << p;
    third = 0.02 * std::abs(values[2]) + 1e-15;
    EXPECT_GT(values[3], 1e-5);
  }
  EXPECT_LT(third, 1e-12);
}

TEST_P(StiffnessP, IsALeadingBlockOfTheHighestDegree) {
  const auto [space, p] = GetParam();
  const Body low = assemble(test::curved_mesh(), space, p, gradient, 8 - p);  // the same points for both
  const Body high = assemble(test::curved_mesh(), space, 8, gradient);
  EXPECT_LT((low.K - high.K.topLeftCorner(low.K.rows(), low.K.cols())).norm(), 1e-14 * low.K.norm());
  EXPECT_LT((low.load - high.load.head(low.load.size())).norm(), 1e-12 * low.load.norm());
}

/// Energy of u_x = x^p y^p on the square [-1, 1]^2, u_y = 0: the product space has it exactly, the trunk space does
/// not.
TEST(Stiffness, EnergyOfAProductOfPowers) {
  Mesh mesh;
  mesh.nodes.resize(2, 4);
  mesh.nodes << -1, 1, 1, -1, -1, -1, 1, 1;
  mesh.quads = Eigen::Vector4i(0, 1, 2, 3);
  const ElementMap map(mesh, find_edges(mesh), 0);
  constexpr int n = 12;  // points each way, more than any degree needs
  const VectorXd line = VectorXd::LinSpaced(n, -1, 1);
  const VectorXd x = line.replicate(n, 1);
  const VectorXd y = line.transpose().replicate(n, 1).reshaped();
  for (int p = 1; p <= 8; ++p) {
    const double exact = (D(0, 0) + D(2, 2)) * p * p * 4 / ((2 * p - 1) * (2 * p + 1));  // the product of slopes is odd
    for (const Space space : {Space::trunk, Space::product}) {
      const MatrixXd N = shape_values(space, p, x, y).N.transpose();
      VectorXd u = VectorXd::Zero(2 * N.cols());
      u.head(N.cols()) = matrices::singular_values(N).solve(x.array().pow(p) * y.array().pow(p), 0);
      const double error = std::abs(u.dot(ElementStiffness(space, p)(map, D, 1) * u) / exact - 1);
      if (space == Space::product || p == 1) {
        EXPECT_LT(error, 1e-11) << name_of(space) << " p=" << p;
      } else {
        EXPECT_GT(error, 0.01) << name_of(space) << " p=" << p;
      }
    }
  }
}

/// A sector of a ring from radius 1 to a straight edge that is square to its middle ray, at a distance from the centre.
Mesh sector(double angle, double distance) {
  Mesh mesh;
  mesh.nodes.resize(2, 4);
  const Eigen::Vector2d ray(std::cos(angle / 2), std::sin(angle / 2));
  const double end = distance * std::tan(angle / 2);
  mesh.nodes << ray.x(), distance, distance, ray.x(), -ray.y(), -end, end, ray.y();
  mesh.quads = Eigen::Vector4i(0, 1, 2, 3);
  mesh.arcs = {{3, 0, {0, 0}}};
  return mesh;
}

/// A square that turns into a triangle: its fourth vertex moves to the middle of the diagonal.
Mesh folding(double moved) {
  Mesh mesh;
  mesh.nodes.resize(2, 4);
  mesh.nodes << 0, 1, 1 - moved / 2, 0, 0, 0, 1 - moved / 2, 1;
  mesh.quads = Eigen::Vector4i(0, 1, 2, 3);
  return mesh;
}

constexpr double exact_integration = 2e-11;

/// Integration at p = 8 must not be what limits S: far below the 1e-8 that S reaches, from next to no arc to a quarter.
TEST(Stiffness, IntegrationIsExactWhateverTheArc) {
  int previous = 0;
  for (const int degrees : {1, 10, 30, 60, 90}) {
    const Mesh mesh = sector(degrees * std::numbers::pi / 180, 2);
    const ElementMap map(mesh, find_edges(mesh), 0);
    for (const Space space : {Space::trunk, Space::product}) {
      const MatrixXd finer = ElementStiffness(space, 8, 20)(map, D, 1);
      EXPECT_LT((ElementStiffness(space, 8)(map, D, 1) - finer).norm(), exact_integration * finer.norm()) << degrees;
      const MatrixXd fewer = ElementStiffness(space, 8, -4)(map, D, 1);
      EXPECT_GT((fewer - finer).norm(), 1e-15 * finer.norm()) << degrees << ": more points than are needed";
    }
    EXPECT_GE(geometric_degree(map).degree, previous) << degrees;
    previous = geometric_degree(map).degree;
  }
}

TEST(Stiffness, MoreDistortedQuadrilateralsTakeMorePoints) {
  int previous = -1;
  for (const double moved : {0.0, 0.1, 0.3, 0.6, 0.8, 0.95}) {
    const Mesh mesh = folding(moved);
    const int degree = geometric_degree(ElementMap(mesh, find_edges(mesh), 0)).degree;
    EXPECT_EQ(degree == 0, moved == 0);
    EXPECT_GT(degree, previous);
    previous = degree;
  }
  EXPECT_EQ(previous, highest_geometric_degree);
}

/// Error of K by the Frobenius norm, against many more points in each part.
double integration_error(const ElementMap& map) {
  const MatrixXd finer = ElementStiffness(Space::product, 8, 12)(map, D, 1);
  return (ElementStiffness(Space::product, 8)(map, D, 1) - finer).norm() / finer.norm();
}

/// Stage 1 accepts elements whose least Jacobian is above 1e-3 of its mean: K is exact down to there. So is the energy
/// of a constant strain, which is known: the area times its density.
TEST(Stiffness, IntegrationIsExactDownToTheSmallestJacobianThatIsAccepted) {
  const Eigen::Vector3d strain(gradient(0, 0), gradient(1, 1), gradient(0, 1) + gradient(1, 0));
  for (const double moved : {0.0, 0.3, 0.8, 0.92, 0.98, 0.995, 0.9995}) {
    const Mesh mesh = folding(moved);
    const ElementMap map(mesh, find_edges(mesh), 0);
    EXPECT_LT(integration_error(map), exact_integration) << moved;
    const MatrixXd K = ElementStiffness(Space::product, 8)(map, D, 1);
    VectorXd u = VectorXd::Zero(K.rows());
    u.head<4>() = (gradient * mesh.nodes).row(0);
    u.segment<4>(K.rows() / 2) = (gradient * mesh.nodes).row(1);
    const double area = 1 - moved / 2;  // two triangles, on (0, 0) (1, 0) and on (0, 0) (0, 1)
    EXPECT_NEAR(u.dot(K * u) / (area * strain.dot(D * strain)), 1, exact_integration) << moved;
  }
  EXPECT_NEAR(jacobian_ratio(ElementMap(folding(0.9995), find_edges(folding(0.9995)), 0)), 1e-3, 1e-5);
  for (const double gap : {0.5, 0.1, 0.01, 0.001, 0.0002}) {
    const Mesh mesh = sector(std::numbers::pi / 2, 1 + gap);
    EXPECT_LT(integration_error(ElementMap(mesh, find_edges(mesh), 0)), exact_integration) << gap;
  }
  const Mesh thin = sector(std::numbers::pi / 2, 1.0002);
  EXPECT_NEAR(jacobian_ratio(ElementMap(thin, find_edges(thin), 0)), 1.2e-3, 1e-4);
}

/// Parts of a fold were halved down to the smallest, seven seconds of an element, and the stiffness was no number.
TEST(Stiffness, OfAFoldedElementIsNone) {
  for (const double moved : {1.02, 1.2, 2.0}) {
    const Mesh mesh = folding(moved);
    EXPECT_THROW((void)ElementStiffness(Space::product, 8)(ElementMap(mesh, find_edges(mesh), 0), D, 1), NumericalError)
        << moved;
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, StiffnessP, testing::Combine(test::both_spaces(), testing::Range(1, 9)),
                         [](const auto& test) {
                           return fmt::format("{}{}", name_of(std::get<0>(test.param)), std::get<1>(test.param));
                         });

}  // namespace
}  // namespace fastjoint::pfem::element_stiffness_test
