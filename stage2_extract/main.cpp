// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/h5/whole_file.hpp"
#include "common/program/memory.hpp"
#include "common/program/program.hpp"
#include "stage2_extract/extract.hpp"
#include "stage2_extract/field/field.hpp"
#include "stage2_extract/field/joint_sheet.hpp"

namespace {

using namespace fastjoint;

const program::Command command = {
    "stage2_extract",
    "Extracts from a solved plate its condensed stiffness S, the friction matrices R and every other linear quantity,\n"
    "superconvergent, for every degree, with error estimates. With --field: one stress field, for ParaView.",
    "PLATE.h5",
    "MATRICES.h5",
    {{"--loads-only", "", "leave out the data for stresses at holes and forces over sections"},
     {"--field", "SPEC",
      "write instead FIELD.vtu: SPEC is RESULT.h5 of a joint, or a sum of cases with coefficients, "
      "external:P=0.01,disc:1:x=0.003,friction:1:+x=50,traction:T=100"},
     {"--plate", "NAME", "name of the sheet in RESULT.h5; default: the only one with the cases of PLATE.h5"},
     {"--increment", "N", "increment of RESULT.h5 to show; default: the one that governs"},
     {"--case", "NAME", "case of RESULT.h5 to show, at its last increment"},
     {"--p", "N", "degree of the field; default: that of RESULT.h5, else the highest"}}};

void write_matrices(const program::Arguments& arguments, formats::PlateSolution plate, program::Timings& timings) {
  timings.phase("extract");
  const auto extraction =
      stage2::extract(std::move(plate), program::generator(command.name), !arguments.flag("--loads-only"));
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

void write_field(const program::Arguments& arguments, stage2::FieldSolver& solver, const stage2::FieldRequest& request,
                 program::Timings& timings) {
  const auto& plate = solver.plate();
  const auto state = stage2::field_state(plate, arguments.input, request);
  timings.phase("extract");
  const auto field = stage2::make_field(solver, arguments.input, request, state);
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

/// Reads and checks the options of a field, before a large file is read.
stage2::FieldRequest field_request(const program::Arguments& arguments) {
  constexpr int max_increments = 1000000;
  if (arguments.flag("--field") && arguments.flag("--loads-only"))
    throw InputError("--loads-only: given together with --field; allowed: one of them");
  stage2::FieldRequest request = {arguments.text("--field"), arguments.text("--plate"),
                                  arguments.integer("--increment", 1, max_increments, 0),
                                  arguments.integer("--p", 1, pfem::highest_p, 0), arguments.text("--case")};
  stage2::check_field_options(request, arguments.flag("--field"), arguments.output, arguments.timings);
  return request;
}

void require_memory(const std::string& file, double need) {
  constexpr double libraries = 23e6;  // includes small parts of the factor
  program::require_memory(file + ": this", libraries + need, "", "a file of a lower p or fewer holes");
}

/// Bytes of a field at the highest degree: the factor, seven numbers at each node, and the text of the file twice, with
/// ten numbers of up to 16 characters and an index per node.
double field_need(const stage2::FieldSolver& solver, double file_size) {
  constexpr double numbers = 7 * sizeof(double), text = 2 * (10 * 16 + 12);
  const int p = solver.numbering().p;
  const double n_nodes = solver.plate().mesh.n_elements() * (p + 1) * (p + 1);
  return file_size + solver.factor_bytes(p) + n_nodes * (numbers + text);
}

void run(const program::Arguments& arguments, program::Timings& timings) {
  timings.phase("read");
  const auto request = field_request(arguments);
  const auto size_of = [](const std::string& file) {
    std::error_code none;
    const auto bytes = std::filesystem::file_size(file, none);
    return none ? 0 : double(bytes);
  };
  const double size = size_of(arguments.input);
  constexpr double copies_to_read =
      1.9;  // memory over the file's size: the plate and the image of the file, which is enough for loads only
  constexpr double copies_to_extract =
      2.15;  // the same to extract all matrices, which are copied in the order of the file
  require_memory(arguments.input, copies_to_read * size);
  auto plate = formats::read_plate_solution(arguments.input);
  for (Eigen::Index i = 0; i < plate.p.size(); ++i) timings.set_unknowns(plate.p[i], plate.ndof[i]);
  if (!arguments.flag("--field")) {
    if (!arguments.flag("--loads-only")) require_memory(arguments.input, copies_to_extract * size);
    return write_matrices(arguments, std::move(plate), timings);
  }
  timings.phase("integrate");
  stage2::take_waves_of_field(plate);
  stage2::FieldSolver solver(plate, arguments.input);
  require_memory(arguments.input, field_need(solver, size));
  write_field(arguments, solver, request, timings);
}

}  // namespace

int main(int argc, char** argv) { program::run(command, argc, argv, run); }
