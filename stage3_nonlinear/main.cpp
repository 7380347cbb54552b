// SPDX-License-Identifier: GPL-3.0-or-later
#include <iostream>

#include "common/program/program.hpp"
#include "stage3_nonlinear/run.hpp"
#include "stage3_nonlinear/solvers/root.hpp"

namespace {

const fastjoint::program::Command command{
    .name = "stage3_nonlinear",
    .summary = "Finds the loads of the fasteners of a joint from its plates' matrices.",
    .input = "JOINT.json",
    .output = "RESULT.h5",
    .options = {
        {"--p", "N", "polynomial degree of the matrices; default: the highest that all plates have"},
        {"--all-stresses", "", "print the stresses around the holes at every increment, not at the last alone"},
        {"--rim-stresses", "", "also write the stresses around all holes, one degree apart, at every increment"},
        {"--distance", "D",
         "also find the largest hoop stress at this distance from the rim of every hole, where point-stress criteria "
         "of laminates\n"
         "judge; with --rim-stresses also the stresses around"},
        {"--csv", "FILE", "also write one line per increment and shear plane"},
        {"--case", "NAME", "solve one of the load cases; default: all"},
        {"--envelope", "FILE",
         "also write a CSV of the largest and smallest value of every quantity over all cases, and where they are"},
        {"--margins", "FILE", "also write a CSV of the margins of all checks"},
        {"--totals", "FILE",
         "also write a CSV of the forces on sheets and rows of holes, and of the displacements of loaded edges"},
        {"--sensitivities", "",
         "also write how the forces, and at the last increment the peaks, change with every load, clearance, gap, "
         "number of a\n"
         "law and coefficient of friction"},
        {"--verbose", "", "say on stderr what each iteration of each try does"},
        {"--study", "FILE", "solve the joint for all samples of a STUDY.json; -o then is a STUDY.h5"},
        {"--threads", "N", "of a study: threads; default: as many as there are processors"},
        {"--slice", "I/N", "of a study: solve only the I-th of N parts of the samples, into the folder of -o's parts"},
        {"--merge", "", "of a study: solve nothing, make -o from the parts that all slices have left"},
        {"--sample", "K", "of a study: write the JOINT.json of sample K, counted from 0, to -o"}}};

}  // namespace

int main(int argc, char** argv) {
  using namespace fastjoint;
  stage3::take_over_gsl_errors();
  program::run(command, argc, argv, [](const program::Arguments& arguments, program::Timings& timings) {
    stage3::run(arguments, std::cout, std::cerr, timings);
  });
}
