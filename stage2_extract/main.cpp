// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "common/h5/whole_file.hpp"
#include "common/program/memory.hpp"
#include "common/program/program.hpp"
#include "stage2_extract/extract.hpp"
#include "stage2_extract/field/field.hpp"
#include "stage2_extract/stresses/stresses.hpp"

namespace {

using namespace fastjoint;

const program::Command command = {
    "stage2_extract",
    "Extracts from a solved plate its condensed stiffness S, the friction matrices R and every other linear quantity,\n"
    "superconvergent, for every degree, with error estimates. With --field: one of its stress fields, for ParaView.",
    "PLATE.h5",
    "MATRICES.h5",
    {{"--field", "SPEC",
      "write instead FIELD.vtu: SPEC is RESULT.h5 of a joint, loads (the scene's own), or cases "
      "with amounts, external:P=0.01,disc:1:x=0.003,friction:1:+x=50,traction:T=100"},
     {"--plate", "NAME", "name of the sheet in RESULT.h5; default: the only one with the cases of PLATE.h5"},
     {"--increment", "N", "increment of RESULT.h5 to show; default: the last"},
     {"--p", "N", "degree of the field; default: that of RESULT.h5, else the highest"}}};

void write_matrices(const program::Arguments& arguments, const formats::PlateSolution& plate,
                    program::Timings& timings) {
  timings.phase("extract");
  const auto extraction = stage2::extract(plate, arguments.input, program::generator(command.name));
  stage2::require_good(extraction.checks, arguments.input);
  const auto& a = extraction.matrices;
  timings.phase("write");
  const std::string digest = formats::write(arguments.output, a);
  if (arguments.quiet) return;
  using program::counted;
  const auto degrees =
      a.p.size() == 1 ? fmt::format("p = {}", a.p[0]) : fmt::format("p = {}..{}", a.p[0], a.p[a.p.size() - 1]);
  std::cout << fmt::format("{}: {}, {}, {}, {}, {}\n", arguments.output, counted(a.n_discs(), "disc"),
                           counted(a.n_externals(), "external"), counted(a.n_friction_cases(), "friction case"),
                           counted(a.n_tractions(), "traction"), degrees);
  using stage2::largest;
  const double S = std::max(largest(a.S_ee.back()), largest(a.S_dd.back()));
  std::cout << fmt::format("  largest stiffness {:.6g} {}, {}\n", S, unit(a.header.units, -1, 1),
                           std::isfinite(matrices::largest(extraction.errors))
                               ? matrices::to_text(extraction.errors)
                               : "error unknown: one degree alone does not show it");
  std::cout << stage2::report(extraction.checks) << fmt::format("  digest {}\n", digest);
}

void write_field(const program::Arguments& arguments, const formats::PlateSolution& plate,
                 const stage2::FieldRequest& request, program::Timings& timings) {
  const auto state = stage2::field_state(plate, arguments.input, request);
  timings.phase("extract");
  const auto field = stage2::make_field(plate, arguments.input, request, state);
  timings.phase("write");
  h5::write_whole_file(arguments.output, stage2::vtu(plate, state, field));
  if (arguments.quiet) return;
  Eigen::Index at = 0;
  const double largest = stage2::von_mises(field.stress).maxCoeff(&at);
  const auto& units = plate.header.units;
  std::cout << fmt::format("{}: {}, {} of degree {}\n  largest von Mises stress {:.6g} {} at ({:.4g}, {:.4g}) {}\n",
                           arguments.output, state.words, program::counted(plate.mesh.n_elements(), "cell"), field.p,
                           largest, unit(units, -2, 1), field.points(0, at), field.points(1, at), unit(units, 1, 0));
}

/// Options are checked before a large file is read.
stage2::FieldRequest field_request(const program::Arguments& arguments) {
  constexpr int most_increments = 1000000;
  stage2::FieldRequest request = {arguments.text("--field"), arguments.text("--plate"),
                                  arguments.integer("--increment", 1, most_increments, 0),
                                  arguments.integer("--p", 1, pfem::highest_p, 0)};
  stage2::check_field_options(request, arguments.flag("--field"), arguments.output, arguments.timings);
  return request;
}

void require_memory(const std::string& file, double need) {
  constexpr double libraries = 24e6;
  program::require_memory(file + ": this", libraries + need, "",
                          "a file of a lower p or fewer holes, or of stage1_plate --loads-only");
}

/// Bytes of the matrices beside the plate's fields: stresses and condensed matrices stand in memory and in the file
/// that is written, which HDF5 enlarges by copying it.
double extraction_need(const formats::PlateSolution& plate, double file_size) {
  constexpr double copies = 4;
  double fields = 0;
  for (const auto& each : plate.cases) fields += 8.0 * double(each.U.size() + each.V.size() + each.W.size());
  return fields + copies * (std::max(file_size - fields, 0.0) + stage2::stress_bytes(plate));
}

void run(const program::Arguments& arguments, program::Timings& timings) {
  timings.phase("read");
  const auto request = field_request(arguments);
  constexpr double of_reading = 3;  // the file's image, and its fields as they are filled
  std::error_code none;
  const auto size = double(std::filesystem::file_size(arguments.input, none));
  if (!none) require_memory(arguments.input, of_reading * size);
  const auto plate = formats::read_plate_solution(arguments.input);
  if (!arguments.flag("--field")) require_memory(arguments.input, extraction_need(plate, size));
  for (Eigen::Index i = 0; i < plate.p.size(); ++i) timings.set_unknowns(plate.p[i], plate.ndof[i]);
  if (!arguments.flag("--field")) return write_matrices(arguments, plate, timings);
  write_field(arguments, plate, request, timings);
}

}  // namespace

int main(int argc, char** argv) { program::run(command, argc, argv, run); }
