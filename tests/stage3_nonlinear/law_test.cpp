// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/law.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "common/errors.hpp"
#include "stage3_nonlinear/cubic_law.hpp"
#include "stage3_nonlinear/power_law.hpp"

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

void expect_derivatives(const Law& law, double s, double k) {
  const double h = 1e-6 * s;
  const Branch at = law.beyond(s, k), above = law.beyond(s + h, k), below = law.beyond(s - h, k);
  // Central differences of a smooth function: h^2 + eps / h, relative.
  EXPECT_NEAR((above.F - below.F) / (2 * h), at.dF, 1e-8 * std::abs(at.dF) + 1e-10);
  EXPECT_NEAR((above.stretch - below.stretch) / (2 * h), at.dstretch, 1e-8 * at.dstretch);
}

TEST(PowerLaw, IsEquation7) {
  const PowerLaw law(200, 0.6, 0.02);
  EXPECT_DOUBLE_EQ(law.delta0(), 0.02);
  for (const double F : {1e-3, 1.0, 50.0, 1e4}) {
    const Branch branch = law.beyond(law.coordinate(F, 7), 7);
    EXPECT_DOUBLE_EQ(branch.F, F);
    EXPECT_NEAR(200 * std::pow(branch.stretch, 0.6), F, 1e-14 * F);
    expect_derivatives(law, F, 7);
  }
  EXPECT_FALSE(law.stiffness());
}

TEST(PowerLaw, IsRigidAtFirstContact) {
  const Branch contact = PowerLaw(200, 0.6, 0).beyond(0, 7);
  EXPECT_EQ(contact.F, 0);
  EXPECT_EQ(contact.stretch, 0);
  EXPECT_EQ(contact.dF, 1);
  EXPECT_EQ(contact.dstretch, 0);
}

TEST(PowerLaw, WithExponentOneIsTheLinearLaw) {
  const auto power = read(R"({"type": "power", "A": 500, "n": 1})");
  const auto linear = read(R"({"type": "linear", "k": 500, "one_sided": true})");
  EXPECT_EQ(power->stiffness().value(), 500);
  EXPECT_EQ(linear->stiffness().value(), 500);
  EXPECT_EQ(linear->beyond(5, 1).stretch, power->beyond(5, 1).stretch);
}

TEST(PowerLaw, WarnsBelowThePracticalRange) {
  EXPECT_THAT(PowerLaw(1, 0.4, 0).doubts(), IsEmpty());
  EXPECT_THAT(PowerLaw(1, 0.3, 0).doubts(), ElementsAre(HasSubstr("n = 0.3 is below the practical range 0.4 to 1")));
}

TEST(CubicLaw, GoesThroughItsPointsInAnyOrder) {
  for (const CubicLaw& law :
       {CubicLaw({0.01, 0.02, 0.04}, {900, 1500, 2000}), CubicLaw({0.04, 0.01, 0.02}, {2000, 900, 1500})}) {
    constexpr double k = 1e5;
    EXPECT_NEAR(law.beyond(k * 0.01, k).F, 900, 1e-10);
    EXPECT_NEAR(law.beyond(k * 0.02, k).F, 1500, 1e-10);
    EXPECT_NEAR(law.beyond(k * 0.04, k).F, 2000, 1e-10);
    EXPECT_EQ(law.beyond(0, k).F, 0);
    EXPECT_EQ(law.last_stretch(), 0.04);
    EXPECT_DOUBLE_EQ(law.beyond(k * 0.013, k).stretch, 0.013);
    expect_derivatives(law, k * 0.013, k);
  }
}

TEST(CubicLaw, IsEquation8) {
  const double d0 = 0.01, d1 = 0.02, d2 = 0.04, F0 = 900, F1 = 1500, F2 = 2000, d = 0.031;
  const double F = F0 * (d - d1) * (d - d2) * d / ((d0 - d1) * (d0 - d2) * d0) +
                   F1 * (d - d0) * (d - d2) * d / ((d1 - d0) * (d1 - d2) * d1) +
                   F2 * (d - d0) * (d - d1) * d / ((d2 - d0) * (d2 - d1) * d2);
  EXPECT_NEAR(CubicLaw({d0, d1, d2}, {F0, F1, F2}).beyond(d, 1).F, F, 1e-9);
}

TEST(CubicLaw, NeverPushesOn) {
  // x (1.1 - 0.1 x) is back at zero at x = 11.
  const CubicLaw law({1, 2, 3}, {1, 1.8, 2.4});
  EXPECT_NEAR(law.beyond(10, 1).F, 1, 1e-12);
  EXPECT_FALSE(law.beyond(10, 1).spent);
  EXPECT_TRUE(law.beyond(12, 1).spent);
  EXPECT_EQ(law.beyond(12, 1).F, 0);
  EXPECT_EQ(law.beyond(12, 1).dF, 0);
  EXPECT_EQ(law.beyond(12, 1).stretch, 12);
}

TEST(CubicLaw, WarnsWhereItTurnsDown) {
  EXPECT_THAT(CubicLaw({1, 2, 3}, {1, 1.6, 2.4}).doubts(), IsEmpty());
  // F = x (6.5 - 4.75 x + x^2): slope 6.5 - 9.5 x + 3 x^2 falls below zero between 1 and 2, at x = 19/12
  // by 1.0208.
  EXPECT_THAT(CubicLaw({1, 2, 3}, {2.75, 2, 3.75}).doubts(),
              ElementsAre(HasSubstr("slope at delta = 1.583 is -1.021; the joint may have more than one solution")));
  EXPECT_THAT(CubicLaw({1, 2, 3}, {1, 1.5, 1.2}).doubts(), ElementsAre(HasSubstr("slope at delta = 3 ")));
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
        Refusal{R"({"type": "glue"})", R"(/type: "glue" is not allowed; allowed: "linear", "power", "cubic")"},
        Refusal{R"({"k": 1})", R"(key "type" is missing)"},
        Refusal{R"({"type": "linear", "k": 0})", "/k: 0 is not allowed; allowed: a number > 0"},
        Refusal{R"({"type": "linear", "k": 1, "n": 1})", "/n: unknown key; allowed: type, k, one_sided"},
        Refusal{R"({"type": "power", "A": -1, "n": 1})", "/A: -1 is not allowed; allowed: a number > 0"},
        Refusal{R"({"type": "power", "A": 1, "n": 1.1})", "/n: 1.1 is not allowed; allowed: a number > 0 and <= 1"},
        Refusal{R"({"type": "power", "A": 1, "n": 0})", "/n: 0 is not allowed; allowed: a number > 0 and <= 1"},
        Refusal{R"({"type": "power", "A": 1, "n": 1, "delta0": -1})",
                "/delta0: -1 is not allowed; allowed: a number >= 0"},
        Refusal{R"({"type": "cubic", "delta": [1, 2], "F": [1, 2, 3]})", "/delta: array of 2; allowed: exactly 3"},
        Refusal{R"({"type": "cubic", "delta": [1, 2, 1], "F": [1, 2, 3]})",
                "/delta: [1,2,1] is not allowed; allowed: three different displacements"},
        Refusal{R"({"type": "cubic", "delta": [0, 1, 2], "F": [1, 2, 3]})",
                "/delta/0: 0 is not allowed; allowed: a number > 0"},
        Refusal{R"({"type": "cubic", "delta": [1, 2, 3], "F": [1, -2, 3]})",
                "/F/1: -2 is not allowed; allowed: a number > 0"}));

}  // namespace
}  // namespace fastjoint::stage3
