// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// A state of a plate as amounts of its unit cases.
struct FieldState {
  Eigen::VectorXd amounts;  ///< (nc + h + q) length of externals and discs, stress of frictions, force of tractions
  std::string words;        ///< what it is, for people
  int p = 0;                ///< degree at which the amounts were found, 0 if they belong to none
  std::string joint_plate = {};  ///< name of the plate in the joint, if the state is a joint's
  int increment = 0;             ///< of the joint, from 1 on
};

/// The user's options of a field as given: "" and 0 where the choice is the program's.
struct FieldRequest {
  std::string spec = {};
  std::string plate = {};
  int increment = 0;
  int p = 0;
};

/// Throws InputError if options are given that need others, or if an output would replace the joint's result.
/// @param wanted  True if a field is asked for at all.
/// @param timings Path of --timings, or empty.
void check_field_options(const FieldRequest& request, bool wanted, const std::string& output,
                         const std::string& timings);

/// The state that the request describes: "loads", the scene's own; or the name of a RESULT.h5, which ends in ".h5" or
/// is no case and a file has this name; or a sum of cases.
///
/// A sum has cases with commas between them, each with "=AMOUNT" or of amount 1: "external:P=0.01,disc:1:x". Ids may
/// hold commas, colons and equals signs: where one case's name begins another's, the longer one is meant. Of a
/// RESULT.h5 the plate is that which the request names, else the only one whose cases have the plate's names; the
/// increment that of the request, else the last.
/// @param file Name of the plate's file, for messages.
/// Throws InputError if the request fits neither plate nor joint, FileError for a bad RESULT.h5.
[[nodiscard]] FieldState field_state(const formats::PlateSolution& plate, const std::string& file,
                                     const FieldRequest& request);

/// Degree to look at: the request's, else the state's, else the plate's highest. Throws InputError if it is above that.
[[nodiscard]] int field_degree(const formats::PlateSolution& plate, const std::string& file,
                               const FieldRequest& request, const FieldState& state);

}  // namespace fastjoint::stage2
