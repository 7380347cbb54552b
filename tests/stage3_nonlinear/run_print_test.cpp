// SPDX-License-Identifier: GPL-3.0-or-later
// What the summary says, and with which signs.
#include <fmt/format.h>

#include "tests/stage3_nonlinear/run_fixture.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A plate's stresses at p = 8 around its first hole, which is open to waves: a hoop stress of 1 per unit of its disc.
void add_stresses(formats::PlateMatrices& plate) {
  auto& a = plate.stresses;
  a.p = Eigen::VectorXi::Constant(1, 8);
  a.rim_hole = {plate.disc_hole[0]};
  a.rim_center = Eigen::MatrixXd::Zero(1, 2);
  a.rim_radius = a.rim_thickness = Eigen::VectorXd::Ones(1);
  a.bearing_area = a.rim_modulus = Eigen::MatrixXd::Constant(1, 2, 2);
  auto& rim = plate.waves.emplace_back(formats::WaveRim{plate.disc_hole[0], {2}, 1, 1, 0});
  rim.compliance = Eigen::Vector3d(1, 1, 2).asDiagonal();
  a.other_waves = {MatrixXd::Zero(rim.size(), plate.n_cases())};
  a.other_waves[0](0, plate.n_externals()) = -1;
  a.gross_area = a.net_area = Eigen::VectorXd(0);
  a.section_force = a.section_shear = {MatrixXd::Zero(0, plate.n_cases())};
  a.stiffness_error = Eigen::VectorXd::Zero(1);
}

TEST_F(Run, PrintsTheStressesOfEveryIncrementIfAsked) {
  auto lap = test::two_fastener_lap();
  add_stresses(lap.b);
  write({{"increments", "3"}}, lap);
  run();
  EXPECT_THAT(out_.str(),
              AllOf(HasSubstr("stresses at the last increment\n"), Not(HasSubstr("stresses at increment"))));
  out_.str("");
  write({{"increments", "[1, 0.5, 0]"}}, lap);
  run();
  EXPECT_THAT(out_.str(), HasSubstr("stresses at the last increment, whose load is not the largest (--all-stresses "
                                    "prints every increment)\n"));
  write({{"increments", "3"}}, lap);
  out_.str("");
  options_.options["--all-stresses"] = "given";
  run();
  for (const char* each : {"1", "2", "3"})
    EXPECT_THAT(out_.str(), HasSubstr(fmt::format("stresses at increment {}\n", each)));
  EXPECT_THAT(out_.str(), Not(HasSubstr("the last increment")));
}

/// schemas/joint-result.md, Signs: whichever plate stands first.
TEST_F(Run, ForcesHaveTheSignsThatThePageSays) {
  for (const bool pulled_first : {true, false}) {
    auto lap = test::two_fastener_lap();
    add_stresses(lap.a);
    add_stresses(lap.b);
    write({{"fasteners", fmt::format(R"([{{"id": "f1", "between": ["{}:1", "{}:1"], "law": "lin"}},
                                         {{"id": "f2", "between": ["{}:2", "{}:2"], "law": "lin"}}])",
                                     pulled_first ? "a" : "b", pulled_first ? "b" : "a", pulled_first ? "a" : "b",
                                     pulled_first ? "b" : "a")}},
          lap);
    out_.str("");
    run();
    const auto a = result();
    const double sign = pulled_first ? 1 : -1;  // plate a is pulled along +x, so that the fasteners push b that way
    EXPECT_NEAR(a.F(0, 0), sign * 50, 1e-9);
    EXPECT_NEAR(a.transferred(0, 0), sign * 50, 1e-9);
    EXPECT_NEAR(a.transferred(0, 1), sign * 50, 1e-9);
    EXPECT_GT(sign * a.delta(0, 0), 0);
    EXPECT_NEAR(a["plates/a/Pe"](0, 0), 100, 1e-9);
    EXPECT_NEAR(a["plates/a/rim/bearing_load"](0, 0), -50, 1e-9);
    EXPECT_NEAR(a["plates/b/rim/bearing_load"](0, 0), 50, 1e-9);
    EXPECT_THAT(out_.str(), HasSubstr("  a                         100             -100                    0\n"
                                      "  b                           0              100                 -100\n"));
    EXPECT_THAT(out_.str(),
                HasSubstr("  forces on a plate are positive along +x, +y; delta = D(first plate) - D(second "
                          "plate), and F > 0 (F_x, F_y > 0 where there are two) pushes the second along +\n"
                          "  share: of what all fasteners transfer between the same two plates, friction "
                          "included\n"));
    EXPECT_EQ(out_.str().find("share: "), out_.str().rfind("share: ")) << "once";
  }
}

TEST_F(Run, CountsOneAsOne) {
  write({{"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin"}])"}});
  run();
  EXPECT_THAT(out_.str(), StartsWith("joint: 2 plates, 1 fastener, p = 8, hybridsj\n"));
  EXPECT_THAT(out_.str(),
              HasSubstr(fmt::format("  tangent stiffness at a:P: {:.6g} ", result()["stiffness/tangent"](0, 0))));
}

}  // namespace
}  // namespace fastjoint::stage3
