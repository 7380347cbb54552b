// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/margins.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "common/count.hpp"
#include "common/infinite.hpp"
#include "common/program/program.hpp"
#include "stage3_nonlinear/output/envelope.hpp"
#include "stage3_nonlinear/results/section_stress.hpp"

namespace fastjoint::stage3 {
namespace {

using formats::JointResult;
using formats::MarginTable;
using Point = Eigen::Vector2d;

/// Applied load and allowable at one increment, with the numbers that the allowable follows from.
struct Applied {
  double applied = 0, allowable = infinite;
  std::string inputs{};
  double edge_ratio = infinite;
  double direction = infinite;  ///< degrees
};

/// One margin: the worst increment of a check of one item.
struct Row {
  double margin = infinite;
  Applied worst{};
  Index at = -1;
  std::string of{}, formula{}, unit{};
  const CheckScene* check = nullptr;
};

/// A hole of a plate, by indices.
struct HoleAt {
  Index plate, rim;
  std::string name;  ///< "plate:hole"
};

/// Direction of a force, degrees counter-clockwise from x; infinite without one.
double direction_of(const Point& force) {
  return force.norm() > 0 ? std::atan2(force.y(), force.x()) * 180 / std::numbers::pi : infinite;
}

class Margins {
 public:
  Margins(const JointScene& scene, const JointModel& joint, const JointResult& result)
      : scene_(scene), joint_(joint), a_(result) {}

  /// Warnings of holes for which a check cannot be made.
  [[nodiscard]] std::vector<program::Warning>& warnings() { return warnings_; }

  std::vector<Row> run() {
    for (const auto& check : scene_.checks) {
      check_ = &check;
      left_out_.clear();
      if (check.kind == CheckKind::fastener_shear)
        of_fasteners();
      else
        of_holes();
      for (const auto& [reason, holes] : left_out_) warn(reason, holes);
    }
    // Equal ones, but for rounding, stay in the order of the joint.
    std::ranges::stable_sort(rows_, {}, [](const Row& row) { return std::round(1e9 * row.margin); });
    return std::move(rows_);
  }

 private:
  [[noreturn]] void fail(const std::string& found, const std::string& allowed) const {
    refuse(check_->where, found, allowed);
  }

  void warn(const std::string& reason, const std::vector<std::string>& holes) {
    warnings_.push_back({"check-left-out", fmt::format("{}: check \"{}\" is not made for {}: {}", scene_.file,
                                                       check_->name, program::listed(holes), reason)});
  }

  /// Adds the smallest margin of an item. @param at Applied(step). @param unknown Why its value may not be known.
  template <class At>
  void add(const std::string& of, const std::string& formula, const std::string& unit, At at,
           const char* unknown = "its value is not known") {
    Row row;
    row.of = of, row.formula = formula, row.unit = unit, row.check = check_;
    bool solved = false;
    for (Index step = 0; step < a_.load_factor.size(); ++step) {
      if (!is_checked(step)) continue;
      solved = true;
      const Applied now = at(step);
      if (!std::isfinite(now.applied)) continue;  // not known
      const double margin = now.applied > 0
                                ? now.allowable / (check_->safety_factor * check_->fitting_factor * now.applied) - 1
                                : infinite;
      if (row.at < 0 || margin < row.margin) row.margin = margin, row.worst = now, row.at = step;
    }
    if (row.at >= 0)
      rows_.push_back(std::move(row));
    else if (a_.load_factor.size() > 0)
      left_out_[solved ? unknown : "none of its cases was solved"].push_back(of);
  }

  /// True if the case of an increment is one of the check's.
  [[nodiscard]] bool is_checked(Index step) const {
    return check_->cases.empty() || index_of(check_->cases, a_.case_name[a_.case_of[step]]) < count_of(check_->cases);
  }

  void of_fasteners() {
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
      add(joint_.short_name(plane), check_->is_force ? "P_su" : "F_su pi d^2 / 4", unit(joint_.units, 0, 1),
          [&](Index step) {
            const auto both = a_.columns["transferred"].row(step).segment<2>(2 * j);
            return Applied{both.cwiseAbs().maxCoeff(), allowable, inputs};
          });
    }
  }

  /// Part of a plane's fastener whose load the model has: a half where a line of symmetry goes through its hole.
  [[nodiscard]] double modelled_part(const ShearPlane& plane) const {
    const HoleModel& hole = joint_.first_hole(plane);
    const PlateModel& plate = joint_.plates[hole.plate];
    const int rim = index_of(plate.stresses.rim_hole, plate.hole_of(hole.disc));
    if (rim == count_of(plate.stresses.rim_hole)) return 1;
    const double whole = 2 * plate.stresses.rim_radius[rim] * plate.stresses.rim_thickness[rim];
    double part = 1;
    for (Index d = 0; d < joint_.n_directions(); ++d)
      if (plate.has_disc(hole.disc + d) && whole > 0)
        part = std::min(part, plate.stresses.bearing_area(rim, plate.axis_of(hole.disc + d)) / whole);
    constexpr double nearly = 1 - 1e-6;  // thickness may differ around a hole
    return part < nearly && std::abs(part - 0.5) < 0.05 ? 0.5 : 1;
  }

  /// Diameter of a plane's fastener: of the check, of JOINT.json, or of the hole less its gap.
  [[nodiscard]] double diameter(const ShearPlane& plane) const {
    if (check_->diameter) return *check_->diameter;
    const FastenerScene& fastener = scene_.fasteners[plane.fastener];
    if (fastener.diameter) return *fastener.diameter;
    const HoleModel& hole = joint_.first_hole(plane);
    const PlateModel& plate = joint_.plates[hole.plate];
    const int rim = index_of(plate.stresses.rim_hole, plate.hole_of(hole.disc));
    if (rim == count_of(plate.stresses.rim_hole))
      fail(fmt::format("the diameter of fastener \"{}\" is not known", fastener.id), "\"diameter\" in the check");
    return 2 * (plate.stresses.rim_radius[rim] - hole.gap);
  }

  void of_holes() {
    std::vector<HoleAt> holes;
    std::vector<std::string> known;
    for (Index i = 0; i < std::ssize(joint_.plates); ++i) {
      const PlateModel& plate = joint_.plates[i];
      known.push_back(plate.name);
      for (Index rim = 0; plate.stress_level && rim < std::ssize(plate.stresses.rim_hole); ++rim) {
        const std::string& hole = plate.stresses.rim_hole[rim];
        known.push_back(plate.name + ":" + hole);
        const auto named = [&](const std::string& each) { return each == plate.name || each == known.back(); };
        if (check_->of.empty() || std::ranges::any_of(check_->of, named)) holes.push_back({i, rim, known.back()});
      }
    }
    for (const auto& each : check_->of)
      if (index_of(known, each) == count_of(known))
        fail(fmt::format("\"{}\" is no plate and no hole with stresses", each),
             fmt::format("{}", fmt::join(known, ", ")));
    if (holes.empty())
      fail("no hole with stresses", "matrices of stage2_extract without --loads-only, at their highest degree");
    for (const auto& hole : holes) of_hole(hole);
  }

  void of_hole(const HoleAt& hole) {
    const formats::PlateStresses& s = joint_.plates[hole.plate].stresses;
    const double d = 2 * s.rim_radius[hole.rim], t = s.rim_thickness[hole.rim],
                 value = check_->polygon.empty() ? check_->allowable.at(infinite) : 0;
    const std::string force = unit(joint_.units, 0, 1), stress = unit(joint_.units, -2, 1);
    const auto at_rim = [&](const char* quantity, Index step) {
      return a_.plates[hole.plate].columns[quantity](step, hole.rim);
    };
    const auto& fastened = joint_.plates[hole.plate].holes;
    const bool has_fastener = index_of(fastened, s.rim_hole[hole.rim]) < count_of(fastened);
    const bool needs_section = check_->kind == CheckKind::tension || check_->kind == CheckKind::bearing_bypass,
               shears_out = check_->kind == CheckKind::shear_out && has_fastener;
    if (shears_out) require_border(hole);
    const HoleSections sections(s, hole.rim, &joint_.plates[hole.plate].border);
    const char* lacks = needs_section && sections.number() == 0 ? "it has no sections"
                        : shears_out && t == 0 ? "its thickness is not known"  // in files before format 1.4
                                               : nullptr;
    if (lacks != nullptr) return left_out_[lacks].push_back(hole.name);
    switch (check_->kind) {
      case CheckKind::bearing:
        if (has_fastener) add(hole.name, "F_br d t", force, [&](Index step) { return bearing(hole, step, d); });
        break;
      case CheckKind::shear_out:
        if (shears_out)
          add(hole.name, "2 F_su t (e - d cos 40 / 2)", force, [&](Index step) { return shear_out(hole, step, d, t); });
        break;
      case CheckKind::tension:
        add(
            hole.name, "F_tu", stress,
            [&](Index step) {
              return Applied{at_rim("rim/net_stress", step), value, fmt::format("F_tu = {:g}", value), infinite,
                             at_rim("rim/net_direction", step)};
            },
            sections.is_filled()
                ? "it fills most of the strip between cell lines, whose net section says nothing of the sheet"
                : "its value is not known");
        break;
      case CheckKind::peak:
        add(hole.name, "limit", stress, [&](Index step) {
          return Applied{at_rim("rim/peak_hoop", step), value, fmt::format("limit = {:g}", value)};
        });
        break;
      case CheckKind::bearing_bypass:
        add(hole.name, "polygon", stress, [&](Index step) { return bearing_bypass(hole, step); });
        break;
      default:
        break;
    }
  }

  /// Force of the fastener on the sheet, friction included, along x and y.
  [[nodiscard]] Point force_on(const HoleAt& hole, Index step) const {
    const formats::PlateHistory& plate = a_.plates[hole.plate];
    Point force = Point::Zero();
    for (Index m = 0; m < std::ssize(plate.disc_hole); ++m)
      if (plate.disc_hole[m] == plate.holes.hole[hole.rim])
        force[plate.disc_direction[m] == "x" ? 0 : 1] +=
            plate.columns["disc/bearing"](step, m) + plate.columns["disc/friction"](step, m);
    return force;
  }

  /// Projected area d t of bearing along a force, that of the part of the hole that the model has.
  [[nodiscard]] double area(const HoleAt& hole, const Point& force) const {
    const auto areas = joint_.plates[hole.plate].stresses.bearing_area.row(hole.rim);
    return force.norm() > 0 ? areas.cwiseProduct(force.cwiseAbs().transpose() / force.norm()).norm() : areas.maxCoeff();
  }

  void require_border(const HoleAt& hole) const {
    if (!check_->edge_distance && joint_.plates[hole.plate].border.is_free.size() == 0)
      fail(fmt::format("the edge distance of {} is not known, since its matrices have no border", hole.name),
           "\"edge_distance\" in the check, or matrices of this version");
  }

  [[nodiscard]] double edge_distance(const HoleAt& hole, const Point& force) const {
    require_border(hole);
    if (check_->edge_distance) return *check_->edge_distance;
    const formats::PlateStresses& s = joint_.plates[hole.plate].stresses;
    return distance_to_border(joint_.plates[hole.plate].border, s.rim_center.row(hole.rim).transpose(), force);
  }

  Applied bearing(const HoleAt& hole, Index step, double d) const {
    const Point force = force_on(hole, step);
    const bool needs_edge = !check_->allowable.edge_ratio.empty() || check_->edge_distance ||
                            joint_.plates[hole.plate].border.is_free.size() > 0;
    const double e = needs_edge ? edge_distance(hole, force) : infinite, value = check_->allowable.at(e / d),
                 A = area(hole, force);
    return {force.norm(), value * A, fmt::format("F_br = {:g}, d t = {:g}, e/D = {:.4g}", value, A, e / d), e / d,
            direction_of(force)};
  }

  Applied shear_out(const HoleAt& hole, Index step, double d, double t) const {
    const double cos_40 = std::cos(40 * std::numbers::pi / 180);
    const Point force = force_on(hole, step);
    const double e = edge_distance(hole, force), value = check_->allowable.at(e / d);
    // Half a hole on a line of symmetry has one of the two planes.
    const double planes = 2 * area(hole, force) / (d * t);
    return {force.norm(), planes * value * t * std::max(e - d / 2 * cos_40, 0.0),
            fmt::format("F_su = {:g}, t = {:g}, e = {:.5g}, d = {:g}", value, t, e, d), e / d, direction_of(force)};
  }

  /// The polygon along the ray of the bearing stress and of that principal stress of what passes by which leaves less;
  /// both as lengths on that ray.
  Applied bearing_bypass(const HoleAt& hole, Index step) const {
    const auto rim = [&](const char* quantity) { return a_.plates[hole.plate].columns[quantity](step, hole.rim); };
    const auto along = [&](double bypass, double direction) -> Applied {
      const Point stress(bypass, rim("rim/bearing_stress"));
      if (!stress.allFinite()) return {infinite};
      const double allowable = stress.norm() > 0 ? reach(stress.normalized()) : infinite;
      return {stress.norm(), allowable, fmt::format("bypass {:g}, bearing {:g}", stress.x(), stress.y()), infinite,
              direction};
    };
    const double direction = rim("rim/bypass_direction"), turned = direction > 0 ? -90 : 90;
    const Applied larger = along(rim("rim/bypass_stress"), direction),
                  other = along(rim("rim/bypass_across"), direction + turned);
    const auto left = [](const Applied& a) { return a.applied > 0 ? a.allowable / a.applied : infinite; };
    return left(other) < left(larger) ? other : larger;
  }

  /// Distance from the origin to the polygon along a direction.
  [[nodiscard]] double reach(const Point& along) const {
    double found = infinite;
    for (std::size_t i = 0; i < check_->polygon.size(); ++i) {
      const auto& [x, y] = check_->polygon[i];
      const auto& [u, v] = check_->polygon[(i + 1) % check_->polygon.size()];
      const Point a(x, y), side(u - x, v - y);
      const double area = along.x() * side.y() - along.y() * side.x();
      if (area == 0) continue;
      const double s = (a.x() * along.y() - a.y() * along.x()) / area, r = (a.x() * side.y() - a.y() * side.x()) / area;
      constexpr double rounding = 1e-12;
      if (s >= -rounding && s <= 1 + rounding && r > 0) found = std::min(found, r);
    }
    return found;
  }

  const JointScene& scene_;
  const JointModel& joint_;
  const JointResult& a_;
  const CheckScene* check_ = nullptr;
  std::vector<Row> rows_;
  std::string unknown_because_;                               ///< of the item that is checked
  std::map<std::string, std::vector<std::string>> left_out_;  ///< holes of the check by the reason
  std::vector<program::Warning> warnings_;
};

}  // namespace

MarginTable margins(const JointScene& scene, const JointModel& joint, const JointResult& result,
                    std::vector<program::Warning>& left_out) {
  Margins all(scene, joint, result);
  const auto rows = all.run();
  left_out.insert(left_out.end(), all.warnings().begin(), all.warnings().end());
  const Index n = std::ssize(rows);
  MarginTable table;
  for (VectorXd* each : {&table.margin, &table.allowable, &table.applied, &table.edge_ratio, &table.direction})
    each->resize(n);
  table.at.resize(n);
  for (Index i = 0; i < n; ++i) {
    const Row& row = rows[i];
    table.check.push_back(row.check->name);
    table.of.push_back(row.of);
    table.formula.push_back(row.formula);
    table.inputs.push_back(
        fmt::format("{}, FS = {:g}, FF = {:g}", row.worst.inputs, row.check->safety_factor, row.check->fitting_factor));
    table.unit.push_back(row.unit);
    table.margin[i] = row.margin, table.allowable[i] = row.worst.allowable, table.applied[i] = row.worst.applied;
    table.edge_ratio[i] = row.worst.edge_ratio, table.direction[i] = row.worst.direction;
    table.at[i] = int(row.at);
  }
  return table;
}

}  // namespace fastjoint::stage3
