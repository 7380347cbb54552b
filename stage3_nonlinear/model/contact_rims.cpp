// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/contact_rims.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <vector>

#include "common/rim/rim_compliance.hpp"

namespace fastjoint::stage3 {
namespace {

bool same(const formats::ContactRim& a, const formats::WaveRim& a_carried, const formats::ContactRim& b,
          const formats::WaveRim& b_carried) {
  return a.pressures == b.pressures && a.modulus == b.modulus && a.radius == b.radius && a.disk == b.disk &&
         a_carried.waves == b_carried.waves && a_carried.compliance == b_carried.compliance;
}

/// Minimum compliance of disk and sheet over waves of order 2 and more, after D if that is known.
double min_compliance(const rim::Harmonics& full, const ShortWaves& a) {
  VectorXd all = a.disk_compliance;
  if (a.D.size() > 0) all += a.D.diagonal().head(a.n);
  const Index first = full.is_whole() ? 3 : 2;  // the first wave of order 2, or 4 on a quarter
  return first < a.n ? all.tail(a.n - first).minCoeff() : all[0];
}

/// Adds to waves the compliance of an elastic disk, or of springs that are stiffer than the shortest wave of the sheet:
/// pressures between a sheet and such springs need more waves than those between a sheet and penalty springs.
void add_disk(const formats::ContactRim& contact, const rim::Harmonics& full, ShortWaves& a) {
  if (contact.disk.is_given()) {
    a.disk_compliance = contact.disk.yield(contact.radius, full);
    a.M_tau = a.disk_by_shear = contact.disk.yield_by_shear(contact.radius, full);
    a.disk_tangential = contact.disk.give_way(contact.radius, full);
  } else {
    a.disk_compliance = VectorXd::Constant(a.n, 1 / contact.modulus);
    constexpr double stiffer = 3;
    constexpr int many = 32;  // waves; of fewer the shortest is softer than most springs
    if (full.highest < many || a.D.size() == 0 || min_compliance(full, a) * contact.modulus < stiffer)
      return a.disk_compliance.resize(0);
    a.disk_by_shear = MatrixXd::Zero(a.n, a.n_shears);
    a.disk_tangential = VectorXd::Zero(a.n_shears);
  }
  a.M.diagonal() = a.disk_compliance;
  a.min_compliance = min_compliance(full, a);
}

}  // namespace

ShortWaves short_waves(const formats::ContactRim& contact, const formats::WaveRim& carried) {
  const auto& [full, long_waves] = std::tie(contact.pressures, carried.waves);
  ShortWaves a;
  a.n_long = long_waves.size(), a.n = full.size(), a.n_long_shears = long_waves.n_shears(),
  a.n_shears = full.n_shears();
  const Index s = a.n - a.n_long, s_t = a.n_shears - a.n_long_shears;
  a.G = MatrixXd::Zero(s, a.n_long);
  a.G_t = MatrixXd::Zero(s, a.n_long_shears);
  a.E = MatrixXd::Zero(a.n_long, s_t);
  a.C_fixed = MatrixXd::Zero(a.n_long, a.n_long);
  a.R_fixed = MatrixXd::Zero(a.n_long, a.n_long_shears);
  a.M = MatrixXd::Zero(a.n, a.n);
  a.M_tau = MatrixXd::Zero(a.n, a.n_shears);
  if (carried.has_closed_form()) a.D = rim::RimCompliance(carried.compliance, carried.radius).displacements(full);
  add_disk(contact, full, a);
  if (!carried.has_closed_form() || s == 0) {
    a.D.resize(0, 0);
    return a;
  }
  constexpr double rounding = 1e-13;  // waves of different order are uncoupled in an isotropic sheet
  a.D = (a.D.array().abs() > rounding * a.D.cwiseAbs().maxCoeff()).select(a.D, 0).eval();
  const MatrixXd nn = a.D.topLeftCorner(a.n, a.n), nt = a.D.topRightCorner(a.n, a.n_shears);
  const MatrixXd own = nn.bottomRightCorner(s, s), to_short = nn.bottomLeftCorner(s, a.n_long);
  const Eigen::PartialPivLU<MatrixXd> softened(MatrixXd::Identity(s, s) + contact.modulus * own);
  a.G = softened.solve(to_short);
  a.G_t = softened.solve(nt.bottomLeftCorner(s, a.n_long_shears));
  a.E = nt.topRightCorner(a.n_long, s_t) - contact.modulus * a.G.transpose() * nt.bottomRightCorner(s, s_t);
  const MatrixXd reaction = own.llt().solve(to_short).transpose();  // short pressures that fix the short waves
  a.C_fixed = reaction * a.G;
  a.R_fixed = reaction * a.G_t;
  a.M.bottomRows(s) += nn.bottomRows(s);
  a.M.topRightCorner(a.n_long, s) += to_short.transpose();
  a.M.topLeftCorner(a.n_long, a.n_long) += reaction * to_short;
  a.M_tau.bottomRows(s) += nt.bottomRows(s);
  a.M_tau.topRightCorner(a.n_long, s_t) += nt.topRightCorner(a.n_long, s_t);
  a.M_tau.topLeftCorner(a.n_long, a.n_long_shears) += reaction * nt.bottomLeftCorner(s, a.n_long_shears);
  return a;
}

std::vector<std::shared_ptr<const ShortWaves>> short_waves_of(const formats::PlateMatrices& a) {
  std::vector<std::shared_ptr<const ShortWaves>> result;
  for (Index i = 0; i < std::ssize(a.contact); ++i) {
    auto& waves = result.emplace_back();
    for (Index before = 0; !waves && before < i; ++before)
      if (same(a.contact[before], a.waves[before], a.contact[i], a.waves[i])) waves = result[before];
    if (!waves) waves = std::make_shared<const ShortWaves>(short_waves(a.contact[i], a.waves[i]));
  }
  return result;
}

RimMatrices rim_matrices(const formats::PlateMatrices& a, Index level) {
  std::vector<Index> pressures, shears;  // rows of W
  std::vector<double> areas;             // of each of `pressures`
  Index next = 0;
  for (Index i = 0; i < std::ssize(a.contact); ++i) {
    const auto& rim = a.waves[i];
    for (Index k = 0; k < rim.waves.size(); ++k) {
      pressures.push_back(next++);
      areas.push_back(rim.area);
    }
    for (Index k = 0; k < rim.waves.n_shears(); ++k) shears.push_back(next++);
  }
  const Index e = a.n_externals(), m = a.n_discs(), h = a.n_friction_cases(), q = a.n_tractions();
  const auto& W = a.W[level];
  const auto columns = [&](std::vector<Index> list) {
    for (Index& k : list) k += e + m;
    return list;
  };
  const VectorXd area = Eigen::Map<const VectorXd>(areas.data(), std::ssize(areas));
  const auto mean = area.cwiseInverse().asDiagonal();
  MatrixXd B(std::ssize(pressures), m + e), R(m + e, std::ssize(shears));
  B << W(pressures, Eigen::seqN(e, m)), W(pressures, Eigen::seqN(0, e));
  R << W(shears, Eigen::seqN(e, m)).transpose(), W(shears, Eigen::seqN(0, e)).transpose();
  return {mean * B,
          -(mean * W(pressures, columns(pressures)) * mean),
          R,
          mean * W(pressures, columns(shears)),
          mean * W(pressures, Eigen::lastN(h + q)).leftCols(h),
          mean * W(pressures, Eigen::lastN(q))};
}

}  // namespace fastjoint::stage3
