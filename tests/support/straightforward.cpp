// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/straightforward.hpp"

#include <Eigen/CholmodSupport>

#include "common/count.hpp"
#include "common/pfem/element.hpp"
#include "common/plate/springs.hpp"

namespace fastjoint::test {

using Sparse = Eigen::SparseMatrix<double>;

Sparse free_stiffness(const stage1::PlateScene& scene, const stage1::PlateMesh& mesh,
                      const stage1::PlateProblem& problem) {
  const auto& numbering = problem.numbering;
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int element, const std::vector<int>& modes, const Eigen::MatrixXd& K) {
    const auto [dof, sign] = pfem::element_dofs(numbering, problem.unknowns.dofs, element, modes);
    for (Eigen::Index i = 0; i < dof.size(); ++i)
      for (Eigen::Index j = 0; j < dof.size(); ++j)
        if (pfem::is_free(dof[i]) && pfem::is_free(dof[j]))
          entries.emplace_back(dof[i], dof[j], sign[i] * sign[j] * K(i, j));
  };
  const pfem::ElementStiffness stiffness(numbering.space, numbering.p);
  std::vector<int> all(numbering.function.rows());
  for (std::size_t m = 0; m < all.size(); ++m) all[m] = static_cast<int>(m);
  for (int element = 0; element < mesh.mesh.n_elements(); ++element)
    add(element, all,
        stiffness(pfem::ElementMap(mesh.mesh, mesh.edges, element), scene.elasticity[mesh.mesh.material[element]],
                  mesh.mesh.thickness[element]));
  const auto sprung = stage1::sprung_mesh(scene, mesh);
  for (int hole = 0; hole < count_of(scene.holes); ++hole) {
    if (!scene.holes[hole].spring) continue;
    for (const auto& side : mesh.rims[hole].sides) {
      const auto terms = plate::rim_terms(sprung, hole, side, numbering.p);
      add(side.element, terms.modes, terms.plate);
    }
  }
  for (const auto& tie : problem.ties)
    if (pfem::is_free(tie.dof)) entries.emplace_back(tie.dof, tie.dof, tie.stiffness);
  const int n = problem.unknowns.n_free.back();
  Sparse K(n, n);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

PlainMatrices plain_matrices(const Sparse& K_ff, const Problem& problem, int p) {
  const int n = problem.unknowns.n_free[p];
  const Eigen::CholmodSupernodalLLT<Sparse> factor(K_ff.block(0, 0, n, n));
  const Sparse K_fc = problem.K_fc.topRows(n);
  Eigen::MatrixXd B(n, problem.K_fc.cols() + problem.L_f.cols());
  B << -Eigen::MatrixXd(K_fc), Eigen::MatrixXd(problem.L_f.topRows(n));
  const Eigen::MatrixXd forces = K_fc.transpose() * Eigen::MatrixXd(factor.solve(B));
  return {problem.K_cc + forces.leftCols(K_fc.cols()), forces.rightCols(problem.L_f.cols()) - problem.L_c};
}

}  // namespace fastjoint::test
