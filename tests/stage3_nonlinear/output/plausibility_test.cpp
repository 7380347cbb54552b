// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers that hardly any joint has are said, with where they stand and what they may be; those of real joints are not.
#include "tests/stage3_nonlinear/run_fixture.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr double E = 72000, t = 2, radius = 2.5;

/// Sheets with n fasteners 20 apart along x, described as stage 2 does; `shift` moves the second sheet's drawing.
test::Lap described(int n, const Eigen::Vector2d& shift = {0, 0}) {
  const auto sheet = [&](int externals, const std::vector<test::Spring>& held, const Eigen::Vector2d& origin) {
    auto plate = test::chain(n, externals, 1e4, held);
    auto& a = plate.stresses;
    a.rim_hole = plate.disc_hole;
    a.rim_radius = Eigen::VectorXd::Constant(n, radius);
    a.rim_thickness = Eigen::VectorXd::Constant(n, t);
    a.rim_modulus = Eigen::MatrixXd::Constant(n, 2, E);
    a.bearing_area = Eigen::MatrixXd::Constant(n, 2, 2 * radius * t);
    a.rim_center.resize(n, 2);
    for (int i = 0; i < n; ++i) a.rim_center.row(i) = (origin + 20 * i * Eigen::Vector2d::UnitX()).transpose();
    return plate;
  };
  return {sheet(1, {{0, n, 1e4}}, {0, 0}), sheet(0, {{n - 1, test::ground, 1e4}}, shift)};
}

/// Fasteners "f1", ... with what else they have, by the holes of the second sheet.
Members fasteners(const std::vector<int>& second, const std::string& more = "") {
  std::string list;
  for (Index i = 0; i < std::ssize(second); ++i)
    list += (i == 0 ? "" : ", ") + std::string(R"({"id": "f)") + std::to_string(i + 1) + R"(", "between": ["a:)" +
            std::to_string(i + 1) + R"(", "b:)" + std::to_string(second[i]) + R"("], "law": "lin")" + more + "}";
  return {{"fasteners", "[" + list + "]"}};
}

class Plausibility : public Run {
 protected:
  std::string warnings(const Members& members, const test::Lap& lap) {
    write(members, lap);
    log_.str("");
    run();
    return log_.str();
  }
};

TEST_F(Plausibility, NothingIsSaidOfAJointThatFits) {
  EXPECT_EQ(warnings(fasteners({1, 2, 3}, R"(, "clearance": 0.1)"), described(3)), "");
}

TEST_F(Plausibility, SwappedHolesAreNamed) {
  const std::string said = warnings(fasteners({1, 3, 2, 4}), described(4));
  EXPECT_THAT(said, AllOf(HasSubstr("[holes-apart]: "), HasSubstr("joint.json: /fasteners/1/between: "),
                          HasSubstr("\"a:2\" and \"b:3\" are 20 apart, more than a tenth of the radius 2.5"),
                          HasSubstr(" (1 more of this kind, this is the worst)\n")));
}

TEST_F(Plausibility, TheOnlyFastenerOfTwoSheetsIsComparedAsTheyAreDrawn) {
  EXPECT_EQ(warnings(fasteners({1}), described(1)), "");
  EXPECT_THAT(warnings(fasteners({1}), described(1, {0, 18})), HasSubstr("\"b:1\" are 18 apart"));
}

TEST_F(Plausibility, TheGroundHasNoHoleToCompareWith) {
  const auto held = [](const std::string& more) {
    return Members{
        {"plates", R"({"a": "a.h5"})"},
        {"laws", R"({"lin": {"type": "formula", "formula": "swift", "mode": "fastener only", "shear": "single",
                             "t": [2, 9], "E": [72000, 9000], "d": 5, "E_f": 110000}})"},
        {"fasteners", R"([{"id": "f1", "between": ["a:1", "ground"], "law": "lin"},
                          {"id": "f2", "between": ["a:2", "ground"], "law": "lin"},
                          {"id": "f3", "between": ["a:3", "ground"], "law": "lin")" +
                          more + "}]"}};
  };
  EXPECT_EQ(warnings(held(""), described(3)), "");
  EXPECT_THAT(
      warnings(held(R"(, "clearance": 3)"), described(3)),
      AllOf(HasSubstr("[gap-unlikely]: "), HasSubstr("/fasteners/2/clearance: the gap 3 "), HasSubstr("radius 2.5")));
}

TEST_F(Plausibility, SheetsMayHaveCoordinatesOfTheirOwn) {
  EXPECT_EQ(warnings(fasteners({1, 2, 3}), described(3, {-100, 30})), "");
  const std::string said = warnings(fasteners({1, 2, 4, 3, 5}), described(5, {-100, 30}));
  EXPECT_THAT(said, AllOf(HasSubstr("/fasteners/2/between"), HasSubstr("(1 more of this kind, this is the worst)"),
                          Not(HasSubstr("/fasteners/0/")), Not(HasSubstr("/fasteners/1/"))));
}

TEST_F(Plausibility, OneOfTwoFastenersIsEnoughToTellWhichIsOff) {
  auto lap = described(3);
  lap.b.stresses.rim_center.row(1) << 38, 0;
  const std::string said = warnings(fasteners({1, 2, 3}), lap);
  EXPECT_THAT(said, AllOf(HasSubstr("/fasteners/1/between"), HasSubstr(" 18 apart"), Not(HasSubstr("/fasteners/0/"))));
}

TEST_F(Plausibility, GapsAboveARadiusAreNamed) {
  EXPECT_THAT(warnings(fasteners({1}, R"(, "clearance": 2.6)"), described(1)),
              AllOf(HasSubstr("[gap-unlikely]: "), HasSubstr("joint.json: /fasteners/0/clearance: the gap 2.6 "),
                    HasSubstr("law \"lin\""), HasSubstr("radius 2.5 ")));
}

TEST_F(Plausibility, FrictionAboveOneIsNamed) {
  auto lap = described(1);
  std::mt19937 random(7);
  test::add_friction(lap.a, random);
  test::add_friction(lap.b, random);
  const auto said = [&](const char* mu) {
    write(fasteners({1}, std::string(R"(, "friction": )") + mu), lap);
    log_.str("");
    try {
      run();
    } catch (const std::exception&) {  // such friction may lock the joint
    }
    return log_.str();
  };
  EXPECT_THAT(said("15"),
              AllOf(HasSubstr("[friction-unlikely]: "), HasSubstr("joint.json: /fasteners/0/friction: 15 is above 1")));
  EXPECT_THAT(said("0.15"), Not(HasSubstr("[friction-unlikely]")));
}

std::string formula(const std::string& thickness, const std::string& modulus, const std::string& diameter) {
  return R"({"lin": {"type": "formula", "formula": "swift", "mode": "total", "shear": "single", "t": )" + thickness +
         R"(, "E": )" + modulus + R"(, "d": )" + diameter + R"(, "E_f": 110000}})";
}

TEST_F(Plausibility, AFormulaForOtherSheetsIsNamedOnce) {
  auto lap = described(2);
  lap.b.stresses.rim_thickness.setConstant(3);
  auto members = fasteners({1, 2}, R"(, "clearance": 0.1)");
  members["laws"] = formula("[3, 2]", "[73000, 71000]", "4.8");
  EXPECT_EQ(warnings(members, lap), "") << "either order of sheets, a shank a little thinner than its hole";
  members["laws"] = formula("[2.1, 3]", "[72, 72]", "2.5");
  const std::string said = warnings(members, lap);
  EXPECT_THAT(said, AllOf(HasSubstr("[formula-sheets-unlike]: "), HasSubstr("joint.json: /laws/lin: "),
                          HasSubstr("t = 2.1, 3 instead of 2, 3, E = 72, 72 instead of 72000, 72000, d = 2.5, 2.5 "
                                    "instead of 5, 5 of the sheets at fastener \"f1\": ")));
  EXPECT_EQ(said.find("[formula-sheets-unlike]"), said.rfind("[formula-sheets-unlike]"));
  lap.b.stresses.rim_thickness.setZero();  // as a file of an earlier version has it
  members["laws"] = formula("[2, 7]", "[72000, 72000]", "5");
  EXPECT_EQ(warnings(members, lap), "");
}

/// Each has its sheet's thickness beside its modulus; in double shear the middle sheet comes first.
TEST_F(Plausibility, AFormulaHasTheSheetsInItsOrder) {
  auto lap = described(1);
  lap.b.stresses.rim_thickness.setConstant(3);
  lap.b.stresses.rim_modulus.setConstant(10000);
  auto members = fasteners({1});
  members["laws"] = formula("[3, 2]", "[10000, 72000]", "5");
  EXPECT_EQ(warnings(members, lap), "");
  members["laws"] = formula("[3, 2]", "[72000, 10000]", "5");
  EXPECT_THAT(warnings(members, lap), HasSubstr("[formula-sheets-unlike]"));
  members["plates"] = R"({"a": "a.h5", "b": "b.h5", "c": "b.h5"})";
  members["fasteners"] = R"([{"id": "f1", "between": ["b:1", "a:1", "c:1"], "law": "lin"}])";
  const auto huth = [](const char* shear, const char* sheets) {
    return R"({"lin": {"type": "formula", "formula": "huth bolt", "mode": "total", "d": 5, "E_f": 210000, "shear": ")" +
           std::string(shear) + "\", " + sheets + "}}";
  };
  constexpr const char *middle_first = R"("t": [2, 3], "E": [72000, 10000])",
                       *strap_first = R"("t": [3, 2], "E": [10000, 72000])";
  members["laws"] = huth("double", middle_first);
  EXPECT_EQ(warnings(members, lap), "");
  members["laws"] = huth("double", strap_first);
  EXPECT_THAT(warnings(members, lap),
              AllOf(HasSubstr("[formula-sheets-unlike]: "), HasSubstr("t = 3, 2 instead of 2, 3")));
  members["laws"] = huth("single", strap_first);
  EXPECT_THAT(warnings(members, lap),
              AllOf(HasSubstr("[formula-shear-unlike]: "), HasSubstr("joint.json: /laws/lin/shear: \"single\", "),
                    HasSubstr(" 3 sheets")));
  members["fasteners"] = R"([{"id": "f1", "between": ["b:1", "a:1", "c:1", "ground"], "law": "lin"}])";
  EXPECT_THAT(warnings(members, lap), Not(HasSubstr("[formula-shear-unlike]")))
      << "the ground may stand for any number of sheets";
  members = fasteners({1});
  members["laws"] = huth("double", middle_first);
  EXPECT_THAT(warnings(members, lap),
              AllOf(HasSubstr("[formula-shear-unlike]: "), HasSubstr("joint.json: /laws/lin/shear: \"double\", "),
                    HasSubstr(" 2 sheets")));
}

TEST_F(Plausibility, DiametersThatContradictEachOtherAreNamedWhateverTheLaw) {
  const std::string diameter = "/fasteners/0/hole_diameter: ";
  EXPECT_THAT(warnings(fasteners({1}, R"(, "diameter": 5.3, "hole_diameter": 5.3)"), described(1)),
              AllOf(HasSubstr("[hole-diameter-unlike]: "),
                    HasSubstr("joint.json: " + diameter + "5.3 for hole \"a:1\", "), HasSubstr(" is 5: ")));
  EXPECT_EQ(warnings(fasteners({1}, R"(, "diameter": 5.25, "hole_diameter": 5.25)"), described(1)), "");
  auto lap = described(1);
  lap.b.stresses.rim_radius.setConstant(2.7);
  EXPECT_THAT(warnings(fasteners({1}), lap),
              AllOf(HasSubstr("[sheet-diameters-unlike]: "), HasSubstr("joint.json: /fasteners/0/between: "),
                    HasSubstr("\"a:1\" and \"b:1\" have the diameters 5 and 5.4 ")));
  EXPECT_EQ(warnings(fasteners({1}, R"(, "clearance": 0.2)"), lap), "") << "that explains it";
  EXPECT_EQ(warnings(fasteners({1}, R"(, "clearance": 0.2)"), described(1)), "");
}

/// A shank much thinner than the holes of its sheets; one that says how wide they are means it.
TEST_F(Plausibility, ADiameterOfAnotherFastenerIsNamed) {
  auto lap = described(1);
  for (auto* plate : {&lap.a, &lap.b}) test::add_contact(*plate, "1", radius);
  EXPECT_THAT(warnings(fasteners({1}, R"(, "diameter": 3.5)"), lap),
              AllOf(HasSubstr("[gap-unlikely]: "),
                    HasSubstr("joint.json: /fasteners/0/diameter: a gap of 0.75 at hole \"a:1\" of radius 2.5")));
  EXPECT_THAT(warnings(fasteners({1}, R"(, "diameter": 3.5, "hole_diameter": 5)"), lap), Not(HasSubstr("/diameter")));
  EXPECT_THAT(warnings(fasteners({1}, R"(, "diameter": 4)"), lap), Not(HasSubstr("/diameter")))
      << "a coarse clearance hole, as M8 in 10 mm";
  auto members = fasteners({1}, R"(, "gap": 0.3)");
  members["laws"] = formula("[2, 2]", "[72000, 72000]", "4.4");
  EXPECT_THAT(warnings(members, lap), Not(HasSubstr("[formula-sheets-unlike]")))
      << "a shank as thin as the gap leaves it";
}

TEST_F(Plausibility, DisplacementsAboveARadiusAreNamedOnceWithTheirIncrement) {
  auto members = fasteners({1});
  members["loads"] = R"([{"external": "a:P", "force": 4000}])";
  members["increments"] = "4";
  const std::string said = warnings(members, described(1));
  EXPECT_THAT(said, AllOf(HasSubstr("[units-mixed]: "), HasSubstr("joint.json: fastener \"f1\": |delta| = 3 "),
                          HasSubstr("radius 2.5 "), HasSubstr(" increment 3: ")));
  EXPECT_EQ(said.find("delta| = "), said.rfind("delta| = "));
}

TEST_F(Plausibility, ForcesThatWouldCrushTheSheetAreNamed) {
  auto lap = described(1);
  auto members = fasteners({1});
  members["loads"] = R"([{"external": "a:P", "force": 1000}])";
  EXPECT_EQ(warnings(members, lap), "");
  lap.a.stresses.rim_modulus.setConstant(72);  // GPa beside N and mm
  EXPECT_THAT(warnings(members, lap),
              AllOf(HasSubstr("[units-mixed]: "), HasSubstr("joint.json: fastener \"f1\": |F| = 1000 "),
                    HasSubstr("d t E = 720 "), HasSubstr(" increment 1: ")));
}

}  // namespace
}  // namespace fastjoint::stage3
