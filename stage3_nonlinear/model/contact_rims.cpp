// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/contact_rims.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "common/matrices/decompositions.hpp"
#include "common/rim/rim_compliance.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr int least_order = 20, highest_order = 128;

/// Order of the shortest wave if the file leaves it to the joint: a half more than the elements carry, so that the
/// change by the shorter waves shows their error.
int fewest_order(const formats::ContactRim& contact, const formats::WaveRim& carried) {
  if (contact.pressures.highest > 0) return contact.pressures.highest;
  const int more = std::max(least_order, (3 * carried.waves.highest / 2 + 3) / 4 * 4);
  return std::max(carried.waves.highest, std::min(more, rim::max_harmonics));
}

/// Mean compliance of the waves beyond an order, of each of which it is constant + fall / order, length / stress. With
/// it the ends of contact are those of all waves but for terms of the order N^-2 (docs/theory.md, section 6.8).
double mean_beyond(double order, double constant, double fall) {
  const double first = fall / order, ratio = first / constant;
  constexpr double small = 1e-6;
  if (constant == 0) return first / std::numbers::e;
  return ratio > small ? constant * std::exp((1 + 1 / ratio) * std::log1p(ratio) - 1) : constant;
}

/// Adds to waves the compliance of an elastic disk, or of springs.
void add_disk(const formats::ContactRim& contact, ShortWaves& a) {
  const bool is_disk = contact.disk.is_given();
  const double spring = 1 / contact.modulus;
  a.disk_compliance =
      is_disk ? contact.disk.yield(contact.radius, a.pressures) : VectorXd(VectorXd::Constant(a.n, spring));
  a.disk_by_shear = MatrixXd::Zero(a.n, a.n_shears);
  a.disk_tangential = VectorXd::Zero(a.n_shears);
  if (is_disk) {
    a.disk_by_shear = contact.disk.yield_by_shear(contact.radius, a.pressures);
    a.disk_tangential = contact.disk.give_way(contact.radius, a.pressures);
  }
  a.M = a.disk_compliance.asDiagonal();
  a.M_tau = a.disk_by_shear;
}

/// Index of the first wave of order 2, also of half or a quarter of a rim; D does not have those before.
Index first_of_D(const ShortWaves& a) {
  return a.pressures.is_whole() ? 3 : std::lround(2 * a.pressures.sweep / std::numbers::pi);
}

/// Smallest eigenvalue of the compliance with ones on its diagonal: below 1 in a laminate, whose rim is stiffer at some
/// places than at others.
double least_to_mean(const ShortWaves& a) {
  const Index first = first_of_D(a), n = a.n - first;
  if (a.D.size() == 0 || n <= 0) return 1;
  MatrixXd all = a.D.block(first, first, n, n);
  if (all.isDiagonal()) return 1;
  all.diagonal() += a.disk_compliance.tail(n);
  const VectorXd root = all.diagonal().cwiseSqrt().cwiseInverse();
  constexpr double least = 0.01;
  return std::max(matrices::symmetric_eigenvalues(root.asDiagonal() * all * root.asDiagonal())[0], least);
}

/// Sets the compliance of the waves beyond the shortest, and lets that of the upper third of the waves pass over into
/// it without a jump, which would make the pressure oscillate (docs/theory.md, section 6.8).
void set_tail(const formats::ContactRim& contact, ShortWaves& a) {
  const rim::Harmonics& shape = a.pressures;
  const Index group = shape.is_whole() ? 2 : 1;  // waves of one order
  const double spacing = shape.is_whole() ? 1 : std::numbers::pi / shape.sweep;
  const auto order = [&](Index k) {
    const Index number = (k + group - 1) / group;
    return spacing * double(number);
  };
  VectorXd all = a.disk_compliance;
  if (a.D.size() > 0) all += a.D.diagonal().head(a.n);
  const double constant = contact.disk.is_given() ? 0 : 1 / contact.modulus;
  a.fall = (all.tail(std::min(group, a.n)).mean() - constant) * order(a.n - 1);
  const double last = order(a.n - 1) + spacing / 2, first = 2 * last / 3;
  const double at_last = constant + a.fall / last, jump = least_to_mean(a);
  a.part = VectorXd::Ones(a.n);
  a.tail = a.disk_compliance[0];
  if (!(at_last > 0)) return;  // of a disk with waves of order 1 alone, which have no compliance
  // The logarithm of what is left of a wave is -depth s(x) + steep h(x), x from 0 to 1 between `first` and `last`, with
  // s' = h' = 0 at 0, s = 1, s' = 0, h = 0 and h' = 1 at 1.
  const auto s = [](double x) { return x * x * (3 - 2 * x); };
  const auto h = [](double x) { return x * x * (x - 1); };
  const VectorXd x = VectorXd::NullaryExpr(
      a.n, [&](Index k) { return k < a.n_long ? 0 : std::max(0.0, (order(k) - first) / (last - first)); });
  const double steep = a.fall / last / at_last * (last - first) / last;
  double of_s = 1 / last, of_h = 0;
  for (Index k = a.n_long; k < a.n; k += group) {
    of_s += spacing * s(x[k]) / (order(k) * order(k));
    of_h += spacing * h(x[k]) / (order(k) * order(k));
  }
  const double beyond = std::log(jump * at_last / mean_beyond(last, constant, a.fall));
  const double depth = (beyond / last + steep * of_h) / of_s;
  a.part = x.unaryExpr([&](double at) { return std::exp(steep * h(at) - depth * s(at)); });
  constexpr double below = 1 - 1e-6;  // the shortest wave, so that rounding leaves it a compliance
  a.tail = below * jump * at_last * std::exp(-depth);
}

/// Compliance that each long wave of disk or springs lacks of the tail's, but no more than a part of the sheet's own.
VectorXd lacking(const ShortWaves& a) {
  const Index first = first_of_D(a);
  if (a.D.size() == 0 || a.n_long <= first) return VectorXd::Zero(a.n_long);
  constexpr double part = 0.6;
  const Index n = a.n_long - first;
  const double least = matrices::symmetric_eigenvalues(a.D.block(first, first, n, n))[0];
  return (a.tail - a.disk_compliance.head(a.n_long).array()).min(part * least).max(0);
}

/// The waves up to an order, long ones without what is moved into them.
ShortWaves waves_up_to(int order, const formats::ContactRim& contact, const formats::WaveRim& carried) {
  ShortWaves a;
  a.pressures = contact.pressures;
  a.pressures.highest = order;
  a.n_long = carried.waves.size(), a.n = a.pressures.size(), a.n_long_shears = carried.waves.n_shears(),
  a.n_shears = a.pressures.n_shears();
  const Index s = a.n - a.n_long, s_t = a.n_shears - a.n_long_shears;
  a.G = MatrixXd::Zero(s, a.n_long);
  a.G_t = MatrixXd::Zero(s, a.n_long_shears);
  a.E = MatrixXd::Zero(a.n_long, s_t);
  a.C_fixed = MatrixXd::Zero(a.n_long, a.n_long);
  a.R_fixed = MatrixXd::Zero(a.n_long, a.n_long_shears);
  if (carried.has_closed_form())
    a.D = rim::RimCompliance(carried.compliance, carried.radius).displacements(a.pressures);
  add_disk(contact, a);
  set_tail(contact, a);
  if (!carried.has_closed_form() || s == 0) return a;
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
  const VectorXd root = a.part.cwiseSqrt();
  a.M = (root.asDiagonal() * a.M * root.asDiagonal()).eval();
  a.M_tau = (a.part.asDiagonal() * a.M_tau).eval();
  return a;
}

}  // namespace

ContactWaves::ContactWaves(const formats::ContactRim& contact, const formats::WaveRim& carried, bool moves)
    : contact_(contact), carried_(carried) {
  auto fewest = waves_up_to(fewest_order(contact, carried), contact, carried);
  fewest.moved = moves ? lacking(fewest) : VectorXd::Zero(fewest.n_long);
  fewest.M.diagonal().head(fewest.n_long) += fewest.moved;
  fewest_ = std::make_shared<const ShortWaves>(std::move(fewest));
}

bool ContactWaves::is_of(const formats::ContactRim& contact, const formats::WaveRim& carried) const {
  return contact_.pressures == contact.pressures && contact_.modulus == contact.modulus &&
         contact_.radius == contact.radius && contact_.area == contact.area && contact_.disk == contact.disk &&
         carried_.waves == carried.waves && carried_.compliance == carried.compliance;
}

bool ContactWaves::is_stiff() const {
  constexpr double stiff = 3.6;
  return contact_.disk.is_given() || fewest_->fall * contact_.modulus > stiff * fewest_->pressures.highest;
}

int ContactWaves::order(double gap, double force) const {
  if (contact_.pressures.highest > 0) return contact_.pressures.highest;
  // Half the arc on which two half-planes of the rims' compliance touch (Hertz), at most that of a disc without a gap.
  double half_arc = std::numbers::pi / 2;
  if (gap > 0 && force > 0) half_arc = std::min(half_arc, 2 * std::sqrt(force * fewest_->fall / (contact_.area * gap)));
  constexpr double per_arc = 20;  // for the aims of section 6.8
  const double needed = std::min(per_arc / half_arc, double(highest_order));
  return std::max(fewest_->pressures.highest, static_cast<int>(std::ceil(needed / 4)) * 4);
}

int ContactWaves::order_to_compare(int order, double mu) const {
  if (has_root_at_end(mu) && contact_.pressures.highest == 0 && 2 * order <= rim::max_harmonics) return 2 * order;
  return std::max({carried_.waves.highest, order / 2, 2});
}

std::shared_ptr<const ShortWaves> ContactWaves::up_to(int order) const {
  if (order == fewest_->pressures.highest) return fewest_;
  const std::scoped_lock lock(mutex_);
  auto& kept = kept_[order];
  if (kept) return kept;
  auto more = waves_up_to(order, contact_, carried_);
  // The sheet's matrices fix the short waves of the fewest.
  more.M.topLeftCorner(more.n_long, more.n_long) += fewest_->C_fixed - more.C_fixed;
  more.M_tau.topLeftCorner(more.n_long, more.n_long_shears) += fewest_->R_fixed - more.R_fixed;
  more.moved = fewest_->moved;
  more.M.diagonal().head(more.n_long) += more.moved;
  return kept = std::make_shared<const ShortWaves>(std::move(more));
}

std::vector<std::shared_ptr<const ContactWaves>> contact_waves_of(const formats::PlateMatrices& a, bool moves) {
  std::vector<std::shared_ptr<const ContactWaves>> result;
  for (Index i = 0; i < std::ssize(a.contact); ++i) {
    const auto like =
        std::ranges::find_if(result, [&](const auto& its) { return its->is_of(a.contact[i], a.waves[i]); });
    auto waves = like != result.end() ? *like : std::make_shared<const ContactWaves>(a.contact[i], a.waves[i], moves);
    result.push_back(std::move(waves));
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
