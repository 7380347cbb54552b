// SPDX-License-Identifier: GPL-3.0-or-later
// What all laws have in common.
#include "stage3_nonlinear/laws/law.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <map>

#include "tests/stage3_nonlinear/scenes.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

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
  std::shared_ptr<const Law> law_ = test::law_of(json(example_, example_.number));
};

TEST_P(EachLaw, IsItsCurve) {
  EXPECT_EQ(law_->rises(), example_.rises);
  for (const double clearance : {0.0, 0.013})
    for (double c = 0; c < 8000; c += 61.3) {
      const Branch on = law_->at(c, k, clearance);
      EXPECT_NEAR(on.F, example_.F(example_.number, on.delta, clearance), 1e-9 * (1 + c)) << "c = " << c;
      EXPECT_NEAR(example_.rises ? on.F + k * on.delta : k * on.delta, c, 1e-12 * (1 + c));
      EXPECT_FALSE(on.failed);
    }
}

/// Error of central differences ~ h^2 + eps / h, relative; corners are left out.
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
      if (std::abs(above.dF - on.dF) > 1e-3 || std::abs(below.dF - on.dF) > 1e-3) return;  // a corner passes
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
        return test::law_of(json(example_, number))->at(c, k, clearance);
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

TEST(PiecewiseLinearLaw, HasCornersWhereItsSlopeJumps) {
  const auto law = test::law_of(R"({"type": "bilinear", "k": 100, "F_yield": 10, "k_yield": 0})");
  EXPECT_THAT(law->corners(50, 0).value(), ElementsAre(15));
  EXPECT_THAT(law->corners(50, 0.2).value(), ElementsAre(10, 25));
  EXPECT_EQ(law->at(1000, 50, 0).F, 10) << "perfectly plastic";
  EXPECT_EQ(law->at(1000, 50, 0).dF, 0);
  EXPECT_THAT(test::law_of(R"({"type": "linear", "k": 100})")->corners(50, 0).value(), IsEmpty());
}

TEST(RigidLaw, DoesNotMovePastItsClearance) {
  const auto law = test::law_of(R"({"type": "rigid"})");
  constexpr double k = 4e4;
  EXPECT_THAT(law->parameters(), IsEmpty());
  EXPECT_THAT(law->corners(k, 0).value(), IsEmpty());
  for (const double c : {0.0, 1.0, 8000.0}) {
    const Branch on = law->at(c, k, 0);
    EXPECT_EQ(on.F, c);
    EXPECT_EQ(on.delta, 0);
    EXPECT_EQ(on.dF, 1);
    EXPECT_EQ(on.ddelta, 0);
    EXPECT_EQ(law->coordinate(c, k, 0), c);
  }
  constexpr double gap = 0.013;
  EXPECT_THAT(law->corners(k, gap).value(), ElementsAre(k * gap));
  EXPECT_EQ(law->at(500, k, gap).F, 0);
  EXPECT_DOUBLE_EQ(law->at(500, k, gap).delta, 500 / k);
  EXPECT_DOUBLE_EQ(law->at(500, k, gap).ddelta, 1 / k);
  EXPECT_EQ(law->slopes(500, k, gap)[0].F, 0);
  EXPECT_DOUBLE_EQ(law->at(800, k, gap).F, 800 - k * gap);
  EXPECT_EQ(law->at(800, k, gap).delta, gap);
  EXPECT_DOUBLE_EQ(law->slopes(800, k, gap)[0].F, -k);
  EXPECT_DOUBLE_EQ(law->slopes(800, k, gap)[0].delta, 1);
  EXPECT_DOUBLE_EQ(law->coordinate(30, k, gap), 30 + k * gap);
}

}  // namespace
}  // namespace fastjoint::stage3
