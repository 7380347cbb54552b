// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <filesystem>
#include <limits>

#include "common/errors.hpp"
#include "tests/stage3_nonlinear/run_fixture.hpp"

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

TEST_F(Run, WritesTheResult) {
  write({{"name", R"("lap")"}, {"increments", "2"}});
  run();
  const auto a = result();
  EXPECT_TRUE(a.complete);
  EXPECT_EQ(a.header.name, "lap");
  EXPECT_EQ(a.header.generator, program::generator("stage3_nonlinear"));
  EXPECT_EQ(a.header.units.force, "lbf");
  EXPECT_EQ(a.header.input, test::read_file(options_.input));
  EXPECT_THAT(a.fastener_id, ElementsAre("f1", "f2"));
  EXPECT_THAT(a.load_factor, ElementsAre(0.5, 1));
  EXPECT_THAT(a.converged, ElementsAre(1, 1));
  EXPECT_THAT(a.iterations, ElementsAre(0, 0)) << "the first guess is that of linear fasteners, the next on its line";
  EXPECT_LT(a.residual.maxCoeff(), 1e-14);
  // Symmetric lap: each fastener takes half.
  EXPECT_NEAR(a.F(1, 0), 50, 1e-11);
  EXPECT_NEAR(a.delta(0, 1), 0.025, 1e-14);
  EXPECT_NEAR(a.transferred(1, 3), 50, 1e-11);
  ASSERT_EQ(a.plates.size(), 2U);
  EXPECT_EQ(a.plates[0].name, "a");
  EXPECT_THAT(a.plates[0].external_id, ElementsAre("P"));
  EXPECT_EQ(a["plates/a/Pe"](1, 0), 100);
  const auto &of_a = a.plates[0].columns, &of_b = a.plates[1].columns;
  EXPECT_NEAR(of_b["D"](1, 0), 0.1, 1e-13);
  EXPECT_NEAR(of_a["D"](1, 0) - of_b["D"](1, 0), 0.05, 1e-13);
  EXPECT_NEAR(of_a["De"](1, 0) - of_a["D"](1, 1), 0.1, 1e-13);
  EXPECT_EQ(of_b["De"].size(), 0);
}

TEST_F(Run, SameInputGivesSameBytes) {
  write({{"laws", R"({"lin": {"type": "power", "A": 500, "n": 0.6}})"}});
  run();
  const std::string first = test::read_file(options_.output) + test::read_file(csv_);
  run();
  EXPECT_EQ(test::read_file(options_.output) + test::read_file(csv_), first);
}

TEST_F(Run, PrintsATable) {
  write({{"name", R"("lap")"}, {"increments", "2"}});
  run();
  EXPECT_EQ(log_.str(), "");
  EXPECT_THAT(out_.str(), StartsWith("joint \"lap\": 2 plates, 2 fasteners, p = 8, hybridsj\n"
                                     "the stiffness of a is known to 0.0e+00 of its largest entry\n"));
  EXPECT_THAT(out_.str(), HasSubstr("increment 2 of 2: load factor 1, 0 iterations, residual "));
  EXPECT_THAT(out_.str(), HasSubstr("  fastener           delta [in]          F [lbf]    transferred [lbf] share [%]\n"
                                    "  f1                       0.05               50                   50    50.000\n"
                                    "  f2                       0.05               50                   50    50.000\n"
                                    "  on plate        applied [lbf]  fasteners [lbf]       supports [lbf]\n"
                                    "  a                         100             -100                    0\n"
                                    "  b                           0              100                 -100\n"
                                    "  equilibrium: worst row out of balance by "));
}

/// A sheet that its fastener alone holds has no stiffness, and none of its digits are to be known.
TEST_F(Run, SaysThatASheetHasNoStiffness) {
  test::Lap lap{test::spring_plate(1, 0, {}), test::spring_plate(1, 0, {{0, test::ground, 1000}})};
  lap.a.traction_id = {"P"};
  lap.a.traction_hole = {""};
  lap.a.traction_unit_force = Eigen::VectorXd::Zero(1);
  lap.a.traction_direction = {"x"};
  lap.a.traction_bearing = {""};
  lap.a.T_d = {Eigen::MatrixXd::Constant(1, 1, -1)};
  lap.a.T_e = {Eigen::MatrixXd(0, 1)};
  lap.a.C_t = {Eigen::MatrixXd::Constant(1, 1, 1e-3)};
  write({{"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin"}])"}}, lap);
  run();
  EXPECT_THAT(out_.str(), HasSubstr("the stiffness of a is zero: its loads and fasteners balance without it\n"
                                    "the stiffness of b is known to 0.0e+00 of its largest entry\n"));
  EXPECT_THAT(out_.str(), Not(HasSubstr("nan")));
  EXPECT_NEAR(result().F(0, 0), 100, 1e-9);
}

TEST_F(Run, UnloadedHasNoRoundingToCompareWith) {
  write({{"laws", R"({"lin": {"type": "power", "A": 300, "n": 0.6}})"}, {"increments", "[1, 0]"}});
  run();
  EXPECT_THAT(out_.str(), HasSubstr("increment 2 of 2: load factor 0, 0 iterations, residual 0.0e+00"));
  EXPECT_THAT(out_.str(),
              HasSubstr("equilibrium: worst row out of balance by 0.0e+00 of the largest force, fastener by 0.0e+00, "
                        "sheet along axes without supports by 0.0e+00\n"));
}

TEST_F(Run, EventsStandInAllThatItWrites) {
  write({{"fasteners", R"([{"id": "f,1", "between": ["a:1", "b:1"], "law": "lin"},
                           {"id": "f2", "between": ["a:2", "b:2"], "law": "lin", "clearance": 0.05}])"},
         {"increments", R"("events")"}});
  run();  // load_path_test.cpp: at 0.05 / (1 / 1000 + 1 / 1000) = 25 of 100
  EXPECT_THAT(out_.str(), StartsWith("joint: 2 plates, 2 fasteners, p = 8, hybridsj\n"));
  EXPECT_THAT(out_.str(), HasSubstr("increment 1 of 2: load factor 0.25, 0 iterations, residual "));
  EXPECT_THAT(out_.str(), HasSubstr("of the largest force\n  f2 closes\n"));
  EXPECT_THAT(out_.str(), HasSubstr("increment 2 of 2: load factor 1, 1 iteration, residual "));
  EXPECT_THAT(result().event, ElementsAre("f2 closes", ""));
  const std::string csv = test::read_file(csv_);
  EXPECT_THAT(csv, HasSubstr(",event,joint,case\n1,0.2"));
  EXPECT_THAT(csv, HasSubstr(",f2 closes,,\n1,0.2"));
  EXPECT_NEAR(result().load_factor[0], 0.25, 1e-14);
  EXPECT_THAT(csv, EndsWith(",\n"));
}

TEST_F(Run, NamedSolverIsUsed) {
  const Members loose{{"fasteners", R"([{"id": "1", "between": ["a:1", "b:1"], "law": "lin"},
                                        {"id": "2", "between": ["a:2", "b:2"], "law": "lin", "clearance": 0.05}])"}};
  for (const char* name : {"hybridsj", "damped newton"}) {
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

TEST_F(Run, WritesACsvWithAllDigits) {
  write({{"increments", "[0.1]"}, {"fasteners", R"([{"id": "a, \"b\"", "between": ["a:1", "b:1"], "law": "lin"}])"}});
  run();
  EXPECT_THAT(
      test::read_file(csv_),
      StartsWith(
          "increment,load_factor,fastener,delta [in],F [lbf],transferred_first [lbf],"
          "transferred_second [lbf],share [%],iterations,residual,first,second,bearing_load_first [lbf],"
          "bearing_load_y_first [lbf],bearing_stress_first [lbf/in^2],bypass_load_first [lbf],"
          "bypass_error_first [lbf],peak_hoop_first [lbf/in^2],peak_angle_first [deg],"
          "peak_error_first [lbf/in^2],gross_concentration_first,net_concentration_first,net_stress_first [lbf/in^2],"
          "against_slip_first [deg],"));
  EXPECT_THAT(test::read_file(csv_),
              HasSubstr(",net_concentration_second,net_stress_second [lbf/in^2],against_slip_second [deg],"
                        "bypass_stress_second [lbf/in^2],bypass_direction_second [deg],net_direction_second "
                        "[deg],bypass_across_second [lbf/in^2],bearing_concentration_second,F_error "
                        "[lbf],event,joint,case\n"));
  std::istringstream lines(test::read_file(csv_));
  std::string header, line;
  std::getline(lines, header);
  std::getline(lines, line);
  double delta = 0, F = 0;
  ASSERT_EQ(std::sscanf(line.c_str(), "1,0.1,\"a, \"\"b\"\"\",%lf,%lf", &delta, &F), 2);
  EXPECT_EQ(F, result().F(0, 0)) << "the same number as in the file, to the last bit";
  EXPECT_EQ(delta, result().delta(0, 0));
  EXPECT_THAT(line, EndsWith(std::string(20, ',') + "0,,,"))
      << "hand-made matrices know no stresses, and these are exact";
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(line.begin(), line.end(), ',') - 1);
}

TEST_F(Run, ShowsTheErrorBarOfTheLargestForce) {
  auto lap = test::two_fastener_lap();
  lap.a.S_dd_error.setConstant(1);
  write({{"increments", "[1, 0.5]"}}, lap);
  run();
  const Eigen::MatrixXd error = result()["F_error"];
  EXPECT_GT(error(0, 0), 0);
  EXPECT_NEAR(error(0, 0) / error(1, 0), 2, 1e-9);
  Eigen::Index largest = 0;  // of two that are equal but for rounding
  result().F.row(0).maxCoeff(&largest);
  EXPECT_THAT(out_.str(),
              HasSubstr(fmt::format("the largest F is 50 +- {:.1g} lbf (fastener \"f{}\", increment 1), by the "
                                    "errors of the plates' matrices\n",
                                    error(0, largest), largest + 1)));
  lap.a.S_dd_error.setConstant(std::numeric_limits<double>::infinity());
  write({}, lap);
  out_.str("");
  run();
  EXPECT_FALSE(result().has("F_error"));
  EXPECT_THAT(out_.str(), Not(HasSubstr("+-")));
}

TEST_F(Run, WritesSensitivitiesIfAsked) {
  write({{"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin"},
                           {"id": "f2", "between": ["a:2", "b:2"], "law": "pow"}])"},
         {"laws", R"({"lin": {"type": "linear", "k": 1000}, "pow": {"type": "power", "A": 300, "n": 0.25}})"},
         {"increments", "3"}});
  run();
  EXPECT_FALSE(result().has("sensitivity"));
  options_.options["--sensitivities"] = "given";
  run();
  const auto with = result();
  EXPECT_THAT(with.texts("sensitivity/law_name"), ElementsAre("lin", "pow", "pow", "pow"));
  EXPECT_THAT(with.texts("sensitivity/law_number"), ElementsAre("k", "A", "n", "delta0"));
  EXPECT_THAT(with.texts("sensitivity/law_unit"), ElementsAre("in", "in^0.25", "lbf", "lbf/in"));
  EXPECT_THAT(with.texts("sensitivity/force_external"), ElementsAre("a:P"));
  EXPECT_THAT(with.texts("sensitivity/displacement_external"), IsEmpty());
  EXPECT_THAT(with.texts("sensitivity/mu_hole"), IsEmpty());
  const Eigen::MatrixXd by_force = with["sensitivity/force"];
  ASSERT_EQ(by_force.rows(), 3);
  EXPECT_NEAR(by_force.row(1).sum(), 2. / 3, 1e-9) << "together they carry what is pulled, at load factor 2/3";
  EXPECT_NEAR(with["sensitivity/load_factor"].row(2).sum(), 100, 1e-7);
  EXPECT_LT(with["sensitivity/clearance"](2, 3), 0) << "a loose fastener carries less";
}

TEST_F(Run, LeavesTheShareOfNoLoadEmpty) {
  write({{"loads", R"([{"external": "a:P", "force": 0}])"}});
  run();
  EXPECT_THAT(test::read_file(csv_), HasSubstr("\n1,1,f1,0,0,0,0,,"));
}

TEST_F(Run, RefusesACsvInTheWay) {
  write({});
  options_.options["--csv"] = options_.input;
  EXPECT_THAT([&] { run(); },
              ThrowsMessage<InputError>(HasSubstr("joint.json: is the input or the output file; choose")));
  options_.options["--csv"] = folder_.path(".") + "/result.h5";
  EXPECT_THAT([&] { run(); }, ThrowsMessage<InputError>(HasSubstr("is the input or the output file")));
  options_.options["--csv"] = folder_.path("nowhere/a.csv");
  EXPECT_THAT([&] { run(); }, ThrowsMessage<FileError>(HasSubstr("a.csv: cannot be written: No such file")));
  options_.options["--csv"] = folder_.path("a.csv");
  options_.timings = folder_.path(".") + "/a.csv";
  EXPECT_THAT([&] { run(); }, ThrowsMessage<InputError>(HasSubstr("a.csv: is the file of --timings; choose another")));
  EXPECT_FALSE(std::filesystem::exists(options_.output)) << "found before the work";
}

TEST_F(Run, NeverWritesOverWhatItReads) {
  write({{"laws", R"({"lin": {"type": "table", "file": "points.csv"}})"}});
  const std::string points = folder_.write("points.csv", "0.1, 100\n0.2, 150\n");
  options_.options["--csv"] = points;
  EXPECT_THAT([&] { run(); }, ThrowsMessage<InputError>(AllOf(
                                  HasSubstr("--csv " + points + ": is a file that " + options_.input + " reads; "),
                                  EndsWith("choose another name"))));
  options_.options["--csv"] = "";
  options_.output = folder_.path("b.h5");
  EXPECT_THAT([&] { run(); }, ThrowsMessage<InputError>(HasSubstr("-o " + options_.output + ": is a file that ")));
  options_.output = folder_.path("result.h5");
  options_.timings = points;
  EXPECT_THAT([&] { run(); }, ThrowsMessage<InputError>(HasSubstr("--timings " + points + ": is a file that ")));
  EXPECT_EQ(test::read_file(points), "0.1, 100\n0.2, 150\n");
}

/// The program itself: exit statuses and the streams.
class Program : public Run {
 protected:
  test::Run call(const std::string& arguments) {
    return test::run(folder_, test::program("stage3_nonlinear") + " " + arguments);
  }
  test::Run call_here(const std::string& more = "") {
    return call(options_.input + " -o " + options_.output + " " + more);
  }
};

TEST_F(Program, Succeeds) {
  write({});
  const auto run = call_here("--csv " + csv_);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("p = 8, hybridsj"));
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(result().header.generator, StartsWith("stage3_nonlinear "));
  EXPECT_TRUE(std::filesystem::exists(csv_));
  EXPECT_EQ(call_here("--quiet --p 8").out, "");
  EXPECT_FALSE(result().has("sensitivity"));
  EXPECT_EQ(call_here("--sensitivities").status, 0);
  EXPECT_TRUE(result().has("sensitivity"));
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
