// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/skeleton.hpp"

#include <algorithm>
#include <iterator>

#include "common/count.hpp"
#include "common/linalg/cholesky.hpp"
#include "common/pfem/shape_functions.hpp"

namespace fastjoint::plate {
namespace {

void sort_unique(std::vector<int>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// First functions of the vertices and edges on the skeleton of an element.
std::vector<int> on_skeleton_of(const PlateStiffness& plate, int element) {
  const auto& kept = plate.elements.classes[plate.elements.class_of[element]].kept;
  const auto& numbering = plate.numbering;
  const Eigen::Vector4i vertices = numbering.function.col(element).head<4>();
  std::vector<int> list(vertices.begin(), vertices.end());
  for (int edge = 0; edge < pfem::n_local_edges && numbering.p > 1; ++edge)
    if (const int mode = pfem::edge_mode(numbering.p, edge, 2); kept[mode])
      list.push_back(numbering.function(mode, element));
  return list;
}

/// Columns of the border that are coupled to an element, by a rim or by an external that moves its skeleton.
std::vector<int> coupled_border(const PlateStiffness& plate, int element, const std::vector<int>& on_skeleton) {
  std::vector<int> list = plate.unknowns.border_of(plate.elements.holes[element]);
  for (const int function : on_skeleton)
    for (const int dof : plate.unknowns.dofs.col(function))
      if (pfem::is_controlled(dof)) list.push_back(pfem::controlled_index(dof));
  return list;
}

}  // namespace

Skeleton::Skeleton(const PlateStiffness& plate) {
  std::vector<Blocks> cliques;
  const auto n_elements = count_of(plate.elements.class_of);
  cliques.reserve(n_elements);
  for (int element = 0; element < n_elements; ++element) cliques.push_back(on_skeleton_of(plate, element));
  order(cliques);
  const int first_border = count_of(function_);
  higher_.resize(function_.size() + plate.unknowns.n_border());
  for (int i = 0; i < n_elements; ++i) {
    const auto border = coupled_border(plate, i, cliques[i]);
    for (int& block : cliques[i]) block = position_[block];
    for (const int column : border) cliques[i].push_back(first_border + column);
    join(cliques[i]);
  }
  for (const auto& tie : plate.ties) {
    const int dof = plate.unknowns.dof_of(tie);
    join({pfem::is_free(dof) ? position_[tie.vertex] : first_border + pfem::controlled_index(dof),
          first_border + plate.unknowns.controlled_of_disc(tie.disc)});
  }
  for (auto& list : higher_) sort_unique(list);
}

void Skeleton::order(const std::vector<Blocks>& on_skeleton) {
  std::vector<int> functions;
  for (const auto& clique : on_skeleton) functions.insert(functions.end(), clique.begin(), clique.end());
  sort_unique(functions);
  const auto n = count_of(functions);
  position_.assign(functions.empty() ? 0 : functions.back() + 1, -1);
  for (int i = 0; i < n; ++i) position_[functions[i]] = i;
  higher_.resize(functions.size());
  for (auto clique : on_skeleton) {
    for (int& block : clique) block = position_[block];
    join(clique);
  }
  Eigen::SparseMatrix<double> graph(n, n);
  for (int a = 0; a < n; ++a) {
    auto& list = higher_[a];
    sort_unique(list);
    graph.startVec(a);
    graph.insertBack(a, a) = 1;
    for (const int b : list) graph.insertBack(b, a) = 1;
    list.clear();
  }
  graph.finalize();
  for (const int i : linalg::elimination_order(graph)) {
    position_[functions[i]] = count_of(function_);
    function_.push_back(functions[i]);
  }
}

void Skeleton::join(const Blocks& clique) {
  for (const int a : clique)
    for (const int b : clique)
      if (a < b) higher_[a].push_back(b);
}

int Skeleton::Rows::of_dof(int dof) const {
  if (pfem::is_free(dof)) return of_unknown[dof];
  return pfem::is_controlled(dof) ? n_skeleton + pfem::controlled_index(dof) : -1;
}

Skeleton::Rows Skeleton::rows(const PlateStiffness& plate, int p, int n_border) const {
  const auto& n_functions = plate.numbering.n_functions;
  Rows rows;
  rows.of_unknown.assign(plate.unknowns.n_free.back(), -1);
  int n = 0;
  const auto number = [&](int function) {
    for (const int dof : plate.unknowns.dofs.col(function))
      if (pfem::is_free(dof)) rows.of_unknown[dof] = n++;
  };
  for (const int function : function_) {
    rows.first.push_back(n);
    if (function < n_functions[1]) {
      number(function);
    } else {
      for (int k = 2; k <= p; ++k) number(n_functions[k - 1] + function - n_functions[1]);
    }
  }
  rows.n_skeleton = n;
  rows.n_border = n_border;
  for (int i = 0; i <= rows.n_border; ++i) rows.first.push_back(n + i);
  return rows;
}

/// Symbolic elimination by blocks: eliminating a block joins its later neighbours, which the first of them inherits.
Skeleton::Size Skeleton::size(const Rows& rows) const {
  const int n_blocks = count_of(rows.first) - 1;
  std::vector<Blocks> joined(higher_.begin(), higher_.begin() + n_blocks);
  for (auto& blocks : joined) std::erase_if(blocks, [&](int block) { return block >= n_blocks; });
  const std::vector<Blocks> direct = joined;
  Size size{0, 0, 0, 0};
  const auto n_rows = [&](int block) -> double { return rows.first[block + 1] - rows.first[block]; };
  const auto n_rows_of = [&](const Blocks& blocks) {
    double n = 0;
    for (const int block : blocks) n += n_rows(block);
    return n;
  };
  const int first_border = count_of(function_);
  std::vector<double> passed(joined.size(), 0);  // size of the updates of border rows for each block
  double stored = 0;
  const auto eliminate_border = [&](int a, double own, double below) {
    double of_border = 0;
    for (auto block = joined[a].rbegin(); block != joined[a].rend() && *block >= first_border; ++block)
      of_border += n_rows(*block);
    const double update = (below - of_border) * of_border;
    size.elimination = std::max(size.elimination, stored + own * of_border + 2 * update);
    stored += update - passed[a];
    if (update > 0) passed[joined[a].front()] += update;
  };
  bool is_dense = false;
  for (int a = 0; a < count_of(joined); ++a) {
    const double own = n_rows(a), below = n_rows_of(joined[a]);
    if (a < first_border) eliminate_border(a, own, below);
    size.entries += own * (own + 1) / 2 + own * n_rows_of(direct[a]);
    if (is_dense) continue;
    size.factor += own * own + own * below;
    size.largest_front = std::max(size.largest_front, below * below);
    // Border blocks are single rows. Once one of them is joined to all later ones, so is each after it.
    is_dense = a >= count_of(function_) && a + count_of(joined[a]) + 1 == count_of(joined);
    if (is_dense) size.factor += below * (below + 1) / 2;
    if (is_dense || joined[a].empty()) continue;
    Blocks& parent = joined[joined[a].front()];
    Blocks both;
    std::set_union(parent.begin(), parent.end(), joined[a].begin() + 1, joined[a].end(), std::back_inserter(both));
    parent = std::move(both);
    Blocks().swap(joined[a]);
  }
  return size;
}

Eigen::SparseMatrix<double> Skeleton::pattern(const Rows& rows) const {
  const int n = rows.n_skeleton + rows.n_border, n_blocks = count_of(rows.first) - 1;
  const auto size = [&](int block) { return block < n_blocks ? rows.first[block + 1] - rows.first[block] : 0; };
  Eigen::SparseMatrix<double> A(n, n);
  Eigen::Index n_entries = 0;
  for (int a = 0; a < n_blocks; ++a) {
    n_entries += size(a) * (size(a) + 1) / 2;
    for (const int b : higher_[a]) n_entries += Eigen::Index{size(a)} * size(b);
  }
  A.reserve(n_entries);
  for (int a = 0; a < n_blocks; ++a)
    for (int column = rows.first[a]; column < rows.first[a + 1]; ++column) {
      A.startVec(column);
      for (int row = column; row < rows.first[a + 1]; ++row) A.insertBackByOuterInner(column, row) = 0;
      for (const int b : higher_[a])
        for (int i = 0; i < size(b); ++i) A.insertBackByOuterInner(column, rows.first[b] + i) = 0;
    }
  A.finalize();
  return A;
}

}  // namespace fastjoint::plate
