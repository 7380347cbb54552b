// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/field/field_state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "common/errors.hpp"

namespace fastjoint::stage2 {
namespace {

using Eigen::Index;

FieldState scene_loads(const formats::PlateSolution& plate, const std::string& file) {
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

}  // namespace

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 12;
  const auto shown = std::min(names.size(), most);
  const std::string text = fmt::format("{}", fmt::join(names.begin(), names.begin() + shown, ", "));
  if (shown == names.size()) return names.empty() ? "none" : text;
  return fmt::format("{} and {} more", text, names.size() - shown);
}

bool names_a_file(const std::string& spec) {
  std::error_code ignored;
  return spec != "loads" && !starts_as_case(spec) && (spec.ends_with(".h5") || std::filesystem::exists(spec, ignored));
}

FieldState field_state(const formats::PlateSolution& plate, const std::string& file, const FieldRequest& request) {
  if (names_a_file(request.spec)) return joint_state(plate, file, request);
  if (!request.plate.empty()) throw InputError("--plate: goes with --field RESULT.h5 only");
  if (request.increment != 0) throw InputError("--increment: goes with --field RESULT.h5 only");
  return request.spec == "loads" ? scene_loads(plate, file) : case_sum(plate, request.spec);
}

std::size_t field_level(const formats::PlateSolution& plate, const std::string& file, const FieldRequest& request,
                        const FieldState& state) {
  const int highest = plate.p[plate.p.size() - 1];
  const int p = request.p != 0 ? request.p : state.p != 0 ? state.p : highest;
  const auto found = std::find(plate.p.begin(), plate.p.end(), p);
  if (found == plate.p.end())
    throw InputError(fmt::format("--p: {} is {}not allowed; {} has the degrees {}", p,
                                 request.p != 0 ? "" : "the degree of the joint and ", file, fmt::join(plate.p, ", ")));
  if (std::find(plate.stress_p.begin(), plate.stress_p.end(), p) == plate.stress_p.end())
    throw InputError(
        fmt::format("{}:stress_p: the fields at p = {} are not in the file; it has those at p = {} (none if "
                    "stage1_plate was told --loads-only)",
                    file, p, plate.stress_p.size() > 0 ? fmt::format("{}", fmt::join(plate.stress_p, ", ")) : "none"));
  return std::distance(plate.p.begin(), found);
}

}  // namespace fastjoint::stage2
