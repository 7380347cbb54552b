// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/plate_states.hpp"

#include <gtest/gtest.h>

#include "tests/support/plate_scenes.hpp"

namespace fastjoint {
namespace {

/// Loads by the states' amounts on the plate's unknowns of one degree, as the problem has them.
Eigen::MatrixXd loads(const stage1::PlateProblem& problem, int n, const Eigen::MatrixXd& border) {
  const auto nc = problem.K_fc.cols();
  return problem.L_f.topRows(n) * border.bottomRows(border.rows() - nc) - problem.K_fc.topRows(n) * border.topRows(nc);
}

Eigen::SparseMatrix<double> a_few(Eigen::Index n, Eigen::Index k) {
  Eigen::SparseMatrix<double> loads(n, k);
  for (Eigen::Index i = 0; i < n; i += 7) loads.insert(i, i % k) = 1e3 * std::sin(static_cast<double>(i));
  return loads;
}

/// Coefficients of every element against the solution for all unknowns, with loads on the border and beside.
TEST(PlateStates, AreTheSolutionUnderTheirAmounts) {
  for (const auto& [name, json] : test::plate_scenes()) {
    const auto plate = test::make_plate(json);
    const auto& problem = plate.problem;
    const plate::Skeleton skeleton(problem);
    for (const int p : {1, 2, 5, 8}) {
      const plate::PlateFactor K(problem, skeleton, p);
      const int n = problem.unknowns.n_free[p];
      const Eigen::MatrixXd border = Eigen::MatrixXd::Random(problem.K_fc.cols() + problem.L_f.cols(), 3);
      const auto beside = a_few(n, 3);
      const plate::PlateStates states(K, border, beside);
      const Eigen::MatrixXd X = K.solve(loads(problem, n, border) + Eigen::MatrixXd(beside));
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
    }
  }
}

TEST(PlateStates, FunctionsCondensedGiveWhatTheyGiveOfCoefficients) {
  for (const auto& [name, json] : test::plate_scenes()) {
    const auto plate = test::make_plate(json);
    const auto& problem = plate.problem;
    const plate::PlateFactor K(problem, plate::Skeleton(problem), 6);
    const Eigen::MatrixXd border = Eigen::MatrixXd::Random(problem.K_fc.cols() + problem.L_f.cols(), 3);
    const plate::PlateStates states(K, border, a_few(problem.unknowns.n_free[6], 3));
    for (int element = 0; element < plate.mesh.mesh.n_elements(); ++element) {
      const Eigen::MatrixXd C = states.coefficients(element), weights = Eigen::MatrixXd::Random(C.rows(), 2);
      const Eigen::MatrixXd values = states.values(plate::PlateStates::condense(K, element, weights));
      EXPECT_LT((values - C.transpose() * weights).norm(), 1e-11 * (C.norm() + values.norm())) << name << element;
    }
  }
}

}  // namespace
}  // namespace fastjoint
