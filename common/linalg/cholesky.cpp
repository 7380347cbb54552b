// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/cholesky.hpp"

#include <cholmod.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "common/errors.hpp"

namespace fastjoint::linalg {
namespace {

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
using Dense = std::unique_ptr<cholmod_dense, Free<cholmod_free_dense>>;

/// A view: the matrix must outlive it, and CHOLMOD does not write to it.
cholmod_sparse view(const Eigen::SparseMatrix<double>& lower) {
  assert(lower.isCompressed() && lower.rows() == lower.cols());
  cholmod_sparse v{};
  v.nrow = lower.rows();
  v.ncol = lower.cols();
  v.nzmax = lower.nonZeros();
  v.p = const_cast<int*>(lower.outerIndexPtr());
  v.i = const_cast<int*>(lower.innerIndexPtr());
  v.x = const_cast<double*>(lower.valuePtr());
  v.stype = -1;
  v.itype = CHOLMOD_INT;
  v.xtype = CHOLMOD_REAL;
  v.dtype = CHOLMOD_DOUBLE;
  v.sorted = 1;
  v.packed = 1;
  return v;
}

cholmod_dense view(const Eigen::MatrixXd& B) {
  cholmod_dense v{};
  v.nrow = B.rows();
  v.ncol = B.cols();
  v.nzmax = v.nrow * v.ncol;
  v.d = v.nrow;
  v.x = const_cast<double*>(B.data());
  v.xtype = CHOLMOD_REAL;
  v.dtype = CHOLMOD_DOUBLE;
  return v;
}

/// Least share of a diagonal entry that elimination must leave: below, not even three digits of a solution are right.
/// A singular matrix leaves 1e-16 to 1e-13, whatever the units and stiffnesses of its rows are.
constexpr double least_left = 1e-12;

void check_memory(int status) {
  if (status == CHOLMOD_OUT_OF_MEMORY)
    throw NumericalError("the stiffness matrix does not fit into memory; use fewer elements or a lower p");
  if (status == CHOLMOD_TOO_LARGE)
    throw NumericalError("the stiffness matrix is too large for 32-bit indices; use fewer elements or a lower p");
}

}  // namespace

struct Cholesky::Impl {
  Context context;  // first member, destroyed last
  Factor factor{nullptr, {&context.c}};
  Eigen::Index n = 0, n_border = 0;

  /// Columns [first, last) of L and their rows, ascending, the columns themselves first; entry (i, j) is at i + j ld.
  struct Supernode {
    int first, last, ld;
    const int* row;
    const double* value;
  };
  template <class Visit>
  void for_each_supernode(Visit visit) const {
    const cholmod_factor* L = factor.get();
    const int* super = static_cast<const int*>(L->super);
    const int* row = static_cast<const int*>(L->pi);
    const int* value = static_cast<const int*>(L->px);
    for (std::size_t s = 0; s < L->nsuper; ++s)
      visit(Supernode{super[s], super[s + 1], row[s + 1] - row[s], static_cast<const int*>(L->s) + row[s],
                      static_cast<const double*>(L->x) + value[s]});
  }

  Eigen::MatrixXd half_solve(int system, const Eigen::MatrixXd& B) {
    auto& c = context.c;
    cholmod_dense b = view(B);
    const Dense x(cholmod_solve(system, factor.get(), &b, &c), {&c});
    check_memory(c.status);
    if (!x) throw NumericalError("solving with the factorised stiffness matrix failed");
    return Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(x->x), B.rows(), B.cols());
  }
};

Cholesky::Cholesky(const Eigen::SparseMatrix<double>& lower, Eigen::Index n_border) : impl_(std::make_unique<Impl>()) {
  impl_->n = lower.rows();
  impl_->n_border = n_border;
  auto& c = impl_->context.c;
  c.nmethods = 1;
  c.method[0].ordering = CHOLMOD_NATURAL;
  c.postorder = 0;
  c.supernodal = CHOLMOD_SUPERNODAL;
  cholmod_sparse A = view(lower);
  impl_->factor.reset(cholmod_analyze(&A, &c));
  check_memory(c.status);
  cholmod_factor* L = impl_->factor.get();
  cholmod_factorize(&A, L, &c);
  check_memory(c.status);
  if (c.status == CHOLMOD_NOT_POSDEF || L->minor < L->n)
    throw NumericalError(fmt::format(
        "the stiffness matrix is not positive definite: pivot of row {} of {} is not positive", L->minor, L->n));
  impl_->for_each_supernode([&](const Impl::Supernode& s) {
    for (int j = s.first; j < s.last && j < impl_->n - n_border; ++j) {
      const double pivot = s.value[(j - s.first) * (s.ld + 1)];
      if (const double left = pivot * pivot / lower.coeff(j, j); !(left > least_left))
        throw NumericalError(
            fmt::format("the stiffness matrix is singular to working precision: elimination leaves {:.1e} of the "
                        "diagonal entry of row {} of {}",
                        left, j, L->n));
    }
  });
}

Cholesky::~Cholesky() = default;

Eigen::MatrixXd Cholesky::border(Eigen::Index k) const {
  const auto first = impl_->n - impl_->n_border;
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(impl_->n_border, k);
  impl_->for_each_supernode([&](const Impl::Supernode& s) {
    for (auto j = std::max<Eigen::Index>(s.first, first); j < std::min<Eigen::Index>(s.last, first + k); ++j)
      for (auto i = j - s.first; i < s.ld; ++i) L(s.row[i] - first, j - first) = s.value[i + (j - s.first) * s.ld];
  });
  return L;
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& B) const {
  if (B.size() == 0) return B;
  Eigen::MatrixXd x(impl_->n, B.cols());
  x << B, Eigen::MatrixXd::Zero(impl_->n_border, B.cols());
  x = impl_->half_solve(CHOLMOD_L, x);
  x.bottomRows(impl_->n_border).setZero();
  return impl_->half_solve(CHOLMOD_Lt, x).topRows(B.rows());
}

std::vector<int> elimination_order(const Eigen::SparseMatrix<double>& graph) {
  if (graph.rows() == 0) return {};
  Context context;
  auto& c = context.c;
  c.nmethods = 1;
  c.method[0].ordering = CHOLMOD_NESDIS;  // a border fills less behind separators than behind a minimum degree
  cholmod_sparse A = view(graph);
  const Factor L(cholmod_analyze(&A, &c), {&c});
  check_memory(c.status);
  const int* order = static_cast<const int*>(L->Perm);
  return {order, order + graph.rows()};
}

}  // namespace fastjoint::linalg
