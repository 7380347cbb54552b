// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/extract.hpp"

#include "common/count.hpp"
#include "stage2_extract/matrices/holes.hpp"

namespace fastjoint::stage2 {
namespace {

/// Modulus of the springs of each disc, (m); 0 for discs of point springs.
Eigen::VectorXd disc_modulus(const formats::PlateSolution& plate) {
  return Eigen::VectorXd::NullaryExpr(count_of(plate.disc_hole), [&](Eigen::Index i) {
    const int hole = index_of(plate.hole_id, plate.disc_hole[i]);
    return hole < count_of(plate.hole_id) ? plate.hole_spring[hole].modulus : 0;
  });
}

/// Sets the names of the cases, the moduli of the discs and the constants of friction and traction cases.
void describe(const formats::PlateSolution& plate, const std::string& generator, formats::PlateMatrices& a) {
  static_cast<formats::UnitCases&>(a) = plate;
  a.header.generator = generator;
  a.plate_digest = plate.header.digest;
  a.disc_modulus = disc_modulus(plate);
  const auto edges = pfem::find_edges(plate.mesh);
  const auto bearing_of = [&](const std::string& hole, const rim::SignedAxis& side) {
    return rim::bearing(plate.mesh, edges, plate.hole_rim[index_of(plate.hole_id, hole)], rim::unit_vector(side));
  };
  a.friction_unit_force = a.friction_resultant = a.friction_resultant_across =
      Eigen::VectorXd::Zero(a.n_friction_cases());
  for (Eigen::Index j = 0; j < a.n_friction_cases(); ++j) {
    const rim::SignedAxis side = rim::signed_axis_named(a.friction_bearing[j]);
    const auto bearing = bearing_of(a.friction_hole[j], side);
    a.friction_unit_force[j] = bearing.unit_force;
    a.friction_resultant[j] = side.sign * bearing.resultant;
    a.friction_resultant_across[j] = bearing.resultant_across;
  }
  a.traction_resultant_across = a.traction_unit_force = Eigen::VectorXd::Zero(a.n_tractions());
  for (Eigen::Index j = 0; j < a.n_tractions(); ++j) {
    if (plate.traction_hole[j].empty()) continue;  // uniform on an edge
    const rim::SignedAxis side = rim::signed_axis_named(a.traction_bearing[j]);
    const auto bearing = bearing_of(plate.traction_hole[j], side);
    a.traction_unit_force[j] = bearing.unit_force;
    a.traction_resultant_across[j] = side.sign * bearing.force_across / bearing.unit_force;  // per force along + axis
  }
}

/// Subtracts from the forces on externals and discs, (nc, columns), their resultant with `known` along a free
/// translation.
void balance(const Eigen::VectorXd& motion, const Eigen::RowVectorXd& known, Eigen::MatrixXd& forces) {
  forces -= motion * ((motion.transpose() * forces + known) / motion.squaredNorm());
}

/// Removes rounding that violates equilibrium along a direction without support. In a joint, the fasteners would have
/// to carry it.
void balance(const FreeTranslation& free, formats::PlateCases& level) {
  if (free.motion.isZero(0)) return;
  auto by_motion = level.W.leftCols(free.motion.size());
  by_motion -= (by_motion.lazyProduct(free.motion) - free.waves.head(by_motion.rows())) *
               (free.motion.transpose() / free.motion.squaredNorm());
  for (int side = 0; side < 2; ++side) {
    balance(free.motion, Eigen::RowVectorXd::Zero(level.S.cols()), level.S);
    level.S.transposeInPlace();
  }
  level.S = (0.5 * (level.S + level.S.transpose())).eval();
  balance(free.motion, free.friction, level.R);
  balance(free.motion, free.traction, level.T);
}

void store(const std::vector<formats::PlateCases>& levels, formats::PlateMatrices& a) {
  const auto e = a.n_externals(), m = a.n_discs();
  for (const auto& [S, R, T, C_t, W, N, V, K] : levels) {
    a.S_ee.push_back(S.topLeftCorner(e, e));
    a.S_ed.push_back(S.topRightCorner(e, m));
    a.S_dd.push_back(S.bottomRightCorner(m, m));
    a.R_ef.push_back(R.topRows(e));
    a.R_df.push_back(R.bottomRows(m));
    a.T_e.push_back(T.topRows(e));
    a.T_d.push_back(T.bottomRows(m));
    a.C_t.push_back(C_t);
    a.W.emplace_back(W.topRows(a.n_loaded_waves()));
    const auto t = std::ssize(a.cracks.tips);
    a.cracks.K_I.emplace_back(K.topRows(t));
    a.cracks.K_II.emplace_back(K.bottomRows(t));
  }
}

}  // namespace

Extraction extract(formats::PlateSolution plate, const std::string& generator, bool with_stresses) {
  Extraction result;
  auto& a = result.matrices;
  describe(plate, generator, a);
  matrices::CondensedLevels levels;
  for (const auto& each : plate.cases) {
    levels.S.push_back(each.S);
    levels.R.push_back(each.R);
    levels.C.push_back(each.C_t);
  }
  levels.rounding = plate.probe.rounding;
  const double fastest = matrices::max_rate_of(plate.elasticity);
  const Eigen::MatrixXd error = matrices::stiffness_error(levels.S, plate.p, fastest).cwiseMax(levels.rounding);
  const auto e = a.n_externals(), m = a.n_discs();
  a.S_ee_error = error.topLeftCorner(e, e);
  a.S_ed_error = error.topRightCorner(e, m);
  a.S_dd_error = error.bottomRightCorner(m, m);
  result.errors = matrices::relative_errors(levels, plate.p, plate.held_stiffness, fastest);
  result.checks = check(plate, a);
  for (const auto& free : free_translations(plate, a)) {
    a.unsupported.push_back(rim::name_of(free.axis));
    for (auto& level : plate.cases) balance(free, level);
  }
  a.cracks.tips = plate.tips;
  store(plate.cases, a);
  a.stresses = describe_holes(plate, with_stresses);
  if (!with_stresses) a.waves.resize(a.contact.size());
  return result;
}

}  // namespace fastjoint::stage2
