// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/field/field_state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/formats/joint_result.hpp"
#include "common/h5/whole_file.hpp"

namespace fastjoint::stage2 {
namespace {

using formats::PlateHistory;
using formats::PlateSolution;

/// Names of unit cases: "external:P", "disc:1:x", "friction:1:+x", "traction:T"; shape (nc + h + q).
/// @param a Anything with the names of a plate's cases: PlateSolution, PlateHistory.
template <class Plate>
std::vector<std::string> case_names(const Plate& a) {
  std::vector<std::string> names;
  names.reserve(a.external_id.size() + a.disc_hole.size() + a.friction_hole.size() + a.traction_id.size());
  for (const auto& id : a.external_id) names.push_back("external:" + id);
  for (std::size_t i = 0; i < a.disc_hole.size(); ++i)
    names.push_back("disc:" + a.disc_hole[i] + ":" + a.disc_direction[i]);
  for (std::size_t i = 0; i < a.friction_hole.size(); ++i)
    names.push_back("friction:" + a.friction_hole[i] + ":" + a.friction_bearing[i]);
  for (const auto& id : a.traction_id) names.push_back("traction:" + id);
  return names;
}

/// Names in a row for a message, the first dozen of a longer list.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 12;
  const auto shown = std::min(names.size(), most);
  const std::string text = fmt::format("{}", fmt::join(names.begin(), names.begin() + shown, ", "));
  if (shown == names.size()) return names.empty() ? "none" : text;
  return fmt::format("{} and {} more", text, names.size() - shown);
}

bool starts_as_case(const std::string& spec) {
  constexpr std::string_view kinds[] = {"external:", "disc:", "friction:", "traction:"};
  return std::any_of(std::begin(kinds), std::end(kinds), [&](auto kind) { return spec.starts_with(kind); });
}

/// The words of a message for what a spec may be, besides "loads".
std::string case_sum_allowed(const PlateSolution& plate) {
  return fmt::format("a RESULT.h5, or a sum CASE=AMOUNT,... of the cases {}", listed(case_names(plate)));
}

bool names_a_file(const std::string& spec) {
  std::error_code ignored;
  return spec != "loads" && !starts_as_case(spec) && (spec.ends_with(".h5") || std::filesystem::exists(spec, ignored));
}

FieldState scene_loads(const PlateSolution& plate, const std::string& file) {
  if (plate.load_displacement.rows() == 0)
    throw InputError(fmt::format("--field: 'loads' is not allowed: the scene of {} has no loads; allowed: {}", file,
                                 case_sum_allowed(plate)));
  FieldState state;
  state.words = "loads of the scene";
  const auto nc = plate.load_displacement.cols(), h = plate.load_friction.cols(), q = plate.load_traction.cols();
  state.amounts.resize(nc + h + q);
  state.amounts << plate.load_displacement.row(0).transpose(), plate.load_friction.row(0).transpose(),
      plate.load_traction.row(0).transpose();
  return state;
}

/// Index of the longest name that the text starts with and that ends there, at a comma or at "=", or -1.
std::ptrdiff_t first_case(const std::vector<std::string>& names, std::string_view text) {
  std::ptrdiff_t longest = -1;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto& name = names[i];
    if (!text.starts_with(name)) continue;
    if (text.size() > name.size() && text[name.size()] != ',' && text[name.size()] != '=') continue;
    if (longest < 0 || name.size() > names[longest].size()) longest = i;
  }
  return longest;
}

/// The amount at the start of the text, which then loses it.
double take_amount(std::string_view& text, const std::string& name) {
  if (text.empty() || text[0] != '=') return 1;
  const auto word = text.substr(1, text.find(',') - 1);
  double amount = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), amount);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(amount))
    throw InputError(
        fmt::format("--field: '{}' is not allowed as the amount of {}; allowed: a number such as 0.01", word, name));
  text.remove_prefix(1 + word.size());
  return amount;
}

FieldState case_sum(const PlateSolution& plate, const std::string& spec) {
  const auto names = case_names(plate);
  FieldState state;
  state.words = spec;
  state.amounts = Eigen::VectorXd::Zero(names.size());
  std::vector<bool> given(names.size());
  for (std::string_view rest = spec;;) {
    const auto found = first_case(names, rest);
    if (found < 0)
      throw InputError(fmt::format("--field: '{}' is not a case of the plate{}; allowed: loads, {}", rest,
                                   starts_as_case(spec) ? "" : " nor a file", case_sum_allowed(plate)));
    if (given[found]) throw InputError(fmt::format("--field: {} stands twice; allowed: each case once", names[found]));
    given[found] = true;
    rest.remove_prefix(names[found].size());
    state.amounts[found] = take_amount(rest, names[found]);
    if (rest.empty()) return state;
    rest.remove_prefix(1);  // the comma
  }
}

/// The plate of the joint that the request names, else the only one with the cases of `plate`.
const PlateHistory& plate_of_joint(const PlateSolution& plate, const std::string& file, const FieldRequest& request,
                                   const formats::JointResult& joint) {
  const auto cases = case_names(plate);
  const bool is_named = !request.plate.empty();
  const PlateHistory* found = nullptr;
  std::vector<std::string> all, fitting;
  for (const auto& candidate : joint.plates) {
    all.push_back(candidate.name);
    if (is_named ? candidate.name != request.plate : case_names(candidate) != cases) continue;
    fitting.push_back(candidate.name);
    if (!found) found = &candidate;
  }
  if (!found && is_named)
    throw InputError(
        fmt::format("--plate: '{}' is not a sheet of {}; allowed: {}", request.plate, request.spec, listed(all)));
  if (!found)
    throw InputError(fmt::format("--field: no sheet of {} ({}) has the cases of {}: {}", request.spec, listed(all),
                                 file, listed(cases)));
  if (is_named && case_names(*found) != cases)
    throw InputError(fmt::format("--plate: '{}' of {} is not the sheet of {}: its cases are {}, those of the sheet {}",
                                 found->name, request.spec, file, listed(case_names(*found)), listed(cases)));
  if (!is_named && fitting.size() > 1)
    throw InputError(fmt::format("--field: {} sheets of {} could be that of {}; tell which by --plate: {}",
                                 fitting.size(), request.spec, file, listed(fitting)));
  return *found;
}

/// The names of the plate's cases fit, but do its matrices come from this file? One without a digest does not tell.
void check_digest(const PlateHistory& history, const PlateSolution& plate, const std::string& file,
                  const FieldRequest& request) {
  const std::string& digest = plate.header.digest;
  if (!history.plate_digest.empty() && !digest.empty() && history.plate_digest != digest)
    throw InputError(
        fmt::format("--field: sheet '{}' of {} was made of a PLATE.h5 with the digest {}, {} has {}; allowed: the file "
                    "that it was made of, or stage2_extract and stage3_nonlinear run again for this one",
                    history.name, request.spec, history.plate_digest, file, digest));
}

FieldState joint_state(const PlateSolution& plate, const std::string& file, const FieldRequest& request) {
  const auto joint = formats::read_joint_result(request.spec);
  const auto& history = plate_of_joint(plate, file, request, joint);
  check_digest(history, plate, file, request);
  const auto steps = count_of(joint.load_factor);
  if (steps == 0) throw InputError(fmt::format("--field: {} holds no increment that converged", request.spec));
  if (request.increment > steps)
    throw InputError(fmt::format("--increment: {} is not allowed; {} has the increments 1..{}", request.increment,
                                 request.spec, steps));
  FieldState state;
  state.increment = request.increment != 0 ? request.increment : steps;
  state.joint_plate = history.name;
  state.p = joint.p;
  const auto step = state.increment - 1;
  state.words = fmt::format("{}increment {} of {}, load factor {:g}",
                            joint.header.name.empty() ? "" : fmt::format("{}, ", joint.header.name), state.increment,
                            steps, joint.load_factor[step]);
  state.amounts.resize(history.De.cols() + history.D.cols() + history.Lambda.cols() + history.traction.cols());
  state.amounts << history.De.row(step).transpose(), history.D.row(step).transpose(),
      history.Lambda.row(step).transpose(), history.traction.row(step).transpose();
  return state;
}

}  // namespace

void check_field_options(const FieldRequest& request, bool wanted, const std::string& output,
                         const std::string& timings) {
  if (!wanted && request.p != 0) throw InputError("--p: goes with --field only; matrices are of all degrees");
  const bool of_joint = wanted && names_a_file(request.spec);
  if (!of_joint && !request.plate.empty()) throw InputError("--plate: goes with --field RESULT.h5 only");
  if (!of_joint && request.increment != 0) throw InputError("--increment: goes with --field RESULT.h5 only");
  for (const auto& [option, path] : {std::pair("-o", output), std::pair("--timings", timings)})
    if (wanted && h5::same_file(request.spec, path))
      throw InputError(fmt::format("{} {}: is the file of --field; choose another name", option, path));
}

FieldState field_state(const PlateSolution& plate, const std::string& file, const FieldRequest& request) {
  if (names_a_file(request.spec)) return joint_state(plate, file, request);
  return request.spec == "loads" ? scene_loads(plate, file) : case_sum(plate, request.spec);
}

int field_degree(const PlateSolution& plate, const std::string& file, const FieldRequest& request,
                 const FieldState& state) {
  const int highest = plate.p[plate.p.size() - 1];
  const int p = request.p != 0 ? request.p : state.p != 0 ? state.p : highest;
  if (p > highest)
    throw InputError(fmt::format("--p: {} is {}not allowed; {} has unknowns of the degrees 1 to {}", p,
                                 request.p != 0 ? "" : "the degree of the joint and ", file, highest));
  return p;
}

}  // namespace fastjoint::stage2
