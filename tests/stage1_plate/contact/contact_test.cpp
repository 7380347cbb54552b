// SPDX-License-Identifier: GPL-3.0-or-later
// Nisida's pin-loaded sheet (section 5 of the paper; docs/theory.md, section 6) and what must hold of any contact.
#include "stage1_plate/contact/contact.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "common/errors.hpp"
#include "stage1_plate/contact/contact_system.hpp"
#include "stage1_plate/run/solve.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

using std::numbers::pi;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double degree = pi / 180;
constexpr double diameter = 20, thickness = 5.34;

/// A square sheet of half width 100 about a disc of its own material, radius 10, in its centre.
struct Sheet {
  bool half = true;  ///< the half y > 0, symmetric about y = 0
  int rings = 2;
  std::string spring = R"("compression_only": true)";  ///< beside the disk
  std::string directions = R"(["x"])";
  std::string extra;  ///< members, each with a comma before it

  [[nodiscard]] std::string json() const {
    return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress",
      "materials": {{"dap": {{"E": 244, "nu": 0.41}}}},
      "geometry": {{"grid": {{"x": [-100, 100], "y": [{}, 100], "thickness": 5.34}}}},
      "holes": [{{"id": "pin", "center": [0, 0], "radius": 10, "rings": {}, "spring": {{"disk": {{"E": 244, "nu": 0.41}}{}{}}}}}],
      "disc_directions": {}{}{}}})",
                       half ? 0 : -100, rings, spring.empty() ? "" : ", ", spring, directions,
                       half ? R"(, "supports": [{"on": "bottom", "fix": ["y"]}])" : "", extra);
  }
};

/// Pulled at its right edge with a force, the disc held.
std::string pulled(const std::string& kind, double force, double friction = 0) {
  return fmt::format(R"(, "external": [{{"id": "P", "on": "right", "direction": "x", "kind": "{}"}}],
    "loads": [{{"external": "P", "force": {}}}, {{"disc": "pin", "direction": "x", "displacement": 0, "friction": {}}}])",
                     kind, force, friction);
}

/// The disc pushed along x with a force, left and right edges held.
std::string pushed(double force) {
  return fmt::format(R"(, "external": [{{"id": "L", "on": "left", "direction": "x", "kind": "rigid"}},
      {{"id": "R", "on": "right", "direction": "x", "kind": "rigid"}}],
    "loads": [{{"disc": "pin", "direction": "x", "force": {}}}, {{"external": "L", "displacement": 0}},
      {{"external": "R", "displacement": 0}}])",
                     force);
}

struct Contact {
  test::Plate plate;
  stage1::RimContactState state;
};
Contact find(const Sheet& sheet) {
  Contact contact{test::make_plate(sheet.json()), {}};
  contact.state = stage1::find_contact(contact.plate.scene, contact.plate.mesh, contact.plate.problem);
  return contact;
}

double peak_ratio(const Contact& contact, double whole_force) {
  return contact.state.holes[0].peak_pressure * diameter * thickness / whole_force;
}

TEST(Nisida, ContactAngleAndPeakPressure) {
  const auto contact = find({.rings = 3, .extra = pulled("traction", 0.5)});
  const auto& hole = contact.state.holes[0];
  EXPECT_NEAR(hole.half_angle / degree, 87.19, 0.001 * 87.19);
  EXPECT_NEAR(peak_ratio(contact, 1), 1.2045, 0.001 * 1.2045);
  EXPECT_NEAR(std::abs(hole.peak_angle), pi, 1e-6);
  EXPECT_EQ(hole.iterations, 4);
  EXPECT_NEAR(contact.state.force[0], -0.5, 1e-12);
  EXPECT_THAT(stage1::contact_summary(contact.plate.scene, contact.state),
              HasSubstr("hole pin: contact 92.82..180.00 degrees (half-angle 87.18), 4 iterations, peak pressure"));
}

/// An edge that moves as one stiffens the sheet: the contact is wider.
TEST(Nisida, TheWholeSheetIsTwiceTheHalf) {
  const auto half = find({.extra = pulled("rigid", 0.5)});
  const auto whole = find({.half = false, .directions = R"(["x", "y"])", .extra = pulled("rigid", 1)});
  EXPECT_NEAR(half.state.holes[0].half_angle / degree, 87.56, 0.01);
  EXPECT_NEAR(whole.state.holes[0].half_angle, half.state.holes[0].half_angle, 1e-8);
  EXPECT_NEAR(peak_ratio(whole, 1), peak_ratio(half, 1), 1e-10);
  EXPECT_EQ(whole.state.holes[0].iterations, half.state.holes[0].iterations);
  EXPECT_NEAR(whole.state.displacement[0] / half.state.displacement[0], 1, 1e-9);
}

/// The same under traction; a point spring on the line of symmetry, which it does not load, keeps the sheet from
/// turning about the disc.
TEST(Nisida, TheWholeSheetUnderTraction) {
  const auto half = find({.extra = pulled("traction", 0.5)});
  std::string extra = pulled("traction", 1);
  extra.insert(extra.size() - 1, R"(, {"disc": "k", "direction": "x", "force": 0})");
  extra += R"(, "points": [{"id": "k", "at": [100, 0], "stiffness": 1}])";
  const auto whole = find({.half = false, .directions = R"(["x", "y"])", .extra = extra});
  EXPECT_NEAR(whole.state.holes[0].half_angle, half.state.holes[0].half_angle, 1e-8);
  EXPECT_NEAR(peak_ratio(whole, 1), peak_ratio(half, 1), 1e-10);
}

TEST(Contact, DoesNotDependOnTheSizeOfTheLoad) {
  const auto one = find({.extra = pulled("traction", 0.5)});
  for (const double factor : {1e-6, 2e5}) {
    const auto other = find({.extra = pulled("traction", 0.5 * factor)});
    EXPECT_LT(stage1::largest_move(one.state.holes[0].arcs, other.state.holes[0].arcs), 1e-10);
    EXPECT_NEAR(peak_ratio(other, factor), peak_ratio(one, 1), 1e-10);
    EXPECT_EQ(other.state.holes[0].iterations, one.state.holes[0].iterations);
  }
}

TEST(Contact, TheOtherWayIsTheMirrorImage) {
  const auto plus = find({.extra = pushed(3)}), minus = find({.extra = pushed(-3)});
  ASSERT_EQ(plus.state.holes[0].arcs.size(), 1U);
  ASSERT_EQ(minus.state.holes[0].arcs.size(), 1U);
  const auto& p = plus.state.holes[0].arcs[0];
  const auto& m = minus.state.holes[0].arcs[0];
  EXPECT_NEAR(p.from, 0, 1e-12);
  EXPECT_NEAR(m.from, pi - p.to, 1e-9);
  EXPECT_NEAR(m.to, pi, 1e-12);
  EXPECT_NEAR(plus.state.displacement[2], -minus.state.displacement[2], 1e-12);
  EXPECT_NEAR(plus.state.holes[0].half_angle, p.to, 1e-15);
}

/// The load as amounts of the unit cases of the plate with the arcs given as found: its linear solution is the state.
TEST(Contact, FoundArcsGivenMakeTheSameState) {
  const auto contact = find({.extra = pulled("traction", 0.5)});
  const auto& arc = contact.state.holes[0].arcs[0];
  const Sheet given = {.spring = fmt::format(R"("arc": [{:.17g}, {:.17g}])", arc.from / degree, arc.to / degree),
                       .extra = R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": "traction"}])"};
  const auto linear = test::solve(test::make_plate(given.json()));
  auto plate = contact.plate;
  plate.scene = stage1::with_arcs(plate.scene, contact.state);
  plate.problem = test::assemble(plate.scene, plate.mesh);
  auto found = test::solve(plate);
  stage1::add_contact(contact.state, found);
  EXPECT_LT((found.cases.back().C_t - linear.cases.back().C_t).norm(), 1e-10 * linear.cases.back().C_t.norm());
  EXPECT_LT((found.held_stiffness - linear.held_stiffness).norm(), 1e-12 * linear.held_stiffness.norm());
  EXPECT_EQ(found.load_traction, Eigen::MatrixXd::Constant(1, 1, 0.5));
  EXPECT_EQ(found.load_displacement.size(), 1);
  EXPECT_EQ(found.contacts.size(), 1U);
  // displacement where the pressure is highest
  const auto& problem = plate.problem;
  const Eigen::VectorXd u =
      test::fields_under(problem, problem.numbering.p, problem.T_f * found.load_traction.transpose());
  for (int node = 0; node < linear.mesh.n_nodes(); ++node)
    if ((linear.mesh.nodes.col(node) - Eigen::Vector2d(-10, 0)).norm() < 1e-9) {
      const double pressure = linear.hole_spring[0].modulus * u[linear.unknown(0, node)];
      EXPECT_NEAR(pressure / contact.state.holes[0].peak_pressure, 1, 1e-9);
    }
}

/// More and other element ends along the rim and into the sheet: only the error of discretisation is left.
TEST(Contact, DoesNotDependOnWhereElementsEnd) {
  const auto coarse = find({.rings = 2, .extra = pulled("traction", 0.5)});
  std::string moved = Sheet{.rings = 2, .extra = pulled("traction", 0.5)}.json();
  const std::string lines = R"("x": [-100, 100], "y": [0, 100])";
  moved.replace(moved.find(lines), lines.size(), R"("x": [-100, -30, 25, 100], "y": [0, 40, 100])");
  auto plate = test::make_plate(moved);
  const auto fine = stage1::find_contact(plate.scene, plate.mesh, plate.problem);
  EXPECT_NEAR(fine.holes[0].half_angle / degree, coarse.state.holes[0].half_angle / degree, 0.05);
  EXPECT_NEAR(fine.holes[0].peak_pressure / coarse.state.holes[0].peak_pressure, 1, 5e-4);
}

/// The mean of g over a short part of the rim, from what springs there do to the disc along x: the work of z on a unit
/// displacement of the disc is that of g cos(theta), of the disc's displacement itself that of cos(theta)^2.
double gap_over(const stage1::RimGap& gap, const Eigen::VectorXd& z, const rim::AngleRange& part, Eigen::Index disc_x) {
  const Eigen::MatrixXd K = gap.stiffness({part});
  return K.row(disc_x).dot(z) / K(disc_x, disc_x) * std::cos((part.from + part.to) / 2);
}

/// Pressure where there are springs, a gap where there are none.
TEST(Contact, IsComplementary) {
  for (const bool half : {true, false}) {
    const auto contact =
        find({.half = half, .directions = half ? R"(["x"])" : R"(["x", "y"])", .extra = pulled("rigid", 1)});
    stage1::ContactSystem system(contact.plate.scene, contact.plate.mesh, contact.plate.problem);
    const auto& arcs = contact.state.holes[0].arcs;
    const Eigen::VectorXd z = system.solve({arcs}).z;
    const double largest = system.gap(0).peak(z).gap;
    constexpr int n = 400;
    constexpr double width = 1e-4;
    std::vector<rim::AngleRange> parts;
    for (int i = 0; i < n; ++i) parts.push_back({2 * pi * i / n, 2 * pi * i / n + width});
    for (const auto& arc : arcs)
      for (const double end : {arc.from, arc.to}) parts.insert(parts.end(), {{end - width, end}, {end, end + width}});
    int pressed = 0, open = 0;
    for (const auto& part : parts) {
      const double angle = (part.from + part.to) / 2;
      const bool sprung = rim::covers(arcs, angle);
      const bool is_cut = rim::covers(arcs, part.from + 1e-7) != rim::covers(arcs, part.to - 1e-7);
      if (is_cut || std::abs(std::cos(angle)) < 0.01 || (half && std::sin(angle) < 0)) continue;
      const double gap = gap_over(system.gap(0), z, part, z.size() - (half ? 1 : 2));
      ++(sprung ? pressed : open);
      EXPECT_GT(sprung ? gap : -gap, -1e-9 * largest) << angle;
    }
    EXPECT_GT(std::min(pressed, open), n / 8);
  }
}

/// A sheet in tension along x about a free disc: the hole narrows across the load, and bears on two sides.
TEST(Contact, ASheetInTensionBearsOnTwoSides) {
  const auto contact = find({.half = false,
                             .directions = R"(["x", "y"])",
                             .extra = R"(, "external": [{"id": "L", "on": "left", "direction": "x", "kind": "rigid"},
      {"id": "R", "on": "right", "direction": "x", "kind": "rigid"}],
    "loads": [{"external": "L", "displacement": -0.1}, {"external": "R", "displacement": 0.1},
      {"disc": "pin", "direction": "x", "force": 0}])"});
  const auto& arcs = contact.state.holes[0].arcs;
  ASSERT_EQ(arcs.size(), 2U);
  EXPECT_NEAR((arcs[0].from + arcs[0].to) / 2, -pi / 2, 1e-8);
  EXPECT_NEAR((arcs[1].from + arcs[1].to) / 2, pi / 2, 1e-8);
  EXPECT_LE(contact.state.holes[0].iterations, 6);
  EXPECT_EQ(contact.state.holes[0].half_angle, 0);
  EXPECT_NEAR(contact.state.displacement[2], 0, 1e-9);
  EXPECT_NEAR(contact.state.force[2], 0, 1e-12);
}

/// Springs and friction together carry the load; the amplitude is mu F / c with c = t d pi / 8 of half a rim.
TEST(Contact, SpringsAndFrictionCarryTheLoad) {
  const double mu = 0.15;
  const auto contact = find({.extra = pulled("traction", 0.5, mu)});
  const double F = contact.state.force[0];
  const double c = thickness * diameter * pi / 8;
  EXPECT_NEAR(contact.state.friction[1], mu * std::abs(F) / c, 1e-12);  // bears along -x
  EXPECT_EQ(contact.state.friction[0], 0);
  const double dragged = thickness * diameter / 2 / 2;  // int t cos^2... of a unit case: t r / 2 along x for half a rim
  EXPECT_NEAR(0.5 + F - contact.state.friction[1] * dragged, 0, 1e-12);
  EXPECT_NEAR(F, -0.5 / (1 + 2 / pi * mu), 1e-12);
  EXPECT_LE(contact.state.holes[0].iterations, 5);
}

TEST(Contact, ASearchThatIsCutShortSaysHowFarItWas) {
  const auto plate = test::make_plate(Sheet{.extra = pulled("traction", 1)}.json());
  const auto search = [&] { (void)stage1::find_contact(plate.scene, plate.mesh, plate.problem, 2); };
  EXPECT_THAT(search, testing::ThrowsMessage<NumericalError>(testing::MatchesRegex(
                          "plate.json: /holes/0/spring: the contact of hole \"pin\" has not come to rest in 2 "
                          "iterations: the ends of its arcs still move by 0.00.* rad; allowed: 1e-06 rad")));
}

/// Rounding alone would hold such a plate, and move it by any distance.
TEST(Contact, AFloatingPlateIsNotHeldByRounding) {
  const auto plate = test::make_plate(R"({"format": "plate", "version": 1, "analysis": "plane strain",
    "materials": {"m": {"E": 1e18, "nu": -0.5}},
    "geometry": {"grid": {"x": [0, 1.4953731671602549e-09, 2.519596595165393e-09, 3.174942100487419e-09],
                          "y": [0, 1.3249713298981606e-09], "thickness": 1e-09}},
    "disc_directions": ["y", "x"],
    "holes": [{"id": "a", "center": [7.476865835801274e-10, 6.624856649490803e-10], "radius": 1.3972169309285464e-10,
               "spring": {"modulus": 7.157084758022732e+21, "compression_only": true}}],
    "supports": [{"on": "left", "fix": ["y"]}],
    "external": [{"id": "T", "on": "left", "direction": "x", "kind": "traction"}],
    "loads": [{"external": "T", "force": 1e-17}, {"disc": "a", "direction": "x", "force": 5e-09}], "p": [1, 2]})");
  EXPECT_THAT([&] { (void)stage1::find_contact(plate.scene, plate.mesh, plate.problem); },
              ThrowsMessage<NumericalError>(HasSubstr("/loads: even with the whole rims sprung")));
}

TEST(Contact, LostContactIsSaid) {
  const auto message = [](const Sheet& sheet) -> std::string {
    try {
      (void)find(sheet);
    } catch (const NumericalError& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_THAT(message({.extra = R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": "traction"}],
    "loads": [{"external": "P", "force": 1}, {"disc": "pin", "force": -2}])"}),
              HasSubstr("plate.json: /loads: even with the whole rims sprung, something that carries load can move"));
  // biaxial tension opens the hole all round, and a disc in it cannot carry a force
  EXPECT_THAT(message({.extra = R"(, "external": [{"id": "L", "on": "left", "direction": "x", "kind": "rigid"},
      {"id": "R", "on": "right", "direction": "x", "kind": "rigid"}, {"id": "T", "on": "top", "direction": "y", "kind": "rigid"}],
    "loads": [{"external": "L", "displacement": -1}, {"external": "R", "displacement": 1}, {"external": "T", "displacement": 1},
      {"disc": "pin", "force": 1e-9}])"}),
              HasSubstr("plate.json: /loads: hole \"pin\" has lost contact all round"));
}

}  // namespace
}  // namespace fastjoint
