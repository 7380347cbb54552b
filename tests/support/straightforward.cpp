// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/straightforward.hpp"

#include <Eigen/CholmodSupport>

#include "common/count.hpp"
#include "common/pfem/element.hpp"
#include "common/plate/springs.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint::test {

using Sparse = Eigen::SparseMatrix<double>;

Sparse free_stiffness(const stage1::PlateScene& scene, const stage1::PlateMesh& mesh,
                      const stage1::PlateProblem& problem) {
  const auto& numbering = problem.numbering;
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int element, const std::vector<int>& modes, const Eigen::MatrixXd& K) {
    const auto [dof, sign] = dofs_of(pfem::element_dofs(numbering, problem.unknowns.dofs, element), modes);
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
  auto sprung = stage1::sprung_mesh(scene, mesh);
  sprung.waves.assign(scene.holes.size(), std::nullopt);  // loads, which the stiffness does not have
  for (int hole = 0; hole < count_of(scene.holes); ++hole) {
    if (!scene.holes[hole].spring) continue;
    for (const auto& side : mesh.rims[hole].sides) {
      const auto terms = plate::rim_terms(sprung, hole, side, numbering.p);
      add(side.element, terms.modes, terms.plate);
    }
  }
  for (const auto& tie : problem.ties)
    if (const int dof = problem.unknowns.dof_of(tie); pfem::is_free(dof)) entries.emplace_back(dof, dof, tie.stiffness);
  const int n = problem.unknowns.n_free.back();
  Sparse K(n, n);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

Eigen::MatrixXd plain_matrices(const Sparse& K_ff, const Problem& problem, int p) {
  const int n = problem.unknowns.n_free[p];
  const Eigen::CholmodSupernodalLLT<Sparse> factor(K_ff.block(0, 0, n, n));
  const Sparse K_fc = problem.K_fc.topRows(n), L_f = problem.L_f.topRows(n);
  const auto nc = K_fc.cols(), n_prescribed = Eigen::Index{problem.unknowns.n_prescribed()};
  Eigen::MatrixXd B(n, n_prescribed), result(problem.unknowns.n_border(), n_prescribed);
  B << -Eigen::MatrixXd(K_fc), Eigen::MatrixXd(L_f.leftCols(n_prescribed - nc));
  const Eigen::MatrixXd X = factor.solve(B);
  result << Eigen::MatrixXd(K_fc.transpose() * X), Eigen::MatrixXd(L_f.transpose() * -X);
  result.topLeftCorner(nc, nc) += problem.K_cc;
  result.topRightCorner(nc, n_prescribed - nc) -= problem.L_c.leftCols(n_prescribed - nc);
  result.bottomLeftCorner(L_f.cols(), nc) -= problem.L_c.transpose();
  return result;
}

}  // namespace fastjoint::test
