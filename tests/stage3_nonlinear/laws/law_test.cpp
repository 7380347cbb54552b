// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/laws/law.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "common/errors.hpp"
#include "stage3_nonlinear/laws/cubic_law.hpp"
#include "stage3_nonlinear/laws/power_law.hpp"
#include "stage3_nonlinear/laws/table_law.hpp"
#include "tests/support/files.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

std::shared_ptr<const Law> read(const std::string& json) {
  const auto document = input::parse("joint.json", json);
  return read_law(input::Value(document));
}

/// A law by its numbers, and its curve F(delta) written down here once more, clearance included.
struct Example {
  const char* name;
  std::string format;                    ///< JSON with {name} for each number
  std::map<std::string, double> number;  ///< those that parameters() names, "F[0]" as "F0"
  std::function<double(std::map<std::string, double>, double delta, double clearance)> F;
  bool rises = true;
};

std::string json(const Example& example, const std::map<std::string, double>& number) {
  std::string text = example.format;
  for (const auto& [name, value] : number) {
    const std::string mark = "<" + name + ">";
    text.replace(text.find(mark), mark.size(), fmt::format("{}", value));
  }
  return text;
}

double power(std::map<std::string, double> a, double delta, double clearance) {
  return a["A"] * std::pow(std::max(0.0, delta - clearance - a["delta0"]), a["n"]);
}

double cubic(std::map<std::string, double> a, double delta, double clearance) {
  const double d = std::max(0.0, delta - clearance);
  const double d0 = 0.01, d1 = 0.02, d2 = 0.04;
  return a["F0"] * (d - d1) * (d - d2) * d / ((d0 - d1) * (d0 - d2) * d0) +
         a["F1"] * (d - d0) * (d - d2) * d / ((d1 - d0) * (d1 - d2) * d1) +
         a["F2"] * (d - d0) * (d - d1) * d / ((d2 - d0) * (d2 - d1) * d2);
}

double bilinear(std::map<std::string, double> a, double delta, double clearance) {
  const double d = std::max(0.0, delta - clearance), yield = a["F_yield"] / a["k"];
  return d < yield ? a["k"] * d : a["F_yield"] + a["k_yield"] * (d - yield);
}

double four_stage(std::map<std::string, double> a, double d, double clearance) {
  const double stuck = a["F_slip"] / a["k_stick"], slipped = stuck + a["slip"] + clearance;
  const double yield = slipped + (a["F_yield"] - a["F_slip"]) / a["k_bearing"];
  if (d < stuck) return a["k_stick"] * d;
  if (d < slipped) return a["F_slip"];
  if (d < yield) return a["F_slip"] + a["k_bearing"] * (d - slipped);
  return a["F_yield"] + a["k_yield"] * (d - yield);
}

const std::string power_format = R"({"type": "power", "A": <A>, "n": <n>, "delta0": <delta0>})";
const std::string cubic_format = R"({"type": "cubic", "delta": [0.01, 0.02, 0.04], "F": [<F0>, <F1>, <F2>]})";

class EachLaw : public testing::TestWithParam<Example> {
 protected:
  static constexpr double k = 4e4;
  const Example& example_ = GetParam();
  std::shared_ptr<const Law> law_ = read(json(example_, example_.number));
};

TEST_P(EachLaw, IsItsCurve) {
  EXPECT_EQ(law_->rises(), example_.rises);
  for (const double clearance : {0.0, 0.013})
    for (double c = 0; c < 8000; c += 61.3) {
      const Branch on = law_->at(c, k, clearance);
      EXPECT_NEAR(on.F, example_.F(example_.number, on.delta, clearance), 1e-9 * (1 + c)) << "c = " << c;
      EXPECT_NEAR(example_.rises ? on.F + k * on.delta : k * on.delta, c, 1e-12 * (1 + c));
      EXPECT_FALSE(on.spent);
    }
}

/// Error of central differences ~ h^2 + eps / h, relative; kinks are left out.
TEST_P(EachLaw, HasTheDerivativesOfItsCurve) {
  for (const double clearance : {0.0, 0.013})
    for (double c = 21; c < 8000; c += 61.3) {
      constexpr double h = 1e-3;
      const Branch on = law_->at(c, k, clearance), above = law_->at(c + h, k, clearance),
                   below = law_->at(c - h, k, clearance);
      if (std::abs(above.dF - below.dF) > 1e-4) continue;
      EXPECT_NEAR((above.F - below.F) / (2 * h), on.dF, 1e-7) << "c = " << c;
      EXPECT_NEAR((above.delta - below.delta) / (2 * h) * k, on.ddelta * k, 1e-7);
      if (example_.rises) {
        EXPECT_GE(on.dF, 0);
        EXPECT_GE(on.ddelta, 0);
        EXPECT_NEAR(on.dF + k * on.ddelta, 1, 1e-12);
      }
    }
}

TEST_P(EachLaw, HasTheSlopesOfItsNumbers) {
  const auto parameters = law_->parameters();
  ASSERT_EQ(parameters.size(), example_.number.size());
  const double clearance = 0.013;
  for (double c = 21; c < 8000; c += 61.3) {
    const auto slopes = law_->slopes(c, k, clearance);
    ASSERT_EQ(slopes.size(), 1 + parameters.size());
    const Branch on = law_->at(c, k, clearance);
    const auto expect = [&](const std::string& name, double h, const Slope& slope,
                            const std::function<Branch(double)>& moved) {
      const Branch above = moved(h), below = moved(-h);
      if (std::abs(above.dF - on.dF) > 1e-3 || std::abs(below.dF - on.dF) > 1e-3) return;  // a kink passes
      EXPECT_NEAR((above.F - below.F) / (2 * h), slope.F, 1e-5 * std::abs(slope.F) + 1e-9 / h) << name << " at " << c;
      EXPECT_NEAR((above.delta - below.delta) / (2 * h), slope.delta, 1e-5 * std::abs(slope.delta) + 1e-13 / h)
          << name << " at " << c;
    };
    expect("clearance", 1e-7, slopes[0], [&](double h) { return law_->at(c, k, clearance + h); });
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      std::string name = parameters[i].name;
      if (name[0] == 'F' && name[1] == '[') name = fmt::format("F{}", name[2]);
      if (name == "n" && example_.number.at(name) == 1) continue;  // no law beyond it to compare with
      expect(name, 1e-5 * std::max(1e-3, example_.number.at(name)), slopes[1 + i], [&](double h) {
        auto number = example_.number;
        number[name] += h;
        return read(json(example_, number))->at(c, k, clearance);
      });
    }
  }
}

TEST_P(EachLaw, FindsTheCoordinateOfAForce) {
  if (!example_.rises || std::string(example_.name) == "cubic") return;  // by a secant only
  for (const double F : {1.0, 30.0, 800.0, 1300.0}) {
    const double c = law_->coordinate(F, k, 0.013);
    EXPECT_NEAR(law_->at(c, k, 0.013).F, F, 1e-11 * F);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, EachLaw,
    testing::Values(Example{"linear",
                            R"({"type": "linear", "k": <k>})",
                            {{"k", 7e4}},
                            [](auto a, double d, double gap) { return a["k"] * std::max(0.0, d - gap); }},
                    Example{"power", power_format, {{"A", 9000}, {"n", 0.6}, {"delta0", 0.004}}, power},
                    Example{"power_one", power_format, {{"A", 9e4}, {"n", 1}, {"delta0", 0.004}}, power},
                    Example{"bilinear",
                            R"({"type": "bilinear", "k": <k>, "F_yield": <F_yield>, "k_yield": <k_yield>})",
                            {{"k", 7e4}, {"F_yield", 900}, {"k_yield", 5e3}},
                            bilinear},
                    Example{"four_stage",
                            R"({"type": "four stage", "k_stick": <k_stick>, "F_slip": <F_slip>, "slip": <slip>,
                    "k_bearing": <k_bearing>, "F_yield": <F_yield>, "k_yield": <k_yield>})",
                            {{"k_stick", 5e5},
                             {"F_slip", 200},
                             {"slip", 0.002},
                             {"k_bearing", 6e4},
                             {"F_yield", 1200},
                             {"k_yield", 2e3}},
                            four_stage},
                    Example{"cubic", cubic_format, {{"F0", 900}, {"F1", 1500}, {"F2", 2300}}, cubic},
                    Example{"cubic_that_falls", cubic_format, {{"F0", 900}, {"F1", 800}, {"F2", 2300}}, cubic, false}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(PowerLaw, IsRigidAtFirstContact) {
  const Branch contact = PowerLaw(200, 0.6, 0).at(0, 7, 0);
  EXPECT_EQ(contact.F, 0);
  EXPECT_EQ(contact.delta, 0);
  EXPECT_EQ(contact.dF, 1);
  EXPECT_EQ(contact.ddelta, 0);
}

/// From far below to far above the plates' stiffness, and for exponents far below practice.
TEST(PowerLaw, IsFoundForAnyRatioOfStiffnesses) {
  for (const double n : {0.05, 0.4, 0.7, 0.99})
    for (double A = 1e-8; A < 1e9; A *= 10)
      for (double c = 1e-6; c < 1e7; c *= 10) {
        const Branch on = PowerLaw(A, n, 0).at(c, 1, 0);
        EXPECT_NEAR(on.F + on.delta, c, 1e-13 * c) << A << " " << c;
        EXPECT_NEAR(A * std::pow(on.delta, n), on.F, 1e-11 * on.F) << A << " " << c;
      }
}

TEST(PowerLaw, WarnsBelowThePracticalRange) {
  EXPECT_THAT(PowerLaw(1, 0.4, 0).doubts(), IsEmpty());
  EXPECT_THAT(PowerLaw(1, 0.3, 0).doubts(), ElementsAre(HasSubstr("n = 0.3 is below the practical range 0.4 to 1")));
}

TEST(CubicLaw, GoesThroughItsPointsInAnyOrder) {
  for (const CubicLaw& law :
       {CubicLaw({0.01, 0.02, 0.04}, {900, 1500, 2000}), CubicLaw({0.04, 0.01, 0.02}, {2000, 900, 1500})}) {
    EXPECT_EQ(law.last_delta(0.5), 0.54);
    const auto at = [&](double F, double delta) { return law.at(law.rises() ? F + 1e5 * delta : 1e5 * delta, 1e5, 0); };
    EXPECT_NEAR(at(900, 0.01).F, 900, 1e-9);
    EXPECT_NEAR(at(1500, 0.02).F, 1500, 1e-9);
    EXPECT_NEAR(at(2000, 0.04).F, 2000, 1e-9);
  }
}

TEST(CubicLaw, NeverPushesOn) {
  // x (1.1 - 0.1 x) falls from 5.5 on and is back at zero at x = 11.
  const CubicLaw law({1, 2, 3}, {1, 1.8, 2.4});
  EXPECT_FALSE(law.rises());
  EXPECT_LE(law.least_slope(), -1.1 + 1e-12);
  EXPECT_NEAR(law.at(10, 1, 0).F, 1, 1e-12);
  EXPECT_FALSE(law.at(10, 1, 0).spent);
  EXPECT_TRUE(law.at(12, 1, 0).spent);
  EXPECT_EQ(law.at(12, 1, 0).F, 0);
  EXPECT_EQ(law.at(12, 1, 0).dF, 0);
  EXPECT_EQ(law.at(12, 1, 0).delta, 12);
}

/// Beyond its last point the cubic falls to 995 at a stretch of 0.19 and rises from there: no test showed that.
TEST(CubicLaw, DoesNotHoldAgainBeyondItsLastPoint) {
  const CubicLaw law({0.05, 0.1, 0.15}, {1500, 1800, 1200});
  constexpr double k = 1e4;
  EXPECT_FALSE(law.at(k * 0.15, k, 0).spent);
  double before = law.at(k * 0.15, k, 0).F;
  for (double delta = 0.151; delta < 1; delta += 0.001) {
    const Branch on = law.at(k * delta, k, 0);
    EXPECT_LE(on.F, before) << delta;
    EXPECT_GE(on.F, 0) << delta;
    if (on.spent) {
      EXPECT_EQ(on.dF, 0) << delta;
    }
    before = on.F;
  }
  EXPECT_TRUE(law.at(k * 0.6, k, 0).spent);
  // Where its own points show that it rises again, it does.
  EXPECT_FALSE(CubicLaw({1, 2, 3}, {10, 2, 10}).at(k * 5, k, 0).spent);
}

TEST(CubicLaw, WarnsWhereItTurnsDown) {
  EXPECT_THAT(CubicLaw({1, 2, 3}, {1, 1.6, 2.4}).doubts(), IsEmpty());
  // F = x (6.5 - 4.75 x + x^2): slope 6.5 - 9.5 x + 3 x^2 falls below zero between 1 and 2, at x = 19/12
  // by 1.0208.
  EXPECT_THAT(CubicLaw({1, 2, 3}, {2.75, 2, 3.75}).doubts(),
              ElementsAre(HasSubstr("slope at delta = 1.583 is -1.021; the joint may have more than one solution")));
  EXPECT_THAT(CubicLaw({1, 2, 3}, {1, 1.5, 1.2}).doubts(), ElementsAre(HasSubstr("slope at delta = 3 ")));
}

TEST(PiecewiseLinearLaw, KinksWhereItsSlopeJumps) {
  const auto law = read(R"({"type": "bilinear", "k": 100, "F_yield": 10, "k_yield": 0})");
  EXPECT_THAT(law->kinks(50, 0).value(), ElementsAre(15));
  EXPECT_THAT(law->kinks(50, 0.2).value(), ElementsAre(10, 25));
  EXPECT_EQ(law->at(1000, 50, 0).F, 10) << "perfectly plastic";
  EXPECT_EQ(law->at(1000, 50, 0).dF, 0);
  EXPECT_THAT(read(R"({"type": "linear", "k": 100})")->kinks(50, 0).value(), IsEmpty());
}

/// Points of sin: the error of a cubic with continuous slope falls as h^3 at least (as h^4 where it may).
TEST(TableLaw, ConvergesToTheCurveOfItsPoints) {
  const auto error = [](int n) {
    std::vector<std::array<double, 2>> points;
    for (int i = 1; i <= n; ++i) points.push_back({1.5 * i / n, std::sin(1.5 * i / n)});
    const TableLaw law(points);
    double worst = 0;
    for (double c = 0.01; c < 2; c += 0.01) {
      const Branch on = law.at(c, 0.7, 0);
      EXPECT_NEAR(on.F + 0.7 * on.delta, c, 1e-14);
      if (on.delta < 1.2) worst = std::max(worst, std::abs(on.F - std::sin(on.delta)));
    }
    return worst;
  };
  for (const int n : {10, 20, 40}) EXPECT_LT(error(2 * n) / error(n), 0.14) << n;
  EXPECT_LT(error(80), 2e-6);
}

TEST(TableLaw, GoesThroughItsPointsAndNeverFalls) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> step(0, 1);
  for (int i = 0; i < 200; ++i) {
    std::vector<std::array<double, 2>> points{{0.1 + step(random), step(random)}};
    for (int j = 0; j < 6; ++j)  // level pieces too
      points.push_back({points.back()[0] + 0.01 + step(random),
                        points.back()[1] + (step(random) < 0.3 ? 0 : step(random) * step(random))});
    const TableLaw law(points);
    const double k = std::pow(10, 6 * step(random) - 3), gap = step(random);
    for (const auto& [x, F] : points) EXPECT_NEAR(law.at(F + k * (gap + x), k, gap).F, F, 1e-13);
    double before = 0;
    for (double c = 0; c < 20 * (1 + k); c += 0.05 * (1 + k)) {
      const Branch on = law.at(c, k, gap);
      EXPECT_GE(on.F, before - 1e-14);
      EXPECT_NEAR(on.F + k * on.delta, c, 1e-12 * (c + k));
      EXPECT_GE(on.dF, 0);
      before = on.F;
    }
    EXPECT_DOUBLE_EQ(law.last_delta(gap), gap + points.back()[0]);
  }
}

TEST(TableLaw, ReadsTheSamePointsFromAFile) {
  const test::TemporaryFolder folder;
  folder.write("rivet.csv", "delta, F\n0, 0\n0.1, 300\n0.2, 500 # last\n");
  const auto document = input::parse(folder.path("joint.json"), R"({"type": "table", "file": "rivet.csv"})");
  const auto from_file = read_law(input::Value(document));
  const auto inside = read(R"({"type": "table", "delta": [0.1, 0.2], "F": [300, 500]})");
  for (const double c : {10.0, 400.0, 2000.0}) {
    EXPECT_EQ(from_file->at(c, 1e3, 0.01).F, inside->at(c, 1e3, 0.01).F);
    EXPECT_EQ(from_file->slopes(c, 1e3, 0.01)[0].F, inside->slopes(c, 1e3, 0.01)[0].F);
  }
}

TEST(TableLaw, IsExactlyAtRestWithoutForce) {
  const auto law = read(R"({"type": "table", "delta": [0.1, 0.2], "F": [300, 310]})");
  EXPECT_EQ(law->at(0, 1e5, 0).F, 0);
  EXPECT_EQ(law->at(0, 1e5, 0).delta, 0);
  EXPECT_EQ(law->at(1e5 * 0.03, 1e5, 0.03).delta, 0.03) << "at first contact";
}

TEST(TableLaw, NamesAFileThatIsMissing) {
  EXPECT_THAT([] { (void)read(R"({"type": "table", "file": "nope.csv"})"); },
              ThrowsMessage<FileError>(HasSubstr("nope.csv: cannot be opened: No such file")));
}

TEST(TableLaw, HasDerivatives) {
  const auto law = read(R"({"type": "table", "delta": [0.1, 0.2, 0.5], "F": [300, 500, 600]})");
  constexpr double h = 1e-4, k = 1000;
  for (double c = 20; c < 2000; c += 33) {
    const Branch on = law->at(c, k, 0.01), above = law->at(c + h, k, 0.01), below = law->at(c - h, k, 0.01);
    EXPECT_NEAR((above.F - below.F) / (2 * h), on.dF, 1e-6) << c;
    EXPECT_NEAR((above.delta - below.delta) / (2 * h) * k, on.ddelta * k, 1e-6) << c;
    const Branch wider = law->at(c, k, 0.01 + 1e-7), tighter = law->at(c, k, 0.01 - 1e-7);
    EXPECT_NEAR((wider.F - tighter.F) / 2e-7, law->slopes(c, k, 0.01)[0].F, 1e-2) << c;
  }
}

TEST(FormulaLaw, IsASpringThatSaysWhereItComesFrom) {
  const auto law = read(R"({"type": "formula", "formula": "huth bolt", "mode": "total", "shear": "single", "t": [2, 3],
                            "E": [72000, 72000], "d": 5, "E_f": 110000})");
  const Branch on = law->at(1000, 1e4, 0);
  EXPECT_NEAR(on.delta / on.F, 2.903227e-5, 5e-12);
  ASSERT_TRUE(law->source());
  EXPECT_TRUE(law->source()->bearing_of_sheet);
  EXPECT_THAT(law->source()->text, HasSubstr("huth bolt in single shear, total"));
  EXPECT_FALSE(read(R"({"type": "linear", "k": 1})")->source());
}

struct Refusal {
  const char* json;
  const char* message;
};
class LawRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(LawRefuses, WithPointerFoundAndAllowed) {
  EXPECT_THAT([] { (void)read(GetParam().json); }, ThrowsMessage<InputError>(HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    Each, LawRefuses,
    testing::Values(
        Refusal{R"({"type": "glue"})", R"(/type: "glue" is not allowed; allowed: "linear", "power", "cubic", )"},
        Refusal{R"({"k": 1})", R"(key "type" is missing)"},
        Refusal{R"({"type": "linear", "k": 0})", "/k: 0 is not allowed; allowed: a number > 0"},
        Refusal{R"({"type": "linear", "k": 1, "n": 1})", "/n: unknown key; allowed: type, k, one_sided"},
        Refusal{R"({"type": "power", "A": -1, "n": 1})", "/A: -1 is not allowed; allowed: a number > 0"},
        Refusal{R"({"type": "power", "A": 1, "n": 1.1})", "/n: 1.1 is not allowed; allowed: a number > 0 and <= 1"},
        Refusal{R"({"type": "power", "A": 1, "n": 0})", "/n: 0 is not allowed; allowed: a number > 0 and <= 1"},
        Refusal{R"({"type": "power", "A": 1, "n": 1, "delta0": -1})",
                "/delta0: -1 is not allowed; allowed: a number >= 0"},
        Refusal{R"({"type": "bilinear", "k": 1, "F_yield": 0, "k_yield": 1})",
                "/F_yield: 0 is not allowed; allowed: a number > 0"},
        Refusal{R"({"type": "bilinear", "k": 1, "F_yield": 1, "k_yield": -1})",
                "/k_yield: -1 is not allowed; allowed: a number >= 0"},
        Refusal{R"({"type": "four stage", "k_stick": 1, "F_slip": 5, "slip": 0, "k_bearing": 1, "F_yield": 5,
                    "k_yield": 0})",
                "/F_yield: 5; allowed: more than F_slip = 5"},
        Refusal{R"({"type": "table", "delta": [1, 2], "F": [1, 2, 3]})", "/F: array of 3; allowed: exactly 2"},
        Refusal{R"({"type": "table", "delta": [1, 1], "F": [1, 2]})",
                "delta = 1 after 1; allowed: displacements that rise"},
        Refusal{R"({"type": "table", "delta": [1, 2], "F": [2, 1]})",
                "F = 1 at delta = 2 after 2; allowed: forces that do not fall: smooth the data, or fit a law to it "
                "(scripts/fit_law)"},
        Refusal{R"({"type": "table", "delta": [0, 2], "F": [0, 1]})", "1 point beyond (0, 0); allowed: at least 2"},
        Refusal{R"({"type": "table", "delta": [0, 1, 2], "F": [5, 6, 7]})",
                "F = 5 at delta = 0; allowed: 0 there: stiff contact is a power law"},
        Refusal{R"({"type": "table", "delta": [1, 2], "F": [0, 0]})", "no force at any point; allowed: a force > 0"},
        Refusal{R"({"type": "table", "file": "a.csv", "F": [1]})", "/F: unknown key"},
        Refusal{R"({"type": "cubic", "delta": [1, 2], "F": [1, 2, 3]})", "/delta: array of 2; allowed: exactly 3"},
        Refusal{R"({"type": "cubic", "delta": [1, 2, 1], "F": [1, 2, 3]})",
                "/delta: [1,2,1] is not allowed; allowed: three different displacements"},
        Refusal{R"({"type": "cubic", "delta": [0, 1, 2], "F": [1, 2, 3]})",
                "/delta/0: 0 is not allowed; allowed: a number > 0"},
        Refusal{R"({"type": "cubic", "delta": [1, 2, 3], "F": [1, -2, 3]})",
                "/F/1: -2 is not allowed; allowed: a number > 0"}));

}  // namespace
}  // namespace fastjoint::stage3
