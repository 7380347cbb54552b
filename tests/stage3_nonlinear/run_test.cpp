// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/run.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/errors.hpp"
#include "common/formats/joint_result.hpp"
#include "stage3_nonlinear/report.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
using testing::ThrowsMessage;

using Members = std::map<std::string, std::string>;

/// A joint in a folder of its own, run in this process.
class Run : public testing::Test {
 protected:
  void write(const Members& members, const test::Lap& lap = test::two_fastener_lap()) {
    options_ = {.input = test::write_joint(folder_, lap, members),
                .output = folder_.path("result.h5"),
                .csv = folder_.path("result.csv"),
                .generator = "test 1"};
  }
  void run() { stage3::run(options_, out_, log_, timings_); }
  [[nodiscard]] formats::JointResult result() const { return formats::read_joint_result(options_.output); }

  test::TemporaryFolder folder_;
  RunOptions options_;
  std::ostringstream out_, log_;
  program::Timings timings_;
};

/// A law that carries 3.025 at most, in series: load factor 3.5 has no equilibrium (load_path_test.cpp).
const Members overloaded{{"laws", R"({"weak": {"type": "cubic", "delta": [1, 2, 3], "F": [1, 1.8, 2.4]}})"},
                         {"fasteners", R"([{"id": "left bolt", "between": ["a:1", "b:1"], "law": "weak"}])"},
                         {"loads", R"([{"external": "a:P", "force": 1}])"},
                         {"increments", "[1, 2, 3.5, 4]"}};

TEST_F(Run, WritesTheResult) {
  write({{"name", R"("lap")"}, {"increments", "2"}});
  run();
  const auto a = result();
  EXPECT_TRUE(a.complete);
  EXPECT_EQ(a.header.name, "lap");
  EXPECT_EQ(a.header.generator, "test 1");
  EXPECT_EQ(a.header.units.force, "lbf");
  EXPECT_EQ(a.header.input, test::read_file(options_.input));
  EXPECT_THAT(a.fastener_id, ElementsAre("f1", "f2"));
  EXPECT_THAT(a.load_factor, ElementsAre(0.5, 1));
  EXPECT_THAT(a.converged, ElementsAre(1, 1));
  EXPECT_THAT(a.iterations, ElementsAre(1, 1));
  EXPECT_LT(a.residual.maxCoeff(), 1e-14);
  // Symmetric lap: each fastener takes half.
  EXPECT_NEAR(a.F(1, 0), 50, 1e-11);
  EXPECT_NEAR(a.delta(0, 1), 0.025, 1e-14);
  EXPECT_NEAR(a.transferred_second(1, 1), 50, 1e-11);
  ASSERT_EQ(a.plates.size(), 2U);
  EXPECT_EQ(a.plates[0].name, "a");
  EXPECT_THAT(a.plates[0].external_id, ElementsAre("P"));
  EXPECT_EQ(a.plates[0].Pe(1, 0), 100);
  EXPECT_NEAR(a.plates[1].D(1, 0), 0.1, 1e-13);
  EXPECT_NEAR(a.plates[0].D(1, 0) - a.plates[1].D(1, 0), 0.05, 1e-13);
  EXPECT_NEAR(a.plates[0].De(1, 0) - a.plates[0].D(1, 1), 0.1, 1e-13);
  EXPECT_EQ(a.plates[1].De.size(), 0);
}

TEST_F(Run, SameInputGivesSameBytes) {
  write({{"laws", R"({"lin": {"type": "power", "A": 500, "n": 0.6}})"}});
  run();
  const std::string first = test::read_file(options_.output) + test::read_file(options_.csv);
  run();
  EXPECT_EQ(test::read_file(options_.output) + test::read_file(options_.csv), first);
}

TEST_F(Run, PrintsATable) {
  write({{"name", R"("lap")"}, {"increments", "2"}});
  run();
  EXPECT_EQ(log_.str(), "");
  EXPECT_THAT(out_.str(), StartsWith("joint \"lap\": 2 plates, 2 fasteners, p = 8, linear\n"
                                     "stiffness of a known to 0.0e+00 of its largest entry\n"));
  EXPECT_THAT(out_.str(), HasSubstr("increment 2 of 2: load factor 1, 1 linear solves, residual "));
  EXPECT_THAT(out_.str(), HasSubstr("  fastener           delta [in]          F [lbf]    transferred [lbf] share [%]\n"
                                    "  f1                       0.05               50                   50    50.000\n"
                                    "  f2                       0.05               50                   50    50.000\n"
                                    "  on plate        applied [lbf]  fasteners [lbf]       supports [lbf]\n"
                                    "  a                         100             -100                    0\n"
                                    "  b                           0              100                 -100\n"
                                    "  equilibrium: worst row out of balance by "));
}

TEST_F(Run, UnloadedHasNoRoundingToCompareWith) {
  write({{"laws", R"({"lin": {"type": "power", "A": 300, "n": 0.6}})"}, {"increments", "[1, 0]"}});
  run();
  EXPECT_THAT(out_.str(), HasSubstr("increment 2 of 2: load factor 0, 0 iterations, residual 0.0e+00"));
  EXPECT_THAT(out_.str(), EndsWith("equilibrium: worst row out of balance by 0.0e+00 of the largest force\n"));
}

TEST_F(Run, EventsStandInAllThatItWrites) {
  write({{"fasteners", R"([{"id": "f,1", "between": ["a:1", "b:1"], "law": "lin"},
                           {"id": "f2", "between": ["a:2", "b:2"], "law": "lin", "clearance": 0.05}])"},
         {"increments", R"("events")"}});
  run();  // load_path_test.cpp: at 0.05 / (1 / 1000 + 1 / 1000) = 25 of 100
  EXPECT_THAT(out_.str(), StartsWith("joint: 2 plates, 2 fasteners, p = 8, exact path\n"));
  EXPECT_THAT(out_.str(), HasSubstr("increment 1 of 2: load factor 0.25, 1 pieces without iterations, residual "));
  EXPECT_THAT(out_.str(), HasSubstr("of the largest force\n  f2 closes\n"));
  EXPECT_THAT(out_.str(), HasSubstr("increment 2 of 2: load factor 1, 2 pieces without iterations, residual "));
  EXPECT_THAT(result().event, ElementsAre("f2 closes", ""));
  const std::string csv = test::read_file(options_.csv);
  EXPECT_THAT(csv, HasSubstr(",event\n1,0.25"));
  EXPECT_THAT(csv, HasSubstr(",f2 closes\n1,0.25"));
  EXPECT_THAT(csv, EndsWith(",\n"));
}

TEST_F(Run, NamedSolverIsUsed) {
  const Members loose{{"fasteners", R"([{"id": "1", "between": ["a:1", "b:1"], "law": "lin"},
                                        {"id": "2", "between": ["a:2", "b:2"], "law": "lin", "clearance": 0.05}])"}};
  for (const char* name : {"exact path", "hybridsj", "damped newton"}) {
    auto members = loose;
    members["solver"] = fmt::format(R"({{"method": "{}"}})", name);
    write(members);
    out_.str("");
    run();
    EXPECT_THAT(out_.str(), HasSubstr(fmt::format("p = 8, {}\n", name)));
  }
}

TEST_F(Run, QuietPrintsNothing) {
  write({});
  options_.quiet = true;
  run();
  EXPECT_EQ(out_.str(), "");
}

TEST_F(Run, ShowsBothPlatesWhereFrictionDiffers) {
  std::mt19937 random(51);
  auto lap = test::two_fastener_lap();
  test::add_friction(lap.a, random);
  test::add_friction(lap.b, random);
  write({{"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin", "friction": {"a": 0.1}},
                           {"id": "f2", "between": ["a:2", "b:2"], "law": "lin"}])"}},
        lap);
  run();
  EXPECT_THAT(out_.str(), HasSubstr("to 1st [lbf]"));
  EXPECT_THAT(out_.str(), HasSubstr("to 2nd [lbf]"));
}

TEST_F(Run, WritesACsvWithAllDigits) {
  write({{"increments", "[0.1]"}, {"fasteners", R"([{"id": "a, \"b\"", "between": ["a:1", "b:1"], "law": "lin"}])"}});
  run();
  EXPECT_THAT(test::read_file(options_.csv),
              StartsWith("increment,load_factor,fastener,delta,F,transferred_first,transferred_second,share,"
                         "iterations,residual,first,second,bearing_load_first,bearing_load_y_first,"));
  std::istringstream lines(test::read_file(options_.csv));
  std::string header, line;
  std::getline(lines, header);
  std::getline(lines, line);
  double delta = 0, F = 0;
  ASSERT_EQ(std::sscanf(line.c_str(), "1,0.1,\"a, \"\"b\"\"\",%lf,%lf", &delta, &F), 2);
  EXPECT_EQ(F, result().F(0, 0)) << "the same number as in the file, to the last bit";
  EXPECT_EQ(delta, result().delta(0, 0));
  EXPECT_THAT(line, EndsWith(std::string(20, ','))) << "hand-made matrices know no stresses";
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(line.begin(), line.end(), ',') - 1);
}

TEST_F(Run, WritesSensitivitiesIfAsked) {
  write({{"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin"},
                           {"id": "f2", "between": ["a:2", "b:2"], "law": "pow"}])"},
         {"laws", R"({"lin": {"type": "linear", "k": 1000}, "pow": {"type": "power", "A": 300, "n": 0.25}})"},
         {"increments", "3"}});
  run();
  EXPECT_FALSE(result().sensitivity);
  options_.sensitivities = true;
  run();
  const auto with = result();
  if (!with.sensitivity) FAIL() << "no group sensitivity";
  const auto& by = *with.sensitivity;
  EXPECT_THAT(by.law_name, ElementsAre("lin", "pow", "pow", "pow"));
  EXPECT_THAT(by.law_number, ElementsAre("k", "A", "n", "delta0"));
  EXPECT_THAT(by.law_unit, ElementsAre("in", "in^0.25", "lbf", "lbf/in"));
  EXPECT_THAT(by.force_external, ElementsAre("a:P"));
  EXPECT_THAT(by.displacement_external, IsEmpty());
  EXPECT_THAT(by.mu_hole, IsEmpty());
  ASSERT_EQ(by.force.size(), 3U);
  EXPECT_NEAR(by.force[1].sum(), 2. / 3, 1e-9) << "together they carry what is pulled, at load factor 2/3";
  EXPECT_NEAR(by.load_factor.row(2).sum(), 100, 1e-7);
  EXPECT_LT(by.clearance[2](1, 1), 0) << "a loose fastener carries less";
}

TEST(Warnings, TellOfASolutionPastTheLargestLoad) {
  const JointModel joint = test::joint_of(test::two_fastener_lap(), test::linear_law(1));
  PathStep step{.load_factor = 0.5,
                .F = Eigen::Vector2d::Zero(),
                .delta = Eigen::Vector2d::Zero(),
                .iterations = 1,
                .residual = 0,
                .check = {}};
  step.check.turned = true;
  LoadPath path;
  path.steps = {step, step};
  EXPECT_THAT(warnings(joint, make_equations(joint), path),
              ElementsAre("joint.json: at load factor 0.5 the tangent of the joint has lost its sign: the solution "
                          "balances, but is not stable; a load beyond it snaps through"));
}

TEST_F(Run, LeavesTheShareOfNoLoadEmpty) {
  write({{"loads", R"([{"external": "a:P", "force": 0}])"}});
  run();
  EXPECT_THAT(test::read_file(options_.csv), HasSubstr("\n1,1,f1,0,0,0,0,,"));
}

TEST_F(Run, RefusesACsvInTheWay) {
  write({});
  options_.csv = options_.input;
  EXPECT_THAT([&] { run(); },
              ThrowsMessage<InputError>(HasSubstr("joint.json: is the input or the output file; choose")));
  options_.csv = folder_.path(".") + "/result.h5";
  EXPECT_THAT([&] { run(); }, ThrowsMessage<InputError>(HasSubstr("is the input or the output file")));
  options_.csv = folder_.path("nowhere/a.csv");
  EXPECT_THAT([&] { run(); }, ThrowsMessage<FileError>(HasSubstr("a.csv: cannot be written: No such file")));
  options_.csv = folder_.path("a.csv");
  options_.timings = folder_.path(".") + "/a.csv";
  EXPECT_THAT([&] { run(); }, ThrowsMessage<InputError>(HasSubstr("a.csv: is the file of --timings; choose another")));
  EXPECT_FALSE(std::filesystem::exists(options_.output)) << "found before the work";
}

TEST_F(Run, NeverWritesOverWhatItReads) {
  write({{"laws", R"({"lin": {"type": "table", "file": "points.csv"}})"}});
  const std::string points = folder_.write("points.csv", "0.1, 100\n0.2, 150\n");
  options_.csv = points;
  EXPECT_THAT([&] { run(); }, ThrowsMessage<InputError>(AllOf(
                                  HasSubstr("--csv " + points + ": is a file that " + options_.input + " reads; "),
                                  EndsWith("choose another name"))));
  options_.csv = "";
  options_.output = folder_.path("b.h5");
  EXPECT_THAT([&] { run(); }, ThrowsMessage<InputError>(HasSubstr("-o " + options_.output + ": is a file that ")));
  options_.output = folder_.path("result.h5");
  options_.timings = points;
  EXPECT_THAT([&] { run(); }, ThrowsMessage<InputError>(HasSubstr("--timings " + points + ": is a file that ")));
  EXPECT_EQ(test::read_file(points), "0.1, 100\n0.2, 150\n");
}

TEST_F(Run, KeepsWhatConvergedAndSaysWhatToCheck) {
  write(overloaded, {test::spring_plate(1, 1, {{0, 1, 1000}}), test::spring_plate(1, 0, {{0, test::ground, 1000}})});
  EXPECT_THAT(
      [&] { run(); },
      ThrowsMessage<NumericalError>(AllOf(
          HasSubstr("joint.json: increment 3 of 4 (load factor 3.5) did not converge from the last "
                    "increment, from any first guess, or after 6 halvings of the step; load factor 3."),
          HasSubstr("was reached; worst residual "), HasSubstr("of the largest force, at fastener \"left bolt\"."),
          HasSubstr("result.h5 holds the 2 increments before (complete = 0). Check the law and the clearance of "
                    "that fastener (a cubic that turns down carries no more than its peak, a law that ends level "
                    "no more than its last force), take smaller "
                    "increments, allow more than 200 iterations or, if the residual is close to it, a larger "
                    "tolerance than 1e-10; and see that each plate is held in the sense of its load: one that "
                    "only fasteners hold has no stiffness while all of them are open, and one-sided fasteners "
                    "cannot pull it"))));
  EXPECT_FALSE(result().complete);
  EXPECT_THAT(result().load_factor, ElementsAre(1, 2));
  EXPECT_THAT(out_.str(), HasSubstr("increment 2 of 4"));
  EXPECT_THAT(test::read_file(options_.csv), HasSubstr("\n2,2,left bolt,"));
}

TEST_F(Run, SaysThatAFastenerIsSpent) {
  // Sheets that hold themselves balance without their fastener: each try finds it far out, where its cubic is negative.
  Members members = overloaded;
  members["increments"] = "[1, 40]";
  write(members, {test::spring_plate(1, 1, {{0, 1, 1000}, {0, test::ground, 1}}),
                  test::spring_plate(1, 0, {{0, test::ground, 1000}})});
  EXPECT_THAT([&] { run(); },
              ThrowsMessage<NumericalError>(HasSubstr(
                  "was reached; every try ended past all that the law carries, at fastener \"left bolt\". ")));
  EXPECT_THAT(result().load_factor, ElementsAre(1));
}

TEST_F(Run, WritesAnEmptyHistoryIfNothingConverged) {
  write({{"laws", R"({"lin": {"type": "power", "A": 300, "n": 0.4, "delta0": 0.01}})"},
         {"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin"},
                           {"id": "f2", "between": ["a:2", "b:2"], "law": "lin", "clearance": 0.02}])"},
         {"solver", R"({"max_iterations": 1, "tolerance": 1e-14})"}});
  EXPECT_THAT([&] { run(); }, ThrowsMessage<NumericalError>(AllOf(HasSubstr("increment 1 of 1"),
                                                                  HasSubstr("allow more than 1 iterations"),
                                                                  HasSubstr("holds the 0 increments before"))));
  EXPECT_FALSE(result().complete);
  EXPECT_EQ(result().load_factor.size(), 0);
  EXPECT_EQ(result().F.cols(), 2);
}

TEST_F(Run, WarnsBeyondTheLastPointOfACubic) {
  // Two carry 1 each at delta = 1; then 2.6 each, which the last point 2.4 does not cover: x (1.4 - 0.5 x +
  // 0.1 x^2).
  write({{"laws", R"({"six": {"type": "cubic", "delta": [1, 2, 3], "F": [1, 1.6, 2.4]}})"},
         {"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "six"},
                           {"id": "f2", "between": ["a:2", "b:2"], "law": "six", "clearance": 0.001}])"},
         {"loads", R"([{"external": "a:P", "force": 2}])"},
         {"increments", "[1, 2.6, 3]"}});
  run();
  EXPECT_THAT(log_.str(), HasSubstr("stage3_nonlinear: warning: "));
  EXPECT_THAT(log_.str(), HasSubstr("joint.json: fastener \"f1\": delta = 3.171"));
  EXPECT_THAT(log_.str(), HasSubstr("at load factor 2.6 is beyond the last point 3 of its law (gap included), which is "
                                    "extrapolated there"));
  EXPECT_THAT(log_.str(), HasSubstr("fastener \"f2\""));
  EXPECT_THAT(log_.str(), HasSubstr("is beyond the last point 3.001"));
  EXPECT_THAT(log_.str(), Not(HasSubstr("at load factor 3 "))) << "once is enough";
}

TEST_F(Run, WarnsOfDoubtfulLawsAndOpenPlaces) {
  write({{"laws", R"({"lin": {"type": "power", "A": 300, "n": 0.3}})"},
         {"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin", "clearance": 1},
                           {"id": "f2", "between": ["a:2", "b:2"], "law": "lin", "clearance": 1}])"}},
        {test::chain(2, 1, 2000, {{1, 2, 1000}, {0, test::ground, 1000}}), test::chain(2, 0, 1000, {})});
  run();
  EXPECT_THAT(log_.str(), HasSubstr("joint.json: /laws/lin: n = 0.3 is below the practical range"));
  EXPECT_THAT(log_.str(), HasSubstr("joint.json: at load factor 1 the joint is a mechanism within the gaps of fastener "
                                    "\"f1\", fastener \"f2\": the forces are right, the displacements are one of many; "
                                    "free is, in proportion, plate \"b\" by 1 along x\n"));
  EXPECT_THAT(out_.str(), HasSubstr("         -\n")) << "no sum, no shares";
}

const Members by_formula{{"laws", R"({"lin": {"type": "formula", "formula": "swift", "mode": "total", "shear": "single",
                                               "t": [2, 3], "E": [72000, 72000], "d": 5, "E_f": 110000}})"}};

TEST_F(Run, PrintsWhereAStiffnessComesFrom) {
  write(by_formula);
  run();
  EXPECT_THAT(out_.str(), HasSubstr("law lin: swift in single shear, total: "));
  EXPECT_THAT(out_.str(), HasSubstr("flexibility 1.83502e-05, of which "));
  EXPECT_EQ(log_.str(), "") << "matrices made by hand say nothing of springs";
}

TEST_F(Run, WarnsOfBearingThatCountsTwice) {
  auto lap = test::two_fastener_lap();
  lap.b.disc_modulus = Eigen::Vector2d(0, 3e7);
  write(by_formula, lap);
  run();
  EXPECT_THAT(log_.str(), HasSubstr("joint.json: /laws/lin: mode \"total\" holds the bearing of the sheets, which the "
                                    "springs around hole \"b:2\" have already: the joint comes out too soft; take "
                                    "\"fastener only\"\n"));
  Members members = by_formula;
  members["laws"].replace(members["laws"].find("total"), 5, "fastener only");
  write(members, lap);
  log_.str("");
  run();
  EXPECT_EQ(log_.str(), "");
}

TEST_F(Run, WarnsWhereTheSolutionMayBeOneOfSeveral) {
  Members members = overloaded;
  members["increments"] = "[1, 2]";
  const test::Lap soft{test::spring_plate(1, 1, {{0, 1, 1000}}), test::spring_plate(1, 0, {{0, test::ground, 1000}})};
  write(members, soft);
  run();
  EXPECT_THAT(log_.str(), HasSubstr("joint.json: the law of fastener \"left bolt\" falls more steeply than the plates "
                                    "hold against: the solution may be one of several; the one given is followed from "
                                    "the load before\n"));
  // Plates that hold themselves with more than the law's steepest fall, 1.21 per length, leave one solution.
  members["laws"] = R"({"weak": {"type": "cubic", "delta": [1, 2, 3], "F": [1, 1.8, 2.4]}})";
  write(members, {test::spring_plate(1, 1, {{0, 1, 1000}, {0, test::ground, 100}}), soft.b});
  log_.str("");
  run();
  EXPECT_EQ(log_.str(), "");
}

/// The program itself: exit statuses and the streams.
class Program : public Run {
 protected:
  test::Run call(const std::string& arguments) {
    return test::run(folder_, std::string(STAGE3_PROGRAM) + " " + arguments);
  }
  test::Run call_here(const std::string& more = "") {
    return call(options_.input + " -o " + options_.output + " " + more);
  }
};

TEST_F(Program, Succeeds) {
  write({});
  const auto run = call_here("--csv " + options_.csv);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("p = 8, linear"));
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(result().header.generator, StartsWith("stage3_nonlinear "));
  EXPECT_TRUE(std::filesystem::exists(options_.csv));
  EXPECT_EQ(call_here("--quiet --p 8").out, "");
  EXPECT_FALSE(result().sensitivity);
  EXPECT_EQ(call_here("--sensitivities").status, 0);
  EXPECT_TRUE(result().sensitivity);
  EXPECT_THAT(call("--help").out, AllOf(HasSubstr("--csv FILE"), HasSubstr("--p N"), HasSubstr("JOINT.json")));
}

TEST_F(Program, LeavesTheOldOutputWhenTheInputIsWrong) {
  write({{"increments", "0"}});
  folder_.write("result.h5", "precious");
  EXPECT_EQ(call_here().status, 2);
  EXPECT_EQ(test::read_file(options_.output), "precious");
  write({});
  EXPECT_THAT(call_here("--p 3").err,
              HasSubstr("stage3_nonlinear: error: --p: 3 is not in the matrices of every plate"));
  EXPECT_THAT(call_here("--p x").err, HasSubstr("--p: 'x' is not allowed; allowed: an integer from 1 to 99"));
  EXPECT_EQ(test::read_file(options_.output), "precious");
}

TEST_F(Program, TellsDamagedMatrices) {
  write({});
  folder_.write("b.h5", "not HDF5");
  const auto run = call_here();
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("b.h5: is not an HDF5 file (expected a 'plate-matrices' file)"));
}

TEST_F(Program, TellsNumericalFailure) {
  write(overloaded, {test::spring_plate(1, 1, {{0, 1, 1000}}), test::spring_plate(1, 0, {{0, test::ground, 1000}})});
  const auto run = call_here();
  EXPECT_EQ(run.status, 4);
  EXPECT_THAT(run.err, HasSubstr("stage3_nonlinear: error: "));
  EXPECT_THAT(run.err, HasSubstr("increment 3 of 4"));
  EXPECT_EQ(result().load_factor.size(), 2);
  write({}, {test::chain(2, 1, 1000, {{1, 2, 1000}}), test::chain(2, 0, 1000, {})});
  const auto mechanism = call_here();
  EXPECT_EQ(mechanism.status, 4);
  EXPECT_THAT(mechanism.err, HasSubstr("the joint is a mechanism: plate \"a\" with plate \"b\" can move"));
}

}  // namespace
}  // namespace fastjoint::stage3
