// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
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
  Plates plates;           ///< ascending
  Vector2d offset;         ///< between the centres, from the higher plate to the lower
  Array2d t, d, E;         ///< of the first and the second hole; E along the joint's direction
  Array2d shank;           ///< diameters minus the gaps
  int n_sheets;            ///< that the fastener joins; 0 if it is grounded, since no thickness is known
  bool first_of_fastener;  ///< the plane between its first two holes
  /// Index of the hole in the middle sheet of three, 0 or 1.
  [[nodiscard]] int middle() const { return first_of_fastener ? 1 : 0; }
};

std::vector<KnownPlane> known_planes(const JointModel& joint) {
  std::vector<KnownPlane> result;
  for (Index j = 0; j < joint.n_planes(); ++j) {
    const ShearPlane& plane = joint.planes[j];
    const HoleModel &first = joint.holes(plane).front(), &second = joint.holes(plane).back();
    const FastenerModel& fastener = joint.fasteners[plane.fastener];
    KnownPlane known{.at = j,
                     .plates = std::minmax(first.plate, second.plate),
                     .offset = Vector2d::Zero(),
                     .t = {0, 0},
                     .d = {0, 0},
                     .E = {0, 0},
                     .shank = {0, 0},
                     .n_sheets = fastener.grounded ? 0 : count_of(fastener.holes),
                     .first_of_fastener = plane.first == 0};
    for (const Index side : {0, 1}) {
      const HoleModel& hole = side == 0 ? first : second;
      const auto& a = joint.plates[hole.plate].stresses;
      const int at = index_of(a.rim_hole, joint.plates[hole.plate].hole_of(hole.disc));
      if (at == count_of(a.rim_hole)) continue;
      known.offset += ((side == 0) == (first.plate <= second.plate) ? 1 : -1) * a.rim_center.row(at).transpose();
      known.t[side] = a.rim_thickness[at];
      known.d[side] = 2 * a.rim_radius[at];
      known.shank[side] = known.d[side] - 2 * hole.gap;
      const bool one_E = joint.n_directions() == 1 ||
                         std::abs(a.rim_modulus(at, 0) - a.rim_modulus(at, 1)) <= 1e-9 * a.rim_modulus(at, 0);
      known.E[side] = one_E ? a.rim_modulus(at, joint.axes[0]) : 0;
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
std::vector<std::string> mismatches(const Source& formula, const KnownPlane& known, double clearance, int one) {
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
  compare("d", {formula.d, formula.d}, known.shank, same_d, 2 * clearance);
  return parts;
}

/// The same for the order of sheets in the formula: in double shear the middle one first, else the order that fits
/// better.
std::string mismatches(const Source& formula, const KnownPlane& known, double clearance) {
  const bool ordered = formula.n_shear == 2 && known.n_sheets == 3;
  auto parts = mismatches(formula, known, clearance, ordered ? known.middle() : 0);
  if (!ordered && !parts.empty())
    if (auto other = mismatches(formula, known, clearance, 1); other.size() < parts.size()) parts = std::move(other);
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

/// Adds a doubt if an interference strains the rim beyond what metals take without yielding.
void add_interference(const FastenerScene& fastener, const JointModel& joint, const HoleModel& hole, double radius,
                      double E, std::vector<Doubt>& doubts) {
  constexpr double yields = 0.01;  // the hoop strain; 0.3 to 0.9 % of most metals
  const double strain = -hole.gap / radius;
  if (strain <= yields) return;
  doubts.emplace_back(
      strain,
      fmt::format("{}: an interference of {:.6g} strains the rim of hole \"{}\" of radius {:.6g} by {:.2g} %{}, "
                  "at which metals yield: stresses are those of an elastic sheet; or it is in another unit of "
                  "length",
                  fastener.where_gap(), -hole.gap, joint.name(hole), radius, 100 * strain,
                  E > 0 ? fmt::format(", a stress of up to {:.3g}", E * strain) : ""));
}

/// A kind of warning about rims, with its measure for a rim, 0 or NaN if there is no reason for it, and its text.
struct RimDoubt {
  const char* code;
  double (*measure)(const RimState&, bool has_clearance);
  const char* text;  ///< {at} is the worst hole with its increment and the number of others; see rim_warnings
};

constexpr double allowed_pull = 0.05, allowed_across = 0.01;  // of the bearing stress, of the bearing force
constexpr double allowed_against = 20;                        // of friction against the slip, degrees

constexpr std::array<RimDoubt, 7> doubts = {{
    {"springs-wrong-arc", [](const RimState& rim, bool) { return rim.pulls ? rim.bearing_stress : 0; },
     "the springs of {at} are in tension: they are on the arc that does not bear under these loads; give the hole's "
     "spring the other \"arc\" in PLATE.json"},
    {"springs-pull",
     [](const RimState& rim, bool) { return rim.pull > allowed_pull * rim.bearing_stress ? rim.pull : 0; },
     "the springs all around {at} have a tension of up to {pull:.4g} {unit}, with a bearing stress of {stress:.4g}: a "
     "fastener cannot pull on the rim, and hoop peaks are too low; give the hole's spring \"compression_only\": true "
     "in "
     "PLATE.json"},
    {"hole-filled",
     [](const RimState& rim, bool has_clearance) {
       return has_clearance && rim.filled ? std::max(rim.pull, rim.bearing_stress) : 0;
     },
     "a fastener with a clearance fills {at}, whose springs act all around: the sheet is too stiff and its hoop "
     "peak, {peak:.4g} {unit}, too low; give the hole's spring \"compression_only\": true in PLATE.json, and the "
     "fastener a \"gap\" instead of \"clearance\""},
    {"kt-below-one",
     [](const RimState& rim, bool) {
       return rim.in_tension && rim.net_concentration > 0 && rim.pull > 0 ? 1 - rim.net_concentration : 0;
     },
     "Kt net is {net:.4g} at {at}: no hole's peak hoop stress is below the mean stress of its net section, unless "
     "springs pull on its rim; give the hole's spring \"compression_only\": true in PLATE.json"},
    {"disc-held-across",
     [](const RimState& rim, bool) { return rim.across_ratio > allowed_across ? std::abs(rim.across) : 0; },
     "the {axis} displacement of the disc of {at} is fixed, with a reaction of {across:.4g} {force} next to a bearing "
     "force of {bearing:.4g}, which no other part of the joint carries; let the discs move: \"disc_directions\": "
     "[\"x\", \"y\"] in "
     "all PLATE.json"},
    {"friction-against-slip",
     [](const RimState& rim, bool) { return rim.against_slip > allowed_against ? rim.against_slip : 0; },
     "friction acts against the slip that it makes on {against:.3g} degrees of the contact at {at}: it is "
     "assumed to slip everywhere, but in reality sticks there; the effect on the loads is small, but the peak hoop "
     "stress {peak:.4g} {unit} is uncertain: compare it with one without friction, and take the larger"},
    {"friction-off-axes", [](const RimState& rim, bool) { return rim.by_components ? rim.bearing_stress : 0; },
     "friction acts off the axes, by its components along x and y, at {at}: the loads are right, but peak hoop "
     "stresses "
     "there may be too low by the part of friction, most of all at 45 degrees"},
}};

}  // namespace

std::vector<program::Warning> implausible_numbers(const JointScene& scene, const JointModel& joint,
                                                  const LoadPath& path) {
  std::vector<Doubt> friction, gaps, interferences, distances, movements;
  std::vector<program::Warning> formulas;
  for (const auto& fastener : scene.fasteners)
    if (const double mu = *std::max_element(fastener.friction.begin(), fastener.friction.end()); mu > 1)
      friction.emplace_back(
          mu, fmt::format("{}/friction: {} is above 1, more than dry metals reach: it may be a percentage",
                          fastener.where, mu));
  const auto planes = known_planes(joint);
  std::map<Plates, std::vector<Vector2d>> offsets;
  for (const auto& known : planes) offsets[known.plates].push_back(known.offset);
  std::set<std::string> compared, sheared;
  for (const auto& known : planes) {
    const ShearPlane& plane = joint.planes[known.at];
    const std::string& where = scene.fasteners[plane.fastener].where;
    const double radius = known.d.minCoeff() / 2;
    if (const double gap = plane.law->gap(plane.clearance); gap > radius)
      gaps.emplace_back(gap / radius,
                        fmt::format("{}/clearance: the gap {:.6g} (that of law \"{}\" included) is above the radius "
                                    "{:.6g} of the hole: one of them may be in another unit of length",
                                    where, gap, plane.law_name, radius));
    for (const HoleModel& hole : joint.holes(plane)) {
      constexpr double max_gap = 0.25;  // of the hole; ISO 273's coarse clearance holes: M8 in 10 mm
      const FastenerScene& fastener = scene.fasteners[plane.fastener];
      const bool by_sheet = fastener.diameter && fastener.hole_diameter.empty();
      add_interference(fastener, joint, hole, radius, known.E.maxCoeff(), interferences);
      if (hole.gap < (by_sheet ? max_gap : 1) * radius) continue;
      gaps.emplace_back(
          std::abs(hole.gap) / radius,
          fmt::format("{}: a gap of {:.6g} at hole \"{}\" of radius {:.6g}: it may be in another unit of length{}",
                      fastener.where_gap(), hole.gap, joint.name(hole), radius,
                      by_sheet ? "; if it is intended, give its \"hole_diameter\" too" : ""));
    }
    for (const auto& [x, y] : scene.fasteners[plane.fastener].offset)
      if (constexpr double max_offset = 0.25; std::hypot(x, y) > max_offset * radius)
        gaps.emplace_back(
            std::hypot(x, y) / radius,
            fmt::format("{}/offset: a hole of radius {:.6g} is {:.6g} from its place in the free sheet: it "
                        "may be in another unit of length",
                        where, radius, std::hypot(x, y)));
    constexpr double coaxial = 0.1;  // of the radius
    if (const double apart = (known.offset - common_offset(offsets[known.plates])).norm(); apart > coaxial * radius)
      distances.emplace_back(
          apart / radius,
          fmt::format(
              "{}/between: the centres of holes \"{}\" and \"{}\" are {:.6g} apart, more than a tenth of the radius "
              "{:.6g}: one of them may be another fastener's hole, or the sheets are drawn in different coordinates",
              where, joint.name(joint.first_hole(plane)), joint.name(joint.second_hole(plane)), apart, radius));
    const auto formula = joint.is_to_ground(plane) ? std::nullopt : plane.law->source();
    const std::string other = formula ? mismatches(*formula, known, plane.clearance) : "";
    const std::string shear =
        formula ? shear_mismatch(*formula, known.n_sheets, shear_alike(joint, path, known.at)) : "";
    if (!shear.empty() && sheared.insert(plane.law_name).second)
      formulas.push_back({"formula-shear-unlike", fmt::format("{}: /laws/{}/shear: {} ({})", joint.file, plane.law_name,
                                                              shear, joint.name(plane))});
    if (!other.empty() && compared.insert(plane.law_name).second)
      formulas.push_back({"formula-sheets-unlike", fmt::format("{}: /laws/{}: the formula has {} of the sheets at {}: "
                                                               "it may be for another fastener, or in other units",
                                                               joint.file, plane.law_name, other, joint.name(plane))});
    const double max_force = (known.d * known.t * known.E).minCoeff();  // 0: not known
    for (const auto& step : path.steps) {
      const double delta = std::abs(magnitudes(step.delta, joint.n_directions())[known.at]);
      const double F = std::abs(magnitudes(step.F, joint.n_directions())[known.at]);
      const bool far = delta > radius;
      if (!far && !(max_force > 0 && F > max_force)) continue;
      const std::string what =
          far ? fmt::format("|delta| = {:.6g} is above the radius {:.6g} of the hole", delta, radius)
              : fmt::format("|F| = {:.6g} is above d t E = {:.6g} of a sheet", F, max_force);
      movements.emplace_back(
          std::max(delta / radius, max_force > 0 ? F / max_force : 0),
          fmt::format("{}: {}: {} at increment {}: loads, laws, lengths or moduli may be in different units",
                      joint.file, joint.name(plane), what, &step - path.steps.data() + 1));
      break;
    }
  }
  std::vector<program::Warning> result;
  add_worst(result, "friction-unlikely", friction);
  add_worst(result, "gap-unlikely", gaps);
  add_worst(result, "interference-yields", interferences);
  add_worst(result, "holes-apart", distances);
  const auto diameters = diameter_warnings(scene, joint);
  result.insert(result.end(), diameters.begin(), diameters.end());
  result.insert(result.end(), formulas.begin(), formulas.end());
  add_worst(result, "units-mixed", movements);
  for (const auto& [name, law] : scene.laws) {
    const std::array<std::string, 2> own{joint.units.length, joint.units.force}, found = law.law->units();
    for (std::size_t i = 0; i < 2; ++i)
      if (!own[i].empty() && !found[i].empty() && own[i] != found[i])
        result.push_back(
            {"units-mixed",
             fmt::format("{}: its first line names the unit \"{}\", the joint's is \"{}\": numbers are taken "
                         "as they are, and none is converted",
                         law.law->file(), found[i], own[i])});
  }
  return result;
}

std::vector<program::Warning> rim_warnings(const JointModel& joint, const std::vector<JointState>& states) {
  std::set<std::string> with_clearance;
  for (const auto& plane : joint.planes)
    for (const HoleModel& hole : joint.holes(plane))
      if (plane.clearance > 0) with_clearance.insert(joint.name(hole));
  const std::string& across = rim::axis_names[1 - joint.axes[0]];
  std::vector<program::Warning> result;
  for (const auto& doubt : doubts) {
    double largest = 0;
    std::string at;
    const RimState* worst = nullptr;
    std::set<std::string> holes;
    for (Index step = 0; step < std::ssize(states); ++step)
      for (Index i = 0; i < std::ssize(joint.plates); ++i)
        for (Index rim = 0; rim < std::ssize(states[step].plates[i].rims); ++rim) {
          const RimState& state = states[step].plates[i].rims[rim];
          const std::string hole = joint.plates[i].name + ":" + joint.plates[i].stresses.rim_hole[rim];
          const double measure = doubt.measure(state, with_clearance.contains(hole));
          if (measure > 0) holes.insert(hole);
          if (!(measure > largest)) continue;
          largest = measure;
          worst = &state;
          at = fmt::format("hole \"{}\" (increment {}", hole, step + 1);
        }
    if (!worst) continue;
    const Index others = holes.size() - 1;
    at += others == 0 ? ")" : fmt::format("; {} other hole{} too)", others, others == 1 ? "" : "s");
    using fmt::arg;
    result.push_back(
        {doubt.code,
         fmt::format(fmt::runtime("{file}: " + std::string(doubt.text)), arg("file", joint.file), arg("at", at),
                     arg("axis", across), arg("pull", worst->pull), arg("stress", worst->bearing_stress),
                     arg("peak", worst->peak_hoop), arg("net", worst->net_concentration),
                     arg("against", worst->against_slip), arg("across", std::abs(worst->across)),
                     arg("bearing", std::hypot(worst->bearing_load, worst->bearing_load_y)),
                     arg("force", unit(joint.units, 0, 1)), arg("unit", unit(joint.units, -2, 1)))});
  }
  return result;
}

}  // namespace fastjoint::stage3
