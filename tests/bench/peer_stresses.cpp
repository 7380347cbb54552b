// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/peer_stresses.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/vector.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace fastjoint::peer {
namespace {

using namespace dealii;

constexpr unsigned int n_steps = n_angles / n_octants;  // between the ends of a cell's side

/// The points of a rim on one of its cells, ends included, and what strains there add to its hoop stresses.
class RimSide {
 public:
  explicit RimSide(const Discretisation& plate)
      : panel_(plate.panel),
        side_(plate.mapping, plate.fe, QIterated<1>(QTrapezoid<1>(), n_steps),
              update_gradients | update_quadrature_points) {}

  /// False of a cell without a side on a rim.
  bool go_to(const Cell& cell) {
    for (const unsigned int face : cell->face_indices())
      if (cell->face(face)->boundary_id() == rim) {
        side_.reinit(cell, face);
        find_points(panel_.center(panel_.hole_of(cell->active_cell_index())));
        return true;
      }
    return false;
  }
  /// The cell's shape functions at the points.
  [[nodiscard]] const FEFaceValues<2>& values() const { return side_; }
  /// Index of a point on the rim.
  [[nodiscard]] unsigned int angle(unsigned int q) const { return angle_[q]; }
  [[nodiscard]] double hoop(unsigned int q, const SymmetricTensor<2, 2>& strain) const { return to_hoop_[q] * strain; }

 private:
  void find_points(const Point<2>& center) {
    constexpr double step = 2 * std::numbers::pi / n_angles;
    for (const unsigned int q : side_.quadrature_point_indices()) {
      const auto ray = side_.quadrature_point(q) - center;
      angle_[q] = static_cast<unsigned int>(std::lround(std::atan2(ray[1], ray[0]) / step) + n_angles) % n_angles;
      const Tensor<1, 2> t({-std::sin(angle_[q] * step), std::cos(angle_[q] * step)});
      const double share = angle_[q] % n_steps == 0 ? 0.5 : 1;
      to_hoop_[q] = share * (elasticity_ * symmetrize(outer_product(t, t)));
    }
  }

  const Panel& panel_;
  FEFaceValues<2> side_;
  const SymmetricTensor<4, 2> elasticity_ = plane_stress();
  std::array<unsigned int, n_steps + 1> angle_{};
  std::array<SymmetricTensor<2, 2>, n_steps + 1> to_hoop_;
};

/// Value of an unknown in a case, the external's being the first.
double value(int row, const Eigen::MatrixXd& U, Eigen::Index unit_case) {
  if (row >= 0) return U(row, unit_case);
  return row == with_external && unit_case == 0 ? 1 : 0;
}

/// Hoop stresses at the points of one cell by its unknowns, shape (n_points, n).
Eigen::MatrixXd hoop_of_shapes(const RimSide& side) {
  const auto& shapes = side.values();
  Eigen::MatrixXd hoop(shapes.n_quadrature_points, shapes.dofs_per_cell);
  for (const unsigned int q : shapes.quadrature_point_indices())
    for (const unsigned int i : shapes.dof_indices())
      hoop(q, i) = side.hoop(q, shapes[displacement].symmetric_gradient(i, q));
  return hoop;
}

/// Hoop stresses of one square's rim by the unknowns of its cells there, insides left out.
struct RimOperator {
  struct Unknown {
    unsigned int cell, local;  ///< of the square, of the cell
  };
  std::vector<Unknown> unknowns;  ///< each once
  Eigen::MatrixXd hoop;           ///< shape (n_angles, unknowns)
};

RimOperator rim_operator(const Discretisation& plate, const std::vector<Eigen::MatrixXd>& insides) {
  const unsigned int n_outside = plate.fe.get_first_quad_index(), n_all = plate.fe.n_dofs_per_cell();
  RimOperator rim{{}, Eigen::MatrixXd::Zero(n_angles, n_octants * n_outside)};
  std::map<types::global_dof_index, Eigen::Index> column;
  RimSide side(plate);
  auto cell = plate.dofs.begin_active();
  for (unsigned int k = 0; k < n_octants; ++k, ++cell) {
    side.go_to(cell);
    const Eigen::MatrixXd by_all = hoop_of_shapes(side);
    const Eigen::MatrixXd by_outside =
        by_all.leftCols(n_outside) - by_all.rightCols(n_all - n_outside) * insides[k].leftCols(n_outside);
    const auto index = plate.indices(cell);
    for (unsigned int i = 0; i < n_outside; ++i) {
      const auto [found, is_new] = column.try_emplace(index[i], rim.unknowns.size());
      if (is_new) rim.unknowns.push_back({k, i});
      for (Eigen::Index q = 0; q < by_outside.rows(); ++q)
        rim.hoop(side.angle(static_cast<unsigned int>(q)), found->second) += by_outside(q, i);
    }
  }
  rim.hoop.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(rim.unknowns.size()));
  return rim;
}

Eigen::MatrixXd none_yet(const Panel& panel) {
  return Eigen::MatrixXd::Zero(panel.n_holes() * n_angles, panel.n_controlled());
}

}  // namespace

Eigen::MatrixXd hoop_stress(const Discretisation& plate, const Eigen::MatrixXd& U) {
  Eigen::MatrixXd hoop = none_yet(plate.panel);
  RimSide side(plate);
  std::vector<SymmetricTensor<2, 2>> strain(n_steps + 1);
  Vector<double> u(plate.dofs.n_dofs());
  for (Eigen::Index unit_case = 0; unit_case < hoop.cols(); ++unit_case) {
    for (unsigned int i = 0; i < u.size(); ++i) u[i] = value(plate.row[i], U, unit_case);
    for (const auto& cell : plate.dofs.active_cell_iterators()) {
      if (!side.go_to(cell)) continue;
      side.values()[displacement].get_function_symmetric_gradients(u, strain);
      const unsigned int first = plate.panel.hole_of(cell->active_cell_index()) * n_angles;
      for (const unsigned int q : side.values().quadrature_point_indices())
        hoop(first + side.angle(q), unit_case) += side.hoop(q, strain[q]);
    }
  }
  return hoop;
}

Eigen::MatrixXd hoop_stress(const Discretisation& plate, const std::vector<Eigen::MatrixXd>& insides,
                            const Eigen::MatrixXd& U) {
  Eigen::MatrixXd hoop = none_yet(plate.panel);
  const RimOperator rim = rim_operator(plate, insides);
  Eigen::MatrixXd u(rim.unknowns.size(), hoop.cols());
  std::vector<int> row(rim.unknowns.size());
  std::vector<std::vector<types::global_dof_index>> index(plate.panel.cells_per_square());
  auto cell = plate.dofs.begin_active();
  for (unsigned int hole = 0; hole < plate.panel.n_holes(); ++hole) {
    for (auto& each : index) each = plate.indices(cell++);
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = plate.row[index[rim.unknowns[i].cell][rim.unknowns[i].local]];
    for (Eigen::Index unit_case = 0; unit_case < u.cols(); ++unit_case)
      for (std::size_t i = 0; i < row.size(); ++i) u(i, unit_case) = value(row[i], U, unit_case);
    hoop.middleRows(hole * n_angles, n_angles).noalias() = rim.hoop * u;
  }
  return hoop;
}

}  // namespace fastjoint::peer
