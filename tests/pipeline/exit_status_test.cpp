// SPDX-License-Identifier: GPL-3.0-or-later
// Every way to fail that a user meets: status, message, and that the output of an earlier run survives.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <memory>

#include "common/h5/writer.hpp"
#include "tests/pipeline/programs.hpp"
#include "tests/support/result.hpp"

namespace fastjoint {
namespace {

using test::replaced;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class ExitStatus : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    test::make_matrices(*folder_);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  void SetUp() override { folder_->write("out.h5", "earlier result"); }
  void TearDown() override { EXPECT_EQ(test::read_file(folder_->path("out.h5")), "earlier result"); }

  static void expect(const test::Run& run, int status, const testing::Matcher<std::string>& message) {
    EXPECT_EQ(run.status, status) << run.err;
    EXPECT_THAT(run.err, message);
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;  // one line
    EXPECT_EQ(run.out, "");
  }
  static void plate(const std::string& json, int status, const testing::Matcher<std::string>& message) {
    folder_->write("plate.json", json);
    expect(test::stage1(*folder_, "plate.json -o out.h5"), status,
           AllOf(StartsWith("stage1_plate: error: plate.json: "), message));
  }
  static void joint(const std::string& json, int status, const testing::Matcher<std::string>& message) {
    folder_->write("joint.json", json);
    expect(test::stage3(*folder_, "joint.json -o out.h5"), status,
           AllOf(StartsWith("stage3_nonlinear: error: "), message));
  }
  static std::string center(const std::string& what, const std::string& by) {
    return replaced(test::example("center.json"), what, by);
  }
  static std::string bolts(const std::string& what, const std::string& by) {
    return replaced(test::three_fastener_joint(1000, 1000), what, by);
  }

  static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> ExitStatus::folder_;

TEST_F(ExitStatus, MissingFiles) {
  const std::string missing = ": error: none: cannot be opened: No such file or directory";
  expect(test::stage1(*folder_, "none -o out.h5"), 3, HasSubstr(missing));
  expect(test::stage2(*folder_, "none -o out.h5"), 3, HasSubstr(missing));
  expect(test::stage3(*folder_, "none -o out.h5"), 3, HasSubstr(missing));
  joint(bolts("doubler.m.h5", "gone.h5"), 3,
        HasSubstr("joint.json: /plates/doubler: gone.h5: cannot be opened: No such file or directory; stage2_extract "
                  "PLATE.h5 -o gone.h5 makes it"));
}

TEST_F(ExitStatus, MalformedJson) {
  plate("{\n  \"format\": \"plate\",\n  \"version\" 1}", 2, HasSubstr("not valid JSON at line 3, column"));
  joint("{\"format\": ", 2, HasSubstr("joint.json: not valid JSON at line 1, column"));
  plate(center("\"analysis\"", "\"analysis\": \"plane stress\", \"analysis\""), 2,
        HasSubstr("key \"analysis\" stands twice"));
}

TEST_F(ExitStatus, KeysTypesAndRanges) {
  plate(center("\"radius\"", "\"raduis\""), 2,
        AllOf(HasSubstr("/holes/0/raduis: unknown key"), HasSubstr("allowed: ")));
  plate(center("\"nu\": 0.3}}", "\"nu\": \"0.3\"}}"), 2, HasSubstr("/materials/al/nu: \"0.3\" is not allowed"));
  plate(center("\"radius\": 0.15", "\"radius\": 0"), 2,
        HasSubstr("/holes/0/radius: 0 is not allowed; allowed: a number > 0"));
  plate(center("\"E\": 1e7", "\"E\": -1e7"), 2, HasSubstr("/materials/al/E: -10000000.0 is not allowed"));
  plate(replaced(center("plane stress", "plane strain"), "\"nu\": 0.3", "\"nu\": 0.5"), 2,
        HasSubstr("/materials/al/nu: 0.5 is not allowed"));
}

TEST_F(ExitStatus, HolesThatDoNotFit) {
  plate(center("[2.3, 0]", "[3.9, 0]"), 2,
        HasSubstr("/holes/0: hole \"1\" of radius 0.15 about (3.9, 0) reaches outside the plate"));
  plate(center("[2.3, 0]", "[1.1, 0.3]"), 2, HasSubstr("are in one cell"));
  plate(center("[2.3, 0]", "[2.7, 0]"), 2, HasSubstr("reaches over the cell line x = 2.8"));
}

TEST_F(ExitStatus, MessagesAreOneLineWhateverTheNames) {
  plate(replaced(center("[2.3, 0]", "[3.9, 0]"), R"("id": "1")", R"("id": "one\n\ttwo")"), 2,
        HasSubstr(R"(the string "one\n\ttwo" holds a control character)"));
}

TEST_F(ExitStatus, PlateThatNothingHolds) {
  const std::string free =
      R"({"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"al": {"E": 1e7, "nu": 0.3}},
    "geometry": {"grid": {"x": [0, 1], "y": [0, 1], "thickness": 1}}, "supports": [{"on": "bottom", "fix": ["y"]}]})";
  plate(free, 4, HasSubstr("/supports: the plate is free to move along x"));
}

TEST_F(ExitStatus, DamagedAndForeignFiles) {
  const std::string whole = test::read_file(folder_->path("center.h5"));
  folder_->write("cut.h5", whole.substr(0, whole.size() / 2));
  expect(test::stage2(*folder_, "cut.h5 -o out.h5"), 3, HasSubstr("cut.h5: is damaged or truncated"));
  expect(test::stage2(*folder_, "center.json -o out.h5"), 3, HasSubstr("center.json: is not an HDF5 file"));
  expect(test::stage2(*folder_, "center.m.h5 -o out.h5"), 3,
         HasSubstr("center.m.h5: is a 'plate-matrices' file, expected 'plate-solution'"));
  joint(bolts("doubler.m.h5", "doubler.h5"), 3,
        HasSubstr("doubler.h5: is a 'plate-solution' file, expected 'plate-matrices'"));
  for (const auto& [name, version, remedy] :
       {std::tuple("newer.h5", 6, "use a newer program"), {"older.h5", 4, "run stage1_plate again"}}) {
    h5::Writer file(folder_->path(name), {"plate-solution", version, 0});
    file.attribute("generator", std::string("stage1_plate 1.0.0"));
    file.commit();
    expect(test::stage2(*folder_, fmt::format("{} -o out.h5", name)), 3,
           HasSubstr(fmt::format("{}: format version {}.0, this program reads 5.x; {}", name, version, remedy)));
  }
}

TEST_F(ExitStatus, Joints) {
  joint(bolts("center:1", "center:7"), 2,
        AllOf(HasSubstr("joint.json: /fasteners/0/between/0"),
              HasSubstr("hole \"7\" does not exist in center.m.h5; allowed: 1, 2, 3")));
  joint(bolts("\"type\": \"linear\", \"k\": 1000", "\"type\": \"power\", \"A\": 1000, \"n\": 1.5"), 2,
        AllOf(HasSubstr("/laws/bolt/n: 1.5 is not allowed"), HasSubstr("allowed")));
  joint(bolts("\"type\": \"linear\", \"k\": 1000", "\"type\": \"power\", \"A\": 1000, \"n\": 0"), 2,
        HasSubstr("/laws/bolt/n"));
  joint(bolts("\"type\": \"linear\", \"k\": 1000",
              "\"type\": \"cubic\", \"delta\": [0.01, 0.02, 0.02], \"F\": [1, 2, 3]"),
        2, HasSubstr("/laws/bolt/delta"));
}

}  // namespace

/// Not converged: exit 4 with the increments that did converge, so here the file does change. All fasteners are open at
/// first: a linear problem, whose first iteration leaves 3e-7 of the load by rounding against the law's steep start and
/// whose second ends it. Two are too few once they bear, eight are enough.
TEST(ExitStatusNotConverged, KeepsTheConvergedIncrements) {
  const test::TemporaryFolder folder;
  test::make_matrices(folder);
  std::string hard = test::three_fastener_joint(1000, 3000, "", R"(, "clearance": 0.06)");
  hard = replaced(hard, R"("type": "linear", "k": 1000)", R"("type": "power", "A": 5000, "n": 0.5)");
  const auto run_with = [&](int iterations) {
    folder.write("joint.json", replaced(hard, "\"increments\": 1",
                                        R"("increments": [0.05, 1], "solver": {"max_iterations": )" +
                                            std::to_string(iterations) + "}"));
    return test::stage3(folder, "joint.json -o out.h5");
  };
  for (const int converged : {0, 1}) {
    const auto run = run_with(converged + 1);
    EXPECT_EQ(run.status, 4);
    EXPECT_THAT(run.err, AllOf(HasSubstr("joint.json: increment " + std::to_string(converged + 1) + " of 2"),
                               HasSubstr("at fastener \""),
                               HasSubstr("Check the law, the gap and the clearance of the fastener there"),
                               HasSubstr("out.h5 holds the " + std::to_string(converged) + " increment")));
    const auto result = test::Result(folder.path("out.h5"));
    EXPECT_FALSE(result.complete);
    EXPECT_EQ(result.load_factor, Eigen::VectorXd::Constant(converged, 0.05));
  }
  EXPECT_EQ(run_with(8).status, 0);
  EXPECT_TRUE(test::Result(folder.path("out.h5")).complete);
}

/// A strip that floats along x, held by one fastener that yields at 3e-7 and does not harden, under 4e-3.
TEST(BeyondCapacity, IsANumericalFailureThatNamesTheFastener) {
  const test::TemporaryFolder folder;
  const std::string strip = R"({"format": "plate", "version": 1, "analysis": "plane stress",
    "materials": {"a": {"E": 1, "nu": 0}}, "geometry": {"grid": {"x": [0, 214], "y": [0, 1], "thickness": 0.1}},
    "holes": [{"id": "1", "center": [107, 0.5], "radius": 0.15, "spring": {"modulus": 261}, "rings": 1}],
    "disc_directions": ["x"], )";
  folder.write("A.json", strip + R"("external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}],
    "supports": [{"on": "bottom", "fix": ["y"]}]})");
  folder.write("B.json", strip + R"("supports": [{"on": "left", "fix": ["x", "y"]}]})");
  for (const std::string name : {"A", "B"}) {
    ASSERT_EQ(test::stage1(folder, name + ".json -o " + name + ".h5").status, 0);
    ASSERT_EQ(test::stage2(folder, name + ".h5 -o " + name + ".m.h5").status, 0);
  }
  folder.write("J.json", R"({"format": "joint", "version": 1, "plates": {"A": "A.m.h5", "B": "B.m.h5"},
    "laws": {"l": {"type": "bilinear", "k": 0.0013, "F_yield": 3e-7, "k_yield": 0}},
    "fasteners": [{"id": "1", "between": ["A:1", "B:1"], "law": "l"}],
    "loads": [{"external": "A:P", "force": -0.0042}], "increments": [5e-5, 1]})");
  const auto run = test::stage3(folder, "J.json -o R.h5");
  EXPECT_EQ(run.status, 4);
  EXPECT_THAT(run.err, testing::HasSubstr("limit load reached: beyond load factor 7.14286e-05, the last that "
                                          "converged, the laws of fastener \"1\" are at"));
  const auto result = test::Result(folder.path("R.h5"));
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(result.load_factor.size(), 1);
}

}  // namespace fastjoint
