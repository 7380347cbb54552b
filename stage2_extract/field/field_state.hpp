// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// A state of a sheet as amounts of its unit cases.
struct FieldState {
  Eigen::VectorXd amounts;  ///< (nc + h + q) length of externals and discs, stress of frictions, force of tractions
  std::string words;        ///< what it is, for people
  int p = 0;                ///< degree at which the amounts were found, 0 if they belong to none
  std::string joint_plate;  ///< name of the sheet in the joint, if the state is a joint's
  int increment = 0;        ///< of the joint, from 1 on
};

/// The user's options of a field as given: "" and 0 where the choice is the program's.
struct FieldRequest {
  std::string spec = {};
  std::string plate = {};
  int increment = 0;
  int p = 0;
};

/// Names of unit cases: "external:P", "disc:1:x", "friction:1:+x", "traction:T".
/// @param a Anything with the names of a plate's cases: PlateSolution, PlateHistory. Shape (nc + h + q).
template <class Plate>
[[nodiscard]] std::vector<std::string> case_names(const Plate& a) {
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
[[nodiscard]] std::string listed(const std::vector<std::string>& names);

/// Whether the request's spec is the name of a file: it ends in ".h5", or is no case and a file has this name.
[[nodiscard]] bool names_a_file(const std::string& spec);

/// The state that the request describes: a sum of cases, "loads" or a RESULT.h5.
/// @param file Name of the plate's file, for messages.
/// Throws InputError if the request fits neither plate nor joint, FileError for a bad RESULT.h5.
[[nodiscard]] FieldState field_state(const formats::PlateSolution& plate, const std::string& file,
                                     const FieldRequest& request);

/// Whether the text starts as a case does: "external:", "disc:", "friction:" or "traction:".
[[nodiscard]] bool starts_as_case(const std::string& spec);

/// The words of a message for what a spec may be, besides "loads".
[[nodiscard]] std::string case_sum_allowed(const formats::PlateSolution& plate);

/// Cases with commas between them, each with "=AMOUNT" or of amount 1: "external:P=0.01,disc:1:x". Ids may hold commas,
/// colons and equals signs: where one case's name begins another's, the longer one is meant.
/// Throws InputError that lists the plate's cases.
[[nodiscard]] FieldState case_sum(const formats::PlateSolution& plate, const std::string& spec);

/// The state of the plate in a solved joint, the RESULT.h5 that the request's spec names. The sheet is that which the
/// request names, else the only one whose cases have the plate's names; the increment that of the request, else the
/// last. Throws InputError, FileError.
[[nodiscard]] FieldState joint_state(const formats::PlateSolution& plate, const std::string& file,
                                     const FieldRequest& request);

/// Index into the plate's degrees of the one to look at: the request's, else the state's, else the highest.
/// Throws InputError if the plate has no such degree, or no fields at this degree.
[[nodiscard]] std::size_t field_level(const formats::PlateSolution& plate, const std::string& file,
                                      const FieldRequest& request, const FieldState& state);

}  // namespace fastjoint::stage2
