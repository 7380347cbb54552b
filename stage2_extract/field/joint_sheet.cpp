// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/field/joint_sheet.hpp"

#include <fmt/format.h>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/program/program.hpp"

namespace fastjoint::stage2 {
namespace {

using formats::PlateSolution;

int sheet_of_joint(const PlateSolution& plate, const std::string& file, const std::string& result_file,
                   const std::string& name, const formats::JointResult& joint) {
  const auto cases = case_names(plate);
  std::vector<std::string> all, fitting;
  for (const auto& sheet : joint.plates) {
    all.push_back(sheet.name);
    if (case_names(sheet) == cases) fitting.push_back(sheet.name);
  }
  if (name.empty() && fitting.empty())
    throw InputError(
        fmt::format("{}: no sheet ({}) has the cases of {}: {}", result_file, listed(all), file, listed(cases)));
  if (name.empty() && fitting.size() > 1)
    throw InputError(fmt::format("{}: {} sheets could be that of {}; tell which by --plate: {}", result_file,
                                 fitting.size(), file, listed(fitting)));
  const int found = index_of(all, name.empty() ? fitting[0] : name);
  if (found == count_of(all))
    throw InputError(fmt::format("--plate: '{}' is not a sheet of {}; allowed: {}", name, result_file, listed(all)));
  if (index_of(fitting, all[found]) == count_of(fitting))
    throw InputError(fmt::format("--plate: '{}' of {} is not the sheet of {}: its cases are {}, those of the sheet {}",
                                 name, result_file, file, listed(case_names(joint.plates[found])), listed(cases)));
  return found;
}

}  // namespace

void take_waves_of_field(PlateSolution& plate) {
  for (std::size_t rim = 0; rim < plate.contact.size(); ++rim)
    plate.waves[rim].waves = formats::waves_of_field(plate.contact[rim], plate.waves[rim]);
}

std::vector<std::string> case_names(const formats::UnitCases& a) {
  std::vector<std::string> names;
  for (const auto& id : a.external_id) names.push_back("external:" + id);
  for (int i = 0; i < count_of(a.disc_hole); ++i) names.push_back("disc:" + a.disc_hole[i] + ":" + a.disc_direction[i]);
  for (std::size_t rim = 0; rim < a.contact.size(); ++rim)
    for (int k = 0; k < a.waves[rim].size(); ++k) names.push_back(fmt::format("wave:{}:{}", a.waves[rim].hole, k));
  for (int i = 0; i < count_of(a.friction_hole); ++i)
    names.push_back("friction:" + a.friction_hole[i] + ":" + a.friction_bearing[i]);
  for (const auto& id : a.traction_id) names.push_back("traction:" + id);
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 13;
  return names.empty() ? "none" : program::listed(names, most);
}

JointSheet read_joint_sheet(const PlateSolution& plate, const std::string& file, const std::string& result_file,
                            const std::string& name) {
  JointSheet result{formats::read_joint_result(result_file), 0, {}};
  result.at = sheet_of_joint(plate, file, result_file, name, result.joint);
  const auto& sheet = result.joint.plates[result.at];
  const std::string& digest = plate.header.digest;
  // The names of the cases fit, but the sheet's matrices may come from another file, which their digest shows.
  if (!sheet.plate_digest.empty() && !digest.empty() && sheet.plate_digest != digest)
    throw InputError(
        fmt::format("{}: sheet '{}' was made of a PLATE.h5 with the digest {}, {} has {}; allowed: the file that it "
                    "was made of, or stage2_extract and stage3_nonlinear run again for this one",
                    result_file, sheet.name, sheet.plate_digest, file, digest));
  if (result.joint.load_factor.size() == 0)
    throw InputError(fmt::format("{}: holds no increment that converged", result_file));
  result.coefficients.resize(plate.n_cases(), result.joint.load_factor.size());
  const auto& of = sheet.columns;
  // What deforms the sheet: without its free expansion.
  result.coefficients << (of["De"] - of["free/De"]).transpose(), (of["D"] - of["free/D"]).transpose(),
      of["wave/amount"].transpose(), of["Lambda"].transpose(), of["traction/force"].transpose();
  return result;
}

}  // namespace fastjoint::stage2
