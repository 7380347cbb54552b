// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/field/field_file.hpp"

#include <fmt/format.h>

#include "common/errors.hpp"
#include "common/h5/whole_file.hpp"
#include "common/program/program.hpp"
#include "stage2_extract/field/vtu.hpp"

namespace fastjoint::stage2 {
namespace {

std::string summary(const std::string& output, const formats::PlateSolution& plate, const FieldState& state,
                    const Field& field) {
  Eigen::Index at = 0;
  const double largest = von_mises(field.stress).maxCoeff(&at);
  const auto& units = plate.header.units;
  return fmt::format("{}: {}, {} of degree {}\n  largest von Mises stress {:.6g} {} at ({:.4g}, {:.4g}) {}\n", output,
                     state.words, program::counted(plate.mesh.n_elements(), "cell"), field.p, largest,
                     unit(units, -2, 1), field.points(0, at), field.points(1, at), unit(units, 1, 0));
}

}  // namespace

void check_field_options(const FieldRequest& request, bool wanted, const std::string& output,
                         const std::string& timings) {
  if (!wanted && request.p != 0) throw InputError("--p: goes with --field only; matrices are of all degrees");
  if (!wanted && !request.plate.empty()) throw InputError("--plate: goes with --field RESULT.h5 only");
  if (!wanted && request.increment != 0) throw InputError("--increment: goes with --field RESULT.h5 only");
  for (const auto& [option, path] : {std::pair("-o", output), std::pair("--timings", timings)})
    if (wanted && h5::same_file(request.spec, path))
      throw InputError(fmt::format("{} {}: is the file of --field; choose another name", option, path));
}

std::string write_field(const std::string& output, const formats::PlateSolution& plate, const std::string& file,
                        const FieldRequest& request, program::Timings& timings) {
  const FieldState state = field_state(plate, file, request);
  const std::size_t level = field_level(plate, file, request, state);
  timings.phase("extract");
  UnitFields fields(plate, file);
  fields.use(level);
  const Field field = superpose(fields, plate.p[level], state.amounts);
  if (!field.displacement.allFinite() || !von_mises(field.stress).allFinite())
    throw NumericalError(
        fmt::format("{}: --field {}: displacements or stresses are too large for the numbers of this "
                    "machine; allowed: smaller amounts",
                    file, request.spec));
  timings.phase("write");
  h5::write_whole_file(output, vtu(plate, state, field));
  return summary(output, plate, state, field);
}

}  // namespace fastjoint::stage2
