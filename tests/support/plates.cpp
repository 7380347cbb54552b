// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/plates.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tuple>

#include "common/plate/plate_states.hpp"

namespace fastjoint::test {

Problem assemble(const stage1::PlateScene& scene, const stage1::PlateMesh& mesh) {
  Problem a{stage1::number_unknowns(scene, mesh), {}, {}, {}, {}};
  stage1::integrate(scene, mesh, a);
  const auto& unknowns = a.unknowns;
  const int n = unknowns.n_free.back(), nc = unknowns.n_controlled(), n_loads = unknowns.n_border() - nc;
  std::vector<Eigen::Triplet<double>> K, L;
  a.K_cc = Eigen::MatrixXd::Zero(nc, nc);
  a.L_c = Eigen::MatrixXd::Zero(nc, n_loads);
  const auto add = [](int dof, int column, double value, auto& free, Eigen::MatrixXd& controlled) {
    if (pfem::is_free(dof)) free.emplace_back(dof, column, value);
    if (pfem::is_controlled(dof)) controlled(pfem::controlled_index(dof), column) += value;
  };
  const auto add_pair = [&](int dof, int other, double value) {
    if (pfem::is_controlled(other)) add(dof, pfem::controlled_index(other), value, K, a.K_cc);
  };
  const auto add_matrix = [&](const pfem::ElementDofs& at, const Eigen::MatrixXd& M, double scale) {
    for (Eigen::Index i = 0; i < at.dof.size(); ++i)
      for (Eigen::Index j = 0; j < at.dof.size(); ++j)
        add_pair(at.dof[i], at.dof[j], scale * at.sign[i] * at.sign[j] * M(i, j));
  };
  for (int element = 0; element < mesh.mesh.n_elements(); ++element) {
    const auto all = pfem::element_dofs(a.numbering, unknowns.dofs, element);
    add_matrix(all, a.elements.stiffness[a.elements.congruent.class_of[element]], mesh.mesh.thickness[element]);
    for (const auto& [of_element, terms] : a.elements.classes[a.elements.class_of[element]].rims) {
      const auto at = dofs_of(all, terms.modes);
      const int hole = a.elements.holes[element][of_element];
      const int disc = unknowns.first_disc[hole], n_directions = unknowns.first_disc[hole + 1] - disc;
      const double scale = a.elements.scale[element];
      add_matrix(at, terms.plate, scale);
      for (int d = 0; d < n_directions; ++d) {
        const int moved = pfem::controlled_dof(unknowns.controlled_of_disc(disc + d));
        for (Eigen::Index i = 0; i < at.dof.size(); ++i) {
          add_pair(at.dof[i], moved, scale * at.sign[i] * terms.coupling(i, d));
          add_pair(moved, at.dof[i], scale * at.sign[i] * terms.coupling(i, d));
        }
        for (int e = 0; e < n_directions; ++e)
          add_pair(pfem::controlled_dof(unknowns.controlled_of_disc(disc + e)), moved, scale * terms.disc(e, d));
      }
      const auto add_load = [&](const auto& values, int column) {
        for (Eigen::Index i = 0; i < at.dof.size(); ++i)
          add(at.dof[i], column, scale * at.sign[i] * values[i], L, a.L_c);
      };
      for (int c = 0; c < terms.friction.cols(); ++c)
        add_load(terms.friction.col(c), unknowns.first_friction[hole] - nc + c);
      for (int k = 0; k < terms.waves.cols(); ++k) {
        const int column = unknowns.first_wave[hole] - nc + k;
        add_load(terms.waves.col(k), column);
        for (int d = 0; d < n_directions; ++d)
          a.L_c(unknowns.controlled_of_disc(disc + d), column) -= scale * terms.reaction(d, k);
      }
    }
  }
  for (const auto& tie : a.ties) {
    const int dof = unknowns.dof_of(tie), disc = pfem::controlled_dof(unknowns.controlled_of_disc(tie.disc));
    for (const auto& [i, j, sign] : {std::tuple(dof, dof, 1), {disc, disc, 1}, {dof, disc, -1}, {disc, dof, -1}})
      add_pair(i, j, sign * tie.stiffness);
  }
  a.K_fc.resize(n, nc);
  a.K_fc.setFromTriplets(K.begin(), K.end());
  a.L_f.resize(n, n_loads);
  a.L_f.setFromTriplets(L.begin(), L.end());
  return a;
}

Plate make_plate(const std::string& json) {
  Plate plate{stage1::read_scene(input::parse("plate.json", json)), {}, {}};
  plate.mesh = stage1::make_mesh(plate.scene);
  plate.problem = test::assemble(plate.scene, plate.mesh);
  return plate;
}

Eigen::MatrixXd fields(const stage1::PlateProblem& problem, int p, const Eigen::MatrixXd& border,
                       const Eigen::MatrixXd& loads) {
  const plate::PlateFactor K(problem, plate::Skeleton(problem), p, false);
  const plate::PlateStates states(K, border, loads.sparseView());
  Eigen::MatrixXd X(problem.unknowns.n_free[p], border.cols());
  for (int element = 0; element < count_of(problem.elements.class_of); ++element) {
    const auto [dof, sign] = pfem::element_dofs(problem.numbering, problem.unknowns.dofs, element);
    const Eigen::MatrixXd C = states.coefficients(element);
    for (Eigen::Index i = 0; i < dof.size(); ++i)
      if (pfem::is_free(dof[i]) && dof[i] < X.rows()) X.row(dof[i]) = sign[i] * C.row(i);
  }
  return X;
}

Eigen::MatrixXd unit_fields(const stage1::PlateProblem& problem, int p) {
  const int nc = problem.unknowns.n_controlled();
  return fields(problem, p, Eigen::MatrixXd::Identity(problem.unknowns.n_prescribed(), nc),
                Eigen::MatrixXd::Zero(problem.unknowns.n_free[p], nc));
}

Eigen::VectorXd on_free(const stage1::PlateProblem& problem, const stage1::Loads& loads) {
  Eigen::VectorXd column = Eigen::VectorXd::Zero(problem.unknowns.n_free.back());
  for (const auto& entry : loads)
    if (entry.row() < column.size()) column[entry.row()] += entry.value();
  return column;
}

Eigen::MatrixXd fields_under(const stage1::PlateProblem& problem, int p, const Eigen::MatrixXd& loads) {
  return fields(problem, p, Eigen::MatrixXd::Zero(problem.unknowns.n_prescribed(), loads.cols()), loads);
}

formats::PlateSolution solve(const Plate& plate) {
  auto solution = stage1::to_solution(plate.scene, plate.mesh, plate.problem, "test");
  stage1::solve_cases(plate.problem, plate::Skeleton(plate.problem), solution);
  return solution;
}

stage2::Extraction extract(const formats::PlateSolution& solution, bool stresses) {
  return stage2::extract(solution, "test", stresses);
}

stage2::Extraction extract(const std::string& json, bool stresses) {
  return extract(solve(make_plate(json)), stresses);
}

const char* one_direction(const std::string& members) {
  return members.find("disc_directions") == std::string::npos ? R"( "disc_directions": ["x"],)" : "";
}

std::string grid_scene(const std::vector<double>& x, const std::vector<double>& y, const std::vector<HoleText>& holes,
                       const std::string& extra) {
  std::vector<std::string> list;
  for (const auto& h : holes)
    list.push_back(fmt::format(R"({{"id": "{}", "center": [{}, {}], "radius": {}, "rings": {}{}}})", h.id, h.x, h.y,
                               h.radius, h.rings, h.sprung ? R"(, "spring": {"disk": {"E": 1e7, "nu": 0.3}})" : ""));
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress",{}
    "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
    "geometry": {{"grid": {{"x": [{}], "y": [{}], "thickness": 0.1}}}}, "holes": [{}]{}}})",
                     one_direction(extra), fmt::join(x, ","), fmt::join(y, ","), fmt::join(list, ","), extra);
}

std::string panel(int nx, int ny, int rings, const std::string& extra) {
  std::vector<double> x, y;
  std::vector<HoleText> holes;
  for (int i = 0; i <= nx; ++i) x.push_back(i);
  for (int j = 0; j <= ny; ++j) y.push_back(j);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) holes.push_back({fmt::format("{},{}", i, j), i + 0.5, j + 0.5, 0.125, rings});
  return grid_scene(x, y, holes,
                    R"(, "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])" +
                        extra);
}

std::string in_space(pfem::Space space) { return fmt::format(R"(, "space": "{}")", pfem::name_of(space)); }

}  // namespace fastjoint::test
