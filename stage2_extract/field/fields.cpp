// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/field/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/pfem/extremes.hpp"

namespace fastjoint::stage2 {
namespace {

using formats::PlateSolution;

/// Restores the classification of the degrees of freedom of stage 1.
plate::Unknowns unknowns_of(const PlateSolution& a, const pfem::Numbering& numbering, const std::string& file) {
  if (a.unknown.cols() != numbering.n_functions.back())
    throw FileError(fmt::format("{}:unknown: has {} rows, the mesh has {} functions at p = {} of the {} space", file,
                                a.unknown.cols(), numbering.n_functions.back(), numbering.p,
                                pfem::name_of(numbering.space)));
  plate::Unknowns unknowns{
      a.unknown, plate::count_free(numbering, a.unknown), count_of(a.external_id), a.disc_hole, {}};
  for (const auto& name : a.disc_direction) unknowns.disc_direction.push_back(rim::axis_named(name));
  for (Eigen::Index i = 0; i < a.p.size(); ++i)
    if (const int n = unknowns.n_free[a.p[i]]; a.ndof[i] != n)
      throw FileError(
          fmt::format("{}:ndof: holds {} at p = {}, expected {}, as many as are in unknown up to that degree", file,
                      a.ndof[i], a.p[i], n));
  unknowns.first_disc = {0};
  for (const auto& id : a.hole_id)
    unknowns.first_disc.push_back(unknowns.first_disc.back() + static_cast<int>(std::ranges::count(a.disc_hole, id)));
  return unknowns;
}

/// Rejects a map of unknowns in which interior functions of an element are not free, since they are condensed as plate
/// unknowns, and point springs at fixed vertices.
void check_free(const PlateSolution& a, const plate::PlateStiffness& K, const std::string& file) {
  for (int element = 0; element < a.mesh.n_elements(); ++element) {
    const auto& kept = K.elements.classes[K.elements.class_of[element]].kept;
    for (int mode = 0; mode < count_of(kept); ++mode)
      if (const int function = K.numbering.function(mode, element);
          !kept[mode] && a.unknown.col(function).minCoeff() < 0)
        throw FileError(
            fmt::format("{}:unknown: holds {} in row {}, expected a plate unknown of a function inside element {}",
                        file, a.unknown.col(function).minCoeff(), function, element));
  }
  for (const auto& tie : K.ties)
    if (K.unknowns.dof_of(tie) == pfem::fixed_dof)
      throw FileError(fmt::format("{}:point/vertex: holds {}, which a support fixes, expected a vertex that can move",
                                  file, tie.vertex));
}

plate::SprungMesh sprung_mesh(const PlateSolution& a, const pfem::Edges& edges, const plate::Unknowns& unknowns) {
  plate::SprungMesh sprung{a.mesh, edges, a.hole_rim, {}, {}, {}};
  for (int i = 0; i < count_of(a.hole_id); ++i) {
    const int first = unknowns.first_disc[i], n = unknowns.first_disc[i + 1] - first;
    sprung.springs.push_back(n == 0 ? std::nullopt : std::optional(a.hole_spring[i]));
    auto& waves = sprung.waves.emplace_back();
    for (int loaded = 0; loaded < count_of(a.contact); ++loaded)
      if (a.waves[loaded].hole == a.hole_id[i]) waves = {a.waves[loaded].waves, true};
    auto& axes = sprung.axes.emplace_back(2, n);
    for (int d = 0; d < n; ++d) axes.col(d) = rim::unit_vector(unknowns.disc_direction[first + d]);
  }
  return sprung;
}

plate::PlateStiffness stiffness_of(const PlateSolution& a, const pfem::Edges& edges, const std::string& file) {
  plate::PlateStiffness K;
  K.numbering = pfem::number_by_degree(a.mesh, edges, a.space, a.p[a.p.size() - 1]);
  K.unknowns = unknowns_of(a, K.numbering, file);
  const plate::SprungMesh sprung = sprung_mesh(a, edges, K.unknowns);
  plate::count_rim_cases(sprung, K.unknowns);
  K.elements = plate::classify_elements(sprung, K.numbering, K.unknowns);
  try {
    K.elements.stiffness = pfem::integrate(K.elements.congruent, a.mesh, edges, a.elasticity, a.space, K.numbering.p);
  } catch (const NumericalError& e) {
    throw FileError(fmt::format("{}:mesh: {}; make the file again", file, e.what()));
  }
  K.ties = a.points;
  check_free(a, K, file);
  return K;
}

}  // namespace

FieldSolver::FieldSolver(const PlateSolution& plate, const std::string& file)
    : plate_(plate),
      file_(file),
      edges_(pfem::find_edges(plate.mesh)),
      stiffness_(stiffness_of(plate, edges_, file)),
      skeleton_(stiffness_) {}

double FieldSolver::factor_bytes(int p) const { return plate::factor_bytes(stiffness_, skeleton_, p).total(); }

void FieldSolver::factorise(int p) {
  factor_.reset();  // frees its memory before the next factorisation
  try {
    factor_ = std::make_unique<plate::PlateFactor>(stiffness_, skeleton_, p, false);
  } catch (const NumericalError& e) {
    throw NumericalError(
        fmt::format("{}: {}: {}", file_, e.what(),
                    pfem::extremes(plate_.mesh, plate_.elasticity, plate::spring_stiffnesses(stiffness_))));
  }
  n_free_ = stiffness_.unknowns.n_free[p];
}

Fields FieldSolver::solve(Eigen::MatrixXd coefficients) const {
  assert(coefficients.rows() == plate_.n_cases());
  const Eigen::SparseMatrix<double> tractions = coefficients.bottomRows(plate_.n_tractions()).sparseView();
  plate::PlateStates states(*factor_, coefficients.topRows(coefficients.rows() - tractions.rows()),
                            plate_.T_f.topRows(n_free_) * tractions);
  return {*this, std::move(coefficients), std::move(states)};
}

const Eigen::Matrix3d& FieldSolver::elasticity(int element) const {
  return plate_.elasticity[plate_.mesh.material[element]];
}

}  // namespace fastjoint::stage2
