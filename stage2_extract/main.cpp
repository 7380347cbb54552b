// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "common/program/program.hpp"
#include "stage2_extract/extract.hpp"

namespace {

using namespace fastjoint;

const program::Command command = {
    "stage2_extract",
    "Extracts from a solved plate its condensed stiffness S, the friction matrices R and every other linear quantity,\n"
    "superconvergent, for every degree, with error estimates.",
    "PLATE.h5",
    "MATRICES.h5",
    {}};

void run(const program::Arguments& arguments) {
  const auto plate = formats::read_plate_solution(arguments.input);
  const auto extraction = stage2::extract(plate, arguments.input, program::generator(command.name));
  stage2::require_good(extraction.checks, arguments.input);
  const auto& a = extraction.matrices;
  formats::write(arguments.output, a);
  if (arguments.quiet) return;
  std::cout << fmt::format("{}: {} discs, {} externals, {} friction cases, {} tractions, p = {}..{}\n",
                           arguments.output, a.n_discs(), a.n_externals(), a.n_friction_cases(), a.n_tractions(),
                           a.p[0], a.p[a.p.size() - 1]);
  using stage2::largest;
  const double S = std::max(largest(a.S_ee.back()), largest(a.S_dd.back()));
  const double error = std::max(largest(a.S_ee_error), largest(a.S_dd_error));
  std::cout << fmt::format("  largest stiffness {:.6g} {}, {}\n", S, formats::unit(a.header.units, -1, 1),
                           std::isfinite(error) ? fmt::format("estimated error {:.1e} of it", S > 0 ? error / S : 0)
                                                : "error unknown: one degree alone does not show it");
  std::cout << stage2::report(extraction.checks);
}

}  // namespace

int main(int argc, char** argv) { return program::run(command, argc, argv, run); }
