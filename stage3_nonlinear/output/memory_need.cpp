// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/memory_need.hpp"

#include <algorithm>
#include <filesystem>

#include "common/program/memory.hpp"
#include "stage3_nonlinear/results/joint_numbers.hpp"
#include "stage3_nonlinear/results/joint_quantities.hpp"

namespace fastjoint::stage3 {

double matrices_need(const JointScene& scene) {
  double bytes = 22e6;  // the program itself
  for (const auto& plate : scene.plates) {
    std::error_code none;
    if (const auto size = std::filesystem::file_size(plate.file, none); !none) bytes += 2 * double(size);
  }
  return bytes;
}

void require_memory_to_read(const JointScene& scene) {
  program::require_memory(scene.file + ": reading its plates' matrices", matrices_need(scene), "",
                          "matrices of fewer holes, or of stage2_extract --loads-only");
}

JointNeed joint_need(const JointModel& joint, const Parameters& parameters, bool with_csv, bool with_sensitivities,
                     bool with_rim_stresses) {
  const JointNumbers numbers = joint_numbers(joint, parameters);
  double of_plane = with_csv ? 76 : 0;  // a line of the table has about 900 bytes in two copies
  if (with_sensitivities) of_plane += double(numbers.n_derivatives());
  constexpr double number = sizeof(double), of_stiffness = 12, of_plate = 30;  // of a plate's state
  constexpr double of_spots = 2 * 3 * TractionWaves::n_points;                 // extremes of a case, and of all
  constexpr double of_points = 3 * 360,
                   of_loaded_rim = 600;  // stresses, and the waves and tractions that they follow from
  double solving = 0, of_step = of_plane * double(joint.n_planes()), around_rims = 0;
  for (const auto& group : plane_quantities(joint)) of_step += double(group.n_numbers());
  for (const auto& plate : joint.plates) {
    const auto cases = double(plate.R.cols()), unknowns = double(plate.n_unknowns());
    solving += of_stiffness * number * unknowns * (unknowns + (numbers.friction.empty() ? 0 : cases / 2));
    const double n_rims = plate.stress_level ? double(plate.stresses.rim_hole.size()) : 0;
    solving += number * of_spots * n_rims;
    of_step += of_plate + unknowns + cases;
    for (const auto& group : plate_quantities(plate)) of_step += double(group.n_numbers());
    if (with_rim_stresses) around_rims += (of_points + of_loaded_rim) * n_rims;
  }
  if (with_sensitivities) {  // derivatives of displacements and of friction loads
    const bool has_peaks =
        std::ranges::any_of(joint.plates, [](const auto& plate) { return plate.stress_level.has_value(); });
    constexpr double of_forces = 3, of_peaks = 4;
    const double each = of_forces + (has_peaks ? of_peaks : 0);
    solving += number * double(joint.n_unknowns()) * each * double(numbers.n_derivatives());
  }
  constexpr double copies = 2.5;  // in the states and in the tables
  return {solving, number * (copies * of_step + around_rims)};
}

}  // namespace fastjoint::stage3
