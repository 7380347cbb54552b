// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/peer_elements.hpp"

#include <deal.II/base/quadrature_lib.h>

#include <Eigen/Cholesky>
#include <vector>

#include "tests/bench/peer_mesh.hpp"

namespace fastjoint::peer {

using namespace dealii;

namespace {

constexpr double E = 1e7, nu = 0.3, thickness = 0.1;
constexpr double spring_modulus = 2 / (1 - nu) * E / (2 * radius);  // equation (29), a disc of the panel's material

}  // namespace

SymmetricTensor<4, 2> plane_stress() {
  const auto unit = unit_symmetric_tensor<2>();
  return E / (1 + nu) * (identity_tensor<2>() + nu / (1 - nu) * outer_product(unit, unit));
}

Integrator::Integrator(const Mapping<2>& mapping, const FiniteElement<2>& fe)
    : inside_(mapping, fe, QGauss<2>(fe.degree + 1), update_gradients | update_JxW_values),
      side_(mapping, fe, QGauss<1>(fe.degree + 1), update_values | update_JxW_values | update_normal_vectors) {}

FullMatrix<double> Integrator::operator()(const Cell& cell) {
  FullMatrix<double> K(inside_.dofs_per_cell + 1);
  inside_.reinit(cell);
  add_plate(K);
  for (const unsigned int face : cell->face_indices())
    if (cell->face(face)->boundary_id() == rim) {
      side_.reinit(cell, face);
      add_springs(K);
    }
  for (unsigned int i = 0; i < K.m(); ++i)
    for (unsigned int j = 0; j < i; ++j) K(j, i) = K(i, j);
  return K;
}

void Integrator::add_plate(FullMatrix<double>& K) const {
  const auto elasticity = plane_stress();
  std::vector<SymmetricTensor<2, 2>> strain(inside_.dofs_per_cell), stress(inside_.dofs_per_cell);
  for (const unsigned int q : inside_.quadrature_point_indices()) {
    for (const unsigned int i : inside_.dof_indices()) {
      strain[i] = inside_[displacement].symmetric_gradient(i, q);
      stress[i] = thickness * inside_.JxW(q) * (elasticity * strain[i]);
    }
    for (const unsigned int i : inside_.dof_indices())
      for (unsigned int j = 0; j <= i; ++j) K(i, j) += stress[i] * strain[j];
  }
}

/// Adds the second derivatives of the energy 1/2 int k t (D n_x - u . n)^2 ds.
void Integrator::add_springs(FullMatrix<double>& K) const {
  std::vector<double> gap(K.m());
  for (const unsigned int q : side_.quadrature_point_indices()) {
    const auto& normal = side_.normal_vector(q);
    for (const unsigned int i : side_.dof_indices()) gap[i] = -(side_[displacement].value(i, q) * normal);
    gap.back() = normal[0];
    for (unsigned int i = 0; i < K.m(); ++i)
      for (unsigned int j = 0; j <= i; ++j) K(i, j) += spring_modulus * thickness * side_.JxW(q) * gap[i] * gap[j];
  }
}

Eigen::MatrixXd condense(FullMatrix<double>& K, unsigned int first, unsigned int last) {
  const Eigen::Index n = K.m();
  Eigen::Map<Eigen::MatrixXd> k(&K(0, 0), n, n);
  const Eigen::MatrixXd rows = k.middleRows(first, last - first);
  Eigen::MatrixXd X = rows.middleCols(first, last - first).llt().solve(rows);
  k -= rows.transpose() * X;
  return X;
}

}  // namespace fastjoint::peer
