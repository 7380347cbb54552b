// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/plate_states.hpp"

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>

#include "tests/support/plate_scenes.hpp"
#include "tests/support/straightforward.hpp"

namespace fastjoint {
namespace {

/// Loads by the states' amounts on the plate's unknowns of one degree, as the problem has them.
Eigen::MatrixXd loads(const test::Problem& problem, int n, const Eigen::MatrixXd& border) {
  const auto nc = problem.K_fc.cols(), n_loads = border.rows() - nc;
  return problem.L_f.topRows(n).leftCols(n_loads) * border.bottomRows(n_loads) -
         problem.K_fc.topRows(n) * border.topRows(nc);
}

Eigen::SparseMatrix<double> a_few(Eigen::Index n, Eigen::Index k) {
  Eigen::SparseMatrix<double> loads(n, k);
  for (Eigen::Index i = 0; i < n; i += 7) loads.insert(i, i % k) = 1e3 * std::sin(static_cast<double>(i));
  return loads;
}

/// Coefficients of every element, forces and work against the solution for all unknowns by a sparse factor, with loads
/// on the border and beside.
TEST(PlateStates, AreTheSolutionUnderTheirAmounts) {
  for (const auto& [name, json] : test::plate_scenes()) {
    const auto plate = test::make_plate(json);
    const auto& problem = plate.problem;
    const plate::Skeleton skeleton(problem);
    const auto K_ff = test::free_stiffness(plate.scene, plate.mesh, problem);
    const auto nc = problem.K_cc.rows();
    for (const int p : {1, 2, 5, 8}) {
      const plate::PlateFactor K(problem, skeleton, p, true);
      const int n = problem.unknowns.n_free[p];
      const Eigen::MatrixXd border = Eigen::MatrixXd::Random(problem.unknowns.n_prescribed(), 3);
      const auto beside = a_few(n, 3);
      const plate::PlateStates states(K, border, beside);
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(K_ff.block(0, 0, n, n));
      const Eigen::MatrixXd X = factor.solve(loads(problem, n, border) + Eigen::MatrixXd(beside));
      for (int element = 0; element < plate.mesh.mesh.n_elements(); ++element) {
        const auto [dof, sign] = pfem::element_dofs(problem.numbering, problem.unknowns.dofs, element);
        Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(dof.size(), 3);
        for (Eigen::Index i = 0; i < dof.size(); ++i) {
          if (pfem::is_free(dof[i]) && dof[i] < n) expected.row(i) = sign[i] * X.row(dof[i]);
          if (pfem::is_controlled(dof[i])) expected.row(i) = sign[i] * border.row(pfem::controlled_index(dof[i]));
        }
        EXPECT_LT((states.coefficients(element) - expected).norm(), 1e-10 * (X.norm() + border.norm()))
            << name << ", p = " << p << ", element " << element;
      }
      const Eigen::MatrixXd D = border.topRows(nc), Lambda = border.bottomRows(border.rows() - nc);
      const Eigen::MatrixXd forces =
          problem.K_fc.topRows(n).transpose() * X + problem.K_cc * D - problem.L_c.leftCols(Lambda.rows()) * Lambda;
      const Eigen::MatrixXd moments = -(problem.L_f.topRows(n).transpose() * X) - problem.L_c.transpose() * D;
      // Eigen asserts that a sparse matrix whose norm is taken has rows and columns.
      const auto norm = [](const Eigen::SparseMatrix<double>& A) { return A.nonZeros() > 0 ? A.norm() : 0; };
      const double scale = norm(problem.K_fc) * X.norm() + problem.K_cc.norm() * D.norm();
      const double scale_of_moments = norm(problem.L_f) * X.norm() + problem.L_c.norm() * D.norm();
      const Eigen::MatrixXd found = states.forces();
      ASSERT_EQ(found.rows(), problem.unknowns.n_border());
      EXPECT_LT((found.topRows(nc) - forces).norm(), 1e-11 * scale) << name << ", p = " << p;
      const auto first = problem.unknowns.n_loaded, h = problem.unknowns.n_friction;  // whose rows mean nothing
      EXPECT_LE((found.bottomRows(moments.rows()) - moments).topRows(first).norm(), 1e-11 * scale_of_moments)
          << name << ", p = " << p;
      EXPECT_LE((found.bottomRows(moments.rows()) - moments).bottomRows(moments.rows() - first - h).norm(),
                1e-11 * scale_of_moments)
          << name << ", p = " << p;
      EXPECT_LT((states.work() - beside.transpose() * X).norm(), 1e-10 * beside.norm() * X.norm())
          << name << ", p = " << p;
    }
  }
}

TEST(PlateStates, FunctionsCondensedGiveWhatTheyGiveOfCoefficients) {
  for (const auto& [name, json] : test::plate_scenes()) {
    const auto plate = test::make_plate(json);
    const auto& problem = plate.problem;
    const plate::PlateFactor K(problem, plate::Skeleton(problem), 6, true);
    const Eigen::MatrixXd border = Eigen::MatrixXd::Random(problem.unknowns.n_prescribed(), 3);
    const plate::PlateStates states(K, border, a_few(problem.unknowns.n_free[6], 3));
    for (int element = 0; element < plate.mesh.mesh.n_elements(); ++element) {
      const Eigen::MatrixXd C = states.coefficients(element), weights = Eigen::MatrixXd::Random(C.rows(), 2);
      const Eigen::MatrixXd values = states.values(K.condense_functions(element, weights));
      EXPECT_LT((values - C.transpose() * weights).norm(), 1e-11 * (C.norm() + values.norm())) << name << element;
    }
  }
}

}  // namespace
}  // namespace fastjoint
