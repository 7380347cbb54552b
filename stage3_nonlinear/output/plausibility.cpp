// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "common/count.hpp"
#include "stage3_nonlinear/output/output.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Array2d;
using Eigen::Vector2d;
using Plates = std::pair<Index, Index>;

/// A shear plane whose holes are described in MATRICES.h5; t and E are 0 if not known. The ground counts as another
/// hole like the first.
struct KnownPlane {
  Index at;
  const ShearPlane& plane;
  const FastenerScene& fastener;
  const Law& law;
  double clearance;
  Array2d gap;                         ///< in the first and the second hole
  Plates plates;                       ///< ascending
  int n_sheets;                        ///< that the fastener joins; 0 if it is grounded, since no thickness is known
  bool first_of_fastener;              ///< the plane between its first two holes
  Vector2d offset = Vector2d::Zero();  ///< between the centres, from the higher plate to the lower
  Array2d t = Array2d::Zero(), d = t;  ///< of the first and the second hole
  Array2d E = t;                       ///< along the joint's direction
  Array2d shank = t;                   ///< diameters minus the gaps
  [[nodiscard]] double radius() const { return d.minCoeff() / 2; }
  /// Index of the hole in the middle sheet of three, 0 or 1.
  [[nodiscard]] int middle() const { return first_of_fastener ? 1 : 0; }
};

std::vector<KnownPlane> known_planes(const JointScene& scene, const JointModel& joint, const Parameters& parameters) {
  std::vector<KnownPlane> result;
  for (Index j = 0; j < joint.n_planes(); ++j) {
    const ShearPlane& plane = joint.planes[j];
    const std::array holes{&joint.holes(plane).front(), &joint.holes(plane).back()};
    const FastenerModel& fastener = joint.fasteners[plane.fastener];
    const auto gaps = parameters.gap.segment(joint.number_of_first_hole(plane), std::ssize(joint.holes(plane)));
    KnownPlane known{j,
                     plane,
                     scene.fasteners[plane.fastener],
                     *parameters.law[j],
                     parameters.clearance[j],
                     {gaps.head<1>().value(), gaps.tail<1>().value()},
                     std::minmax(holes[0]->plate, holes[1]->plate),
                     fastener.grounded ? 0 : count_of(fastener.holes),
                     plane.first == 0};
    for (const Index side : {0, 1}) {
      const auto at = joint.described(*holes[side]);
      if (!at) continue;
      const auto& a = joint.plates[holes[side]->plate].stresses;
      known.offset +=
          ((side == 0) == (holes[0]->plate <= holes[1]->plate) ? 1 : -1) * a.rim_center.row(*at).transpose();
      known.t[side] = a.rim_thickness[*at];
      known.d[side] = 2 * a.rim_radius[*at];
      known.shank[side] = known.d[side] - 2 * known.gap[side];
      const bool one_E = joint.n_directions() == 1 ||
                         std::abs(a.rim_modulus(*at, 0) - a.rim_modulus(*at, 1)) <= 1e-9 * a.rim_modulus(*at, 0);
      known.E[side] = one_E ? a.rim_modulus(*at, joint.axes[0]) : 0;
    }
    if (known.d.minCoeff() > 0) result.push_back(known);
  }
  return result;
}

/// Median of the offsets of the fasteners between two plates; zero for fewer than three.
Vector2d common_offset(std::vector<Vector2d> offsets) {
  Vector2d median = Vector2d::Zero();
  const auto middle = offsets.begin() + std::ssize(offsets) / 2;
  for (Index i = 0; i < 2 && offsets.size() > 2; ++i) {
    std::nth_element(offsets.begin(), middle, offsets.end(), [&](const auto& a, const auto& b) { return a[i] < b[i]; });
    median[i] = (*middle)[i];
  }
  return median;
}

/// Differences between the numbers of a formula and those of the sheets, "t = 3, 3 instead of 1.6, 2", if its sheet 1
/// is that of hole `one`, 0 or 1.
std::vector<std::string> mismatches(const Source& formula, const KnownPlane& known, int one) {
  constexpr double same_t = 0.01, same_E = 0.2, same_d = 0.05;  // a hole is slightly wider than its shank
  std::vector<std::string> parts;
  const auto compare = [&](const char* key, const Array2d& said, const Array2d& by_hole, double tolerance,
                           double slack) {
    const Array2d here(by_hole[one], by_hole[1 - one]);
    if (here.minCoeff() > 0 && ((said - here).abs() > tolerance * here + slack).any())
      parts.push_back(
          fmt::format("{} = {:.6g}, {:.6g} instead of {:.6g}, {:.6g}", key, said[0], said[1], here[0], here[1]));
  };
  compare("t", {formula.t[0], formula.t[1]}, known.t, same_t, 0);
  compare("E", {formula.E[0], formula.E[1]}, known.E, same_E, 0);
  compare("d", {formula.d, formula.d}, known.shank, same_d, 2 * known.clearance);
  return parts;
}

/// The same for the order of sheets in the formula: in double shear the middle one first, else the order that fits
/// better.
std::string mismatches(const Source& formula, const KnownPlane& known) {
  const bool ordered = formula.n_shear == 2 && known.n_sheets == 3;
  auto parts = mismatches(formula, known, ordered ? known.middle() : 0);
  if (!ordered && !parts.empty())
    if (auto other = mismatches(formula, known, 1); other.size() < parts.size()) parts = std::move(other);
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Work of the forces of the first on those of the second shear plane of a fastener through three sheets at the last
/// increment, over the product of both: -1 in double shear, 1 in a pack whose sheets all pull the same way on; 0 of
/// other fasteners, and where one plane carries less than a tenth of the other.
double shear_alike(const JointModel& joint, const LoadPath& path, Index plane) {
  const Index n = joint.n_directions(), first = joint.planes[plane].first == 0 ? plane : plane - 1;
  if (path.steps.empty() || first + 1 >= joint.n_planes() ||
      joint.planes[first + 1].fastener != joint.planes[first].fastener)
    return 0;
  const auto a = path.steps.back().F.segment(first * n, n), b = path.steps.back().F.segment((first + 1) * n, n);
  constexpr double hardly = 0.1;
  if (std::min(a.norm(), b.norm()) <= hardly * std::max(a.norm(), b.norm())) return 0;
  return a.dot(b) / (a.norm() * b.norm());
}

/// The contradiction between a formula for single or double shear and the sheets; empty if there is none, or for more
/// than three sheets, which no formula covers.
/// @param alike As of shear_alike.
const char* shear_mismatch(const Source& formula, int n_sheets, double alike) {
  if (formula.n_shear == 2 && n_sheets == 2)
    return "\"double\", but the fastener goes through 2 sheets, which is single shear; right only if they are half of "
           "a joint that is symmetric about its middle sheet";
  if (formula.n_shear == 1 && n_sheets == 3 && alike < 0)
    return "\"single\", but the fastener goes through 3 sheets, of which the outer two pull against the middle one, "
           "which is double shear; the huth formulas know it, with the middle sheet first in \"t\" and \"E\"";
  if (formula.n_shear == 2 && n_sheets == 3 && alike > 0)
    return "\"double\", but both planes of the fastener pull the same way: its sheets are a pack, and each plane is in "
           "single shear";
  return "";
}

/// Doubts friction above that of dry metals.
void check_friction(const JointScene& scene, WarningList& list) {
  for (const auto& fastener : scene.fasteners)
    if (const double mu = std::ranges::max(fastener.friction); mu > 1)
      list.doubt("friction-unlikely", mu,
                 "{}/friction: {} is above 1, more than dry metals reach: it may be a percentage", fastener.where, mu);
}

/// Doubts the gaps and offsets of a plane beside the radius of its smaller hole.
void check_gaps(const JointModel& joint, const KnownPlane& known, WarningList& list) {
  constexpr double max_gap = 0.25, max_offset = 0.25;  // of the hole; ISO 273's coarse clearance holes: M8 in 10 mm
  const char* code = "gap-unlikely";
  const double radius = known.radius();
  if (const double gap = known.law.gap(known.clearance); gap > radius)
    list.doubt(code, gap / radius,
               "{}/clearance: the gap {:.6g} (that of law \"{}\" included) is above the radius {:.6g} of the hole: one "
               "of them may be in another unit of length",
               known.fastener.where, gap, known.plane.law_name, radius);
  const bool by_sheet = known.fastener.diameter && known.fastener.hole_diameter.empty();
  const auto holes = joint.holes(known.plane);
  for (std::size_t i = 0; i < holes.size(); ++i)
    if (const double gap = known.gap[Index(i)]; gap >= (by_sheet ? max_gap : 1) * radius)
      list.doubt(code, std::abs(gap) / radius,
                 "{}: a gap of {:.6g} at hole \"{}\" of radius {:.6g}: it may be in another unit of length{}",
                 known.fastener.where_gap(), gap, joint.name(holes[i]), radius,
                 by_sheet ? "; if it is intended, give its \"hole_diameter\" too" : "");
  for (const auto& [x, y] : known.fastener.offset)
    if (const double offset = std::hypot(x, y); offset > max_offset * radius)
      list.doubt(code, offset / radius,
                 "{}/offset: a hole of radius {:.6g} is {:.6g} from its place in the free sheet: it may be in another "
                 "unit of length",
                 known.fastener.where, radius, offset);
}

/// Doubts interferences that strain the rim beyond what metals take without yielding.
void check_interferences(const JointModel& joint, const KnownPlane& known, WarningList& list) {
  constexpr double yields = 0.01;  // the hoop strain; 0.3 to 0.9 % of most metals
  const auto holes = joint.holes(known.plane);
  for (std::size_t i = 0; i < holes.size(); ++i)
    if (const double gap = known.gap[Index(i)], strain = -gap / known.radius(), E = known.E.maxCoeff(); strain > yields)
      list.doubt("interference-yields", strain,
                 "{}: an interference of {:.6g} strains the rim of hole \"{}\" of radius {:.6g} by {:.2g} %{}, at "
                 "which metals yield: stresses are those of an elastic sheet; or it is in another unit of length",
                 known.fastener.where_gap(), -gap, joint.name(holes[i]), known.radius(), 100 * strain,
                 E > 0 ? fmt::format(", a stress of up to {:.3g}", E * strain) : "");
}

/// Doubts the distance between the centres of a plane's holes. @param common Offset of its sheets.
void check_distance(const JointModel& joint, const KnownPlane& known, const Vector2d& common, WarningList& list) {
  constexpr double coaxial = 0.1;  // of the radius
  const double apart = (known.offset - common).norm(), radius = known.radius();
  if (apart > coaxial * radius)
    list.doubt("holes-apart", apart / radius,
               "{}/between: the centres of holes \"{}\" and \"{}\" are {:.6g} apart, more than a tenth of the radius "
               "{:.6g}: one of them may be another fastener's hole, or the sheets are drawn in different coordinates",
               known.fastener.where, joint.name(joint.first_hole(known.plane)),
               joint.name(joint.second_hole(known.plane)), apart, radius);
}

/// Diameter of a hole in its sheet, length; 0 if the sheet's matrices do not have it.
double diameter_in_sheet(const JointModel& joint, const HoleModel& hole) {
  const PlateModel& plate = joint.plates[hole.plate];
  const auto rim = std::ranges::find(plate.contact, plate.hole_of(hole.disc), &formats::ContactRim::hole);
  if (rim != plate.contact.end()) return 2 * rim->radius;
  const auto at = joint.described(hole);
  return at ? 2 * plate.stresses.rim_radius[*at] : 0;
}

/// Doubts diameters that differ for any law: hole_diameter from that in the sheet, and those of the two holes of a
/// shear plane, minus their gaps, from each other.
void check_diameters(const JointScene& scene, const JointModel& joint, const Parameters& parameters,
                     WarningList& list) {
  constexpr double same = 0.05 * (1 + 1e-9);  // relative difference of diameters that are taken for one
  for (Index i = 0; i < std::ssize(scene.fasteners); ++i)
    for (Index at = 0; at < std::ssize(scene.fasteners[i].hole_diameter); ++at) {
      const HoleModel& hole = joint.fasteners[i].holes[at];
      const double here = scene.fasteners[i].hole_diameter[at], in_sheet = diameter_in_sheet(joint, hole);
      if (in_sheet > 0 && std::abs(here - in_sheet) > same * in_sheet)
        list.doubt("hole-diameter-unlike", std::abs(here - in_sheet) / in_sheet,
                   "{}/hole_diameter: {:.6g} for hole \"{}\", whose diameter in its sheet is {:.6g}: one of them may "
                   "be a radius, another hole's, or in another unit of length",
                   scene.fasteners[i].where, here, joint.name(hole), in_sheet);
    }
  for (Index j = 0; j < joint.n_planes(); ++j) {
    const ShearPlane& plane = joint.planes[j];
    const FastenerScene& fastener = scene.fasteners[plane.fastener];
    if (joint.is_to_ground(plane) || fastener.diameter) continue;  // the gaps follow from that diameter
    const HoleModel &first = joint.first_hole(plane), &second = joint.second_hole(plane);
    const double one = diameter_in_sheet(joint, first), other = diameter_in_sheet(joint, second);
    const auto gap = parameters.gap.segment<2>(joint.number_of_first_hole(plane));
    const double apart = std::abs((one - 2 * gap[0]) - (other - 2 * gap[1]));
    if (std::min(one, other) > 0 && apart > same * std::max(one, other) + 2 * parameters.clearance[j])
      list.doubt("sheet-diameters-unlike", apart / std::min(one, other),
                 "{}/between: holes \"{}\" and \"{}\" have the diameters {:.6g} and {:.6g} in their sheets, which the "
                 "gaps and the clearance of their one fastener do not explain: one of them may be another fastener's "
                 "hole, or in another unit of length",
                 fastener.where, joint.name(first), joint.name(second), one, other);
  }
}

/// Warns of formulas that are for other sheets, of each law once.
void check_formulas(const JointModel& joint, const LoadPath& path, const std::vector<KnownPlane>& planes,
                    WarningList& list) {
  std::set<std::string> compared, sheared;
  for (const auto& known : planes) {
    const auto formula = joint.is_to_ground(known.plane) ? std::nullopt : known.law.source();
    if (!formula) continue;
    const std::string other = mismatches(*formula, known), name = joint.name(known.plane);
    const std::string shear = shear_mismatch(*formula, known.n_sheets, shear_alike(joint, path, known.at));
    if (!shear.empty() && sheared.insert(known.plane.law_name).second)
      list.add("formula-shear-unlike", "{}: /laws/{}/shear: {} ({})", joint.file, known.plane.law_name, shear, name);
    if (!other.empty() && compared.insert(known.plane.law_name).second)
      list.add(
          "formula-sheets-unlike",
          "{}: /laws/{}: the formula has {} of the sheets at {}: it may be for another fastener, or in other units",
          joint.file, known.plane.law_name, other, name);
  }
}

/// Doubts delta above the radius of the smaller hole, or F that no sheet carries, at the first increment with one.
void check_movement(const JointModel& joint, const LoadPath& path, const KnownPlane& known, WarningList& list) {
  const double radius = known.radius(), max_force = (known.d * known.t * known.E).minCoeff();  // 0: not known
  for (const auto& step : path.steps) {
    const double delta = std::abs(magnitudes(step.delta, joint.n_directions())[known.at]);
    const double F = std::abs(magnitudes(step.F, joint.n_directions())[known.at]);
    const bool far = delta > radius;
    if (!far && !(max_force > 0 && F > max_force)) continue;
    list.doubt("units-mixed", std::max(delta / radius, max_force > 0 ? F / max_force : 0),
               "{}: {}: {} at increment {}: loads, laws, lengths or moduli may be in different units", joint.file,
               joint.name(known.plane),
               far ? fmt::format("|delta| = {:.6g} is above the radius {:.6g} of the hole", delta, radius)
                   : fmt::format("|F| = {:.6g} is above d t E = {:.6g} of a sheet", F, max_force),
               &step - path.steps.data() + 1);
    return;
  }
}

/// Warns of tables whose units are not those of the joint.
void check_units(const JointScene& scene, const JointModel& joint, WarningList& list) {
  for (const auto& [name, law] : scene.laws) {
    const std::array<std::string, 2> own{joint.units.length, joint.units.force}, found = law.law->units();
    for (std::size_t i = 0; i < 2; ++i)
      if (!own[i].empty() && !found[i].empty() && own[i] != found[i])
        list.add("units-mixed",
                 "{}: its first line names the unit \"{}\", the joint's is \"{}\": numbers are taken as they are, and "
                 "none is converted",
                 law.law->file(), found[i], own[i]);
  }
}

}  // namespace

std::vector<program::Warning> implausible_numbers(const JointScene& scene, const JointModel& joint,
                                                  const Parameters& parameters, const LoadPath& path) {
  WarningList list;
  const auto planes = known_planes(scene, joint, parameters);
  std::map<Plates, std::vector<Vector2d>> offsets;
  for (const auto& known : planes) offsets[known.plates].push_back(known.offset);
  check_friction(scene, list);
  for (const auto& each : planes) check_gaps(joint, each, list);
  for (const auto& each : planes) check_interferences(joint, each, list);
  for (const auto& each : planes) check_distance(joint, each, common_offset(offsets[each.plates]), list);
  check_diameters(scene, joint, parameters, list);
  check_formulas(joint, path, planes, list);
  for (const auto& each : planes) check_movement(joint, path, each, list);
  check_units(scene, joint, list);
  return list.all();
}

}  // namespace fastjoint::stage3
