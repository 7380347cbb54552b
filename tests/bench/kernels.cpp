// SPDX-License-Identifier: GPL-3.0-or-later
// Times of the parts that a study spends its time in, each on its own; Google Benchmark's options.
#include <benchmark/benchmark.h>

#include "common/formats/plate_matrices.hpp"
#include "common/pfem/element.hpp"
#include "common/pfem/material.hpp"
#include "common/pfem/shape_functions.hpp"
#include "common/plate/plate_factor.hpp"
#include "common/rim/rim.hpp"
#include "stage2_extract/extract.hpp"
#include "tests/support/files.hpp"
#include "tests/support/meshes.hpp"
#include "tests/support/plates.hpp"

namespace {

using namespace fastjoint;
using benchmark::DoNotOptimize;
using benchmark::State;

void element_stiffness(State& state, const pfem::Mesh& mesh) {
  const auto edges = pfem::find_edges(mesh);
  const pfem::ElementMap map(mesh, edges, 0);
  const auto D = pfem::elasticity(pfem::isotropic(1e7, 0.3), 0, pfem::Analysis::plane_stress);
  const pfem::ElementStiffness stiffness(pfem::Space::trunk, static_cast<int>(state.range(0)));
  for (auto _ : state) DoNotOptimize(stiffness(map, D, 0.1));
}
BENCHMARK_CAPTURE(element_stiffness, straight, test::distorted_mesh())->Arg(2)->Arg(4)->Arg(8);
BENCHMARK_CAPTURE(element_stiffness, curved, test::curved_mesh())->Arg(2)->Arg(4)->Arg(8);

/// At the points of a square's quadrature, p + 2 each way.
void shape_values(State& state) {
  const int p = static_cast<int>(state.range(0));
  const Eigen::Index n = p + 2;
  const Eigen::VectorXd x = pfem::gauss(p + 2).x;
  const Eigen::VectorXd xi = x.replicate(n, 1);
  const Eigen::VectorXd eta = x.transpose().replicate(n, 1).reshaped();
  for (auto _ : state) DoNotOptimize(pfem::shape_values(pfem::Space::product, p, xi, eta));
}
BENCHMARK(shape_values)->Arg(2)->Arg(4)->Arg(8);

/// All sides of one hole.
void rim_rule(State& state) {
  const auto plate = test::make_plate(test::panel(1, 1));
  const auto& mesh = plate.mesh.mesh;
  const auto& edges = plate.mesh.edges;
  const int p = static_cast<int>(state.range(0));
  const auto& hole = plate.scene.holes.front();
  const auto rim = rim::find_rim(mesh, edges, hole.center, hole.radius);
  for (auto _ : state)
    for (const auto& side : rim.sides) DoNotOptimize(rim::rim_rule(mesh, edges, side, p));
}
BENCHMARK(rim_rule)->Arg(2)->Arg(4)->Arg(8);

/// The eight elements around a hole.
void condense(State& state) {
  const auto plate = test::make_plate(test::panel(1, 1));
  const auto& elements = plate.problem.elements;
  const int p = static_cast<int>(state.range(0));
  for (auto _ : state)
    for (const auto& each : elements.classes)
      DoNotOptimize(plate::condense(each, elements.stiffness[each.congruent], plate.problem.numbering, p));
}
BENCHMARK(condense)->Arg(2)->Arg(4)->Arg(8)->Unit(benchmark::kMillisecond);

/// panel(n, n) at p = 8, from its integrated elements to S and R.
void factorise(State& state) {
  const int n = static_cast<int>(state.range(0));
  const auto plate = test::make_plate(test::panel(n, n));
  const plate::Skeleton skeleton(plate.problem);
  for (auto _ : state) DoNotOptimize(plate::PlateFactor(plate.problem, skeleton, 8, true).condensed());
}
BENCHMARK(factorise)->Arg(3)->Arg(10)->Unit(benchmark::kMillisecond);

/// The matrices of panel(3, 3) at p = 8 with the blocks of waves, and their checks.
void extract(State& state) {
  const auto plate = test::solve(test::make_plate(test::panel(3, 3)));
  for (auto _ : state) DoNotOptimize(stage2::extract(plate, "", true));
}
BENCHMARK(extract)->Unit(benchmark::kMillisecond);

/// Matrices of panel(3, 3) at all degrees, stresses among them.
const formats::PlateMatrices& matrices() {
  static const auto a = test::extract(test::panel(3, 3)).matrices;
  return a;
}

void write_matrices(State& state) {
  const test::TemporaryFolder folder;
  const auto path = folder.path("matrices.h5");
  for (auto _ : state) formats::write(path, matrices());
}
BENCHMARK(write_matrices)->Unit(benchmark::kMillisecond);

void read_matrices(State& state) {
  const test::TemporaryFolder folder;
  const auto path = folder.path("matrices.h5");
  formats::write(path, matrices());
  for (auto _ : state) DoNotOptimize(formats::read_plate_matrices(path));
}
BENCHMARK(read_matrices)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
