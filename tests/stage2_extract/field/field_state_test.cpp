// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/field/field.hpp"

#include <gmock/gmock.h>

#include "common/errors.hpp"
#include "common/formats/joint_result.hpp"
#include "tests/support/files.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using Eigen::VectorXd;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Names of cases only: external P, discs 1 and 0,0, their frictions on one side, traction T; degrees 1..3.
formats::PlateSolution sheet() {
  formats::PlateSolution plate;
  plate.external_id = {"P"};
  plate.disc_hole = {"1", "0,0"};
  plate.disc_direction = {"x", "x"};
  plate.friction_hole = {"1", "0,0"};
  plate.friction_bearing = {"+x", "+x"};
  plate.traction_id = {"T"};
  plate.traction_bearing = {""};
  plate.held_stiffness.setZero(3);
  plate.p = Eigen::VectorXi::LinSpaced(3, 1, 3);
  return plate;
}

VectorXd amounts(const formats::PlateSolution& plate, const std::string& spec) {
  return stage2::field_state(plate, "plate.h5", {spec}).coefficients;
}
VectorXd vector(std::initializer_list<double> values) {
  return Eigen::Map<const VectorXd>(values.begin(), values.size());
}

TEST(CaseSum, AmountsByName) {
  EXPECT_EQ(amounts(sheet(), "external:P"), vector({1, 0, 0, 0, 0, 0}));
  EXPECT_EQ(amounts(sheet(), "traction:T=-1e2,friction:1:+x=5,disc:0,0:x=0.003,external:P=0.01"),
            vector({0.01, 0, 0.003, 5, 0, -100}));
  EXPECT_EQ(amounts(sheet(), "disc:0,0:x,disc:1:x"), vector({0, 1, 1, 0, 0, 0}));
}

/// A load in a hole is one name, and its sign tells the side that bears.
TEST(CaseSum, ALoadInAHoleIsOfTheSideThatItsSignTells) {
  auto plate = sheet();
  plate.traction_id = {"T", "T", "half"};
  plate.traction_bearing = {"+x", "-x", "+x"};
  EXPECT_EQ(amounts(plate, "traction:T=2,traction:half=3").tail(3), vector({2, 0, 3}));
  EXPECT_EQ(amounts(plate, "traction:half=3,traction:T=-2").tail(3), vector({0, -2, 3}));
  EXPECT_THAT(
      [&] { return amounts(plate, "traction:half=-3"); },
      ThrowsMessage<InputError>(HasSubstr("-3 is not allowed as the coefficient of traction:half: the model has no")));
  EXPECT_THAT([&] { return amounts(plate, "traction:T=1,traction:T=-1"); },
              ThrowsMessage<InputError>(HasSubstr("traction:T stands twice")));
  EXPECT_THAT([&] { return amounts(plate, "nonsense"); },
              ThrowsMessage<InputError>(HasSubstr("friction:0,0:+x, traction:T, traction:half")));
}

/// If one name begins another's, the longer one is meant.
TEST(CaseSum, IdsMayHoldTheSigns) {
  auto plate = sheet();
  plate.external_id = {"a"};
  plate.traction_id = {"a,external:a"};
  plate.disc_hole = {"a:b", "a=2"};
  EXPECT_EQ(amounts(plate, "disc:a:b:x=3,disc:a=2:x=4,external:a=5"), vector({5, 3, 4, 0, 0, 0}));
  plate.disc_hole = {"a", "a:x,disc:a"};
  EXPECT_EQ(amounts(plate, "disc:a:x,disc:a:x"), vector({0, 0, 1, 0, 0, 0}));
}

TEST(CaseSum, WhatIsRefused) {
  const auto refused = [](const std::string& spec, const auto& message) {
    EXPECT_THAT([&] { return amounts(sheet(), spec); }, ThrowsMessage<InputError>(message)) << spec;
  };
  refused("external:Q", HasSubstr("--field: 'external:Q' is not a case of the plate; allowed: a RESULT.h5, or a sum "
                                  "CASE=COEFFICIENT,... of the cases external:P, disc:1:x, disc:0,0:x, friction:1:+x, "
                                  "friction:0,0:+x, traction:T"));
  refused("nonsense", HasSubstr("'nonsense' is not a case of the plate nor a file"));
  refused("", HasSubstr("'' is not a case"));
  refused("external:P,", HasSubstr("'' is not a case"));
  refused("external:P;disc:1:x", HasSubstr("'external:P;disc:1:x' is not a case"));
  refused("external:P=1,disc:1:y", HasSubstr("'disc:1:y' is not a case"));
  for (const std::string amount : {"", "x", "1x", "inf", "nan", "1e999"})
    refused("external:P=" + amount, HasSubstr("'" + amount + "' is not allowed as the coefficient of external:P"));
  refused("external:P,disc:1:x,external:P=2", HasSubstr("external:P stands twice"));
}

TEST(CaseSum, LongListsAreCut) {
  auto plate = sheet();
  plate.disc_hole.assign(400, "h");
  plate.disc_direction.assign(400, "x");
  EXPECT_THAT([&] { return amounts(plate, "disc:i:x"); }, ThrowsMessage<InputError>(HasSubstr(" and 392 more")));
}

/// Two sheets with the sheet's names, "up" and "down", and one without; two increments.
class StateOfAJoint : public testing::Test {
 protected:
  static formats::PlateHistory history(const std::string& name, double value) {
    const auto plate = sheet();
    formats::PlateHistory result{plate, name};
    result.waves.clear();  // of a hole without contact
    result.traction_arm = {0};
    const auto add = [&](const columns::Quantity& quantity, Eigen::Index n, double offset) {
      result.columns.put(
          {quantity, {}, n, {}, Eigen::Vector2d(1, 2) * Eigen::RowVectorXd::LinSpaced(n, offset, offset + 0.1)});
    };
    for (const auto& [quantity, n, offset] :
         {std::tuple(&formats::De, 1, 1), std::tuple(&formats::D, 2, 3), std::tuple(&formats::Lambda, 2, 4),
          std::tuple(&formats::traction_force, 1, 5)})
      add(*quantity, n, value + offset);
    add(formats::wave_amount, 0, 0);
    return result;
  }
  std::string joint(const std::vector<std::string>& names) const {
    formats::JointResult result;
    result.header.name = "lap";
    result.p = 3;
    result.direction = {"x"};
    result.load_factor = Eigen::Vector2d(0.5, 1);
    result.event.resize(result.load_factor.size());
    result.case_name = {""};
    result.case_of = Eigen::VectorXi::Zero(2);
    result.converged = result.iterations = Eigen::VectorXi::Ones(2);
    result.residual = Eigen::Vector2d::Zero();
    for (const auto& name : names) result.plates.push_back(history(name, 10 * static_cast<double>(name.size())));
    if (names.size() > 1) result.plates.back().disc_hole[0] = "other";
    formats::write(folder_.path("joint.h5"), result);
    return folder_.path("joint.h5");
  }
  static stage2::FieldState state(const stage2::FieldRequest& request) {
    return stage2::field_state(sheet(), "plate.h5", request);
  }
  template <class Message>
  static void refused(const stage2::FieldRequest& request, const Message& message) {
    EXPECT_THAT([&] { return state(request); }, ThrowsMessage<InputError>(message));
  }
  test::TemporaryFolder folder_;
};

TEST_F(StateOfAJoint, OfTheOnlySheetThatFits) {
  const auto last = state({joint({"up", "third"})});
  EXPECT_LT((last.coefficients - 2 * vector({21.1, 23, 23.1, 24, 24.1, 25.1})).norm(), 1e-12);
  EXPECT_EQ(last.p, 3);
  EXPECT_EQ(last.joint_plate, "up");
  EXPECT_EQ(last.increment, 2);
  EXPECT_EQ(last.words, "lap, increment 2 of 2, load factor 1");
  const auto first = state({joint({"up", "third"}), "", 1});
  EXPECT_EQ(2 * first.coefficients, last.coefficients);
  EXPECT_EQ(first.words, "lap, increment 1 of 2, load factor 0.5");
}

TEST_F(StateOfAJoint, OfTheSheetThatIsNamed) {
  const auto file = joint({"up", "down", "third"});
  EXPECT_DOUBLE_EQ(state({file, "down"}).coefficients[0], 2 * 41.1);
  refused({file}, HasSubstr("joint.h5: 2 sheets could be that of plate.h5; tell which by --plate: up, down"));
  refused({file, "left"}, AllOf(HasSubstr("--plate: 'left' is not a sheet of"), HasSubstr("allowed: up, down, third")));
  refused({file, "third"},
          AllOf(HasSubstr("--plate: 'third' of "), HasSubstr(" is not the sheet of plate.h5: its cases "
                                                             "are external:P, disc:other:x, ")));
}

TEST_F(StateOfAJoint, WhatIsRefused) {
  const auto file = joint({"up"});
  refused({file, "", 3}, AllOf(HasSubstr("--increment: 3 is not allowed"), HasSubstr("has the increments 1..2")));
  auto other = sheet();
  other.traction_id[0] = "S";
  EXPECT_THAT([&] { return stage2::field_state(other, "other.h5", {file}); },
              ThrowsMessage<InputError>(HasSubstr("joint.h5: no sheet (up) has the cases of other.h5: external:P")));
  EXPECT_THAT([&] { return state({folder_.path("none.h5")}); },
              ThrowsMessage<FileError>(HasSubstr("none.h5: cannot be opened")));
  EXPECT_THAT([&] { return state({folder_.write("text", "text")}); },
              ThrowsMessage<FileError>(HasSubstr("text: is not an HDF5 file")));
}

TEST(FieldDegree, OfTheRequestTheJointOrTheHighest) {
  auto plate = sheet();
  stage2::FieldState state{VectorXd::Zero(6), "", 0, "", 0};
  const auto degree = [&](int p) { return stage2::field_degree(plate, "plate.h5", {"", "", 0, p}, state); };
  EXPECT_EQ(degree(0), 3);
  EXPECT_EQ(degree(1), 1);
  EXPECT_THAT(
      [&] { return degree(4); },
      ThrowsMessage<InputError>(HasSubstr("--p: 4 is not allowed; plate.h5 has unknowns of the degrees 1 to 3")));
  state.p = 2;
  EXPECT_EQ(degree(0), 2);
  EXPECT_EQ(degree(3), 3);
  state.p = 8;
  EXPECT_THAT([&] { return degree(0); },
              ThrowsMessage<InputError>(HasSubstr("--p: 8 is the degree of the joint and not allowed")));
}

TEST(FieldOptions, ThatNeedOthers) {
  const auto check = [](const stage2::FieldRequest& request) {
    return [=] { stage2::check_field_options(request, false, "out.h5", ""); };
  };
  EXPECT_NO_THROW(check({})());
  EXPECT_THAT(check({"", "", 0, 8}), ThrowsMessage<InputError>(HasSubstr("--p: goes with --field only")));
  EXPECT_THAT(check({"", "up"}), ThrowsMessage<InputError>(HasSubstr("--plate: goes with --field RESULT.h5 only")));
  EXPECT_THAT(check({"", "", 2}), ThrowsMessage<InputError>(HasSubstr("--increment: goes with --field RESULT.h5")));
  for (const std::string spec : {"external:P", "nonsense"}) {
    EXPECT_THAT(
        [&] {
          stage2::check_field_options({spec, "up"}, true, "out.vtu", "");
        },
        ThrowsMessage<InputError>(HasSubstr("--plate: goes with --field RESULT.h5 only")));
    EXPECT_THAT(
        [&] {
          stage2::check_field_options({spec, "", 1}, true, "out.vtu", "");
        },
        ThrowsMessage<InputError>(HasSubstr("--increment: goes with --field RESULT.h5 only")));
  }
  const test::TemporaryFolder folder;
  const auto file = folder.write("joint.h5", "");
  EXPECT_THAT([&] { stage2::check_field_options({file}, true, file, ""); },
              ThrowsMessage<InputError>(HasSubstr("joint.h5: is the file of --field; choose another name")));
  EXPECT_THAT([&] { stage2::check_field_options({file}, true, "out.vtu", file); },
              ThrowsMessage<InputError>(testing::StartsWith("--timings " + file + ": is the file of --field")));
}

TEST(MakeField, RefusesAmountsThatOverflow) {
  const auto plate = test::solve(test::make_plate(test::panel(1, 1)));
  const stage2::FieldRequest request = {"external:P=1e305"};
  const auto state = stage2::field_state(plate, "plate.h5", request);
  stage2::FieldSolver solver(plate, "plate.h5");
  EXPECT_THAT(
      [&] { return stage2::make_field(solver, "plate.h5", request, state); },
      ThrowsMessage<NumericalError>(HasSubstr("plate.h5: --field external:P=1e305: displacements or stresses")));
}

}  // namespace
}  // namespace fastjoint
