// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/matrices/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/matrices/decompositions.hpp"
#include "common/pfem/extremes.hpp"
#include "common/pfem/numbering.hpp"

namespace fastjoint::stage2 {
namespace {

using formats::PlateCases;
using formats::PlateSolution;

/// Upper bound of all errors: far above the rounding of good scenes (1e-15 to 1e-11, see the tests), far below any
/// modelling error.
constexpr double max_error = 1e-7;
/// Upper bound of the change of S by rounding, above which S is none.
constexpr double max_rounding = 1e-3;
/// Lower bound of a reference value, relative to that of the springs or the sheet alone, so that rounding passes the
/// checks.
constexpr double min_scale = 1e-5;

double ratio(double x, double scale) { return scale > 0 ? x / scale : x; }

/// The same, raised so that errors up to the rounding that stage 1 estimates pass: the springs of one disc that alone
/// holds a stiff sheet may be so soft that it is more.
double min_scale_of(const PlateSolution& plate) {
  return std::max(min_scale, ratio(plate.probe.rounding, max_error * largest(plate.held_stiffness)));
}

/// Reference stiffness for errors of S: its largest entry, or a fraction of the springs' stiffness if S is nearly zero.
double scale_of(const PlateSolution& plate, const Eigen::MatrixXd& S) {
  return std::max(largest(S), min_scale_of(plate) * largest(plate.held_stiffness));
}

/// Displacement along an axis at a point by rigid motions of the sheet: along x, along y, and rotation by 1 / size.
Eigen::RowVector3d rigid_motions(int axis, const Eigen::Vector2d& at, double size) {
  return axis == 0 ? Eigen::RowVector3d(1, 0, -at.y() / size) : Eigen::RowVector3d(0, 1, at.x() / size);
}

/// True if all displacements of externals and discs are rigid motions that supports allow. The sheet then has no
/// stiffness: as if one disc alone holds it.
bool moves_rigidly(const PlateSolution& plate) {
  constexpr double rounding = 1e-9;
  const auto e = std::ssize(plate.external_direction), m = std::ssize(plate.disc_direction);
  const double size = (plate.mesh.nodes.rowwise().maxCoeff() - plate.mesh.nodes.rowwise().minCoeff()).norm();
  Eigen::MatrixX3d controlled = Eigen::MatrixX3d::Zero(e + m, 3);
  std::vector<Eigen::RowVector3d> held;  // combinations of the motions that are 0: at supports, along externals
  std::vector<bool> found(e, false);
  for (int node = 0; node < plate.mesh.n_nodes(); ++node)
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::RowVector3d u = rigid_motions(axis, plate.mesh.nodes.col(node), size);
      const int dof = plate.unknown(axis, node);
      if (dof == pfem::fixed_dof) held.push_back(u);
      if (!pfem::is_controlled(dof) || pfem::controlled_index(dof) >= e) continue;
      const int i = pfem::controlled_index(dof);
      if (found[i])
        held.emplace_back(u - controlled.row(i));
      else
        controlled.row(i) = u, found[i] = true;
    }
  for (Eigen::Index i = 0; i < m; ++i) {
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
    if (const int hole = index_of(plate.hole_id, plate.disc_hole[i]); hole < count_of(plate.hole_id))
      at = plate.hole_rim[hole].center;
    for (const auto& point : plate.points)
      if (point.disc == i) at = plate.mesh.nodes.col(point.vertex);
    controlled.row(e + i) = rigid_motions(rim::coordinate(rim::axis_named(plate.disc_direction[i])), at, size);
  }
  Eigen::MatrixX3d constraints = Eigen::MatrixX3d::Zero(std::max<Eigen::Index>(std::ssize(held), 3), 3);
  for (Eigen::Index i = 0; i < std::ssize(held); ++i) constraints.row(i) = held[i];
  const auto svd = matrices::singular_values(constraints);
  const auto free = svd.V.rightCols((svd.values.array() <= rounding * std::max(1.0, svd.values[0])).count());
  const Eigen::MatrixXd moved = controlled * free;
  return moved.cols() > 0 && matrices::singular_values(moved).rank(rounding) == e + m;
}

/// Rounding of S relative to its largest entry. Stiff springs are no reference: they make the rounding, not S. Where S
/// is zero because nothing resists, the reference is a fraction of the sheet's stiffness; where rounding is all that is
/// left of S, it is infinitely larger.
double rounding_of(const PlateSolution& plate, const Eigen::MatrixXd& S) {
  if (S.size() == 0 || largest(S) > 0) return ratio(plate.probe.rounding, largest(S));
  if (!moves_rigidly(plate)) return std::numeric_limits<double>::infinity();
  double stiffest = 0;
  for (const auto& D : plate.elasticity) stiffest = std::max(stiffest, D.diagonal().maxCoeff());
  return ratio(plate.probe.rounding, min_scale * stiffest * plate.mesh.thickness.maxCoeff());
}

/// Reference value for errors of the first `n_waves` rows of W by displacements: the largest entry, or a fraction of
/// the rims' area if the plate moves with its only disc.
double scale_of_motion(const PlateSolution& plate, const PlateCases& level, Eigen::Index n_waves) {
  double area = 0;
  for (Eigen::Index i = 0; i < std::ssize(plate.waves) && plate.n_waves_before(i) < n_waves; ++i)
    area = std::max(area, plate.waves[i].area);
  return std::max(largest(level.W.topLeftCorner(n_waves, level.S.rows())), min_scale_of(plate) * area);
}

/// Reference value for forces in unit friction cases and loaded waves.
double scale_of_loads(const PlateSolution& plate, const PlateCases& level) {
  return std::max(largest(level.R), scale_of_motion(plate, level, plate.n_loaded_waves()));
}

/// Error of the forces for the probe's displacements by S, compared with the probe's own solution.
std::optional<double> energy(const PlateSolution& plate, const Eigen::MatrixXd& S) {
  if (S.size() == 0) return std::nullopt;
  return ratio(largest(plate.probe.force - S * plate.probe.displacement), scale_of(plate, S));
}

/// Errors of W, R and T: forces of waves, friction and tractions on externals and discs, and displacements of the rims,
/// compared with the probe's solutions.
std::optional<double> reciprocity(const PlateSolution& plate, const PlateCases& level) {
  const auto& probe = plate.probe;
  if (level.R.size() + level.T.size() + level.W.size() == 0) return std::nullopt;
  double worst = 0;
  const auto add = [&](const Eigen::MatrixXd& error, double scale) {
    worst = std::max(worst, ratio(largest(error), scale));
  };
  const auto by = [](const auto& A, const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return A.lazyProduct(x);  // OpenBLAS rejects matrices without rows
  };
  const auto nc = level.S.rows(), k = plate.n_loaded_waves(), h = plate.n_friction_cases();
  const auto by_motion = level.W.leftCols(nc), by_load = level.W.middleCols(nc, k + h);
  Eigen::VectorXd loads(k + h);
  loads << probe.wave, probe.friction;
  add(probe.friction_force - by(level.R, probe.friction) - by(by_motion.topRows(k).transpose(), probe.wave),
      scale_of_loads(plate, level));
  add(probe.moment - by(by_motion, probe.displacement), scale_of_motion(plate, level, level.W.rows()));
  add(probe.friction_moment - by(by_load, loads), largest(by_load));
  if (level.T.size() > 0) {
    const double scale = std::max(largest(level.T), 1e-3);
    worst = std::max(worst, ratio(largest(probe.traction_work + level.T.transpose() * probe.displacement), scale));
  }
  return worst;
}

/// The smallest eigenvalue if it is too far below zero. A Cholesky factorisation of the shifted S decides first, since
/// it costs a tenth of the eigenvalues.
std::optional<double> negative_eigenvalue(const Eigen::MatrixXd& S, double scale) {
  if (S.size() == 0) return std::nullopt;
  const Eigen::MatrixXd shifted = S + max_error * scale * Eigen::MatrixXd::Identity(S.rows(), S.rows());
  if (matrices::is_positive_definite(shifted)) return std::nullopt;
  return ratio(matrices::symmetric_eigenvalues(S)[0], scale);
}

/// The smallest eigenvalue, relative to the largest entry, of -W (energy of the loaded waves) or of A / K - C
/// (compliance of the springs less that of a sheet with them), in means over the rims, if it is negative.
std::optional<double> negative_compliance(const PlateSolution& plate, const PlateCases& level) {
  const auto nc = level.S.rows(), k = plate.n_loaded_waves();
  if (k == 0) return std::nullopt;
  Eigen::MatrixXd energy = -level.W.block(0, nc, k, k);
  Eigen::VectorXd root_of_area(k);
  Eigen::VectorXi pressures(k);
  Eigen::Index n = 0;
  Eigen::VectorXd of_springs(k);
  for (Eigen::Index i = 0, next = 0; i < std::ssize(plate.contact); ++i)
    for (Eigen::Index j = 0; j < plate.waves[i].size(); ++j, ++next) {
      root_of_area[next] = std::sqrt(plate.waves[i].area);
      of_springs[next] = 1 / plate.waves[i].modulus;
      if (j < plate.waves[i].waves.size()) pressures[n++] = static_cast<int>(next);
    }
  const auto mean = root_of_area.cwiseInverse().asDiagonal();
  energy = (mean * energy * mean).eval();
  if (const auto value = negative_eigenvalue(energy, largest(energy))) return value;
  pressures.conservativeResize(n);
  Eigen::MatrixXd rest = -energy(pressures, pressures);
  rest.diagonal() += of_springs(pressures);
  return negative_eigenvalue(rest, of_springs.maxCoeff());
}

/// Relative resultant along a direction without support, maximum over all unit cases.
double residual_force(const PlateSolution& plate, const PlateCases& level, const FreeTranslation& free) {
  const auto& [S, R, T, C_t, W, N, V, K] = level;
  double worst = std::max(ratio(largest(S * free.motion), scale_of(plate, S)),
                          ratio(largest(W.leftCols(S.rows()).lazyProduct(free.motion) - free.waves.head(W.rows())),
                                scale_of_motion(plate, level, W.rows())));
  const Eigen::RowVectorXd of_friction = free.motion.transpose().lazyProduct(R) + free.friction;
  worst = std::max(worst, ratio(largest(of_friction), scale_of_loads(plate, level)));
  return std::max(worst, largest(free.motion.transpose() * T + free.traction));
}

std::optional<double> equilibrium(const PlateSolution& plate, const formats::PlateMatrices& a,
                                  const PlateCases& level) {
  std::optional<double> worst;
  if (plate.held_at.size() > 0) return worst;  // a free body: its unit loads are in balance only together
  for (const auto& free : free_translations(plate, a))
    worst = std::max(worst.value_or(0), residual_force(plate, level, free));
  return worst;
}

/// Integrals over the rims for a translation of the sheet along an axis with its discs. Only those of open holes are
/// not zero.
Eigen::VectorXd waves_of_translation(const PlateSolution& plate, rim::Axis axis) {
  Eigen::VectorXd waves = Eigen::VectorXd::Zero(plate.n_waves());
  Eigen::Index next = 0;
  for (const auto& rim : plate.waves) {
    const Eigen::Index first = std::exchange(next, next + rim.size());
    if (std::ranges::find(plate.disc_hole, rim.hole) != plate.disc_hole.end()) continue;
    waves.segment(first, rim.size()) << rim.waves.push(rim::coordinate(axis)), rim.waves.drag(rim::coordinate(axis));
    waves.segment(first, rim.size()) *= -rim.area;
  }
  return waves;
}

std::string shown(const std::optional<double>& value, const char* otherwise) {
  return value ? fmt::format("{:.1e}", *value) : otherwise;
}

}  // namespace

std::vector<FreeTranslation> free_translations(const PlateSolution& plate, const formats::PlateMatrices& a) {
  std::vector<FreeTranslation> result;
  const std::set<std::string> holes(plate.disc_hole.begin(), plate.disc_hole.end());
  for (const rim::Axis axis : rim::both_axes) {
    const std::string& along = rim::name_of(axis);
    const auto count = [&](const std::vector<std::string>& names) {
      return std::count(names.begin(), names.end(), along);
    };
    if (count(plate.supported) > 0 || count(plate.disc_direction) < std::ssize(holes)) continue;
    std::vector<std::string> direction = plate.external_direction;
    direction.insert(direction.end(), plate.disc_direction.begin(), plate.disc_direction.end());
    const auto is_along = [&](const std::vector<std::string>& names) -> Eigen::VectorXd {
      return Eigen::VectorXd::NullaryExpr(std::ssize(names),
                                          [&](Eigen::Index i) { return names[i].ends_with(along) ? 1.0 : 0.0; });
    };
    const Eigen::ArrayXd friction = is_along(plate.friction_bearing), traction = is_along(plate.traction_direction);
    result.push_back(
        {axis, is_along(direction),
         (friction * a.friction_resultant.array() + (1 - friction) * a.friction_resultant_across.array()).transpose(),
         (traction + (1 - traction) * a.traction_resultant_across.array()).transpose(),  // 0 of a moment
         waves_of_translation(plate, axis)});
  }
  return result;
}

double largest(const Eigen::MatrixXd& A) { return A.size() == 0 ? 0 : A.cwiseAbs().maxCoeff(); }

Checks check(const PlateSolution& plate, const formats::PlateMatrices& a) {
  const PlateCases& level = plate.cases.back();  // highest p
  const double scale = scale_of(plate, level.S);
  std::vector<double> springs(plate.held_stiffness.begin(), plate.held_stiffness.end());
  for (const auto& point : plate.points) springs.push_back(point.stiffness);
  return {energy(plate, level.S),
          reciprocity(plate, level),
          negative_eigenvalue(level.S, scale),
          negative_compliance(plate, level),
          equilibrium(plate, a, level),
          rounding_of(plate, level.S),
          pfem::extremes(plate.mesh, plate.elasticity, springs)};
}

void require_good(const Checks& checks, const std::string& file) {
  const auto fail = [&](const char* what, double value, double allowed = max_error) {
    throw NumericalError(
        fmt::format("{}: {} is {:.1e} of the largest entry, allowed {:.0e}; the plate's stiffness is too badly "
                    "conditioned: {}",
                    file, what, value, allowed, checks.extremes));
  };
  if (checks.negative_eigenvalue) fail("smallest eigenvalue of S", *checks.negative_eigenvalue);
  if (checks.negative_compliance) fail("smallest eigenvalue of C, Q or A/K - C", *checks.negative_compliance);
  if (!(checks.energy.value_or(0) < max_error)) fail("error of S", checks.energy.value_or(0));
  if (!(checks.reciprocity.value_or(0) < max_error)) fail("error of reciprocity", checks.reciprocity.value_or(0));
  if (!(checks.equilibrium.value_or(0) < max_error))
    fail("error of global equilibrium", checks.equilibrium.value_or(0));
  if (!(checks.rounding < max_rounding)) fail("the change of S by rounding", checks.rounding, max_rounding);
}

std::string report(const Checks& checks) {
  return fmt::format(
      "  relative errors of the checks: S against the energy of its fields {}, R and T against reciprocity {}, "
      "equilibrium {}; rounding may change S by {:.0e}\n",
      shown(checks.energy, "not applicable (no discs)"), shown(checks.reciprocity, "not applicable (no loads)"),
      shown(checks.equilibrium, "not applicable (the sheet is held)"), checks.rounding);
}

}  // namespace fastjoint::stage2
