// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/checked_items.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "common/count.hpp"
#include "stage3_nonlinear/strength/section_stress.hpp"

namespace fastjoint::stage3 {
namespace {

using Point = Eigen::Vector2d;

/// Direction of a force, degrees counter-clockwise from x; infinite without one.
double direction_of(const Point& force) {
  return force.norm() > 0 ? std::atan2(force.y(), force.x()) * 180 / std::numbers::pi : infinite;
}

/// Distance from the origin to a polygon around it along a direction.
double reach(const std::vector<std::pair<double, double>>& polygon, const Point& along) {
  double found = infinite;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& [x, y] = polygon[i];
    const auto& [u, v] = polygon[(i + 1) % polygon.size()];
    const Point a(x, y), side(u - x, v - y);
    const double area = along.x() * side.y() - along.y() * side.x();
    if (area == 0) continue;
    const double s = (a.x() * along.y() - a.y() * along.x()) / area, r = (a.x() * side.y() - a.y() * side.x()) / area;
    constexpr double rounding = 1e-12;
    if (s >= -rounding && s <= 1 + rounding && r > 0) found = std::min(found, r);
  }
  return found;
}

/// A hole that is checked, and the numbers of it that do not change.
struct CheckedHole {
  const CheckScene* check;
  const PlateModel* plate;
  Index at, rim;  ///< of the plate, and of the hole among its holes with stresses
  double d, t;
  std::vector<std::pair<Index, int>> discs{};  ///< columns of its discs, and their axes

  /// A quantity of the hole.
  [[nodiscard]] double of(const JointColumns& all, const char* quantity, Index step) const {
    return (*all.plates[at])[quantity](step, rim);
  }
  /// Force of the fastener on the sheet, friction included, along x and y.
  [[nodiscard]] Point force(const JointColumns& all, Index step) const {
    Point sum = Point::Zero();
    for (const auto& [disc, axis] : discs)
      for (const char* part : {"disc/bearing", "disc/friction"}) sum[axis] += (*all.plates[at])[part](step, disc);
    return sum;
  }
  /// Projected area d t of bearing along a force, that of the part of the hole that the model has.
  [[nodiscard]] double area(const Point& force) const {
    const auto areas = plate->stresses.bearing_area.row(rim);
    return force.norm() > 0 ? areas.cwiseProduct(force.cwiseAbs().transpose() / force.norm()).norm() : areas.maxCoeff();
  }
  /// Distance of its centre from the edge along a force; infinite if the sheet's outline is not known.
  [[nodiscard]] double edge_distance(const Point& force) const {
    if (check->edge_distance) return *check->edge_distance;
    return distance_to_border(plate->border, plate->stresses.rim_center.row(rim).transpose(), force);
  }

  [[nodiscard]] Applied bearing(const JointColumns& all, Index step) const {
    const Point F = force(all, step);
    const double ratio = edge_distance(F) / d, value = check->allowable.at(ratio), A = area(F);
    return {F.norm(), value * A, fmt::format("F_br = {:g}, d t = {:g}, e/D = {:.4g}", value, A, ratio), ratio,
            direction_of(F)};
  }
  [[nodiscard]] Applied shear_out(const JointColumns& all, Index step) const {
    const double cos_40 = std::cos(40 * std::numbers::pi / 180);
    const Point F = force(all, step);
    const double e = edge_distance(F), value = check->allowable.at(e / d);
    // Half a hole on a line of symmetry has one of the two planes.
    const double planes = 2 * area(F) / (d * t);
    return {F.norm(), planes * value * t * std::max(e - d / 2 * cos_40, 0.0),
            fmt::format("F_su = {:g}, t = {:g}, e = {:.5g}, d = {:g}", value, t, e, d), e / d, direction_of(F)};
  }
  /// The polygon along the ray of the bearing stress and of that principal stress of what passes by which leaves less;
  /// both as lengths on that ray.
  [[nodiscard]] Applied bearing_bypass(const JointColumns& all, Index step) const {
    const auto along = [&](double bypass, double direction) -> Applied {
      const Point stress(bypass, of(all, "rim/bearing_stress", step));
      if (!stress.allFinite()) return {infinite};
      const double allowable = stress.norm() > 0 ? reach(check->polygon, stress.normalized()) : infinite;
      return {stress.norm(), allowable, fmt::format("bypass {:g}, bearing {:g}", stress.x(), stress.y()), infinite,
              direction};
    };
    const double direction = of(all, "rim/bypass_direction", step), turned = direction > 0 ? -90 : 90;
    const Applied larger = along(of(all, "rim/bypass_stress", step), direction),
                  other = along(of(all, "rim/bypass_across", step), direction + turned);
    const auto left = [](const Applied& a) { return a.applied > 0 ? a.allowable / a.applied : infinite; };
    constexpr double equal = 1 - 1e-9;  // so that rounding does not choose between them
    return left(other) < equal * left(larger) ? other : larger;
  }
  [[nodiscard]] Applied tension(const JointColumns& all, Index step) const {
    const double value = check->allowable.at(infinite);
    return {of(all, "rim/net_stress", step), value, fmt::format("F_tu = {:g}", value), infinite,
            of(all, "rim/net_direction", step)};
  }
  [[nodiscard]] Applied peak(const JointColumns& all, Index step) const {
    const double value = check->allowable.at(infinite);
    return {of(all, check->with_bending ? "bending/peak" : "rim/peak_hoop", step), value,
            fmt::format("limit = {:g}", value)};
  }
};

/// Collects what the checks of a joint ask.
class Collector {
 public:
  Collector(const JointScene& scene, const JointModel& joint, const Parameters& parameters)
      : scene_(scene), joint_(joint), parameters_(parameters) {}

  CheckedItems run() {
    for (const auto& check : scene_.checks) {
      check_ = &check;
      check.kind == CheckKind::fastener_shear ? of_fasteners() : of_holes();
    }
    return std::move(all_);
  }

 private:
  [[noreturn]] void fail(const std::string& found, const std::string& allowed) const {
    refuse(check_->where, found, allowed);
  }

  void of_fasteners() {
    if (joint_.n_planes() == 0) fail("a check of fasteners, of which there is none", "checks of holes");
    for (const auto& id : check_->of)
      if (std::ranges::find(joint_.fasteners, id, &FastenerModel::id) == joint_.fasteners.end())
        fail(fmt::format("fastener \"{}\" does not exist", id), "ids of fasteners");
    for (Index j = 0; j < joint_.n_planes(); ++j) {
      const ShearPlane& plane = joint_.planes[j];
      const std::string& id = joint_.fasteners[plane.fastener].id;
      if (!check_->of.empty() && std::ranges::find(check_->of, id) == check_->of.end()) continue;
      const double d = check_->is_force ? 0 : diameter(plane), part = modelled_part(plane);
      const double value = check_->allowable.at(0);
      const double allowable = part * (check_->is_force ? value : value * std::numbers::pi * d * d / 4);
      const std::string inputs =
          (check_->is_force ? fmt::format("P_su = {:g}", value) : fmt::format("F_su = {:g}, d = {:g}", value, d)) +
          (part < 1 ? fmt::format(", {:g} of the fastener is in the model", part) : "");
      all_.items.push_back({check_, joint_.short_name(plane), check_->is_force ? "P_su" : "F_su pi d^2 / 4",
                            unit(joint_.units, 0, 1), [=](const JointColumns& all, Index step) {
                              const auto both = (*all.joint)["transferred"].row(step).segment<2>(2 * j);
                              return Applied{both.cwiseAbs().maxCoeff(), allowable, inputs};
                            }});
    }
  }

  /// Part of a plane's fastener whose load the model has: a half where a line of symmetry goes through its hole.
  [[nodiscard]] double modelled_part(const ShearPlane& plane) const {
    const HoleModel& hole = joint_.first_hole(plane);
    const PlateModel& plate = joint_.plates[hole.plate];
    const auto rim = joint_.described(hole);
    if (!rim) return 1;
    const double whole = 2 * plate.stresses.rim_radius[*rim] * plate.stresses.rim_thickness[*rim];
    double part = 1;
    for (Index d = 0; d < joint_.n_directions(); ++d)
      if (plate.has_disc(hole.disc + d) && whole > 0)
        part = std::min(part, plate.stresses.bearing_area(*rim, plate.axis_of(hole.disc + d)) / whole);
    constexpr double nearly = 1 - 1e-6;  // thickness may differ around a hole
    return part < nearly && std::abs(part - 0.5) < 0.05 ? 0.5 : 1;
  }

  /// Diameter of a plane's fastener: of the check, of JOINT.json, or of the hole less its gap.
  [[nodiscard]] double diameter(const ShearPlane& plane) const {
    if (check_->diameter) return *check_->diameter;
    const FastenerScene& fastener = scene_.fasteners[plane.fastener];
    if (fastener.diameter) return *fastener.diameter;
    const HoleModel& hole = joint_.first_hole(plane);
    const auto rim = joint_.described(hole);
    if (!rim)
      fail(fmt::format("the diameter of fastener \"{}\" is not known", fastener.id), "\"diameter\" in the check");
    return 2 *
           (joint_.plates[hole.plate].stresses.rim_radius[*rim] - parameters_.gap[joint_.number_of_first_hole(plane)]);
  }

  void of_holes() {
    std::vector<std::pair<Index, Index>> holes;
    std::vector<std::string> known;
    for (Index i = 0; i < std::ssize(joint_.plates); ++i) {
      const PlateModel& plate = joint_.plates[i];
      known.push_back(plate.name);
      for (Index rim = 0; plate.stress_level && rim < std::ssize(plate.stresses.rim_hole); ++rim) {
        const std::string& hole = plate.stresses.rim_hole[rim];
        known.push_back(plate.name + ":" + hole);
        const auto named = [&](const std::string& each) { return each == plate.name || each == known.back(); };
        if (check_->of.empty() || std::ranges::any_of(check_->of, named)) holes.emplace_back(i, rim);
      }
    }
    for (const auto& each : check_->of)
      if (index_of(known, each) == count_of(known))
        fail(fmt::format("\"{}\" is no plate and no hole with stresses", each),
             fmt::format("{}", fmt::join(known, ", ")));
    if (check_->with_bending && !joint_.plates.front().bends)
      fail("\"bending\": true of a joint without secondary bending",
           "a joint without \"bending\": \"none\", and matrices of this version of sheets in plane stress");
    if (holes.empty())
      fail("no hole with stresses", "matrices of stage2_extract without --loads-only, at their highest degree");
    for (const auto& [plate, rim] : holes) of_hole(plate, rim);
  }

  void of_hole(Index at, Index rim) {
    const PlateModel& plate = joint_.plates[at];
    const formats::PlateStresses& s = plate.stresses;
    const std::string &hole = s.rim_hole[rim], name = plate.name + ":" + hole;
    const CheckKind kind = check_->kind;
    const bool has_fastener = index_of(plate.holes, hole) < count_of(plate.holes),
               needs_border = kind == CheckKind::shear_out ||
                              (kind == CheckKind::bearing && !check_->allowable.edge_ratio.empty());
    if ((kind == CheckKind::bearing || kind == CheckKind::shear_out) && !has_fastener) return;
    if (needs_border && !check_->edge_distance && plate.border.empty())
      fail(fmt::format("the edge distance of {} is not known, since its matrices have no border", name),
           "\"edge_distance\" in the check, or matrices of this version");
    const HoleSections sections(s, rim, &plate.border);
    const bool needs_section = kind == CheckKind::tension || kind == CheckKind::bearing_bypass;
    const char* lacks = needs_section && sections.number() == 0                     ? "it has no sections"
                        : kind == CheckKind::shear_out && s.rim_thickness[rim] == 0 ? "its thickness is not known"
                                                                                    : nullptr;
    if (lacks != nullptr) return all_.left_out.add(*check_, lacks, name);
    CheckedHole its{check_, &plate, at, rim, 2 * s.rim_radius[rim], s.rim_thickness[rim]};
    for (Index i = 0; i < std::ssize(plate.discs); ++i)
      if (plate.hole_of(plate.discs[i]) == hole) its.discs.emplace_back(i, plate.axis_of(plate.discs[i]));
    CheckedItem& item = all_.items.emplace_back(item_of(its, name));
    if (kind == CheckKind::peak) item.is_known = plate.has_peak(hole);
    if (kind != CheckKind::tension) return;
    item.is_known = false;
    if (sections.is_open())
      item.unknown = "cracks cut its net section through";
    else if (sections.is_filled())
      item.unknown = "it fills most of the strip between cell lines, whose net section says nothing of the sheet";
    else
      item.is_known = true;
  }

  /// What its check asks of a hole, with the formula.
  [[nodiscard]] CheckedItem item_of(const CheckedHole& hole, const std::string& name) const {
    const std::string force = unit(joint_.units, 0, 1), stress = unit(joint_.units, -2, 1);
    const auto item = [&](const char* formula, const std::string& unit, auto compute) -> CheckedItem {
      return {check_, name, formula, unit,
              [=](const JointColumns& all, Index step) { return (hole.*compute)(all, step); }};
    };
    switch (check_->kind) {
      case CheckKind::bearing:
        return item("F_br d t", force, &CheckedHole::bearing);
      case CheckKind::shear_out:
        return item("2 F_su t (e - d cos 40 / 2)", force, &CheckedHole::shear_out);
      case CheckKind::tension:
        return item("F_tu", stress, &CheckedHole::tension);
      case CheckKind::peak:
        return item("limit", stress, &CheckedHole::peak);
      case CheckKind::bearing_bypass:
        return item("polygon", stress, &CheckedHole::bearing_bypass);
      case CheckKind::fastener_shear:
        break;
    }
    throw std::logic_error("a check of fasteners is not one of holes");
  }

  const JointScene& scene_;
  const JointModel& joint_;
  const Parameters& parameters_;
  const CheckScene* check_ = nullptr;
  CheckedItems all_;
};

}  // namespace

double CheckedItem::margin(const Applied& now) const {
  return now.applied > 0 ? now.allowable / (check->safety_factor * check->fitting_factor * now.applied) - 1 : infinite;
}

std::vector<program::Warning> LeftOut::warnings(const JointScene& scene) const {
  std::vector<program::Warning> all;
  for (const auto& [key, items] : items_) {
    const auto& [check, at_some_increments, reason] = key;
    all.push_back({"check-left-out", fmt::format("{}: check \"{}\" is {} for {}: {}", scene.file, check->name,
                                                 at_some_increments ? "made of some increments alone" : "not made",
                                                 program::listed(items), reason)});
  }
  return all;
}

CheckedItems checked_items(const JointScene& scene, const JointModel& joint, const Parameters& parameters) {
  return Collector(scene, joint, parameters).run();
}

}  // namespace fastjoint::stage3
