// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/field/field_state.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/formats/joint_result.hpp"

namespace fastjoint::stage2 {
namespace {

using formats::JointResult;
using formats::PlateHistory;

std::vector<std::string> names_of(const std::vector<const PlateHistory*>& sheets) {
  std::vector<std::string> names;
  names.reserve(sheets.size());
  for (const auto* sheet : sheets) names.push_back(sheet->name);
  return names;
}

const PlateHistory& named_sheet(const JointResult& joint, const formats::PlateSolution& plate, const std::string& file,
                                const FieldRequest& request) {
  std::vector<const PlateHistory*> all;
  all.reserve(joint.plates.size());
  for (const auto& sheet : joint.plates) all.push_back(&sheet);
  for (const auto* sheet : all) {
    if (sheet->name != request.plate) continue;
    if (case_names(*sheet) != case_names(plate))
      throw InputError(
          fmt::format("--plate: '{}' of {} is not the sheet of {}: its cases are {}, those of the sheet {}",
                      sheet->name, request.spec, file, listed(case_names(*sheet)), listed(case_names(plate))));
    return *sheet;
  }
  throw InputError(fmt::format("--plate: '{}' is not a sheet of {}; allowed: {}", request.plate, request.spec,
                               listed(names_of(all))));
}

/// The names of the sheet's cases fit, but do its matrices come from this file? One without a digest does not tell.
void check_digest(const PlateHistory& sheet, const formats::PlateSolution& plate, const std::string& file,
                  const FieldRequest& request) {
  const std::string& digest = plate.header.digest;
  if (!sheet.plate_digest.empty() && !digest.empty() && sheet.plate_digest != digest)
    throw InputError(
        fmt::format("--field: sheet '{}' of {} was made of a PLATE.h5 with the digest {}, {} has {}; allowed: the file "
                    "that it was made of, or stage2_extract and stage3_nonlinear run again for this one",
                    sheet.name, request.spec, sheet.plate_digest, file, digest));
}

const PlateHistory& only_fitting_sheet(const JointResult& joint, const formats::PlateSolution& plate,
                                       const std::string& file, const FieldRequest& request) {
  std::vector<const PlateHistory*> fitting, all;
  for (const auto& sheet : joint.plates) {
    all.push_back(&sheet);
    if (case_names(sheet) == case_names(plate)) fitting.push_back(&sheet);
  }
  if (fitting.size() == 1) return *fitting[0];
  if (fitting.empty())
    throw InputError(fmt::format("--field: no sheet of {} ({}) has the cases of {}: {}", request.spec,
                                 listed(names_of(all)), file, listed(case_names(plate))));
  throw InputError(fmt::format("--field: {} sheets of {} could be that of {}; tell which by --plate: {}",
                               fitting.size(), request.spec, file, listed(names_of(fitting))));
}

}  // namespace

FieldState joint_state(const formats::PlateSolution& plate, const std::string& file, const FieldRequest& request) {
  const auto joint = formats::read_joint_result(request.spec);
  const auto& sheet = request.plate.empty() ? only_fitting_sheet(joint, plate, file, request)
                                            : named_sheet(joint, plate, file, request);
  check_digest(sheet, plate, file, request);
  const auto steps = count_of(joint.load_factor);
  if (steps == 0) throw InputError(fmt::format("--field: {} holds no increment that converged", request.spec));
  if (request.increment > steps)
    throw InputError(fmt::format("--increment: {} is not allowed; {} has the increments 1..{}", request.increment,
                                 request.spec, steps));
  FieldState state;
  state.increment = request.increment != 0 ? request.increment : steps;
  state.joint_plate = sheet.name;
  state.p = joint.p;
  const auto step = state.increment - 1;
  state.words = fmt::format("{}increment {} of {}, load factor {:g}",
                            joint.header.name.empty() ? "" : fmt::format("{}, ", joint.header.name), state.increment,
                            steps, joint.load_factor[step]);
  state.amounts.resize(sheet.De.cols() + sheet.D.cols() + sheet.Lambda.cols() + sheet.traction.cols());
  state.amounts << sheet.De.row(step).transpose(), sheet.D.row(step).transpose(), sheet.Lambda.row(step).transpose(),
      sheet.traction.row(step).transpose();
  return state;
}

}  // namespace fastjoint::stage2
