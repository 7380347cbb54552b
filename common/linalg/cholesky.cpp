// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/cholesky.hpp"

#include <cholmod.h>
#include <fmt/format.h>

#include <cassert>

#include "common/errors.hpp"

extern "C" void openblas_set_num_threads(int);  // Debian keeps its header outside the usual path

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
  v.nrow = static_cast<std::size_t>(lower.rows());
  v.ncol = static_cast<std::size_t>(lower.cols());
  v.nzmax = static_cast<std::size_t>(lower.nonZeros());
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
  v.nrow = static_cast<std::size_t>(B.rows());
  v.ncol = static_cast<std::size_t>(B.cols());
  v.nzmax = v.nrow * v.ncol;
  v.d = v.nrow;
  v.x = const_cast<double*>(B.data());
  v.xtype = CHOLMOD_REAL;
  v.dtype = CHOLMOD_DOUBLE;
  return v;
}

/// Below this not even three digits of a solution are right; the factor of a singular matrix comes to 1e-16 to 1e-13.
constexpr double least_rcond = 1e-12;

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
};

Cholesky::Cholesky(const Eigen::SparseMatrix<double>& lower) : impl_(std::make_unique<Impl>()) {
  auto& c = impl_->context.c;
  cholmod_sparse A = view(lower);
  impl_->factor.reset(cholmod_analyze(&A, &c));
  check_memory(c.status);
  cholmod_factor* L = impl_->factor.get();
  cholmod_factorize(&A, L, &c);
  check_memory(c.status);
  if (c.status == CHOLMOD_NOT_POSDEF || L->minor < L->n)
    throw NumericalError(
        fmt::format("the stiffness matrix is not positive definite: pivot of row {} of {} is not "
                    "positive",
                    static_cast<const int*>(L->Perm)[L->minor], L->n));
  if (const double r = rcond(); !(r > least_rcond))
    throw NumericalError(
        fmt::format("the stiffness matrix is singular to working precision (1/condition = {:.1e})", r));
}

Cholesky::~Cholesky() = default;

double Cholesky::rcond() const { return cholmod_rcond(impl_->factor.get(), &impl_->context.c); }

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& B) const {
  if (B.size() == 0) return B;
  auto& c = impl_->context.c;
  cholmod_dense b = view(B);
  const Dense x(cholmod_solve(CHOLMOD_A, impl_->factor.get(), &b, &c), {&c});
  check_memory(c.status);
  if (!x) throw NumericalError("solving with the factorised stiffness matrix failed");
  return Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(x->x), B.rows(), B.cols());
}

Eigen::SparseMatrix<double> leading_block(const Eigen::SparseMatrix<double>& lower, int n) {
  assert(lower.isCompressed());
  Eigen::SparseMatrix<double> block(n, n);
  block.reserve(lower.outerIndexPtr()[n]);
  for (int column = 0; column < n; ++column) {
    block.startVec(column);
    for (Eigen::SparseMatrix<double>::InnerIterator it(lower, column); it && it.row() < n; ++it)
      block.insertBack(it.row(), column) = it.value();
  }
  block.finalize();
  return block;
}

void set_threads(int n_threads) { openblas_set_num_threads(n_threads); }

}  // namespace fastjoint::linalg
