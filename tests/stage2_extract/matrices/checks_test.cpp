// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/matrices/checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

#include "common/errors.hpp"
#include "common/matrices/decompositions.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using testing::HasSubstr;

const std::string floating = test::grid_scene({0, 1, 2}, {0, 1}, {{"a", 0.4, 0.5, 0.2}, {"b", 1.5, 0.6, 0.25}},
                                              R"(, "disc_directions": ["x", "y"],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                 {"id": "T", "on": "top", "direction": "y", "kind": "traction"}])");

/// A sheet that only its fasteners and a boundary hold: every check applies, S has exactly the three rigid motions.
TEST(Checks, FloatingSheet) {
  const auto result = test::extract(floating);
  EXPECT_LT(*result.checks.energy, 1e-12);
  EXPECT_FALSE(result.checks.negative_eigenvalue);
  ASSERT_TRUE(result.checks.reciprocity && result.checks.equilibrium);
  EXPECT_LT(*result.checks.reciprocity, 1e-12);
  EXPECT_LT(*result.checks.equilibrium, 1e-12);
  EXPECT_NO_THROW(stage2::require_good(result.checks, "f.h5"));
}

/// Stage 1's rounding is 2e-11 of S in the strip, 200 times as long as wide; a joint would bear on it.
TEST(Checks, MatricesOfAFloatingSheetBalanceToTheLastDigits) {
  const std::string strip = test::grid_scene({0, 200}, {0, 1}, {{"a", 100, 0.5, 0.15, 1}}, R"(,
    "supports": [{"on": "bottom", "fix": ["y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])");
  for (const auto& scene : {strip, floating}) {
    const auto a = test::extract(scene).matrices;
    for (std::size_t level = 0; level < a.S_dd.size(); ++level) {
      Eigen::VectorXd motion(a.n_discs());
      for (Eigen::Index i = 0; i < motion.size(); ++i) motion[i] = a.disc_direction[i] == "x" ? 1 : 0;
      const Eigen::VectorXd external = Eigen::VectorXd::Ones(a.n_externals());  // P, along x
      const double largest = a.S_dd[level].cwiseAbs().maxCoeff();
      EXPECT_LE((a.S_dd[level] * motion + a.S_ed[level].transpose() * external).cwiseAbs().maxCoeff(), 1e-14 * largest);
      EXPECT_LE((a.S_ed[level] * motion + a.S_ee[level] * external).cwiseAbs().maxCoeff(), 1e-14 * largest);
      for (Eigen::Index j = 0; j < a.n_friction_cases(); ++j) {
        const bool along = a.friction_bearing[j].ends_with("x");
        const double sum = motion.dot(a.R_df[level].col(j)) + external.dot(a.R_ef[level].col(j));
        EXPECT_NEAR(sum, along ? -a.friction_resultant[j] : 0, 1e-14 * a.R_df[level].cwiseAbs().maxCoeff());
      }
    }
  }
}

/// Friction and bearing loads have a resultant across their direction where the thickness differs around the hole; it
/// is in the balance of a sheet that floats, as is that along.
TEST(Checks, ThicknessThatDiffersAroundHoles) {
  auto plate =
      test::make_plate(test::grid_scene({0, 1, 2}, {0, 1}, {{"a", 0.4, 0.5, 0.2}, {"o", 1.5, 0.6, 0.25, 0, false}},
                                        R"(, "p": [3, 4], "disc_directions": ["x", "y"],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                 {"id": "B", "on": "o", "direction": "x", "kind": "bearing"},
                 {"id": "C", "on": "o", "direction": "y", "kind": "bearing"}])"));
  auto& mesh = plate.mesh.mesh;
  for (int i = 0; i < mesh.n_elements(); ++i) {
    const Eigen::Vector2d middle = mesh.nodes(Eigen::all, mesh.quads.col(i)).rowwise().mean();
    mesh.thickness[i] = 0.1 * (1 + 0.3 * middle.x() + 0.2 * middle.y());
  }
  plate.problem = test::assemble(plate.scene, plate.mesh);
  const auto result = test::extract(test::solve(plate), false);
  EXPECT_LT(*result.checks.equilibrium, 1e-12);
  EXPECT_NO_THROW(stage2::require_good(result.checks, "f.h5"));
  const auto& a = result.matrices;
  for (const std::string axis : {"x", "y"}) {
    const double P = axis == "x" ? 1 : 0;
    const auto sum = [&](const Eigen::MatrixXd& discs, const Eigen::MatrixXd& externals) -> Eigen::RowVectorXd {
      return discs.row(axis == "x" ? 0 : 1) + P * externals;
    };
    const Eigen::RowVectorXd of_friction = sum(a.R_df.back(), a.R_ef.back()), of_load = sum(a.T_d.back(), a.T_e.back());
    for (Eigen::Index j = 0; j < 4; ++j) {  // bearing sides +x, -x, +y, -y
      const bool along = a.friction_bearing[j].ends_with(axis);
      EXPECT_NEAR(of_friction[j], along ? -a.friction_resultant[j] : -a.friction_resultant_across[j], 1e-15);
      EXPECT_GT(std::abs(a.friction_resultant_across[j]), 1e-4);
    }
    for (Eigen::Index j = 0; j < of_load.size(); ++j) {  // a case for each side that bears
      EXPECT_NEAR(of_load[j], a.traction_direction[j] == axis ? -1 : -a.traction_resultant_across[j], 1e-14);
      EXPECT_GT(std::abs(a.traction_resultant_across[j]), 1e-3);
    }
  }
}

/// The disc of a half hole holds the sheet across its line, so that nothing floats along y.
TEST(Checks, AHalfHoleHoldsTheSheetAcrossItsLine) {
  const auto result =
      test::extract(test::grid_scene({0, 1, 2}, {0, 1}, {{"half", 0.5, 0, 0.2}, {"whole", 1.5, 0.5, 0.2}},
                                     R"(, "p": [1, 2], "disc_directions": ["x", "y"])"),
                    false);
  EXPECT_NO_THROW(stage2::require_good(result.checks, "f.h5"));
  EXPECT_LT(*result.checks.equilibrium, 1e-12) << "along x";
}

/// The sheet follows its one disc: S and B are rounding, which must not be compared with itself.
TEST(Checks, ASheetThatOneDiscInContactHolds) {
  const auto result = test::extract(R"({"format": "plate", "version": 1, "analysis": "plane stress", "p": [4, 5],
    "materials": {"m": {"E": 244, "nu": 0.4}}, "geometry": {"grid": {"x": [-9, 9], "y": [0, 9], "thickness": 5}},
    "holes": [{"id": "pin", "center": [0, 0], "radius": 2, "spring": {"modulus": 40, "compression_only": true}}],
    "supports": [{"on": "bottom", "fix": ["y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "traction"}]})");
  EXPECT_NO_THROW(stage2::require_good(result.checks, "f.h5"));
  EXPECT_LT(*result.checks.reciprocity, 1e-9);
  EXPECT_LT(*result.checks.equilibrium, 1e-9);
}

/// The rounding of a stiff sheet is more than a small fraction of its soft springs, and is no force on its disc.
TEST(Checks, AStiffSheetThatOneSoftDiscHolds) {
  for (const double E : {500.0, 5.0, 0.05}) {
    const auto result = test::extract(fmt::format(
        R"({{"format": "plate", "version": 1, "analysis": "plane stress", "p": [2, 5],
      "materials": {{"m": {{"E": 4e5, "nu": 0.33}}}}, "geometry": {{"grid": {{"x": [-13, 21.5, 22.5], "y": [0, 5], "thickness": 4}}}},
      "holes": [{{"id": "pin", "center": [0, 0], "radius": 4.3, "spring": {{"disk": {{"E": {}, "nu": 0.3}}}}}}],
      "supports": [{{"on": "bottom", "fix": ["y"]}}],
      "external": [{{"id": "P", "on": "right", "direction": "x", "kind": "traction"}}]}})",
        E));
    EXPECT_NO_THROW(stage2::require_good(result.checks, "f.h5")) << E;
    EXPECT_EQ(result.matrices.S_dd.back()(0, 0), 0) << E;
  }
}

TEST(Checks, RigidMotionsAreTheNullSpaceOfS) {
  const auto m = test::extract(test::grid_scene({0, 1, 2}, {0, 1}, {{"a", 0.4, 0.5, 0.2}, {"b", 1.5, 0.6, 0.25}},
                                                R"(, "disc_directions": ["x", "y"])"))
                     .matrices;
  const Eigen::MatrixXd& S = m.S_dd.back();  // a.x a.y b.x b.y
  const Eigen::VectorXd values = matrices::symmetric_eigenvalues(S);
  EXPECT_LT(values.head(2).cwiseAbs().maxCoeff(), 1e-12 * values[3]);  // translations: exact
  const Eigen::Vector4d turning(-0.5, 0.4, -0.6, 1.5);
  EXPECT_LT((S * turning).norm(),
            1e-6 * S.norm());  // turning: as exact as the arcs' maps allow, see element_stiffness_test
  EXPECT_GT(values[3], 0.1 * S.norm());
}

TEST(Checks, SupportedSheetHasNothingToCheckOfEquilibrium) {
  EXPECT_FALSE(test::extract(test::panel(1, 1)).checks.equilibrium);
}

/// A sheet of random cells, holes, materials and thicknesses, in units of so many mm and N, which its one disc, a
/// support across and perhaps a second one hold.
std::string random_sheet(unsigned seed, double mm, double N) {
  std::mt19937 engine(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(engine()) / 4294967296.0);
  };
  const auto lines = [&](int n) {
    std::vector<double> at{0};
    while (n-- > 0) at.push_back(at.back() + between(15, 30) / mm);
    return at;
  };
  const auto x = lines(1 + static_cast<int>(between(0, 3))), y = lines(1 + static_cast<int>(between(0, 2)));
  const double MPa = mm * mm / N;
  std::vector<std::string> holes;
  for (std::size_t i = 0; i + 1 < x.size(); ++i)
    holes.push_back(fmt::format(
        R"({{"id": "{}", "center": [{}, {}], "radius": {}, "rings": {}{}}})", i, (x[i] + x[i + 1]) / 2, y[1] / 2,
        between(1.5, 4) / mm, static_cast<int>(between(0, 3)),
        i > 0 ? ""
              : fmt::format(R"(, "spring": {{"disk": {{"E": {}, "nu": 0.3}}}})", std::pow(10, between(4, 6)) * MPa)));
  const std::string isotropic = fmt::format(R"("E": {}, "nu": 0.3)", 7e4 * MPa);
  const std::string ply =
      fmt::format(R"("E1": {}, "E2": {}, "nu12": 0.3, "G12": {}, "angle": 30)", 1.4e5 * MPa, 9e3 * MPa, 5e3 * MPa);
  const std::string held = between(0, 1) < 0.3 ? R"(, {"on": "left", "fix": ["x"]})" : "";
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress", "disc_directions": ["x"],
    "materials": {{"a": {{{}}}}}, "geometry": {{"grid": {{"x": [{}], "y": [{}], "thickness": {}}}}}, "holes": [{}],
    "supports": [{{"on": "bottom", "fix": ["y"]}}{}],
    "external": [{{"id": "T", "on": "right", "direction": "x", "kind": "traction"}}]}})",
                     between(0, 1) < 0.6 ? isotropic : ply, fmt::join(x, ","), fmt::join(y, ","), between(0.5, 5) / mm,
                     fmt::join(holes, ","), held);
}

/// Most of these sheets have no stiffness, as one disc alone holds them; their checks and errors are those of any
/// other.
/// Number of runs, five of each seed, of a sheet whose discs have no stiffness.
int expect_as_good_in_all_units(unsigned n_seeds) {
  int without_stiffness = 0;
  for (unsigned seed = 0; seed < n_seeds; ++seed) {
    std::string said;
    for (const auto& [mm, N] : {std::pair{1.0, 1.0}, {1e3, 1.0}, {1e-3, 1e-6}, {25.4, 4.448}, {1e-5, 1e2}}) {
      const auto result = test::extract(random_sheet(seed, mm, N));
      EXPECT_NO_THROW(stage2::require_good(result.checks, "f.h5")) << seed << ", " << mm << " mm";
      if (said.empty()) said = matrices::to_text(result.errors);
      EXPECT_EQ(matrices::to_text(result.errors), said) << seed << ", " << mm << " mm";
      if (result.matrices.S_dd.back().isZero(0)) ++without_stiffness;
    }
    EXPECT_THAT(said, HasSubstr("of C_t about "));
  }
  return without_stiffness;
}

TEST(Checks, RandomSheetsAreAsGoodInAllUnits) { EXPECT_GT(expect_as_good_in_all_units(3), 0); }
TEST(ChecksSweep, RandomSheetsAreAsGoodInAllUnits) { EXPECT_GT(expect_as_good_in_all_units(20), 40); }

/// A strip 200 times as long as wide, nearly incompressible, clamped at one end and held by soft springs: what bending
/// it takes is 1e-11 of its elements' stiffness. Rounding is then what S lacks most, and its estimate says so.
TEST(Checks, RoundingIsEstimatedWhereItCounts) {
  const auto strip = [](double length, double scale) {
    return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane strain",
      "materials": {{"a": {{"E": {}, "nu": 0.499}}}},
      "geometry": {{"grid": {{"x": [0, {}], "y": [0, {}], "thickness": {}}}}},
      "holes": [{{"id": "1", "center": [{}, {}], "radius": {}, "spring": {{"disk": {{"E": {}, "nu": 0.3}}}}}}],
      "supports": [{{"on": "left", "fix": ["x", "y"]}}], "space": "product", "disc_directions": ["x", "y"]}})",
                       1 / scale / scale, length * scale, 0.95 * scale, 0.1 * scale, length / 2 * scale, 0.475 * scale,
                       0.24 * scale, 1.3e-6 / scale / scale);
  };
  for (const double length : {200.0, 2.0}) {
    const auto result = test::extract(strip(length, 1));
    const auto& S = result.matrices.S_dd.back();
    double worst = 0;
    for (const double scale : {1e-3, 1e3, 1 / 25.4, 0.3, 7.0}) {
      const Eigen::MatrixXd other = test::extract(strip(length, scale)).matrices.S_dd.back() * scale;
      worst = std::max(worst, (other - S).norm() / S.norm());
    }
    EXPECT_LT(worst, 10 * result.checks.rounding + 1e-12) << length;
    EXPECT_GT(worst, 0.02 * result.checks.rounding) << length;
    EXPECT_EQ(result.checks.rounding > 1e-6, length > 100);
    EXPECT_GE(result.matrices.S_dd_error(1, 1), 0.5 * result.checks.rounding * S.cwiseAbs().maxCoeff());
  }
}

/// A point spring many times as stiff as the sheet leaves rounding of its own size in S, which the estimate says; where
/// it is all there is of S, nothing is extracted.
TEST(Checks, StiffPointsAreRounding) {
  const auto sheet = [](double stiffness, double scale) {
    return test::extract(fmt::format(
        R"({{"format": "plate", "version": 1, "analysis": "plane stress", "materials": {{"a": {{"E": {}, "nu": 0.3}}}},
        "geometry": {{"grid": {{"x": [0, {}, {}], "y": [0, {}], "thickness": {}}}}},
        "points": [{{"id": "1", "at": [{}, {}], "stiffness": {}}}, {{"id": "2", "at": [{}, {}], "stiffness": {}}}],
        "supports": [{{"on": "left", "fix": ["x", "y"]}}], "disc_directions": ["x"], "p": [1, 3]}})",
        7e4 / scale / scale, 2 * scale, 4 * scale, scale, 0.1 * scale, 2 * scale, scale, stiffness / scale, 4 * scale,
        scale, stiffness / scale));
  };
  for (const double stiffness : {1e5, 1e11, 1e14}) {
    const auto result = sheet(stiffness, 1);
    const auto& S = result.matrices.S_dd.back();
    double worst = 0;
    for (const double scale : {1e-3, 1e3, 1 / 25.4, 0.3, 7.0})
      worst = std::max(worst, (sheet(stiffness, scale).matrices.S_dd.back() * scale - S).lpNorm<Eigen::Infinity>() /
                                  S.lpNorm<Eigen::Infinity>());
    EXPECT_LT(worst, result.checks.rounding) << stiffness;
    EXPECT_EQ(result.checks.rounding > 1e-6, stiffness > 1e13);
    EXPECT_NO_THROW(stage2::require_good(result.checks, "f.h5"));
  }
  for (const double stiffness : {1e18, 1e20})  // S is wrong, or taken for a sheet without stiffness
    EXPECT_THAT([&] { stage2::require_good(sheet(stiffness, 1).checks, "f.h5"); },
                ThrowsMessage<NumericalError>(
                    AllOf(HasSubstr("f.h5: the change of S by rounding is "),
                          HasSubstr(fmt::format("springs {} to {}; allowed", stiffness, stiffness)))));
}

/// The checks can fail: each of them on a solution that is spoilt in the digit that it looks at.
TEST(Checks, SpoiltSolutionsAreFound) {
  const auto good = test::solve(test::make_plate(floating));
  const auto complaint_of = [&](const std::function<void(formats::PlateSolution&)>& spoil) -> std::string {
    auto spoilt = good;
    spoil(spoilt);
    try {
      stage2::require_good(test::extract(spoilt, false).checks, "f.h5");
    } catch (const NumericalError& e) {
      return e.what();
    }
    return {};
  };
  EXPECT_THAT(complaint_of([](auto& a) { a.probe.force *= 1 + 1e-6; }), HasSubstr("f.h5: error of S is"));
  EXPECT_THAT(complaint_of([](auto& a) { a.cases.back().R(2, 0) += 1e-6 * a.cases.back().R.cwiseAbs().maxCoeff(); }),
              HasSubstr("error of reciprocity"));
  EXPECT_THAT(complaint_of([](auto& a) { a.probe.friction_force *= 1 + 1e-6; }), HasSubstr("error of reciprocity"));
  EXPECT_THAT(complaint_of([](auto& a) { a.probe.traction_work *= 1 + 1e-6; }), HasSubstr("error of reciprocity"));
  const auto add = [](auto& a, double share) {
    const Eigen::MatrixXd change = share * a.held_stiffness.asDiagonal();
    a.cases.back().S += change;
    a.probe.force += change * a.probe.displacement;
  };
  EXPECT_THAT(complaint_of([&](auto& a) { add(a, 1e-3); }), HasSubstr("error of global equilibrium"));
  EXPECT_THAT(complaint_of([&](auto& a) { add(a, -0.5); }), HasSubstr("smallest eigenvalue of S"));
}

}  // namespace
}  // namespace fastjoint
