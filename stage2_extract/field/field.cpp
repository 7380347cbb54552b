// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/field/field.hpp"

#include <fmt/format.h>

#include <cassert>

#include "common/errors.hpp"
#include "common/pfem/element.hpp"
#include "common/pfem/shape_functions.hpp"

namespace fastjoint::stage2 {
using Eigen::Index;

Eigen::Matrix2Xd lagrange_nodes(int p) {
  const Eigen::VectorXd inner = Eigen::VectorXd::LinSpaced(p + 1, -1, 1).segment(1, p - 1);
  const Index n = inner.size();
  Eigen::Matrix2Xd nodes(2, (p + 1) * (p + 1));
  nodes.leftCols<4>() << -1, 1, 1, -1,  //
      -1, -1, 1, 1;
  for (int edge = 0; edge < pfem::n_local_edges; ++edge)
    nodes.middleCols(4 + edge * n, n) = pfem::along_edge(edge, inner);
  for (Index j = 0; j < n; ++j) {
    auto row = nodes.middleCols(4 + (pfem::n_local_edges + j) * n, n);
    row.row(0) = inner.transpose();
    row.row(1).setConstant(inner[j]);
  }
  return nodes;
}

Field at_nodes(const Fields& fields, int p) {
  const auto& solver = fields.solver();
  const auto& mesh = solver.plate().mesh;
  assert(fields.n_states() == 1);
  const Eigen::Matrix2Xd nodes = lagrange_nodes(p);
  const Eigen::VectorXd xi = nodes.row(0), eta = nodes.row(1);
  const Eigen::MatrixXd N = pfem::shape_values(fields.space(), fields.p(), xi, eta).N;
  const Index n = nodes.cols(), n_points = n * mesh.n_elements();
  Field field{p, Eigen::Matrix2Xd(2, n_points), Eigen::Matrix2Xd(2, n_points), Eigen::Matrix3Xd(3, n_points)};
  for (int element = 0; element < mesh.n_elements(); ++element) {
    const pfem::ElementMap map(mesh, solver.edges(), element);
    const Eigen::VectorXd c = fields.coefficients(element);
    const Eigen::VectorXd strain = pfem::strain_operator(map, fields.space(), fields.p(), xi, eta) * c;
    const Index first = element * n;
    for (Index i = 0; i < n; ++i) field.points.col(first + i) = map.point(xi[i], eta[i]);
    field.displacement.middleCols(first, n) << c.head(N.rows()).transpose() * N, c.tail(N.rows()).transpose() * N;
    field.stress.middleCols(first, n) = solver.elasticity(element) * strain.reshaped(3, n);
  }
  return field;
}

Field make_field(FieldSolver& solver, const std::string& file, const FieldRequest& request, const FieldState& state) {
  const int p = field_degree(solver.plate(), file, request, state);
  solver.factorise(p);
  Field field = at_nodes(solver.solve(state.amounts), p);
  if (!field.displacement.allFinite() || !von_mises(field.stress).allFinite())
    throw NumericalError(
        fmt::format("{}: --field {}: displacements or stresses are too large for the numbers of this "
                    "machine; allowed: smaller amounts",
                    file, request.spec));
  return field;
}

Eigen::VectorXd von_mises(const Eigen::Matrix3Xd& stress) {
  const auto x = stress.row(0).array(), y = stress.row(1).array(), xy = stress.row(2).array();
  return (x.square() - x * y + y.square() + 3 * xy.square()).sqrt().transpose();
}

Eigen::Matrix2Xd principal(const Eigen::Matrix3Xd& stress) {
  const auto x = stress.row(0).array(), y = stress.row(1).array(), xy = stress.row(2).array();
  const Eigen::RowVectorXd mean = (x + y) / 2;
  const Eigen::RowVectorXd radius = (((x - y) / 2).square() + xy.square()).sqrt();
  Eigen::Matrix2Xd result(2, stress.cols());
  result << mean + radius, mean - radius;
  return result;
}

}  // namespace fastjoint::stage2
