// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/formats/joint_result.hpp"
#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// Makes unit cases of all waves of contact that a joint has, where the plate's own end with those that its elements
/// carry best: a field shows all of the pressure, as far as its elements follow.
void take_waves_of_field(formats::PlateSolution& plate);

/// Names of a plate's unit cases: "external:P", "disc:1:x", "wave:2:0", "friction:1:+x", "traction:T"; shape (n_cases).
[[nodiscard]] std::vector<std::string> case_names(const formats::PlateSolution& plate);

/// Names in a row for a message, the first dozen of a longer list.
[[nodiscard]] std::string listed(const std::vector<std::string>& names);

/// The result of a joint, and which of its sheets a plate is.
struct JointSheet {
  formats::JointResult joint;
  int at;                   ///< of joint.plates
  Eigen::MatrixXd amounts;  ///< (n_cases, steps) of the plate's unit cases at every increment
};

/// Reads a RESULT.h5, in which the plate is the sheet of that name or, without a name, the only one whose cases have
/// the plate's names.
/// @param file Name of the plate's file, for messages.
/// Throws InputError if no sheet or increment fits or the sheet is of another PLATE.h5, FileError for a bad RESULT.h5.
[[nodiscard]] JointSheet read_joint_sheet(const formats::PlateSolution& plate, const std::string& file,
                                          const std::string& result_file, const std::string& name);

}  // namespace fastjoint::stage2
