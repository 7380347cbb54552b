// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/rim_stresses.hpp"

namespace fastjoint::stage3 {

const LoadedRim* loaded_rim(const PlateState& state, const std::string& hole) {
  for (const auto& rim : state.loaded)
    if (rim && rim->rim.hole == hole) return &*rim;
  return nullptr;
}

void set_points(const PlateState* state, formats::HoleList& holes) {
  const Index r = std::ssize(holes.hole);
  holes.start = Eigen::VectorXi::Zero(r + 1);
  for (Index i = 0; i < r; ++i) {
    const LoadedRim* rim = state ? loaded_rim(*state, holes.hole[i]) : nullptr;
    const VectorXd places = rim ? rim->places() : VectorXd();
    holes.start[i + 1] = holes.start[i] + int(places.size());
    holes.angle.conservativeResize(holes.start[i + 1]);
    holes.angle.tail(places.size()) = places;
  }
}

PlateGroup rim_stresses(const formats::HoleList& points) {
  return {columns::Of::point,
          points.angle.size(),
          {{"rim/sigma_rr", columns::stress, "radial stress of the sheet at each point"},
           {"rim/sigma_tt", columns::stress, "hoop stress at each point"},
           {"rim/sigma_rt", columns::stress, "shear stress at each point"}},
          [points](const PlateAt& at) {
            MatrixXd all(points.angle.size(), 3);
            for (Index i = 0; i < std::ssize(points.hole); ++i)
              if (const Index n = points.start[i + 1] - points.start[i]; n > 0)
                all.middleRows(points.start[i], n) =
                    loaded_rim(at.state(), points.hole[i])->stresses(points.angle.segment(points.start[i], n));
            return all;
          }};
}

}  // namespace fastjoint::stage3
