// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "common/errors.hpp"
#include "stage3_nonlinear/laws/law.hpp"
#include "tests/stage3_nonlinear/scenes.hpp"

namespace fastjoint::stage3::law_refusals_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

struct Refusal {
  const char* json;
  const char* message;
};
class LawRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(LawRefuses, WithPointerFoundAndAllowed) {
  EXPECT_THAT([] { (void)test::law_of(GetParam().json); }, ThrowsMessage<InputError>(HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    Each, LawRefuses,
    testing::Values(
        Refusal{R"({"type": "glue"})", R"(/type: "glue" is not allowed; allowed: "linear", "power", "cubic", )"},
        Refusal{R"({"k": 1})", R"(key "type" is missing)"},
        Refusal{R"({"type": "linear", "k": 0})", "/k: 0 is not allowed; allowed: a number > 0"},
        Refusal{R"({"type": "linear", "k": 1, "n": 1})", "/n: unknown key; allowed: type, k, one_sided"},
        Refusal{R"({"type": "rigid", "k": 1})", "/k: unknown key; allowed: type, one_sided"},
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
}  // namespace fastjoint::stage3::law_refusals_test
