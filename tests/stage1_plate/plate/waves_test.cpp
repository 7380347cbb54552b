// SPDX-License-Identifier: GPL-3.0-or-later
// Loads of the unit waves around holes: against plain quadrature, resultants, rigid motions.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/pfem/shape_functions.hpp"
#include "common/plate/springs.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint::waves_test {
namespace {

using Eigen::Index;

constexpr double radius = 0.2, thickness = 0.1;

/// A whole hole, an open one and a half one, nothing held but the line of symmetry y = 0.
std::string sheet_of(int order, bool contact, const char* more = "") {
  const std::string spring =
      fmt::format(R"("spring": {{"modulus": 1e6{}}})", contact ? R"(, "compression_only": true)" : "");
  const auto hole = [&](const char* id, double x, double y, const std::string& rest) {
    return fmt::format(R"({{"id": "{}", "center": [{}, {}], "radius": {}, "rings": 0, "waves": {}{}}})", id, x, y,
                       radius, order, rest);
  };
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress", "disc_directions": ["x", "y"],
    "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
    "geometry": {{"grid": {{"x": [0, 1, 2, 3], "y": [0, 1], "thickness": {}}}}},
    "supports": [{{"on": "bottom", "fix": ["y"]}}], "holes": [{}, {}, {}]{}}})",
                     thickness, hole("whole", 0.45, 0.55, ", " + spring), hole("open", 1.5, 0.5, ""),
                     hole("half", 2.4, 0, ", " + spring), more);
}

/// Loads of one side by Gauss's rule on many short pieces.
Eigen::MatrixXd plain_loads(const plate::SprungMesh& sprung, const rim::Harmonics& shape, const pfem::Side& side,
                            int p) {
  constexpr int n_pieces = 40;
  const auto rule = pfem::gauss(12);
  const auto curve = pfem::edge_curve(sprung.mesh, sprung.edges, side.element, side.local_edge);
  const auto n_modes = std::ssize(pfem::modes_on_edge(p, side.local_edge));
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(2 * n_modes, shape.size() + shape.n_shears());
  for (int piece = 0; piece < n_pieces; ++piece)
    for (Index q = 0; q < rule.x.size(); ++q) {
      const double s = -1 + (2 * piece + 1 + rule.x[q]) / n_pieces;
      const double angle = curve.start_angle() + (s + 1) / 2 * curve.sweep();
      const double weight = rule.w[q] / n_pieces * curve.derivative(s).norm() * thickness;
      const Eigen::Vector2d n(std::cos(angle), std::sin(angle)), t(-n.y(), n.x());
      Eigen::MatrixXd traction(2, loads.cols());
      traction << n * shape.at(angle).transpose(), t * shape.shears_at(angle).transpose();
      const Eigen::VectorXd N = pfem::integrated_legendre(p, Eigen::VectorXd::Constant(1, s)).N.col(0);
      for (const int axis : {0, 1}) loads.middleRows(axis * n_modes, n_modes) += weight * N * traction.row(axis);
    }
  return loads;
}

/// Also of waves much shorter than a side, which an element does not follow.
TEST(Waves, AreIntegratedExactly) {
  for (const int order : {1, 5, 40}) {
    const auto plate = test::make_plate(sheet_of(order, false));
    const auto sprung = stage1::sprung_mesh(plate.scene, plate.mesh);
    for (const int hole : {0, 1, 2})
      for (const auto& side : plate.mesh.rims[hole].sides)
        for (const int p : {1, 8}) {
          const auto terms = plate::rim_terms(sprung, hole, side, p);
          const Eigen::MatrixXd plain = plain_loads(sprung, sprung.waves[hole].value().shape, side, p);
          EXPECT_LT((terms.waves - plain).cwiseAbs().maxCoeff(), 1e-13 * thickness * radius) << order << ", p = " << p;
        }
  }
}

/// Coefficients of the free unknowns and of the controlled displacements as everything moves along an axis.
struct Translation {
  Eigen::VectorXd free, controlled;
};
Translation translation(const test::Plate& plate, int axis, bool with_discs) {
  const auto& unknowns = plate.problem.unknowns;
  Translation move{Eigen::VectorXd::Zero(unknowns.n_free.back()), Eigen::VectorXd::Zero(unknowns.n_controlled())};
  for (int node = 0; node < plate.mesh.mesh.n_nodes(); ++node)
    if (const int dof = unknowns.dofs(axis, node); pfem::is_free(dof)) move.free[dof] = 1;
  for (int disc = 0; with_discs && disc < unknowns.n_discs(); ++disc)
    if (rim::coordinate(unknowns.disc_direction[disc]) == axis) move.controlled[disc] = 1;
  return move;
}

/// Work of the loads of all border columns behind the discs.
Eigen::VectorXd work(const test::Plate& plate, const Translation& move) {
  return plate.problem.L_f.transpose() * move.free + plate.problem.L_c.transpose() * move.controlled;
}

TEST(Waves, HaveTheResultantsOfTheirDistributions) {
  for (const bool contact : {false, true}) {
    const auto plate = test::make_plate(sheet_of(3, contact));
    const auto& unknowns = plate.problem.unknowns;
    const auto sprung = stage1::sprung_mesh(plate.scene, plate.mesh);
    for (const int axis : {0, 1}) {
      const Eigen::VectorXd resultant = work(plate, translation(plate, axis, false));
      for (int hole = 0; hole < 3; ++hole) {
        if (hole == 2 && axis == 1) continue;  // the support on its line takes a part of it
        const rim::Harmonics& shape = sprung.waves[hole].value().shape;
        const double area = thickness * radius * shape.sweep;
        const auto of_hole =
            resultant.segment(unknowns.first_wave[hole] - unknowns.n_controlled(), unknowns.n_waves[hole]);
        EXPECT_LT((of_hole.head(shape.size()) - area * shape.push(axis)).cwiseAbs().maxCoeff(), 1e-14) << hole << axis;
        EXPECT_LT((of_hole.tail(shape.n_shears()) - area * shape.drag(axis)).cwiseAbs().maxCoeff(), 1e-14)
            << hole << axis;
      }
    }
  }
}

/// A wave of a hole with a disc acts between disc and sheet; the disc of the half hole moves along its line alone.
TEST(Waves, BetweenDiscAndSheetDoNoWorkAsBothMove) {
  for (const bool contact : {false, true}) {
    const auto plate = test::make_plate(sheet_of(5, contact));
    const auto& unknowns = plate.problem.unknowns;
    for (const int axis : {0, 1}) {
      const Eigen::VectorXd both = work(plate, translation(plate, axis, true));
      for (const int hole : axis == 0 ? std::vector{0, 2} : std::vector{0}) {
        const auto first = unknowns.first_wave[hole] - unknowns.n_controlled();
        EXPECT_LT(both.segment(first, unknowns.n_waves[hole]).cwiseAbs().maxCoeff(), 1e-14) << hole << ", " << axis;
      }
      if (!contact) continue;
      EXPECT_EQ(unknowns.n_friction, 0);
      EXPECT_EQ(unknowns.n_other, unknowns.n_waves[1]) << "the open hole's";
    }
  }
}

}  // namespace
}  // namespace fastjoint::waves_test
