// SPDX-License-Identifier: GPL-3.0-or-later
#include <iostream>

#include "common/program/program.hpp"
#include "stage3_nonlinear/run.hpp"
#include "stage3_nonlinear/solvers/root.hpp"

namespace {

constexpr int highest_p = 99;  // matrices may come from elsewhere; what they hold is checked when they are read

const fastjoint::program::Command command{
    .name = "stage3_nonlinear",
    .summary = "Finds the loads of the fasteners of a joint from its plates' matrices.",
    .input = "JOINT.json",
    .output = "RESULT.h5",
    .options = {
        {"--p", "N", "polynomial degree of the matrices; default: the highest that all plates have"},
        {"--all-stresses", "", "print the stresses around the holes at every increment, not at the last alone"},
        {"--csv", "FILE", "also write one line per increment and shear plane"},
        {"--sensitivities", "",
         "also write how the forces change with every load, clearance, number of a law, coefficient of friction"}}};

void body(const fastjoint::program::Arguments& arguments, fastjoint::program::Timings& timings) {
  fastjoint::stage3::run({.input = arguments.input,
                          .output = arguments.output,
                          .csv = arguments.text("--csv"),
                          .timings = arguments.timings,
                          .p = arguments.integer("--p", 1, highest_p, 0),
                          .all_stresses = arguments.flag("--all-stresses"),
                          .sensitivities = arguments.flag("--sensitivities"),
                          .quiet = arguments.quiet,
                          .generator = fastjoint::program::generator(command.name)},
                         std::cout, std::cerr, timings);
}

}  // namespace

int main(int argc, char** argv) {
  fastjoint::stage3::take_over_gsl_errors();
  fastjoint::program::run(command, argc, argv, body);
}
