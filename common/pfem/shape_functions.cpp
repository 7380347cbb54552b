// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/shape_functions.hpp"

#include <algorithm>
#include <cassert>

#include "common/pfem/legendre.hpp"

namespace fastjoint::pfem {

std::vector<Mode> modes(Space space, int p) {
  assert(p >= 1);
  std::vector<Mode> list = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (int edge = 0; edge < n_local_edges; ++edge)
    for (int k = 2; k <= p; ++k) {
      const int across = edge == 1 || edge == 2 ? 1 : 0;
      list.push_back(edge % 2 == 0 ? Mode{k, across, k} : Mode{across, k, k});
    }
  for (int degree = 2; degree <= p; ++degree)
    for (int i = 2; i <= degree; ++i)
      for (int j = 2; j <= degree; ++j)
        if (degree == (space == Space::trunk ? i + j : std::max(i, j))) list.push_back({i, j, degree});
  return list;
}

std::vector<int> modes_on_edge(int p, int edge) {
  const auto [first, second] = natural_ends(edge);
  std::vector<int> list = {first, second};
  for (int k = 2; k <= p; ++k) list.push_back(edge_mode(p, edge, k));
  return list;
}

ShapeValues shape_values(Space space, int p, const Eigen::VectorXd& xi, const Eigen::VectorXd& eta) {
  const auto list = modes(space, p);
  const Eigen::Index n_modes = list.size();
  const Values X = integrated_legendre(p, xi);
  const Values Y = integrated_legendre(p, eta);
  ShapeValues v{Eigen::MatrixXd(n_modes, xi.size()), Eigen::MatrixXd(n_modes, xi.size()),
                Eigen::MatrixXd(n_modes, xi.size())};
  for (Eigen::Index m = 0; m < n_modes; ++m) {
    const auto [i, j, degree] = list[m];
    v.N.row(m) = X.N.row(i).cwiseProduct(Y.N.row(j));
    v.dN_dxi.row(m) = X.dN.row(i).cwiseProduct(Y.N.row(j));
    v.dN_deta.row(m) = X.N.row(i).cwiseProduct(Y.dN.row(j));
  }
  return v;
}

}  // namespace fastjoint::pfem
