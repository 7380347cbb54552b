// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <array>
#include <numbers>
#include <random>
#include <string>

#include "common/errors.hpp"
#include "tests/stage3_nonlinear/scenes.hpp"

namespace fastjoint::stage3::flexibility_formula_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

struct Formula {
  const char* name;
  bool knows_double_shear = false, uses_nu_f = false, uses_rows = false;
};
constexpr std::array formulas{Formula{"huth bolt", true},
                              Formula{"huth rivet", true},
                              Formula{"huth composite", true},
                              Formula{"swift"},
                              Formula{"boeing"},
                              Formula{"grumman"},
                              Formula{"tate-rosenfeld", false, true},
                              Formula{"morris", false, false, true}};

/// Numbers of a fastener as the input names them; E_z, d_head, pitch, row_pitch and c_f are those of "morris".
struct Geometry {
  std::array<double, 2> t{2, 3}, E{72000, 72000};
  double d = 5, E_f = 110000, nu_f = 0.33;
  bool double_shear = false;
  std::array<double, 2> E_z{72000, 72000};
  double d_head = 8, pitch = 25, row_pitch = 25, c_f = 1;
};

/// t = 2 and 3 mm, d = 5 mm, sheets of 72 GPa, fastener of 110 GPa.
const Geometry example;

double stiffness(const std::shared_ptr<const Law>& law) {
  const Branch on = law->at(1, 1, 0);
  return on.F / on.delta;
}

/// Flexibility of the whole fastener by the law that the program reads, which is that of one plane.
double flexibility(const Formula& formula, const Geometry& g, const char* mode) {
  std::string json = fmt::format(
      R"({{"type": "formula", "formula": "{}", "mode": "{}", "shear": "{}", "t": {}, "E": {}, "d": {}, "E_f": {})",
      formula.name, mode, g.double_shear ? "double" : "single", g.t, g.E, g.d, g.E_f);
  if (formula.uses_nu_f) json += fmt::format(R"(, "nu_f": {})", g.nu_f);
  if (formula.uses_rows)
    json += fmt::format(R"(, "E_z": {}, "d_head": {}, "pitch": {}, "row_pitch": {}, "rows": 2, "c_f": {})", g.E_z,
                        g.d_head, g.pitch, g.row_pitch, g.c_f);
  return 1 / ((g.double_shear ? 2 : 1) * stiffness(test::law_of(json + "}")));
}

double total(const Formula& formula, const Geometry& g) { return flexibility(formula, g, "total"); }
double of_fastener(const Formula& formula, const Geometry& g) { return flexibility(formula, g, "fastener only"); }

const Formula& named(const std::string& name) {
  for (const auto& formula : formulas)
    if (formula.name == name) return formula;
  throw std::runtime_error("no formula " + name);
}

Geometry random_geometry(std::mt19937& random) {
  std::uniform_real_distribution<double> number(0.5, 5);
  return {.t = {number(random), number(random)},
          .E = {number(random) * 1e4, number(random) * 1e4},
          .d = number(random),
          .E_f = number(random) * 1e5,
          .nu_f = number(random) / 10,
          .E_z = {number(random) * 1e4, number(random) * 1e4},
          .d_head = number(random),
          .pitch = number(random),
          .row_pitch = number(random),
          .c_f = 8.2};
}

/// Calls `check` with every formula, in every shear it knows, and with 50 random fasteners.
template <class Check>
void for_all(Check check) {
  std::mt19937 random(7);
  for (const auto& formula : formulas)
    for (const bool double_shear : {false, true})
      for (int i = 0; i < 50 && (formula.knows_double_shear || !double_shear); ++i) {
        SCOPED_TRACE(formula.name);
        auto g = random_geometry(random);
        g.double_shear = double_shear;
        check(formula, g);
      }
}

constexpr double rounding = 1e-13;  // relative, of some ten operations and powers

struct Known {
  const char* name;
  double flexibility;  ///< mm / N, seven digits
};
class FormulaValue : public testing::TestWithParam<Known> {};

TEST_P(FormulaValue, OfTheExample) {
  EXPECT_NEAR(total(named(GetParam().name), example), GetParam().flexibility, 5.1e-12);
}

/// Boeing's by hand: 2^(0.4^0.85) = 1.374527, 2^(0.6^0.85) = 1.566757, and 1 / E + 3 / (8 E_f) = 1.72979798e-5.
INSTANTIATE_TEST_SUITE_P(Each, FormulaValue,
                         testing::Values(Known{"huth bolt", 2.903227e-5}, Known{"huth rivet", 2.561280e-5},
                                         Known{"huth composite", 4.064518e-5}, Known{"swift", 1.835017e-5},
                                         Known{"boeing", 2.092218e-5}, Known{"grumman", 4.464226e-5},
                                         Known{"tate-rosenfeld", 2.325712e-5}));

/// Sheets of 3 and 4 mm and a steel bolt of 6.35 mm, and a splice of 6 mm between straps of 3 mm by one of 8 mm, worked
/// out step by step: 0.6722 * 3 * 9.560e-6, and 0.6814 * 1.5 * 5.463e-6.
TEST(Formula, OfALapAndASpliceByHand) {
  const Geometry lap{.t = {3, 4}, .d = 6.35, .E_f = 200000};
  const Geometry splice{.t = {6, 3}, .d = 8, .E_f = 200000, .double_shear = true};
  EXPECT_NEAR(total(named("huth bolt"), lap), 1.928e-5, 5e-9);
  EXPECT_NEAR(total(named("huth bolt"), splice), 5.584e-6, 5e-10);
  // The same lap by the others: 2^(0.4724^0.85) = 1.442 and 2^(0.6299^0.85) = 1.597 for Boeing's.
  EXPECT_NEAR(total(named("boeing"), lap), (1.4424 / 3 + 1.5968 / 4) * (1 / 72e3 + 3 / 1.6e6), 1e-9);
  EXPECT_NEAR(total(named("swift"), lap), 3.937e-6 + 0.8 * 8.102e-6, 5e-9);
  EXPECT_NEAR(total(named("grumman"), lap), 9.569e-7 + 3.7 * 8.102e-6, 5e-9);
}

/// 2.845 (1/144e3 + 1/216e3) = 3.292824e-5, c_f terms 1.474747e-6 + 2.212121e-6, and the powers 1.6^-0.34 5^-0.16 e^0.6
/// = 1.200441, worked out step by step.
TEST(Formula, OfMorrisByHand) {
  EXPECT_NEAR(total(named("morris"), example), 4.395428e-5, 1e-10);
  // Aluminium rivets come out near the other formulas, as they must: the unit of the printed constants is mm/kN.
  EXPECT_NEAR(total(named("morris"), example) / total(named("grumman"), example), 1, 0.1);
}

/// A middle sheet as thick as both its straps together bears as they do: sheet 1 is the one in the middle. Its terms
/// are then those of the straps, and the fastener's have 2 E_f where the sheets' have E.
TEST(Formula, DoubleShearHasItsFirstSheetInTheMiddle) {
  for_all([](const Formula& formula, Geometry g) {
    if (!g.double_shear) return;
    g.t[0] = 2 * g.t[1];
    g.E[0] = g.E[1];
    const double c = total(formula, g), fastener = of_fastener(formula, g);
    EXPECT_NEAR(fastener * 2 * g.E_f, (c - fastener) * g.E[0], rounding * c * (2 * g.E_f + g.E[0]));
    Geometry stiff_middle = g, stiff_straps = g;
    stiff_middle.E[0] *= 3;
    stiff_straps.E[1] *= 3;
    EXPECT_NEAR(total(formula, stiff_middle), total(formula, stiff_straps), rounding * c);
  });
}

TEST(Formula, IsALengthPerForce) {
  for_all([](const Formula& formula, const Geometry& g) {
    const double s = 25.4, c = total(formula, g);
    auto longer = g, stiffer = g;
    for (auto* length : {&longer.t[0], &longer.t[1], &longer.d, &longer.d_head, &longer.pitch, &longer.row_pitch})
      *length *= s;
    for (auto* modulus : {&stiffer.E[0], &stiffer.E[1], &stiffer.E_f, &stiffer.E_z[0], &stiffer.E_z[1]}) *modulus *= s;
    EXPECT_NEAR(total(formula, longer), c / s, rounding * c / s);
    EXPECT_NEAR(total(formula, stiffer), c / s, rounding * c / s);
  });
}

TEST(Formula, SingleShearDoesNotTellTheSheetsApart) {
  for_all([](const Formula& formula, Geometry g) {
    if (g.double_shear) return;
    const double c = total(formula, g);
    std::swap(g.t[0], g.t[1]);
    std::swap(g.E[0], g.E[1]);
    std::swap(g.E_z[0], g.E_z[1]);
    EXPECT_NEAR(total(formula, g), c, rounding * c);
  });
}

/// Rigid sheets leave the terms of the fastener, a rigid fastener those of the sheets, and both add up.
TEST(Formula, IsTheSumOfItsParts) {
  for_all([](const Formula& formula, const Geometry& g) {
    auto rigid_sheets = g, rigid_fastener = g;
    rigid_sheets.E = rigid_sheets.E_z = {1e90, 1e90};
    rigid_fastener.E_f = 1e90;
    const double c = total(formula, g), fastener = of_fastener(formula, g);
    EXPECT_GT(fastener, 0);
    EXPECT_NEAR(total(formula, rigid_sheets), fastener, rounding * c);
    EXPECT_NEAR(total(formula, rigid_fastener), c - fastener, rounding * c);
  });
}

std::string law(const std::string& formula, const std::string& more) {
  return R"({"type": "formula", "formula": ")" + formula + R"(", "t": [2, 3], "E": [72000, 72000], "d": 5, )" + more +
         "}";
}

TEST(FormulaLaw, GivesTheStiffness) {
  const auto whole =
      test::law_of(law("huth bolt", R"("mode": "total", "shear": "single", "E_f": 110000, "one_sided": true)"));
  EXPECT_NEAR(stiffness(whole), 1 / 2.903227e-5, 0.01);
  EXPECT_TRUE(whole->source()->bearing_of_plate);
  EXPECT_EQ(whole->source()->text,
            "huth bolt in single shear, total: H. Huth, LBF report FB-172, 1984, and ASTM STP 927, 1986; k = 34444.4; "
            "flexibility 2.90323e-05, of which 7.15864e-06 of the fastener");
  // Shear and bending of the shank, and its bearing on both sheets.
  const double bending = (8 + 60 + 90 + 27) / (40 * 110000 * std::numbers::pi * 625 / 64);
  const double shear = 4 * 5 / (9 * 110000 / 2.66 * std::numbers::pi * 25 / 4);
  const auto part =
      test::law_of(law("tate-rosenfeld", R"("mode": "fastener only", "shear": "single", "E_f": 110000, "nu_f": 0.33)"));
  EXPECT_NEAR(1 / stiffness(part), bending + shear + (1 / 2.0 + 1 / 3.0) / 110000, 1e-17);
  EXPECT_FALSE(part->source()->bearing_of_plate);
  const auto shank = test::law_of(
      law("tate-rosenfeld", R"("mode": "shear and bending", "shear": "single", "E_f": 110000, "nu_f": 0.33)"));
  EXPECT_NEAR(1 / stiffness(shank), bending + shear, 1e-17);
  const auto grumman = test::law_of(law("grumman", R"("mode": "shear and bending", "shear": "single", "E_f": 110000)"));
  EXPECT_NEAR(1 / stiffness(grumman), 25.0 / (110000 * 125), 1e-17);
  EXPECT_THAT(part->source()->text, HasSubstr("tate-rosenfeld in single shear, fastener only: M. B. Tate"));
}

TEST(FormulaLaw, KnowsDoubleShear) {
  const auto one = test::law_of(law("huth rivet", R"("mode": "total", "shear": "single", "E_f": 110000)"));
  const auto two = test::law_of(law("huth rivet", R"("mode": "total", "shear": "double", "E_f": 110000)"));
  // Both planes of the fastener are half as flexible, and each of them is half as stiff as both.
  EXPECT_NEAR(2 * stiffness(two) / stiffness(one), 2 * (1 / 2.0 + 1 / 3.0) / (1 / 2.0 + 1 / 6.0), 1e-12);
  EXPECT_THAT(two->source()->text, HasSubstr("huth rivet in double shear, total"));
}

TEST(FormulaLaw, IsASpringThatSaysWhereItComesFrom) {
  const auto law =
      test::law_of(R"({"type": "formula", "formula": "huth bolt", "mode": "total", "shear": "single", "t": [2, 3],
                            "E": [72000, 72000], "d": 5, "E_f": 110000})");
  const Branch on = law->at(1000, 1e4, 0);
  EXPECT_NEAR(on.delta / on.F, 2.903227e-5, 5e-12);
  ASSERT_TRUE(law->source());
  EXPECT_TRUE(law->source()->bearing_of_plate);
  EXPECT_THAT(law->source()->text, HasSubstr("huth bolt in single shear, total"));
  EXPECT_FALSE(test::linear_law(1)->source());
}

struct Refusal {
  std::string json;
  const char* message;
};
class FlexibilityRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(FlexibilityRefuses, WithPointerFoundAndAllowed) {
  EXPECT_THAT([] { (void)test::law_of(GetParam().json); }, ThrowsMessage<InputError>(HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    Each, FlexibilityRefuses,
    testing::Values(
        Refusal{law("glue", R"("mode": "total", "shear": "single", "E_f": 1)"),
                R"(/formula: "glue" is not allowed; allowed: "huth bolt", "huth rivet", "huth composite", "swift", )"
                R"("boeing", "grumman", "tate-rosenfeld")"},
        Refusal{law("swift", R"("shear": "single", "E_f": 1)"), R"(key "mode" is missing)"},
        Refusal{law("swift", R"("mode": "part", "shear": "single", "E_f": 1)"),
                R"(/mode: "part" is not allowed; allowed: "total", "fastener only", "shear and bending")"},
        Refusal{
            law("boeing", R"("mode": "shear and bending", "shear": "single", "E_f": 1)"),
            R"(/mode: "shear and bending", which "boeing" does not tell apart; allowed: "total" or "fastener only", or)"},
        Refusal{law("swift", R"("mode": "total", "E_f": 1)"), R"(key "shear" is missing)"},
        Refusal{law("swift", R"("mode": "total", "shear": "triple", "E_f": 1)"),
                R"(/shear: "triple" is not allowed; allowed: "single", "double")"},
        Refusal{law("swift", R"("mode": "total", "shear": "double", "E_f": 1)"),
                R"(/shear: "double" is not allowed; allowed: "single", the only shear of the formula "swift")"},
        Refusal{law("huth bolt", R"("mode": "total", "shear": "single", "E_f": 1, "nu_f": 0.3)"),
                R"(/nu_f: unknown key; allowed: no "nu_f", the formula "huth bolt" does not use it)"},
        Refusal{law("tate-rosenfeld", R"("mode": "total", "shear": "single", "E_f": 1)"), R"(key "nu_f" is missing)"},
        Refusal{law("tate-rosenfeld", R"("mode": "total", "shear": "single", "E_f": 1, "nu_f": 0.6)"),
                "/nu_f: 0.6 is not allowed; allowed: a number >= 0 and <= 0.5"},
        Refusal{law("swift", R"("mode": "total", "shear": "single", "E_f": 0)"),
                "/E_f: 0 is not allowed; allowed: a number > 0"},
        Refusal{law("swift", R"("mode": "total", "shear": "single", "E_f": 1, "k": 1)"),
                "/k: unknown key; allowed: type, formula, mode, shear, t, E, d, E_f, nu_f, E_z, d_head, pitch, "
                "row_pitch, rows, c_f, "
                "one_sided"},
        Refusal{law("swift", R"("mode": "total", "shear": "single", "E_f": 1, "c_f": 1)"),
                R"(/c_f: unknown key; allowed: no "c_f", the formula "swift" does not use it)"},
        Refusal{law("morris", R"("mode": "total", "shear": "single", "E_f": 1)"), R"(key "E_z" is missing)"},
        Refusal{R"({"type": "formula", "formula": "swift", "mode": "total", "shear": "single", "t": [1], "E": [1, 1]})",
                "/t: array of 1; allowed: exactly 2"},
        Refusal{
            R"({"type": "formula", "formula": "swift", "mode": "total", "shear": "single", "t": [1, 1], "E": [1, -1]})",
            "/E/1: -1 is not allowed; allowed: a number > 0"},
        Refusal{
            R"({"type": "formula", "formula": "swift", "mode": "total", "shear": "single", "t": [1, 1], "E": [1, 1], "d": 0})",
            "/d: 0 is not allowed; allowed: a number > 0"}));

}  // namespace
}  // namespace fastjoint::stage3::flexibility_formula_test
