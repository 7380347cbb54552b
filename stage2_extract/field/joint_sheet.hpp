// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/formats/joint_result.hpp"
#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// Extends the unit cases of the loaded waves to those of a joint (formats::waves_of_field), so that a field shows the
/// whole contact pressure as far as the elements resolve it.
void take_waves_of_field(formats::PlateSolution& plate);

/// Names of a plate's unit cases: "external:P", "disc:1:x", "wave:2:0", "friction:1:+x", "traction:T"; shape (n_cases).
[[nodiscard]] std::vector<std::string> case_names(const formats::UnitCases& plate);

/// Joins names for a message, at most a dozen.
[[nodiscard]] std::string listed(const std::vector<std::string>& names);

/// The result of a joint, and the sheet in it that is a given plate.
struct JointSheet {
  formats::JointResult joint;
  int at;                        ///< index into joint.plates
  Eigen::MatrixXd coefficients;  ///< (n_cases, steps) of the plate's unit cases at every increment
};

/// Reads a RESULT.h5 and finds the plate in it: the sheet of that name or, without a name, the only one whose cases
/// have the plate's names.
/// @param file Name of the plate's file, for messages.
/// Throws InputError if no sheet fits, there is no increment or the sheet is of another PLATE.h5, FileError for a bad
/// RESULT.h5.
[[nodiscard]] JointSheet read_joint_sheet(const formats::PlateSolution& plate, const std::string& file,
                                          const std::string& result_file, const std::string& name);

}  // namespace fastjoint::stage2
