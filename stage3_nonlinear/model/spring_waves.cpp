// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/spring_waves.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "common/rim/angles.hpp"
#include "common/rim/rim_compliance.hpp"

namespace fastjoint::stage3 {
namespace {

SpringWaves make(const formats::WaveRim& rim) {
  constexpr int highest = 48, quarters = 4, points = 2048;
  SpringWaves waves{rim.waves, {}, {}, {}};
  rim::Harmonics& full = waves.full;
  full.highest = std::max(full.highest, highest);
  const Index n_long = rim.waves.size(), n = full.size(), s = n - n_long;
  if (s == 0) return {full, MatrixXd(0, n_long), MatrixXd(0, quarters), true};
  const MatrixXd D = rim::RimCompliance(rim.compliance, rim.radius).displacements(full).middleRows(n_long, s);
  std::vector<rim::SignedRange> sprung_arcs;
  for (const auto& arc : rim.acts)
    for (const int turns : {-1, 0, 1}) {
      const double from = std::max(arc.from + turns * rim::full_turn, full.start);
      const double to = std::min(arc.to + turns * rim::full_turn, full.start + full.sweep);
      if (from < to) sprung_arcs.push_back({from, to});
    }
  // K times the mean over the rim of the products, integrated over the arcs with springs only.
  const MatrixXd sprung = rim.modulus / full.sweep * full.products(sprung_arcs);
  MatrixXd shear = MatrixXd::Zero(full.n_shears(), quarters);
  for (int i = 0; i < points; ++i) {
    const double angle = full.start + (i + 0.5) / points * full.sweep;
    const VectorXd shapes = full.shears_at(angle) / points;
    for (int quarter = 0; quarter < quarters; ++quarter)
      shear.col(quarter) += cosine_friction(angle, quarter * rim::full_turn / quarters) * shapes;
  }
  const MatrixXd by_w = D.leftCols(n) * sprung;
  const Eigen::PartialPivLU<MatrixXd> own(MatrixXd::Identity(s, s) + by_w.rightCols(s));
  waves.by_long = -own.solve(by_w.leftCols(n_long));
  waves.by_friction = -own.solve(D.rightCols(full.n_shears()) * shear);
  constexpr double rounding = 1e-12;
  waves.only_friction = waves.by_long.lpNorm<Eigen::Infinity>() < rounding;
  return waves;
}

bool same(const formats::WaveRim& a, const formats::WaveRim& b) {
  const auto same_arc = [](const auto& one, const auto& other) { return one.from == other.from && one.to == other.to; };
  return a.waves.highest == b.waves.highest && a.waves.start == b.waves.start && a.waves.sweep == b.waves.sweep &&
         a.radius == b.radius && a.modulus == b.modulus && a.compliance == b.compliance &&
         std::ranges::equal(a.acts, b.acts, same_arc);
}

}  // namespace

double cosine_bearing(double angle, double direction) { return std::max(std::cos(angle - direction), 0.0); }

double cosine_friction(double angle, double direction) {
  const double along = std::sin(angle - direction);
  return along == 0 ? 0 : -std::copysign(cosine_bearing(angle, direction), along);
}

std::vector<std::shared_ptr<const SpringWaves>> spring_waves(const std::vector<formats::WaveRim>& rims) {
  std::vector<std::shared_ptr<const SpringWaves>> result;
  for (const auto& rim : rims) {
    auto& waves = result.emplace_back();
    if (!rim.has_closed_form() || rim.modulus == 0) continue;
    for (Index before = 0; !waves && before + 1 < std::ssize(result); ++before)
      if (result[before] && same(rims[before], rim)) waves = result[before];
    if (!waves) waves = std::make_shared<const SpringWaves>(make(rim));
  }
  return result;
}

}  // namespace fastjoint::stage3
