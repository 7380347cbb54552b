// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/joint_model.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "common/errors.hpp"
#include "stage3_nonlinear/model/parameters.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

using Members = std::map<std::string, std::string>;

/// Writes the two plates and the joint, and loads it.
JointModel load(const test::Lap& lap, const Members& members = {}, int p = 0) {
  const test::TemporaryFolder folder;
  const std::string path = test::write_joint(folder, lap, members);
  return load_joint(read_joint_scene(input::parse(path, test::read_file(path))), p);
}

/// The numbers of its first case.
Parameters numbers_of(const test::Lap& lap, const Members& members) {
  const test::TemporaryFolder folder;
  const std::string path = test::write_joint(folder, lap, members);
  const JointScene scene = read_joint_scene(input::parse(path, test::read_file(path)));
  return parameters_of(load_joint(scene, 0), scene, scene.cases.front());
}

const Members with_friction{{"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin", "friction": 0.1},
                      {"id": "f2", "between": ["a:2", "b:2"], "law": "lin"}])"}};

test::Lap rubbing_lap() {
  std::mt19937 random(1);
  auto lap = test::two_fastener_lap();
  test::add_friction(lap.a, random);
  test::add_friction(lap.b, random);
  return lap;
}

template <class Error>
void expect_refusal(const test::Lap& lap, const Members& members, const std::string& message) {
  EXPECT_THAT([&] { (void)load(lap, members); }, ThrowsMessage<Error>(HasSubstr(message)));
}

TEST(JointModel, ResolvesNamesToIndices) {
  const Members members{{"fasteners", R"([{"id": "f", "between": ["b:2", "a:1"], "law": "lin"}])"}};
  const JointModel joint = load(test::two_fastener_lap(), members);
  EXPECT_EQ(joint.p, 8);
  EXPECT_EQ(joint.units.length, "in");
  EXPECT_EQ(joint.plates[0].name, "a");
  EXPECT_EQ(numbers_of(test::two_fastener_lap(), members).load, Eigen::VectorXd::Constant(1, 100));
  ASSERT_EQ(joint.planes.size(), 1U);
  EXPECT_EQ(joint.first_hole(joint.planes[0]).plate, 1U);
  EXPECT_EQ(joint.first_hole(joint.planes[0]).disc, 1);
  EXPECT_EQ(joint.second_hole(joint.planes[0]).plate, 0U);
  EXPECT_EQ(joint.second_hole(joint.planes[0]).disc, 0);
  EXPECT_EQ(joint.n_unknowns(), 5);
  EXPECT_EQ(joint.offset(1), 3);
}

TEST(JointModel, AddsClearanceToTheLawsGap) {
  const Members members{{"laws", R"({"lin": {"type": "power", "A": 1, "n": 1, "delta0": 0.01, "one_sided": true}})"},
                        {"fasteners", R"([{"id": "f", "between": ["a:1", "b:1"], "law": "lin", "clearance": 0.02}])"}};
  const Parameters numbers = numbers_of(test::two_fastener_lap(), members);
  EXPECT_DOUBLE_EQ(numbers.law[0]->gap(numbers.clearance[0]), 0.03);
  EXPECT_TRUE(load(test::two_fastener_lap(), members).planes[0].one_sided);
}

TEST(JointModel, RefusesGapsInHolesThatTheirSpringsFill) {
  const auto with = [](const std::string& gaps) {
    return numbers_of(test::two_fastener_lap(),
                      {{"fasteners", R"([{"id": "f", "between": ["a:1", "b:1"], "law": "lin", )" + gaps + "}]"}});
  };
  for (const char* gaps : {R"("gap": [0, 0.1])", R"("diameter": 5)", R"("diameter": 5, "hole_diameter": [5, 5.1])"})
    EXPECT_THAT([&] { (void)with(gaps); },
                ThrowsMessage<InputError>(AllOf(HasSubstr(gaps[1] == 'g' ? "/fasteners/0/gap: " : "/0/diameter: "),
                                                HasSubstr("the springs of hole \""), HasSubstr("act in tension too"))));
  for (const char* none : {R"("gap": 0)", R"("diameter": 5, "hole_diameter": 5)"}) EXPECT_EQ(with(none).gap[1], 0);
}

TEST(JointModel, RimsOfContactAreThoseOfDiscs) {
  auto lap = test::two_fastener_lap();
  test::add_contact(lap.a, "3", 1);
  expect_refusal<FileError>(lap, {}, "a.h5:pressure/hole: holds \"3\", expected holes in disc/hole");
  lap = test::two_fastener_lap();
  test::add_contact(lap.a, "1", 1);
  test::add_contact(lap.a, "1", 1);
  expect_refusal<FileError>(lap, {}, "a.h5:pressure/hole: \"1\" stands twice");
}

TEST(JointModel, NamesAFileWhosePathIsTooLong) {
  const std::string name(300, 'x');
  expect_refusal<FileError>(test::two_fastener_lap(), {{"plates", R"({"a": ")" + name + R"(.h5", "b": "b.h5"})"}},
                            ".h5: cannot be opened: File name too long");
}

TEST(JointModel, TakesTheFrictionCaseOfTheSideThatBears) {
  const auto lap = rubbing_lap();
  const JointModel joint = load(lap, with_friction);
  const auto& holes = joint.fasteners[0].holes;
  const auto expect = [](const FrictionCase& its, const formats::PlateMatrices& plate, Eigen::Index column) {
    EXPECT_EQ(its.column, column);
    EXPECT_EQ(its.unit_force, plate.friction_unit_force[column]);
    EXPECT_EQ(its.resultant, std::abs(plate.friction_resultant[column]));
  };
  expect(holes[0].friction[0][plus_side], lap.a, 0);
  expect(holes[0].friction[0][minus_side], lap.a, 1);
  expect(holes[1].friction[0][plus_side], lap.b, 0);
  expect(holes[1].friction[0][minus_side], lap.b, 1);
  EXPECT_TRUE(joint.fasteners[1].holes[0].friction.empty());
}

TEST(JointModel, OneSidedFastenersNeedOneSideOfFriction) {
  auto lap = rubbing_lap();
  lap.b.friction_unit_force[1] = 0;  // hole 1 of b cannot bear on -x
  Members members = with_friction;
  members["laws"] = R"({"lin": {"type": "linear", "k": 1, "one_sided": true}})";
  EXPECT_EQ(load(lap, members).fasteners[0].holes[1].friction[0][minus_side].column, -1);
  expect_refusal<InputError>(
      lap, with_friction,
      "b.h5:friction/unit_force: hole \"1\" has 0 on its side -x: no rim there can bear, so friction 0.1 "
      "has no meaning; allowed: a value > 0, a law with \"one_sided\"");
}

TEST(JointModel, TakesTheHighestCommonDegreeOrTheOneAskedFor) {
  auto lap = test::two_fastener_lap();
  const auto add_degrees = [](formats::PlateMatrices& plate, const std::vector<int>& degrees) {
    plate.p = Eigen::Map<const Eigen::VectorXi>(degrees.data(), degrees.size());
    plate.ndof = plate.p;
    for (auto* stack :
         {&plate.S_dd, &plate.S_ed, &plate.S_ee, &plate.R_df, &plate.R_ef, &plate.T_d, &plate.T_e, &plate.C_t})
      stack->resize(degrees.size(), stack->front());
    for (Index i = 0; i < std::ssize(degrees); ++i) plate.S_dd[i] *= degrees[i];
  };
  const auto a = lap.a.S_dd[0];
  add_degrees(lap.a, {5, 6, 7});
  add_degrees(lap.b, {6, 7, 8});
  EXPECT_EQ(load(lap).p, 7);
  EXPECT_EQ(load(lap, {}, 6).p, 6);
  EXPECT_DOUBLE_EQ(load(lap, {}, 6).plates[0].S(0, 0), 6 * a(0, 0));
  EXPECT_EQ(load(lap, {}, 6).plates[0].S_error.size(), 0) << "the estimate is for the highest degree";
  EXPECT_GT(load(lap).plates[0].S_error.size(), 0);
  EXPECT_THAT([&] { (void)load(lap, {}, 8); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("--p: 8 is not in the matrices of every plate of"),
                                              HasSubstr("joint.json; allowed: 6, 7"))));
  add_degrees(lap.b, {1, 2, 3});
  expect_refusal<InputError>(lap, {}, "the plates have no polynomial degree in common");
}

TEST(JointModel, RefusesNamesThatThePlatesDoNotHave) {
  const auto lap = test::two_fastener_lap();
  expect_refusal<InputError>(lap, {{"fasteners", R"([{"id": "f", "between": ["a:1", "b:9"], "law": "lin"}])"}},
                             "joint.json: /fasteners/0/between/1: hole \"9\" does not exist in ");
  expect_refusal<InputError>(lap, {{"fasteners", R"([{"id": "f", "between": ["a:1", "b:9"], "law": "lin"}])"}},
                             "b.h5; allowed: 1, 2");
  expect_refusal<InputError>(lap, {{"loads", R"([{"external": "a:R", "force": 1}])"}},
                             "joint.json: /loads/0/external: external \"R\" does not exist in ");
  expect_refusal<InputError>(lap, {{"loads", R"([{"external": "a:R", "force": 1}])"}}, "a.h5; allowed: P");
  expect_refusal<InputError>(lap, {{"loads", R"([{"external": "b:P", "force": 1}])"}},
                             "allowed: none: this plate has no external boundary");
}

TEST(JointModel, RefusesADisplacementOfATraction) {
  auto lap = test::two_fastener_lap();
  lap.a.traction_id = {"T"};
  lap.a.traction_hole = {""};
  lap.a.traction_unit_force = Eigen::VectorXd::Zero(1);
  lap.a.traction_direction = {"y"};
  lap.a.traction_bearing = {""};
  lap.a.T_d = {Eigen::MatrixXd::Zero(2, 1)};
  lap.a.T_e = {Eigen::MatrixXd::Zero(1, 1)};
  lap.a.C_t = {Eigen::MatrixXd::Zero(1, 1)};
  expect_refusal<InputError>(
      lap, {{"loads", R"([{"external": "a:T", "displacement": 1}])"}},
      "/loads/0/external: \"T\" carries a traction and has no single displacement; allowed: \"force\", or "
      "an external of kind \"rigid\"");
  const Members members{{"loads", R"([{"external": "a:T", "force": 7}])"}};
  const JointModel joint = load(lap, members);
  EXPECT_EQ(numbers_of(lap, members).load, Eigen::Vector2d(0, 7)) << "on the external, then on the traction";
  EXPECT_EQ(joint.plates[0].traction_axis[0], 1);
  EXPECT_EQ(joint.plates[0].external_axis[0], 0);
}

TEST(JointModel, RefusesUnitsThatDiffer) {
  auto lap = test::two_fastener_lap();
  expect_refusal<InputError>(
      lap, {{"units", R"({"length": "mm", "force": "N"})"}},
      "joint.json: /units: length \"mm\", force \"N\"; allowed: length \"in\", force \"lbf\", as in ");
  lap.b.header.units = {"mm", "N"};
  expect_refusal<InputError>(lap, {},
                             "b.h5: units are length \"mm\", force \"N\"; allowed: length \"in\", force \"lbf\"");
}

TEST(JointModel, RefusesFrictionWithoutItsMatrices) {
  expect_refusal<InputError>(
      test::two_fastener_lap(), with_friction,
      "a.h5:friction/hole: has no friction case for hole \"1\" bearing +x, but its fastener has friction "
      "0.1; run stage 2 again, or set the friction to 0");
}

TEST(JointModel, RefusesFastenersWhoseDiscsMoveInOtherDirections) {
  auto lap = test::two_fastener_lap();
  lap.b.disc_direction = {"x", "z"};
  expect_refusal<FileError>(lap, {}, "b.h5:disc/direction: is \"z\", expected \"x\" or \"y\"");
  lap.b.disc_direction = {"y", "y"};
  expect_refusal<InputError>(
      lap, {},
      "/between: the disc of hole \"a:1\" moves along x, that of hole \"b:1\" along y; allowed: discs "
      "of the same directions: whole holes of sheets with the same \"disc_directions\", as ");
  expect_refusal<InputError>(lap, {}, "a.h5 has them, or half holes on one line of symmetry");
  lap.a.disc_hole = lap.b.disc_hole = {"1", "1"};
  lap.b.disc_direction = {"x", "y"};
  lap.a.disc_direction = {"y", "x"};
  expect_refusal<FileError>(
      lap, {}, "b.h5:disc/direction: hole \"1\" has y after x, expected each direction once, all in one order");
}

/// A line of symmetry holds discs in one direction: nothing else moves in it, and nothing changes along the other.
TEST(JointModel, HoldsDiscsInDirectionsThatTheyDoNotHave) {
  const auto lap = test::two_fastener_lap();
  const PlateModel alone = make_plate("a", "a.h5", lap.a, 8), both = make_plate("a", "a.h5", lap.a, 8, {0, 1});
  EXPECT_EQ(both.discs, (std::vector<Index>{0, 2}));
  EXPECT_EQ(both.n_disc_unknowns(), 4);
  std::vector<Index> own{0, 2};
  for (Index i = 4; i < both.n_unknowns(); ++i) own.push_back(i);
  EXPECT_EQ(MatrixXd(both.S(own, own)), alone.S);
  EXPECT_EQ(MatrixXd(both.R(own, Eigen::all)), alone.R);
  for (const Index held : {1, 3}) {
    EXPECT_GT(both.S(held, held), 0);
    EXPECT_EQ(both.S.row(held).cwiseAbs().sum(), both.S(held, held));
    EXPECT_FALSE(both.has_disc(held));
  }
}

TEST(JointModel, RefusesMatricesThatNoPlateHas) {
  auto lap = test::two_fastener_lap();
  lap.b.S_dd[0](0, 1) *= 1.001;
  expect_refusal<FileError>(lap, {}, "b.h5:S_dd: is not symmetric: entries (1, 0) and (0, 1) are -1000 and -100");
  lap = test::two_fastener_lap();
  lap.b.S_dd[0](0, 0) = 500;
  expect_refusal<FileError>(lap, {},
                            "b.h5:S_dd: the stiffness matrix [S_dd S_de; S_ed S_ee] has the eigenvalue -280.776");
  lap = test::two_fastener_lap();
  lap.b.disc_hole = {"1", "1"};
  expect_refusal<FileError>(lap, {}, "b.h5:disc/hole: \"1\" stands twice, expected each name once");
  lap = test::two_fastener_lap();
  lap.b = test::chain(0, 0, 1000, {});
  expect_refusal<InputError>(lap, {}, "allowed: none: the sheet has no hole with a spring");
}

TEST(JointModel, RefusesFilesThatAreMissing) {
  expect_refusal<FileError>(test::two_fastener_lap(), {{"plates", R"({"a": "a.h5", "b": "nope.h5"})"}},
                            "nope.h5: cannot be opened: No such file or directory; stage2_extract PLATE.h5 -o ");
}

}  // namespace
}  // namespace fastjoint::stage3
