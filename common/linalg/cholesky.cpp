// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/cholesky.hpp"

#include <cholmod.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "common/count.hpp"
#include "common/errors.hpp"

namespace fastjoint::linalg {

struct Context {
  cholmod_common c{};
  Context() {
    cholmod_start(&c);
    c.final_ll = 1;  // else a small indefinite matrix passes as LDL'
    c.print = 0;
  }
  ~Context() { cholmod_finish(&c); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
};

template <auto FreeFn>
struct Free {
  cholmod_common* c;
  void operator()(auto* p) const noexcept { FreeFn(&p, c); }
};
using Factor = std::unique_ptr<cholmod_factor, Free<cholmod_free_factor>>;

namespace {

/// Number of entries of each of the first n columns in the first n rows.
std::vector<int> entries_in_block(const Eigen::SparseMatrix<double>& lower, Eigen::Index n) {
  std::vector<int> entries;
  entries.reserve(n + 1);  // CHOLMOD rejects the null pointer that an empty vector would give
  const int* row = lower.innerIndexPtr();
  for (Eigen::Index j = 0; j < n; ++j) {
    const int *from = row + lower.outerIndexPtr()[j], *to = row + lower.outerIndexPtr()[j + 1];
    entries.push_back(static_cast<int>(std::lower_bound(from, to, n) - from));
  }
  return entries;
}

/// View of the leading block for CHOLMOD, which does not write to it. The matrix must outlive the view.
/// @param entries Number of entries of each column in the block; must outlive the view.
cholmod_sparse view(const Eigen::SparseMatrix<double>& lower, std::vector<int>& entries) {
  assert(lower.isCompressed() && lower.rows() == lower.cols());
  cholmod_sparse v{};
  v.nrow = v.ncol = entries.size();
  v.nzmax = lower.nonZeros();
  v.p = const_cast<int*>(lower.outerIndexPtr());
  v.nz = entries.data();
  v.i = const_cast<int*>(lower.innerIndexPtr());
  v.x = const_cast<double*>(lower.valuePtr());
  v.stype = -1;
  v.itype = CHOLMOD_INT;
  v.xtype = CHOLMOD_REAL;
  v.dtype = CHOLMOD_DOUBLE;
  v.sorted = 1;
  v.packed = 0;
  return v;
}

/// Lower bound of a pivot over its diagonal entry; below it, not even three digits of a solution are right. Singular
/// matrices have ratios of 1e-16 to 1e-13, whatever the units and stiffnesses of their rows are.
constexpr double min_pivot_ratio = 1e-12;

/// Throws NumericalError if CHOLMOD failed; whether the matrix is positive definite is checked by the caller.
void check_status(const cholmod_common& c) {
  if (c.status == CHOLMOD_OUT_OF_MEMORY)
    throw NumericalError("the stiffness matrix does not fit into memory; use fewer elements or a lower p");
  if (c.status == CHOLMOD_TOO_LARGE)
    throw NumericalError("the stiffness matrix is too large for 32-bit indices; use fewer elements or a lower p");
  if (c.status < CHOLMOD_OK)
    throw NumericalError(
        fmt::format("CHOLMOD cannot factorise the stiffness matrix ({}, its status {}); check moduli, thicknesses and "
                    "element shapes",
                    c.status == CHOLMOD_INVALID         ? "it is empty or damaged"
                    : c.status == CHOLMOD_NOT_INSTALLED ? "this CHOLMOD lacks a part that is needed"
                                                        : "it gives no reason",
                    c.status));
}

/// Columns [first, last) of L with their ascending row indices, which start with the columns' own; entry (i, j) is
/// stored at i + j ld.
struct Supernode {
  int first, last, ld;
  const int* row;
  const double* value;

  Supernode(const cholmod_factor& L, int i) {
    const int* columns = static_cast<const int*>(L.super) + i;
    const int* rows = static_cast<const int*>(L.pi) + i;
    first = columns[0], last = columns[1], ld = rows[1] - rows[0];
    row = static_cast<const int*>(L.s) + rows[0];
    value = static_cast<const double*>(L.x) + static_cast<const int*>(L.px)[i];
  }
  [[nodiscard]] int size() const { return last - first; }
  [[nodiscard]] int n_below() const { return ld - size(); }
  [[nodiscard]] const int* below() const { return row + size(); }
  [[nodiscard]] auto diagonal() const { return rows(0, size()).triangularView<Eigen::Lower>(); }
  [[nodiscard]] auto below_diagonal() const { return rows(size(), n_below()); }

 private:
  [[nodiscard]] Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>> rows(int from, int n) const {
    return {value + from, n, size(), Eigen::OuterStride<>(ld)};
  }
};

/// Forward elimination of the rows of a sparse matrix C: each row visits the supernodes on the path from its first
/// entry to the root of the elimination tree (Liu, SIAM Review 34, 82, 1992).
class RowElimination {
 public:
  RowElimination(const cholmod_factor& L, const Eigen::SparseMatrix<double>& C, Eigen::Index k)
      : L_(L),
        C_(C),
        k_(k),
        supernode_of_(C.cols()),
        index_in_(C.cols()),
        index_of_(C.rows()),
        passed_(L.nsuper),
        products_(Eigen::MatrixXd::Zero(k, C.rows())) {
    for (int i = 0; i < count_of(passed_); ++i) {
      const Supernode s(L, i);
      std::fill_n(supernode_of_.begin() + s.first, s.size(), i);
    }
  }

  Eigen::MatrixXd run() {
    for (int i = 0; i < count_of(passed_); ++i) eliminate(i);
    return std::move(products_);
  }

 private:
  /// Update that a supernode passes to its parent: rows of C after elimination, over the rows of L below the supernode.
  struct Rest {
    Supernode from;
    std::vector<int> of;   ///< (r) rows of C, ascending
    Eigen::MatrixXd left;  ///< (rows below, r)
  };

  void eliminate(int i) {
    const Supernode s(L_, i);
    Rest rest{s, reaching(s, passed_[i]), {}};
    if (rest.of.empty()) return;
    Eigen::MatrixXd Y = gather(rest, passed_[i]);
    std::vector<Rest>().swap(passed_[i]);
    auto own = Y.topRows(s.size());
    s.diagonal().solveInPlace(own);
    add_products(rest.of, own);
    if (s.n_below() == 0) return;
    rest.left = Y.bottomRows(s.n_below());
    rest.left.noalias() -= s.below_diagonal() * own;
    passed_[supernode_of_[*s.below()]].push_back(std::move(rest));
  }

  /// Rows of C with entries in the supernode or in the updates of its children.
  [[nodiscard]] std::vector<int> reaching(const Supernode& s, const std::vector<Rest>& passed) const {
    std::vector<int> list(C_.innerIndexPtr() + C_.outerIndexPtr()[s.first],
                          C_.innerIndexPtr() + C_.outerIndexPtr()[s.last]);
    for (const auto& rest : passed) list.insert(list.end(), rest.of.begin(), rest.of.end());
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }

  /// Sums these rows of C and the children's updates over the rows of the supernode, shape (ld, r).
  [[nodiscard]] Eigen::MatrixXd gather(const Rest& at, const std::vector<Rest>& passed) {
    const Supernode& s = at.from;
    for (int i = 0; i < count_of(at.of); ++i) index_of_[at.of[i]] = i;
    for (int i = 0; i < s.ld; ++i) index_in_[s.row[i]] = i;
    Eigen::MatrixXd Y = Eigen::MatrixXd::Zero(s.ld, std::ssize(at.of));
    for (int j = s.first; j < s.last; ++j)
      for (Eigen::SparseMatrix<double>::InnerIterator entry(C_, j); entry; ++entry)
        Y(j - s.first, index_of_[entry.row()]) = entry.value();
    for (const auto& rest : passed)
      for (int b = 0; b < count_of(rest.of); ++b)
        for (int a = 0; a < rest.from.n_below(); ++a)
          Y(index_in_[rest.from.below()[a]], index_of_[rest.of[b]]) += rest.left(a, b);
    return Y;
  }

  void add_products(const std::vector<int>& of, const Eigen::Ref<const Eigen::MatrixXd>& Y) {
    const auto n_left = std::lower_bound(of.begin(), of.end(), k_) - of.begin();
    const Eigen::MatrixXd product = Y.leftCols(n_left).transpose() * Y;
    for (Eigen::Index b = 0; b < product.cols(); ++b)
      for (Eigen::Index a = 0; a < n_left; ++a) products_(of[a], of[b]) += product(a, b);
  }

  const cholmod_factor& L_;
  const Eigen::SparseMatrix<double>& C_;
  Eigen::Index k_;
  std::vector<int> supernode_of_;          ///< (n) supernode of each column of L
  std::vector<int> index_in_;              ///< (n) position of a row among those of the current supernode
  std::vector<int> index_of_;              ///< (m) position of a row of C among those active in the current supernode
  std::vector<std::vector<Rest>> passed_;  ///< updates for each supernode from its children
  Eigen::MatrixXd products_;
};

}  // namespace

struct Cholesky::Impl {
  Context context;  // first member, destroyed last
  Factor factor{nullptr, {&context.c}};
};

Cholesky::Cholesky(const Eigen::SparseMatrix<double>& lower, Eigen::Index n) : impl_(std::make_unique<Impl>()) {
  auto& c = impl_->context.c;
  c.nmethods = 1;
  c.method[0].ordering = CHOLMOD_NATURAL;
  c.postorder = 0;
  c.supernodal = CHOLMOD_SUPERNODAL;
  auto entries = entries_in_block(lower, n);
  cholmod_sparse A = view(lower, entries);
  impl_->factor.reset(cholmod_analyze(&A, &c));
  check_status(c);
  cholmod_factor* L = impl_->factor.get();
  cholmod_factorize(&A, L, &c);
  check_status(c);
  if (c.status == CHOLMOD_NOT_POSDEF || L->minor < L->n)
    throw NumericalError(fmt::format(
        "the stiffness matrix is not positive definite: pivot of row {} of {} is not positive", L->minor, L->n));
  for (int i = 0; i < static_cast<int>(L->nsuper); ++i) {
    const Supernode s(*L, i);
    for (int j = s.first; j < s.last; ++j) {
      const double pivot = s.value[Eigen::Index(j - s.first) * (s.ld + 1)];
      if (const double ratio = pivot * pivot / lower.valuePtr()[lower.outerIndexPtr()[j]]; !(ratio > min_pivot_ratio))
        throw NumericalError(
            fmt::format("the stiffness matrix is singular to working precision: elimination leaves {:.1e} of the "
                        "diagonal entry of row {} of {}",
                        ratio, j, L->n));
    }
  }
}

Cholesky::~Cholesky() = default;

Eigen::MatrixXd Cholesky::solve(Eigen::MatrixXd B) const {
  const cholmod_factor& L = *impl_->factor;
  if (B.rows() == 0) return B;
  Eigen::MatrixXd gathered(B.rows(), L.maxesize);
  for (int i = 0; i < int(L.nsuper); ++i) {
    const Supernode s(L, i);
    auto own = B.middleCols(s.first, s.size()), below = gathered.leftCols(s.n_below());
    if (own.isZero(0)) continue;
    s.diagonal().adjoint().solveInPlace<Eigen::OnTheRight>(own);
    below.noalias() = own * s.below_diagonal().transpose();
    for (int j = 0; j < s.n_below(); ++j) B.col(s.below()[j]) -= below.col(j);
  }
  for (int i = int(L.nsuper) - 1; i >= 0; --i) {
    const Supernode s(L, i);
    auto own = B.middleCols(s.first, s.size()), below = gathered.leftCols(s.n_below());
    for (int j = 0; j < s.n_below(); ++j) below.col(j) = B.col(s.below()[j]);
    own.noalias() -= below * s.below_diagonal();
    s.diagonal().solveInPlace<Eigen::OnTheRight>(own);
  }
  return B;
}

Eigen::MatrixXd Cholesky::products(const Eigen::SparseMatrix<double>& C, Eigen::Index k) const {
  return RowElimination(*impl_->factor, C, k).run();
}

std::vector<int> elimination_order(const Eigen::SparseMatrix<double>& graph) {
  if (graph.rows() == 0) return {};
  Context context;
  auto& c = context.c;
  c.nmethods = 1;
  c.method[0].ordering = CHOLMOD_NESDIS;  // border rows fill in less after nested dissection than after minimum degree
  auto entries = entries_in_block(graph, graph.cols());
  cholmod_sparse A = view(graph, entries);
  const Factor L(cholmod_analyze(&A, &c), {&c});
  check_status(c);
  const int* order = static_cast<const int*>(L->Perm);
  return {order, order + graph.rows()};
}

}  // namespace fastjoint::linalg
