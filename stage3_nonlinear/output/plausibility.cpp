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

/// A shear plane whose holes MATRICES.h5 describes; t and E are 0 where it does not tell them. The ground is taken for
/// one more hole like the first.
struct KnownPlane {
  Index at;
  Plates plates;           ///< ascending
  Vector2d offset;         ///< between the centres, from the higher plate to the lower
  Array2d t, d, E;         ///< of the first and the second hole; E along the joint's direction
  Array2d shank;           ///< diameters less the gaps
  int n_sheets;            ///< that the fastener joins; 0 where the ground holds it too, whose thickness is not known
  bool first_of_fastener;  ///< the plane between its first two holes
  /// Which hole, 0 or 1, is in the middle sheet of three.
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

/// Offset that most fasteners between two plates have in common; zero of fewer than three.
Vector2d common_offset(std::vector<Vector2d> offsets) {
  Vector2d median = Vector2d::Zero();
  const auto middle = offsets.begin() + std::ssize(offsets) / 2;
  for (Index i = 0; i < 2 && offsets.size() > 2; ++i) {
    std::nth_element(offsets.begin(), middle, offsets.end(), [&](const auto& a, const auto& b) { return a[i] < b[i]; });
    median[i] = (*middle)[i];
  }
  return median;
}

/// Numbers that a formula has other than the sheets, "t = 3, 3 instead of 1.6, 2", if its sheet 1 is that of hole
/// `one`, 0 or 1.
std::vector<std::string> unlike(const Source& formula, const KnownPlane& known, double clearance, int one) {
  constexpr double same_t = 0.01, same_E = 0.2, same_d = 0.05;  // a hole is a little wider than its shank
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

/// The same in the order of sheets that the formula means: in double shear the middle one first, else either.
std::string unlike(const Source& formula, const KnownPlane& known, double clearance) {
  const bool ordered = formula.n_shear == 2 && known.n_sheets == 3;
  auto parts = unlike(formula, known, clearance, ordered ? known.middle() : 0);
  if (!ordered && !parts.empty())
    if (auto other = unlike(formula, known, clearance, 1); other.size() < parts.size()) parts = std::move(other);
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// What contradicts a formula for single or double shear in the number of sheets; empty if nothing. Of more than three
/// sheets no formula tells.
const char* unlike_shear(const Source& formula, int n_sheets) {
  if (formula.n_shear == 2 && n_sheets == 2)
    return "\"double\", but the fastener goes through 2 sheets, which is single shear; right only if they are half of "
           "a joint that is symmetric about its middle sheet";
  if (formula.n_shear == 1 && n_sheets == 3)
    return "\"single\", but the fastener goes through 3 sheets, which is double shear; the huth formulas know it, "
           "with the middle sheet first in \"t\" and \"E\"";
  return "";
}

/// A doubt about rims: how much of it a rim gives cause for, 0 or NaN if none, and what to say where that is most.
struct RimDoubt {
  const char* code;
  double (*amount)(const RimState&, bool loose);
  const char* text;  ///< {at} the hole with the increment and the number of others, other fields as arguments name them
};

constexpr double allowed_pull = 0.05, allowed_across = 0.01;  // of the bearing stress, of the bearing force
constexpr double allowed_against = 20;                        // degrees

constexpr std::array<RimDoubt, 7> doubts = {{
    {"springs-wrong-arc", [](const RimState& rim, bool) { return rim.pulls ? rim.bearing_stress : 0; },
     "the springs of {at} pull the sheet instead of pushing it: they act on the arc that does not bear under these "
     "loads; give the hole's spring the other \"arc\" in PLATE.json"},
    {"springs-pull",
     [](const RimState& rim, bool) { return rim.pull > allowed_pull * rim.bearing_stress ? rim.pull : 0; },
     "the springs all around {at} pull on its rim by up to {pull:.4g} {unit}, beside a bearing stress of {stress:.4g}: "
     "a fastener only pushes, and hoop peaks come out too low; give the hole's spring \"compression_only\": true in "
     "PLATE.json"},
    {"hole-filled",
     [](const RimState& rim, bool loose) { return loose && rim.filled ? std::max(rim.pull, rim.bearing_stress) : 0; },
     "a fastener with a clearance fills {at}, whose springs act all around: the sheet comes out too stiff and its hoop "
     "peak, {peak:.4g} {unit}, too low; give the hole's spring \"compression_only\": true in PLATE.json, and the "
     "fastener a \"gap\" instead of \"clearance\""},
    {"kt-below-one",
     [](const RimState& rim, bool) {
       return rim.in_tension && rim.peak_hoop != 0 && rim.pull > 0 ? 1 - rim.net_concentration : 0;
     },
     "Kt net is {net:.4g} at {at}: no hole's peak hoop stress is below the mean stress of its net section, unless "
     "springs pull on its rim; give the hole's spring \"compression_only\": true in PLATE.json"},
    {"disc-held-across",
     [](const RimState& rim, bool) { return rim.across_share > allowed_across ? std::abs(rim.across) : 0; },
     "the disc of {at} is held across its one direction by {across:.4g} {force}, beside a bearing force of "
     "{bearing:.4g}, and nothing in the joint gives that; let the discs move: \"disc_directions\": [\"x\", \"y\"] in "
     "all PLATE.json"},
    {"friction-against-slip",
     [](const RimState& rim, bool) { return rim.against_slip > allowed_against ? rim.against_slip : 0; },
     "friction acts against the slip that it makes on {against:.3g} degrees of the contact at {at}: it is taken to "
     "slip "
     "everywhere, and sticks there in reality; the loads hardly change, but the peak hoop stress {peak:.4g} {unit} is "
     "in doubt: compare it with one without friction"},
    {"friction-off-axes", [](const RimState& rim, bool) { return rim.by_components ? rim.bearing_stress : 0; },
     "friction acts off the axes, by its components along x and y, at {at}: the loads hold, but peak hoop stresses "
     "there may lack what friction adds to them, most of it at 45 degrees"},
}};

}  // namespace

std::vector<program::Warning> implausible_numbers(const JointScene& scene, const JointModel& joint,
                                                  const LoadPath& path) {
  std::vector<Doubt> friction, gaps, distances, movements;
  std::vector<program::Warning> formulas;
  for (const auto& fastener : scene.fasteners)
    if (const double mu = *std::max_element(fastener.friction.begin(), fastener.friction.end()); mu > 1)
      friction.emplace_back(
          mu, fmt::format("{}/friction: {} is above 1, which dry metals hardly reach: it may be a percentage",
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
      constexpr double most_interference = 0.05;  // far beyond what metals bear without yielding
      constexpr double widest = 0.25;             // of the hole; ISO 273's coarse clearance holes: M8 in 10 mm
      const FastenerScene& fastener = scene.fasteners[plane.fastener];
      const bool by_sheet = fastener.diameter && fastener.hole_diameter.empty();
      if (hole.gap < (by_sheet ? widest : 1) * radius && -hole.gap < most_interference * radius) continue;
      gaps.emplace_back(
          std::abs(hole.gap) / radius,
          fmt::format("{}: a gap of {:.6g} at hole \"{}\" of radius {:.6g}: it may be in another unit of length{}",
                      fastener.where_gap(), hole.gap, joint.name(hole), radius,
                      by_sheet ? "; if the hole is meant so, give its \"hole_diameter\" too" : ""));
    }
    if (const double apart = (known.offset - common_offset(offsets[known.plates])).norm(); apart > radius)
      distances.emplace_back(
          apart / radius,
          fmt::format(
              "{}/between: the centres of holes \"{}\" and \"{}\" are {:.6g} apart, more than the radius {:.6g}: one "
              "of them may be another fastener's hole, or the sheets are drawn in different coordinates",
              where, joint.name(joint.first_hole(plane)), joint.name(joint.second_hole(plane)), apart, radius));
    const auto formula = joint.is_to_ground(plane) ? std::nullopt : plane.law->source();
    const std::string other = formula ? unlike(*formula, known, plane.clearance) : "";
    const std::string shear = formula ? unlike_shear(*formula, known.n_sheets) : "";
    if (!shear.empty() && sheared.insert(plane.law_name).second)
      formulas.push_back({"formula-shear-unlike", fmt::format("{}: /laws/{}/shear: {} ({})", joint.file, plane.law_name,
                                                              shear, joint.name(plane))});
    if (!other.empty() && compared.insert(plane.law_name).second)
      formulas.push_back({"formula-sheets-unlike", fmt::format("{}: /laws/{}: the formula has {} of the sheets at {}: "
                                                               "it may be for another fastener, or in other units",
                                                               joint.file, plane.law_name, other, joint.name(plane))});
    const double crushing = (known.d * known.t * known.E).minCoeff();  // 0: not known
    for (const auto& step : path.steps) {
      const double delta = std::abs(amounts(step.delta, joint.n_directions())[known.at]);
      const double F = std::abs(amounts(step.F, joint.n_directions())[known.at]);
      const bool far = delta > radius;
      if (!far && !(crushing > 0 && F > crushing)) continue;
      const std::string what =
          far ? fmt::format("|delta| = {:.6g} is above the radius {:.6g} of the hole", delta, radius)
              : fmt::format("|F| = {:.6g} is above d t E = {:.6g} of a sheet", F, crushing);
      movements.emplace_back(
          std::max(delta / radius, crushing > 0 ? F / crushing : 0),
          fmt::format("{}: {}: {} at increment {}: loads, laws, lengths or moduli may be in different units",
                      joint.file, joint.name(plane), what, &step - path.steps.data() + 1));
      break;
    }
  }
  std::vector<program::Warning> result;
  add_worst(result, "friction-unlikely", friction);
  add_worst(result, "gap-unlikely", gaps);
  add_worst(result, "holes-apart", distances);
  const auto diameters = unlike_diameters(scene, joint);
  result.insert(result.end(), diameters.begin(), diameters.end());
  result.insert(result.end(), formulas.begin(), formulas.end());
  add_worst(result, "units-mixed", movements);
  return result;
}

std::vector<program::Warning> rim_warnings(const JointModel& joint, const std::vector<JointState>& states) {
  std::set<std::string> loose;
  for (const auto& plane : joint.planes)
    for (const HoleModel& hole : joint.holes(plane))
      if (plane.clearance > 0) loose.insert(joint.name(hole));
  std::vector<program::Warning> result;
  for (const auto& doubt : doubts) {
    double most = 0;
    std::string at;
    const RimState* worst = nullptr;
    std::set<std::string> holes;
    for (Index step = 0; step < std::ssize(states); ++step)
      for (Index i = 0; i < std::ssize(joint.plates); ++i)
        for (Index rim = 0; rim < std::ssize(states[step].plates[i].rims); ++rim) {
          const RimState& state = states[step].plates[i].rims[rim];
          const std::string hole = joint.plates[i].name + ":" + joint.plates[i].stresses.rim_hole[rim];
          const double amount = doubt.amount(state, loose.contains(hole));
          if (amount > 0) holes.insert(hole);
          if (!(amount > most)) continue;
          most = amount;
          worst = &state;
          at = fmt::format("hole \"{}\" (increment {}", hole, step + 1);
        }
    if (!worst) continue;
    const Index others = holes.size() - 1;
    at += others == 0 ? ")" : fmt::format("; {} other hole{} likewise)", others, others == 1 ? "" : "s");
    using fmt::arg;
    result.push_back(
        {doubt.code, fmt::format(fmt::runtime("{file}: " + std::string(doubt.text)), arg("file", joint.file),
                                 arg("at", at), arg("pull", worst->pull), arg("stress", worst->bearing_stress),
                                 arg("peak", worst->peak_hoop), arg("net", worst->net_concentration),
                                 arg("against", worst->against_slip), arg("across", std::abs(worst->across)),
                                 arg("bearing", std::hypot(worst->bearing_load, worst->bearing_load_y)),
                                 arg("force", unit(joint.units, 0, 1)), arg("unit", unit(joint.units, -2, 1)))});
  }
  return result;
}

}  // namespace fastjoint::stage3
