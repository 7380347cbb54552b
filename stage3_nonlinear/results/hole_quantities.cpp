// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/hole_quantities.hpp"

#include <cmath>

namespace fastjoint::stage3 {
namespace {

using columns::Dimension;

/// A quantity of a hole, which stands under its name in RESULT.h5, in the CSV and in the envelope.
struct HoleQuantity {
  const char* name;
  Dimension dimension;
  const char* meaning;
  std::function<double(const HoleState&)> value;
  bool needs_section = false;
  h5::Allowed allowed{};
  std::optional<columns::Output> output{};
};

/// Peak hoop stress over bearing stress; 0 where the bearing stress is less than a twentieth of the peak.
double bearing_concentration(const HoleState& hole) {
  constexpr double max_ratio = 20;  // beyond, the peak has nothing to do with the fastener
  return std::abs(hole.peak_hoop) < max_ratio * hole.bearing_stress ? hole.peak_hoop / hole.bearing_stress : 0;
}

const std::vector<HoleQuantity>& all_of_a_hole() {
  using R = HoleState;
  using namespace columns;
  static const std::vector<HoleQuantity> all{
      {"bearing_load", force, "bearing force of the fastener on the plate along x", &R::bearing_load},
      {"bearing_load_y", force, "bearing force of the fastener on the plate along y", &R::bearing_load_y},
      {"bearing_stress", stress, "magnitude of the bearing force over the projected area d t", &R::bearing_stress},
      {"bypass_load", force,
       "force that passes the fastener by, in the direction of the larger principal stress, tension positive",
       &R::bypass_load, true, h5::infinite_too},
      {"bypass_error", force, "estimated error of the bypass load", &R::bypass_error, true, h5::infinite_too},
      {"peak_hoop", stress, "largest hoop stress at the rim", &R::peak_hoop, false, h5::nan_too,
       Output{"peak", "peaks", "largest hoop stress at each hole", "largest hoop stress of all"}},
      {"peak_angle", angle, "angle of the largest hoop stress, counter-clockwise from x", &R::peak_angle, false,
       h5::nan_too},
      {"peak_error", stress, "estimated error of the largest hoop stress", &R::peak_error, false, h5::infinite_too},
      {"gross_concentration", ratio, "peak over the stress of the gross section", &R::gross_concentration, true},
      {"net_concentration", ratio, "peak over the stress of the net section", &R::net_concentration, true},
      {"net_stress", stress, "largest tension over the net sections next to the hole, in any direction", &R::net_stress,
       true, h5::infinite_too},
      {"against_slip", angle, "part of the contact on which friction acts against the slip that it assumes",
       &R::against_slip},
      {"bypass_stress", stress, "bypass load over the gross section, tension positive", &R::bypass_stress, true,
       h5::infinite_too},
      {"bypass_direction", angle, "direction of the bypass load, counter-clockwise from x", &R::bypass_direction, true},
      {"net_direction", angle, "direction of the net stress, counter-clockwise from x", &R::net_direction, true},
      {"bypass_across", stress, "principal stress across the direction of the bypass load", &R::bypass_across, true,
       h5::infinite_too},
      {"bearing_concentration", ratio, "peak over the bearing stress, 0 of a fastener that hardly bears",
       bearing_concentration},
  };
  return all;
}

}  // namespace

PlateGroup hole_quantities(const PlateModel& plate) {
  const auto& all = all_of_a_hole();
  std::vector<columns::Quantity> quantities;
  for (const auto& each : all)
    quantities.push_back({std::string("rim/") + each.name, each.dimension, each.meaning, each.name, each.allowed,
                          each.output, each.needs_section});
  const Index r = plate.stress_level ? std::ssize(plate.stresses.rim_hole) : 0;
  return {columns::Of::hole, r, std::move(quantities), [&all, r](const PlateAt& at) {
            const auto value = [&](Index i, Index k) { return all[k].value(at.state().rims[i]); };
            return MatrixXd::NullaryExpr(r, std::ssize(all), value);
          }};
}

}  // namespace fastjoint::stage3
