// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/near_peaks.hpp"

#include <algorithm>

#include "common/infinite.hpp"
#include "stage3_nonlinear/results/hoop_peak.hpp"
#include "stage3_nonlinear/results/near_stress.hpp"
#include "stage3_nonlinear/results/rim_stresses.hpp"

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

}  // namespace

VectorXd room_around(const PlateModel& plate) {
  const formats::PlateStresses& a = plate.stresses;
  const Index r = std::ssize(a.rim_hole);
  VectorXd room = VectorXd::Constant(r, infinite);
  for (Index i = 0; i < r; ++i) {
    const Vector2d center = a.rim_center.row(i);
    for (const auto& [from, to, is_free] : plate.border)
      room[i] = std::min(room[i], distance_to(from - center, to - center, a.rim_radius[i]));
    for (Index j = 0; j < r; ++j)
      if (j != i) room[i] = std::min(room[i], (a.rim_center.row(j).transpose() - center).norm() - a.rim_radius[j]);
  }
  return room - a.rim_radius;
}

PlateGroup near_peaks(const PlateModel& plate, double distance) {
  const Index r = std::ssize(plate.stresses.rim_hole);
  return {columns::Of::hole,
          r,
          {{"rim/near/peak_hoop", columns::stress, "largest hoop stress on the circle", "", h5::nan_too},
           {"rim/near/peak_angle", columns::angle, "angle of it, counter-clockwise from x", "", h5::nan_too},
           {"rim/near/peak_error", columns::stress, "estimated error of it", "", h5::infinite_too}},
          [distance, room = room_around(plate), r](const PlateAt& at) {
            MatrixXd all(r, 3);
            all.leftCols(2).setConstant(std::nan(""));
            all.col(2).setConstant(infinite);
            for (Index i = 0; i < r; ++i) {
              const LoadedRim* rim = loaded_rim(at.state(), at.model().stresses.rim_hole[i]);
              if (!rim || !(distance < room[i])) continue;
              if (const auto peak = hoop_peak(*rim, {}, distance)) all.row(i) << peak->value, peak->angle, peak->error;
            }
            return all;
          }};
}

PlateGroup near_stresses(const PlateModel& plate, double distance, const formats::HoleList& points) {
  const std::string meaning = " stress at this distance outwards from each point";
  return {columns::Of::point,
          points.angle.size(),
          {{"rim/near/sigma_rr", columns::stress, "radial" + meaning, "", h5::infinite_too},
           {"rim/near/sigma_tt", columns::stress, "hoop" + meaning, "", h5::infinite_too},
           {"rim/near/sigma_rt", columns::stress, "shear" + meaning, "", h5::infinite_too}},
          [distance, room = room_around(plate), points](const PlateAt& at) {
            MatrixXd all = MatrixXd::Constant(points.angle.size(), 3, infinite);
            for (Index i = 0; i < room.size(); ++i) {
              const LoadedRim* rim = loaded_rim(at.state(), points.hole[i]);
              if (!rim || !(distance < room[i])) continue;
              const NearStress near(rim->hoop(0, rim->rim.waves, rim->traction_waves(rim->degrees[0].tractions)),
                                    distance);
              for (Index k = points.start[i]; k < points.start[i + 1]; ++k)
                all.row(k) = near.at(points.angle[k] * rim::degree);
            }
            return all;
          }};
}

}  // namespace fastjoint::stage3
