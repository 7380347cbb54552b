// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/near_peaks.hpp"

#include <algorithm>

#include "common/infinite.hpp"
#include "stage3_nonlinear/results/hoop_peak.hpp"
#include "stage3_nonlinear/results/near_stress.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Vector2d;
/// Distance of the origin from the piece between two points; infinite if it lies on a line through the origin.
double distance_to(const Vector2d& from, const Vector2d& to, double radius) {
  const Vector2d along = to - from;
  const double area = from.x() * to.y() - from.y() * to.x();
  constexpr double same_line = 1e-6;
  if (std::abs(area) <= same_line * radius * along.norm()) return infinite;
  const double at = std::clamp(-from.dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (from + at * along).norm();
}

const LoadedRim* rim_of(const JointState& state, Index plate, const std::string& hole) {
  for (const auto& rim : state.plates[plate].loaded)
    if (rim && rim->rim.hole == hole) return &*rim;
  return nullptr;
}

}  // namespace

VectorXd room_around(const PlateModel& plate) {
  const formats::PlateStresses& a = plate.stresses;
  const Index r = std::ssize(a.rim_hole);
  VectorXd room = VectorXd::Constant(r, infinite);
  for (Index i = 0; i < r; ++i) {
    const Vector2d center = a.rim_center.row(i);
    for (Index j = 0; j < plate.border.ends.rows(); ++j) {
      const Vector2d from = plate.border.ends.row(j).head<2>(), to = plate.border.ends.row(j).tail<2>();
      room[i] = std::min(room[i], distance_to(from - center, to - center, a.rim_radius[i]));
    }
    for (Index j = 0; j < r; ++j)
      if (j != i) room[i] = std::min(room[i], (a.rim_center.row(j).transpose() - center).norm() - a.rim_radius[j]);
  }
  return room - a.rim_radius;
}

formats::NearStresses near_stresses(const PlateModel& plate, const std::vector<JointState>& states, Index at,
                                    double distance, const formats::RimStresses* around) {
  const Index n = std::ssize(states), r = std::ssize(plate.stresses.rim_hole);
  const VectorXd room = room_around(plate);
  const MatrixXd none = MatrixXd::Constant(n, r, std::nan(""));
  formats::NearStresses a{distance, none, none, MatrixXd::Constant(n, r, infinite)};
  if (around)
    for (auto* table : {&a.rr, &a.tt, &a.rt}) *table = MatrixXd::Constant(n, around->angle.size(), infinite);
  for (Index step = 0; step < n; ++step)
    for (Index i = 0; i < r; ++i) {
      const LoadedRim* rim = rim_of(states[step], at, plate.stresses.rim_hole[i]);
      if (!rim || !(distance < room[i])) continue;
      if (const auto peak = hoop_peak(*rim, {}, distance)) {
        a.peak(step, i) = peak->value;
        a.angle(step, i) = peak->angle;
        a.error(step, i) = peak->error;
      }
      if (!around) continue;
      const NearStress near(rim->hoop(0, rim->rim.waves, rim->traction_waves(rim->degrees[0].tractions)), distance);
      for (Index k = around->start[i]; k < around->start[i + 1]; ++k) {
        const Eigen::Vector3d stress = near.at(around->angle[k] * rim::degree);
        a.rr(step, k) = stress[0];
        a.tt(step, k) = stress[1];
        a.rt(step, k) = stress[2];
      }
    }
  return a;
}

}  // namespace fastjoint::stage3
